#include "app/participant/gl_picture_shelf.hpp"

#include "engine/pictures/colour_image.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <GLFW/glfw3.h>

namespace touchtrial::app {
namespace {

// OpenGL 1.2, which some systems' gl.h stops short of.
constexpr GLint kClampToEdge = 0x812F;

void upload(const GreyImage& image) {
  std::vector<std::uint8_t> pixels;
  pixels.reserve(image.size() * 4);
  for (const std::uint8_t grey : image.samples())
    pixels.insert(pixels.end(), {grey, grey, grey, 255});
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, kClampToEdge);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, kClampToEdge);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, image.width(), image.height(), 0, GL_RGBA,
               GL_UNSIGNED_BYTE, pixels.data());
}

}  // namespace

void GlPictureShelf::clear() {
  for (const auto& [label, texture] : textures_) glDeleteTextures(1, &texture.name);
  textures_.clear();
}

Vec2 GlPictureShelf::size_mm(const std::string& label) const {
  constexpr double kBlankMm = 40.0;
  const auto found = pictures_.find(label);
  if (found == pictures_.end() || found->second.empty()) return {kBlankMm, kBlankMm};
  return {pitch_mm_ * found->second.width(), pitch_mm_ * found->second.height()};
}

void* GlPictureShelf::texture(const std::string& label, int width, int height) {
  const auto found = pictures_.find(label);
  if (found == pictures_.end() || found->second.empty()) return nullptr;
  const int across = std::max(1, static_cast<int>(std::lround(width * density_)));
  const int down = std::max(1, static_cast<int>(std::lround(height * density_)));
  Texture& texture = textures_[label];
  if (texture.name == 0) glGenTextures(1, &texture.name);
  if (texture.width != across || texture.height != down) {
    glBindTexture(GL_TEXTURE_2D, texture.name);
    upload(engine::resized(found->second, down, across));
    texture.width = across;
    texture.height = down;
  }
  // ImGui's renderer takes the number for a pointer.
  return reinterpret_cast<void*>(static_cast<std::intptr_t>(texture.name));
}

}  // namespace touchtrial::app
