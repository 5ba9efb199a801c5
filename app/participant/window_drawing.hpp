/// \file The thread that draws a participant's window, and its pictures.
#pragma once

#include "app/participant/canvas.hpp"
#include "app/participant/window_exchange.hpp"
#include "core/plane.hpp"

#include <map>
#include <string>

struct GLFWwindow;

namespace touchtrial::app {

class ConsoleWindow;

/// Pictures as OpenGL textures, each resized to the size at which it is shown.
/// Belongs to the drawing thread, whose OpenGL context must be current.
class GlPictureShelf final : public PictureShelf {
 public:
  /// \param pictures  by label; must outlive this object
  /// \param pitch_mm  of a pixel, > 0
  GlPictureShelf(const std::map<std::string, GreyImage>& pictures, double pitch_mm)
      : pictures_(pictures), pitch_mm_(pitch_mm) {}

  /// \return 40 mm x 40 mm if there is no such picture
  [[nodiscard]] Vec2 size_mm(const std::string& label) const override;
  [[nodiscard]] void* texture(const std::string& label, int width, int height) override;

  /// Deletes all textures, while the context is still current.
  void clear();
  /// \param density  screen pixels per window unit
  void set_density(double density) noexcept { density_ = density; }

 private:
  struct Texture {
    unsigned int name = 0;
    int width = 0;
    int height = 0;
  };

  const std::map<std::string, GreyImage>& pictures_;
  double pitch_mm_;
  double density_ = 1.0;
  std::map<std::string, Texture> textures_;
};

/// Draws what the exchange shows until it ends, with the window's OpenGL context, which it releases
/// afterwards. Draws nothing while nothing changes, so that the servo has the processor. The screen
/// takes one key or button per picture, so that its effect is seen before the next. Failures go to
/// the exchange.
/// \param glass  the scale that the screens read; only this function writes it
/// \param shelf  of the same OpenGL context; its textures are deleted at the end
/// \param console  drawn between this window's pictures when it asks for it; null: no console
void draw_until_ended(GLFWwindow* window, WindowExchange& exchange, Glass& glass,
                      GlPictureShelf& shelf, ConsoleWindow* console);

}  // namespace touchtrial::app
