/// \file What OpenGL has drawn.
#pragma once

#include "engine/pictures/colour_image.hpp"

namespace touchtrial {

/// The current context's picture, before it is swapped to the screen. \param width,height  pixels,
/// >= 1
[[nodiscard]] ColourImage drawn_picture(int width, int height);

}  // namespace touchtrial
