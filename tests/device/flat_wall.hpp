/// \file A wall by Hooke's law and a sink that keeps everything: what the device tests feel with.
#pragma once

#include "device/servo/servo.hpp"

#include <algorithm>
#include <vector>

namespace touchtrial {

class FlatWall final : public ForceSource {
 public:
  [[nodiscard]] Vec3 force_n(const DeviceSample& sample) noexcept override {
    return {0.0, 0.0, 0.4 * std::max(0.0, -sample.position_mm.z)};
  }
};

class KeptSamples final : public SampleSink {
 public:
  void record(const ServoSample& sample) noexcept override { samples.push_back(sample); }

  std::vector<ServoSample> samples;
};

}  // namespace touchtrial
