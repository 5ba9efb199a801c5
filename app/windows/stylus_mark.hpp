/// \file How the stylus is drawn on every plane.
#pragma once

#include "core/vec.hpp"

namespace touchtrial::app {

/// A ring for a stylus above the plane, filled while it is pressed; grey where nobody moves it.
/// Into ImGui's current window. \param at  window units \param density  as GlfwWindow::density
void draw_stylus(Vec2 at, bool pressed, bool is_live, float density);

}  // namespace touchtrial::app
