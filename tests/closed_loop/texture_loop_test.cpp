#include "bench/closed_loop/texture_loop.hpp"

#include "engine/extraction.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

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
  engine::RenderingOptions options{.texture_stiffness_n_per_mm = 4.0};
  const Plane<double> texture = texture_of("cloth");
  CHECK(stroke_texture(texture, options).vibration_mm_s >
        20.0 * stroke_texture(texture, engine::RenderingOptions{}).vibration_mm_s);
}

TEST_CASE("a touchdown ramp takes the lateral step from a landing under model paper") {
  engine::RenderingOptions options;
  const engine::TextureField field = engine::make_texture_field(texture_of("pebbles"), options);
  const engine::FieldView view = field.view();
  const auto median_step_n = [&](double ramp_n) {
    options.touchdown_ramp_n = ramp_n;
    const engine::RenderingModel model(view, options, {.tangential_n = 0.01, .normal_n = 0.01});
    std::vector<double> steps_n;
    for (std::uint64_t seed = 1; seed <= 9; ++seed) {
      const Touchdown landing =
          touch_down(model, view.geometry, {.speed_mm_s = 100.0, .time_s = 1.2, .seed = seed});
      CHECK(landing.largest_step_n >= landing.step_n);
      CHECK(landing.rms_n > 0.01);
      steps_n.push_back(landing.step_n);
    }
    std::ranges::sort(steps_n);
    return steps_n[4];
  };
  const double step_n = median_step_n(0.0);
  CHECK(step_n > 0.01);
  CHECK(median_step_n(0.2) < 0.3 * step_n);
}

}  // namespace
}  // namespace touchtrial::bench
