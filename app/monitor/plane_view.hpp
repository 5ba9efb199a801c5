/// \file The stylus from in front of the plane, and its height beside it.
#pragma once

#include "app/monitor/monitor_view.hpp"

namespace touchtrial::app {

/// Draws at ImGui's cursor, and takes the pointer there for a mouse.
/// \param width,height  window units
void draw_plane(const MonitorPicture& picture, const GlfwWindow& window, float width, float height,
                MonitorRequests& requests);

}  // namespace touchtrial::app
