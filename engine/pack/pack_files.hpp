/// \file The bytes of a pack's two kinds of file, `<code>.field` and `pack.json`.
/// Private to engine/pack. Formats: docs/data-dictionary.md, "Pack".
///
/// A field file is little-endian: 64 bytes of header, then height x width samples, row-major:
///   offset type content 0 8 bytes "TTFIELD1" 8 u32 version, 3 12 u32 sample layout, 1: f32
///   surface, f32 force_x, f32 force_y; 2: f32 coefficient 16 u32 height, pixels 20 u32 width,
///   pixels 24 f64 pitch, mm per pixel 32 f64 the highest surface or coefficient 40 24 bytes zero
///   The header holds all that a model needs before contact, so that creating a model reads no
///   sample. The file's checksum ensures that header and samples agree.
#pragma once

#include "core/bytes.hpp"
#include "engine/pack/pack.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace touchtrial::engine {

/// The file has the view's layout; its highest point is recomputed.
/// \throws std::invalid_argument if the view is empty or too large, the number of samples does not
///   fit its geometry, its heights are not finite, or its pitch is not a finite number > 0
[[nodiscard]] Bytes encode_field(FieldView field);

/// The field in a file's bytes, not copied.
/// \param file  aligned to 4 bytes, as mapped files are
/// \param path  of the file, for the message
/// \throws FileError if the bytes are not exactly one field
[[nodiscard]] FieldView decode_field(ByteView file, const std::filesystem::path& path);

/// Keys and codes are sorted: equal manifests give equal texts.
/// \throws std::invalid_argument as write_manifest
[[nodiscard]] std::string manifest_to_json(PackManifest manifest);

/// Every key must be there once, known, and with a value of its type and range, and every byte as
/// manifest_to_json writes it.
/// \param path  of the file, for the message
/// \throws FileError with the file and the place of the first fault
[[nodiscard]] PackManifest manifest_from_json(std::string_view text,
                                              const std::filesystem::path& path);

}  // namespace touchtrial::engine
