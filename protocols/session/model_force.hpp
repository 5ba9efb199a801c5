/// \file The rendering model as the servo asks for it.
#pragma once

#include "device/servo/servo.hpp"
#include "engine/rendering/rendering_model.hpp"

namespace touchtrial {

/// One presentation of a model, which must outlive it.
class ModelForce final : public ForceSource {
 public:
  explicit ModelForce(const RenderingModel& model) noexcept : model_(model) {}

  [[nodiscard]] Vec3 force_n(const DeviceSample& sample) noexcept override {
    return model_.force_n(sample.position_mm, sample.velocity_mm_s, touch_);
  }

 private:
  const RenderingModel& model_;
  Bristle touch_;
};

}  // namespace touchtrial
