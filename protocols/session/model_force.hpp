/// \file The rendering model as the servo asks for it.
#pragma once

#include "device/servo/servo.hpp"
#include "engine/rendering/rendering_model.hpp"

namespace touchtrial::session {

/// One presentation of a model, which must outlive it.
class ModelForce final : public device::ForceSource {
 public:
  explicit ModelForce(const engine::RenderingModel& model) noexcept : model_(model) {}

  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    return model_.force_n(sample.position_mm, sample.velocity_mm_s, touch_);
  }

 private:
  const engine::RenderingModel& model_;
  engine::Bristle touch_;
};

}  // namespace touchtrial::session
