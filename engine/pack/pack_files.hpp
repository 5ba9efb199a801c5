/// \file The bytes of a pack's two kinds of file, `<code>.field` and `pack.json`.
/// Private to engine/pack. Formats: docs/data-dictionary.md, "Pack".
///
/// A field file is a little-endian header of 64 bytes, then height x width f32 samples, row-major.
/// The header holds everything that a model needs before contact, so that creating a model reads no
/// samples.
#pragma once

#include "core/bytes.hpp"
#include "engine/pack/pack.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace touchtrial::engine {

/// Encodes a field in the view's layout; recomputes the highest point.
/// \throws std::invalid_argument if the view is empty or too large, the number of samples does not
///   fit its geometry, its heights are not finite, or its pitch is not a finite number > 0
[[nodiscard]] Bytes encode_field(FieldView field);

/// Decodes a field without copying; the view points into `file`.
/// \param file  aligned to 4 bytes, as mapped files are
/// \param path  the file's path, for messages
/// \throws FileError if the bytes are not exactly one field
[[nodiscard]] FieldView decode_field(ByteView file, const std::filesystem::path& path);

/// Writes keys and codes in order, so that equal manifests give equal texts.
/// \throws std::invalid_argument as write_manifest
[[nodiscard]] std::string manifest_to_json(PackManifest manifest);

/// Reads a manifest. Requires every key exactly once, valid values, no unknown keys, and the exact
/// bytes of manifest_to_json().
/// \param path  the file's path, for messages
/// \throws FileError with the file and the place of the first fault
[[nodiscard]] PackManifest manifest_from_json(std::string_view text,
                                              const std::filesystem::path& path);

}  // namespace touchtrial::engine
