/// \file The bytes of a `<code>.field` file. Private to engine/pack.
///
/// Little-endian. 64 bytes of header, then height x width samples, row-major:
///   offset  type       content
///        0  8 bytes    "TTFIELD1"
///        8  u32        version, 1
///       12  u32        sample layout, 1: f32 surface, f32 force_x, f32 force_y
///       16  u32        height, pixels
///       20  u32        width, pixels
///       24  f64        pitch, mm per pixel
///       32  32 bytes   zero
/// Format: docs/data-dictionary.md, "Pack".
#pragma once

#include "core/bytes.hpp"
#include "engine/rendering/texture_field.hpp"

#include <filesystem>

namespace touchtrial {

/// \throws std::invalid_argument if the view is empty, too large, has another number of samples
///   than its geometry, or a pitch that is not a finite number > 0
[[nodiscard]] Bytes encode_field(FieldView field);

/// The field in a file's bytes, not copied; they must be aligned to 4 bytes, as mapped files are.
/// \param path  of the file, for the message
/// \throws FileError if the bytes are not exactly one field
[[nodiscard]] FieldView decode_field(ByteView file, const std::filesystem::path& path);

}  // namespace touchtrial
