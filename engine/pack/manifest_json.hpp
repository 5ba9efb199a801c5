/// \file The text of `pack.json`. Private to engine/pack. Format: docs/data-dictionary.md, "Pack".
#pragma once

#include "engine/pack/pack.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace touchtrial::engine {

/// Sorted keys and codes: one text for one manifest. \throws std::invalid_argument as
/// write_manifest
[[nodiscard]] std::string manifest_to_json(PackManifest manifest);

/// Takes nothing on trust: every key must be there once, known, of its type and in its range.
/// \param path  of the file, for the message
/// \throws FileError with the file and the JSON pointer of the first fault
[[nodiscard]] PackManifest manifest_from_json(std::string_view text,
                                              const std::filesystem::path& path);

}  // namespace touchtrial::engine
