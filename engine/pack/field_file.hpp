/// \file The bytes of a `<code>.field` file. Private to engine/pack.
///
/// Little-endian. 64 bytes of header, then height x width samples, row-major:
///   offset  type       content
///        0  8 bytes    "TTFIELD1"
///        8  u32        version, 2
///       12  u32        sample layout, 1: f32 surface, f32 force_x, f32 force_y; 2: f32 coefficient
///       16  u32        height, pixels
///       20  u32        width, pixels
///       24  f64        pitch, mm per pixel
///       32  f64        the highest surface or coefficient
///       40  24 bytes   zero
/// The header holds all that a model needs before the stylus comes down, so that making one reads
/// no sample. That it agrees with the samples is what the file's checksum vouches for.
/// Format: docs/data-dictionary.md, "Pack".
#pragma once

#include "core/bytes.hpp"
#include "engine/rendering/texture_field.hpp"

#include <filesystem>

namespace touchtrial::engine {

/// The layout is that of the view; its `highest` is computed anew.
/// \throws std::invalid_argument if the view is empty, too large, has another number of samples
///   than its geometry, heights that are not finite, or a pitch that is not a finite number > 0
[[nodiscard]] Bytes encode_field(FieldView field);

/// The field in a file's bytes, not copied; they must be aligned to 4 bytes, as mapped files are.
/// \param path  of the file, for the message
/// \throws FileError if the bytes are not exactly one field
[[nodiscard]] FieldView decode_field(ByteView file, const std::filesystem::path& path);

}  // namespace touchtrial::engine
