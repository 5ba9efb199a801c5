#include "bench/closed_loop/texture_loop.hpp"

#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/servo/servo.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "protocols/session/exploration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace touchtrial::bench {
namespace {

constexpr double kHighPassHz = 30.0;
constexpr double kLandingS = 1.0;

/// Two first-order high-pass filters in series.
class HighPass {
 public:
  [[nodiscard]] Vec3 filter(Vec3 value) noexcept {
    for (Vec3& slow : slow_) {
      slow = slow + kShare * (value - slow);
      value = value - slow;
    }
    return value;
  }

 private:
  static constexpr double kShare = 2.0 * std::numbers::pi * kHighPassHz /
                                   (2.0 * std::numbers::pi * kHighPassHz + device::kServoRateHz);
  std::array<Vec3, 2> slow_{};
};

class ChatterSink final : public device::SampleSink {
 public:
  explicit ChatterSink(double push_n) : push_n_(push_n) {}

  void record(const device::ServoSample& sample) noexcept override {
    const Vec3 fast = high_pass_.filter(device::kServoRateHz * (sample.position_mm - previous_mm_));
    previous_mm_ = sample.position_mm;
    const bool is_touching = sample.force_n.z > 0.0;
    if (static_cast<double>(sample.tick) >= kLandingS * device::kServoRateHz) {
      ++ticks_;
      power_ += fast.x * fast.x + fast.y * fast.y + fast.z * fast.z;
      lost_contacts_ += was_touching_ && !is_touching ? 1 : 0;
      deviation_n_ = std::max(deviation_n_, std::abs(sample.force_n.z - push_n_));
    }
    was_touching_ = is_touching;
  }

  [[nodiscard]] Chatter chatter() const {
    const auto ticks = static_cast<double>(std::max<std::int64_t>(ticks_, 1));
    return {std::sqrt(power_ / ticks),
            static_cast<double>(lost_contacts_) * device::kServoRateHz / ticks, deviation_n_};
  }

 private:
  double push_n_;
  HighPass high_pass_;
  Vec3 previous_mm_;
  bool was_touching_ = false;
  std::int64_t ticks_ = 0;
  std::int64_t lost_contacts_ = 0;
  double power_ = 0.0;
  double deviation_n_ = 0.0;
};

class TouchdownSink final : public device::SampleSink {
 public:
  void record(const device::ServoSample& sample) noexcept override {
    const Vec2 lateral_n{sample.force_n.x, sample.force_n.y};
    const double step_n = norm(lateral_n - previous_n_);
    if (contact_ticks_ == 0 && sample.force_n.z > 0.0) touchdown_.step_n = step_n;
    if (contact_ticks_ > 0 || sample.force_n.z > 0.0) ++contact_ticks_;
    if (contact_ticks_ <= kLandingTicks) {
      touchdown_.largest_step_n = std::max(touchdown_.largest_step_n, step_n);
    }
    if (static_cast<double>(sample.tick) >= kLandingS * device::kServoRateHz) {
      ++ticks_;
      squares_ += lateral_n.x * lateral_n.x + lateral_n.y * lateral_n.y;
    }
    previous_n_ = lateral_n;
  }

  [[nodiscard]] Touchdown touchdown() const {
    Touchdown touchdown = touchdown_;
    touchdown.rms_n = std::sqrt(squares_ / static_cast<double>(std::max<std::int64_t>(ticks_, 1)));
    return touchdown;
  }

 private:
  static constexpr int kLandingTicks = 20;
  Touchdown touchdown_;
  Vec2 previous_n_;
  int contact_ticks_ = 0;  ///< since the first contact, including its tick
  std::int64_t ticks_ = 0;
  double squares_ = 0.0;
};

device::SimulatedHand stroking_hand(const PlaneGeometry& plane, const TextureStroke& stroke) {
  device::HandOptions hand;
  hand.push_n = stroke.push_n;
  hand.explore_s = stroke.time_s;
  device::ExplorationOptions path;
  path.slowest_mm_s = stroke.speed_mm_s;
  path.fastest_mm_s = stroke.speed_mm_s;
  path.duration_s = stroke.time_s;
  RandomStream random(stroke.seed, "closed loop: stroke");
  return {hand, device::ExplorationPath(plane, path, random)};
}

void run_stroke(const engine::RenderingModel& model, const PlaneGeometry& plane,
                const TextureStroke& stroke, device::SampleSink& sink) {
  device::SimulatedHand hand = stroking_hand(plane, stroke);
  session::ModelForce force(model);
  const device::ServoReport report = device::run_servo_in_virtual_time(hand, force, sink, {});
  if (report.end == device::ServoEnd::fault) {
    throw std::runtime_error("closed loop: the run ended with a fault: " +
                             std::string(device::name_of(report.fault)));
  }
}

}  // namespace

Chatter stroke_texture(const Plane<double>& texture, const engine::RenderingOptions& options,
                       const TextureStroke& stroke) {
  const engine::TextureField field = engine::make_texture_field(texture, options);
  const engine::FieldView view = field.view();
  const engine::Gains gains = engine::choose_gains({&view, 1}, options).per_field.front();
  const engine::RenderingModel model(view, options, gains);
  ChatterSink sink(stroke.push_n);
  run_stroke(model, view.geometry, stroke, sink);
  return sink.chatter();
}

Touchdown touch_down(const engine::RenderingModel& model, const PlaneGeometry& plane,
                     const TextureStroke& stroke) {
  TouchdownSink sink;
  run_stroke(model, plane, stroke, sink);
  return sink.touchdown();
}

}  // namespace touchtrial::bench
