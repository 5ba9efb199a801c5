#include "bench/jitter/bench_scene.hpp"

#include "engine/extraction.hpp"
#include "engine/rendering/gains.hpp"
#include "stimuli/generator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchtrial::bench::jitter {
namespace {

constexpr double kStartHeightMm = 2.0;
constexpr double kDepthMm = 1.0;
constexpr double kDescentMmPerS = 20.0;
/// Two frequencies without a common period, so that strokes never repeat.
constexpr Vec2 kTurnsPerS = {0.31, 0.23};
constexpr double kFastestMmPerS = 80.0;
constexpr double kTau = 6.283185307179586;

engine::TextureField bench_field() {
  const GreyImage picture = stimuli::generate_stimulus("bark", stimuli::kDefaultStimuliSeed);
  return engine::make_texture_field(engine::extract_texture<double>(picture, {}).texture, {});
}

engine::RenderingModel model_of(const engine::TextureField& field) {
  const std::array fields = {field.view()};
  return {field.view(), {}, engine::choose_gains(fields, {}).of_field.front()};
}

/// As far as the plane reaches, unless that would be too fast.
double reach_of(double side_mm, double turns_per_s) noexcept {
  return std::min(0.4 * side_mm, kFastestMmPerS / std::sqrt(2.0) / (kTau * turns_per_s));
}

}  // namespace

LedStylus::LedStylus(const PlaneGeometry& plane, double rate_hz) noexcept
    : middle_mm_{0.5 * plane.width_mm(), 0.5 * plane.height_mm()},
      reach_mm_{reach_of(plane.width_mm(), kTurnsPerS.x),
                reach_of(plane.height_mm(), kTurnsPerS.y)},
      tick_s_(1.0 / rate_hz) {}

device::DeviceInfo LedStylus::info() const {
  return {"led stylus", "", 3.3, true};
}

device::DeviceStatus LedStylus::read(device::DeviceSample& sample) noexcept {
  const double time_s = static_cast<double>(ticks_) * tick_s_;
  const Vec2 turn = {kTau * kTurnsPerS.x, kTau * kTurnsPerS.y};
  const double z_mm = std::max(-kDepthMm, kStartHeightMm - kDescentMmPerS * time_s);
  sample.position_mm = {middle_mm_.x + reach_mm_.x * std::sin(turn.x * time_s),
                        middle_mm_.y + reach_mm_.y * std::sin(turn.y * time_s), z_mm};
  sample.velocity_mm_s = {reach_mm_.x * turn.x * std::cos(turn.x * time_s),
                          reach_mm_.y * turn.y * std::cos(turn.y * time_s),
                          z_mm > -kDepthMm ? -kDescentMmPerS : 0.0};
  sample.sequence = static_cast<std::uint64_t>(++ticks_);
  return device::DeviceStatus::ok;
}

BenchScene::BenchScene()
    : field_(bench_field()), plane_(field_.view().geometry), model_(model_of(field_)) {}

}  // namespace touchtrial::bench::jitter
