/// \file The rendering model as the servo asks for it.
#pragma once

#include "device/servo.hpp"
#include "engine/rendering/paper_model.hpp"

namespace touchtrial {

/// Refers to the model, which must outlive it.
class PaperForce final : public ForceSource {
 public:
  explicit PaperForce(const PaperModel& model) noexcept : model_(model) {}

  [[nodiscard]] Vec3 force_n(const DeviceSample& sample) noexcept override {
    return model_.force_n(sample.position_mm, sample.velocity_mm_s);
  }

 private:
  const PaperModel& model_;
};

}  // namespace touchtrial
