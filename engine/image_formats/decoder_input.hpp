/// \file A picture that has passed the checks of its format.
#pragma once

#include "core/bytes.hpp"

#include <optional>

namespace touchtrial::engine {

/// What is done with a fourth (or, with grey, a second) channel.
enum class Alpha {
  straight,  ///< composited on black by us
  ignored,   ///< the colours are multiplied already, or the channel is not alpha
};

/// What the decoder gets, and how to understand what it gives back. The bytes are a cleaned copy:
/// only what decides pixels is left, so colour profiles, thumbnails, orientation tags and comments
/// can neither change the result nor upset the decoder.
struct DecoderInput {
  Bytes bytes;
  int width_px = 0;
  int height_px = 0;
  Alpha alpha = Alpha::straight;
  bool white_is_zero = false;           ///< grey samples are to be inverted
  bool alpha_as_columns = false;        ///< grey and alpha come as neighbouring grey pixels
  std::optional<int> transparent_grey;  ///< the decoded grey sample that stands for transparent
};

/// Each checks that a file is whole and of a sample type that we know, from its structure alone.
/// \throws ImageFault otherwise
[[nodiscard]] DecoderInput check_png(ByteView file);
[[nodiscard]] DecoderInput check_jpeg(ByteView file);
[[nodiscard]] DecoderInput check_tiff(ByteView file);
[[nodiscard]] DecoderInput check_bmp(ByteView file);

}  // namespace touchtrial::engine
