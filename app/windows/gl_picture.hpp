/// \file What OpenGL has drawn.
#pragma once

#include "engine/pictures/colour_image.hpp"

namespace touchtrial::app {

/// The current context's picture, before it is swapped to the screen. \param width,height  pixels,
/// >= 1
[[nodiscard]] engine::ColourImage drawn_picture(int width, int height);

}  // namespace touchtrial::app
