/// \file A wall by Hooke's law, and a sink that keeps all samples, for tests of devices.
#pragma once

#include "device/servo/servo.hpp"

#include <algorithm>
#include <vector>

namespace touchtrial {

class FlatWall final : public device::ForceSource {
 public:
  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    return {0.0, 0.0, 0.4 * std::max(0.0, -sample.position_mm.z)};
  }
};

class KeptSamples final : public device::SampleSink {
 public:
  void record(const device::ServoSample& sample) noexcept override { samples.push_back(sample); }

  std::vector<device::ServoSample> samples;
};

}  // namespace touchtrial
