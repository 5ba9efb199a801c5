/// \file Forces that are shaped so that the tip of a device accelerates as that of an ideal one in
/// the same hand. For simulations alone: with people, nobody knows what an unmeasured tip does.
/// Source: docs/devices/compensation.md.
#pragma once

#include "core/vec.hpp"
#include "device/model/device_model.hpp"
#include "device/servo/servo.hpp"
#include "device/simulated/hand_on_tip.hpp"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace touchtrial::device {

/// The largest bound on a shaper's gain, dB.
inline constexpr double kMostGainDb = 40.0;

/// A causal filter of every axis of a force, for ticks of the servo: as much gain as mass,
/// structure and low-pass of a device take away, up to a bound, and none at rest, so that the
/// stiffness of a wall and the mean of a push are what they were. A tick costs no heap, lock or
/// exception, and half a microsecond. Not thread-safe.
class ForceShaper {
 public:
  /// \param device  its friction, delay and steps are left as they are; its peak force bounds the
  ///   shaped force
  /// \param hand  that holds it
  /// \param most_gain_db  bound of the gain at any frequency, and of its loss, in [0, kMostGainDb]
  /// \throws std::invalid_argument if a parameter is out of range
  ForceShaper(const DeviceModel& device, const HandOptions& hand, double most_gain_db);

  /// \return the force to command in place of this one, N; call it once a tick
  [[nodiscard]] Vec3 shaped(Vec3 force_n) noexcept;
  /// Forgets the forces so far.
  void reset() noexcept;

  /// \param axis  0 .. 2: x, y, z of the plane frame
  /// \return the filter's gain at a frequency, a factor
  [[nodiscard]] double gain(std::size_t axis, double frequency_hz) const noexcept;

 private:
  std::array<std::vector<double>, 3> responses_;  ///< to a unit pulse, by axis
  std::vector<Vec3> forces_n_;                    ///< the latest, a ring
  std::size_t next_ = 0;
  double max_force_n_;  ///< 0: no limit
};

/// A source whose forces are shaped. The servo's safety chain judges the shaped force.
class CompensatedForce final : public ForceSource {
 public:
  /// \param force  must outlive this
  CompensatedForce(ForceSource& force, ForceShaper shaper)
      : force_(force), shaper_(std::move(shaper)) {}

  [[nodiscard]] Vec3 force_n(const DeviceSample& sample) noexcept override {
    return shaper_.shaped(force_.force_n(sample));
  }

 private:
  ForceSource& force_;
  ForceShaper shaper_;
};

}  // namespace touchtrial::device
