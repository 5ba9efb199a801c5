#include "bench/closed_loop/texture_loop.hpp"

#include "engine/extraction.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"

#include <string>

namespace touchtrial::bench {
namespace {

Plane<double> texture_of(const std::string& name) {
  const std::string path = std::string(TOUCHTRIAL_STIMULI) + "/" + name + ".png";
  return engine::extract_texture<double>(engine::read_grey_image(path), {}).texture;
}

TEST_CASE(
    "at the defaults hand, wall and texture are stable: contact is kept and nothing chatters") {
  engine::RenderingOptions options;
  options.model = GENERATE(engine::ModelKind::paper, engine::ModelKind::surface);
  const std::string name = GENERATE("bark", "cloth");
  CAPTURE(name);
  const Chatter chatter = stroke_texture(texture_of(name), options);
  CHECK(chatter.lost_contacts_per_s == 0.0);
  CHECK(chatter.vibration_mm_s < 1.0);
  CHECK(chatter.normal_deviation_n < 0.3);
}

TEST_CASE("a texture of ten times the stiffness makes the hand chatter under model paper") {
  engine::RenderingOptions options;
  options.texture_stiffness_n_per_mm = 4.0;
  const Plane<double> texture = texture_of("cloth");
  CHECK(stroke_texture(texture, options).vibration_mm_s >
        20.0 * stroke_texture(texture, engine::RenderingOptions{}).vibration_mm_s);
}

}  // namespace
}  // namespace touchtrial::bench
