// example PICTURE [TEXTURE.png]: the picture's texture, and the forces on a stylus that strokes it.
#include "engine/extraction.hpp"
#include "engine/image_file.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/rendering_model.hpp"

#include <array>
#include <cstdio>
#include <exception>

namespace {

void stroke(const char* picture, const char* texture_file) {
  using namespace touchtrial;
  const GreyImage image = engine::read_grey_image(picture);
  const auto extraction = engine::extract_texture<double>(image, {}, {.picture = true});
  if (texture_file != nullptr) engine::write_png(texture_file, extraction.picture);

  // As `touchtrial prepare` makes it: a pixel is 0.2 mm, forces as strong as a stable plane allows.
  const engine::RenderingOptions rendering;
  const engine::TextureField field = engine::make_texture_field(extraction.texture, rendering);
  const std::array fields = {field.view()};
  const engine::Gains gains = engine::choose_gains(fields, rendering).per_field.front();
  const engine::RenderingModel model(field.view(), rendering, gains);

  // Along the middle of the picture at 60 mm/s, 1 mm deep, a thousand times a second.
  engine::Bristle touch;
  const double y_mm = 0.5 * image.height() * rendering.pitch_mm;
  std::puts("time_s,x_mm,force_x_n,force_y_n,force_z_n");
  for (int tick = 0; tick < 20; ++tick) {
    const double x_mm = 0.06 * tick;
    const Vec3 force_n = model.force_n({x_mm, y_mm, -1.0}, {60.0, 0.0, 0.0}, touch);
    std::printf("%.3f,%.2f,%.4f,%.4f,%.4f\n", 0.001 * tick, x_mm, force_n.x, force_n.y, force_n.z);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: example PICTURE [TEXTURE.png]\n", stderr);
    return 2;
  }
  try {
    stroke(argv[1], argc > 2 ? argv[2] : nullptr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "example: %s\n", error.what());
    return 1;
  }
  return 0;
}
