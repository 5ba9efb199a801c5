/// \file The decoder of OpenCV, kept from the terminal.
#pragma once

#include "core/plane.hpp"
#include "engine/image_formats/decoder_input.hpp"

namespace touchtrial::engine {

/// Decodes a checked picture and makes it 8-bit grey. One call at a time decodes; the others wait.
/// While it does, what the process writes to standard error is taken away: the libraries under
/// OpenCV complain there, and some of those complaints are the only sign of damaged data.
/// \throws ImageFault if the decoder refuses the data or complains of damage
[[nodiscard]] GreyImage decode_grey(const DecoderInput& input);

}  // namespace touchtrial::engine
