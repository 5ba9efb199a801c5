/// \file Pictures as OpenGL's textures, each brought to the size at which it is shown.
#pragma once

#include "app/participant/canvas.hpp"
#include "core/plane.hpp"

#include <map>
#include <string>

namespace touchtrial::app {

/// The drawing thread's, with its OpenGL context current.
class GlPictureShelf final : public PictureShelf {
 public:
  /// \param pictures  must outlive this \param pitch_mm  of a pixel, > 0
  GlPictureShelf(const std::map<std::string, GreyImage>& pictures, double pitch_mm)
      : pictures_(pictures), pitch_mm_(pitch_mm) {}

  /// A square of 40 mm if there is no such picture.
  [[nodiscard]] Vec2 size_mm(const std::string& label) const override;
  [[nodiscard]] void* texture(const std::string& label, int width, int height) override;

  /// Gives all textures back, while the context is still current.
  void clear();
  /// Pixels of the screen for a window unit.
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

}  // namespace touchtrial::app
