/// \file The thread that draws a participant's window.
#pragma once

#include "app/participant/gl_picture_shelf.hpp"
#include "app/participant/window_exchange.hpp"

struct GLFWwindow;

namespace touchtrial::app {

class ConsoleWindow;

/// Draws what the exchange shows until it ends; takes the window's OpenGL context and gives it
/// back. Draws nothing as long as nothing changes, so that the servo has the processor.
/// One key or button goes to the screen a picture: what it does is seen before the next.
/// \param glass  where the screens' context looks the scale up; written here alone
/// \param shelf  of the same context; its textures are gone afterwards
/// \param console  drawn between this window's pictures, when it wants to be; null: there is none
/// Failures go to the exchange.
void draw_until_ended(GLFWwindow* window, WindowExchange& exchange, Glass& glass,
                      GlPictureShelf& shelf, ConsoleWindow* console);

}  // namespace touchtrial::app
