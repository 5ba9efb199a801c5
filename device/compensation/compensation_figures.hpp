/// \file What shaping forces for a device would deliver at the tip, and what it costs in noise of
/// the encoders and in stiffness: measured on the device's model in virtual time.
/// Source: docs/devices/compensation.md.
#pragma once

#include "device/model/device_model.hpp"
#include "device/simulated/hand_on_tip.hpp"

#include <vector>

namespace touchtrial::device {

/// The stiffness of the wall on which noise is measured.
inline constexpr double kNoiseWallNPerMm = 0.4;
/// Walls are tried from the softest to the stiffest, each stiffer than the last by the step.
inline constexpr double kSoftestWallNPerMm = 0.05;
inline constexpr double kStiffestWallNPerMm = 20.0;
inline constexpr double kWallStep = 1.05;

/// The tip's acceleration under a sine along a stroke from left to right, in amplitudes per newton
/// of the texture.
struct TipResponse {
  double frequency_hz = 0.0;
  double ideal_m_s2_per_n = 0.0;    ///< of an ideal device in the same hand
  double without_m_s2_per_n = 0.0;  ///< of the device
  double with_m_s2_per_n = 0.0;     ///< of the device, with shaped forces
  double gain_db = 0.0;             ///< of the motors' force, by shaping
};

/// What a wall is like.
struct WallFigures {
  /// Root mean square of what encoder steps add to the force, on a wall of kNoiseWallNPerMm.
  double noise_motors_n = 0.0;
  double noise_tip_n = 0.0;  ///< to the force between tip and hand
  /// The last wall before the first that keeps swinging; 0: not even the softest settles.
  double stiffest_n_per_mm = 0.0;
};

struct CompensationFigures {
  std::vector<TipResponse> responses;  ///< 10 to 320 Hz, in thirds of octaves
  WallFigures without;
  WallFigures with;
};

/// Measures by sines, strokes and kicks. A function of its arguments. Cost: a few seconds.
/// \param hand  its push, kind and factors
/// \throws std::invalid_argument as ForceShaper
[[nodiscard]] CompensationFigures measure_compensation(const DeviceModel& device,
                                                       const HandOptions& hand,
                                                       double most_gain_db);

}  // namespace touchtrial::device
