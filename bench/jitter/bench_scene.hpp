/// \file What the measured servo feels: a stylus that is led over a texture, without hardware.
#pragma once

#include "device/servo/servo.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/texture_field.hpp"

#include <cstdint>

namespace touchtrial::bench::jitter {

/// A device whose stylus comes down on the plane and then strokes it at up to 80 mm/s, 1 mm deep,
/// whatever the force. Its state is a function of the number of ticks.
class LedStylus final : public device::HapticDevice {
 public:
  LedStylus(const PlaneGeometry& plane, double rate_hz) noexcept;

  [[nodiscard]] device::DeviceInfo info() const override;
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& sample) noexcept override;
  [[nodiscard]] device::DeviceStatus write(Vec3) noexcept override {
    return device::DeviceStatus::ok;
  }
  void halt() noexcept override {}
  void rearm() noexcept override {}

 private:
  Vec2 middle_mm_;
  Vec2 reach_mm_;
  double tick_s_;
  std::int64_t ticks_ = 0;
};

/// The model `paper` with a study's defaults on the default picture "bark", extracted adaptively.
class BenchScene {
 public:
  BenchScene();

  [[nodiscard]] const engine::RenderingModel& model() const noexcept { return model_; }
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }

 private:
  engine::TextureField field_;
  PlaneGeometry plane_;
  engine::RenderingModel model_;
};

}  // namespace touchtrial::bench::jitter
