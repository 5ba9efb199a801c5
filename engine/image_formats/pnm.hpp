/// \file PGM and PPM, text and binary, of any maximum value. Read here, without a decoder, because
/// the maximum value decides the scale.
#pragma once

#include "core/bytes.hpp"
#include "core/plane.hpp"

namespace touchtrial::engine {

/// Samples are scaled to floor(v * 255 / maximum + 0.5), each channel for itself, then made grey
/// like those of any other picture. Only the first picture of a file is read.
/// \param file  starts with P2, P3, P5 or P6
/// \throws ImageFault if it is truncated, too large, or a sample exceeds the maximum
[[nodiscard]] GreyImage read_pnm(ByteView file);

}  // namespace touchtrial::engine
