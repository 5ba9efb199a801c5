#include "app/windows/gl_picture.hpp"

#include <cstddef>
#include <vector>

#include <GLFW/glfw3.h>

namespace touchtrial::app {

engine::ColourImage drawn_picture(int width, int height) {
  std::vector<unsigned char> bytes(static_cast<std::size_t>(width) * height * 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
  engine::ColourImage picture(height, width);
  for (int y = 0; y < height; ++y) {
    const unsigned char* row = bytes.data() + static_cast<std::size_t>(height - 1 - y) * width * 3;
    for (int x = 0; x < width; ++x) {
      picture.at(y, x) = {row[3 * x], row[3 * x + 1], row[3 * x + 2]};
    }
  }
  return picture;
}

}  // namespace touchtrial::app
