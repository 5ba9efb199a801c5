#include "protocols/session/hand_meter.hpp"

#include "core/random.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/texture_field.hpp"
#include "protocols/session/exploration.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace touchtrial::session {
namespace {

constexpr double kRateHz = 1000.0;

/// Strokes to and fro along x over 60 mm, and presses evenly.
class EvenHand {
 public:
  EvenHand(double force_n, double speed_mm_s) : force_n_(force_n), speed_mm_s_(speed_mm_s) {}

  void stroke(HandMeter& meter, double seconds, double height_mm = -1.0) {
    const auto end = tick_ + std::llround(seconds * kRateHz);
    for (; tick_ < end; ++tick_) {
      const double way_mm = speed_mm_s_ * static_cast<double>(tick_) / kRateHz;
      const double there_and_back = std::fmod(way_mm, 120.0);
      const double x_mm = there_and_back < 60.0 ? there_and_back : 120.0 - there_and_back;
      meter.feel({{x_mm, 20.0, height_mm}, {0.0, 0.0, height_mm > 0.0 ? 0.0 : force_n_}, tick_});
    }
  }

 private:
  double force_n_;
  double speed_mm_s_;
  std::int64_t tick_ = 0;
};

std::optional<HandLevels> levels_after(double force_n, double speed_mm_s,
                                       const study::ValidityRule& rule = {}) {
  HandMeter meter(rule, kRateHz);
  EvenHand(force_n, speed_mm_s).stroke(meter, 2.0);
  return meter.levels();
}

TEST_CASE("levels of the hand are relative to the instructions") {
  CHECK(levels_after(0.3, 30.0) == HandLevels{HandLevel::low, HandLevel::low});
  CHECK(levels_after(0.65, 100.0) == HandLevels{HandLevel::right, HandLevel::right});
  CHECK(levels_after(1.2, 250.0) == HandLevels{HandLevel::high, HandLevel::high});
  CHECK(levels_after(1.2, 10.0) == HandLevels{HandLevel::high, HandLevel::low});
}

TEST_CASE("a study's own window of force holds where it is narrower, or another one") {
  study::ValidityRule rule{.max_median_n = 0.6};
  CHECK(levels_after(0.7, 100.0, rule)->force == HandLevel::high);
  rule = {.min_median_n = 1.5, .max_median_n = 3.0};
  CHECK(levels_after(0.7, 100.0, rule)->force == HandLevel::low);
  CHECK(levels_after(2.0, 100.0, rule)->force == HandLevel::right);
}

TEST_CASE("there are no levels before the hand has been at the plane for half a second") {
  HandMeter meter({}, kRateHz);
  EvenHand hand(0.65, 100.0);
  hand.stroke(meter, 1.0, 10.0);
  CHECK_FALSE(meter.levels());
  hand.stroke(meter, 0.45);
  CHECK_FALSE(meter.levels());
  hand.stroke(meter, 0.1);
  CHECK(meter.levels());
  // A relief takes a light hand out of contact, but not away.
  hand.stroke(meter, 0.2, 2.0);
  CHECK(meter.levels());
  hand.stroke(meter, 0.01, 5.0);
  CHECK_FALSE(meter.levels());
  meter.feel({{0.0, 0.0, std::numeric_limits<double>::quiet_NaN()}, {}, 5000});
  CHECK_FALSE(meter.levels());
}

TEST_CASE("a step of the encoders is no stroke") {
  HandMeter meter({}, kRateHz);
  RandomStream random(1, "hand meter");
  for (std::int64_t tick = 0; tick < 2000; ++tick) {
    const double x_mm = random.uniform(0.0, 1.0) < 0.5 ? 0.0 : 0.06;
    meter.feel({{x_mm, 0.0, -1.0}, {0.0, 0.0, 0.65}, tick});
  }
  REQUIRE(meter.levels());
  CHECK(meter.levels()->speed == HandLevel::low);
}

/// What the experimenter reads, every 250 ms, while a hand strokes a texture.
class Reader final : public device::SampleSink {
 public:
  void record(const device::ServoSample& sample) noexcept override {
    meter_.feel(sample);
    if (sample.tick % 250 != 0 || read_.size() == read_.capacity()) return;
    read_.push_back(meter_.levels());
  }
  [[nodiscard]] const std::vector<std::optional<HandLevels>>& read() const { return read_; }

 private:
  HandMeter meter_{study::ValidityRule{}, kRateHz};
  std::vector<std::optional<HandLevels>> read_ = [] {
    std::vector<std::optional<HandLevels>> room;
    room.reserve(100);
    return room;
  }();
};

/// A texture of white noise, as rough as its stiffness budget allows; 0: a blank wall.
std::vector<std::optional<HandLevels>> read_over(double budget_n_per_mm, engine::ModelKind kind,
                                                 double push_n) {
  engine::RenderingOptions options{.model = kind};
  if (budget_n_per_mm > 0.0) options.texture_stiffness_n_per_mm = budget_n_per_mm;
  Plane<double> texture(200, 200);
  RandomStream random(3, "hand meter: texture");
  for (double& value : texture.samples()) value = random.uniform(-40.0, 40.0);
  const engine::TextureField field = engine::make_texture_field(texture, options);
  const engine::FieldView view = field.view();
  const engine::Gains gains = budget_n_per_mm > 0.0
                                  ? engine::choose_gains({&view, 1}, options).per_field.front()
                                  : engine::Gains{};
  const engine::RenderingModel model(view, options, gains);
  device::HandOptions hand{.push_n = push_n, .explore_s = 6.0};
  device::ExplorationOptions path{.duration_s = 6.0};
  path.slowest_mm_s = path.fastest_mm_s = 100.0;
  RandomStream way(4, "hand meter: path");
  device::SimulatedHand stroking(hand, device::ExplorationPath(view.geometry, path, way));
  ModelForce force(model);
  Reader reader;
  CHECK(device::run_servo_in_virtual_time(stroking, force, reader, {}).end !=
        device::ServoEnd::fault);
  return reader.read();
}

TEST_CASE("the levels are those of the hand, the same on a blank and on a rough plane") {
  const double push_n = GENERATE(0.35, 0.65, 1.1);
  const engine::ModelKind kind = GENERATE(engine::ModelKind::paper, engine::ModelKind::surface);
  const auto blank = read_over(0.0, kind, push_n);
  REQUIRE(blank.size() > 15);
  CHECK(blank.back().has_value());
  CHECK(read_over(0.4, kind, push_n) == blank);
}

}  // namespace
}  // namespace touchtrial::session
