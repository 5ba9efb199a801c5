/// \file What a simulated participant detects and tells apart, by the tracks with which published
/// thresholds were found: vibrations through hand, device and servo, three intervals, one up and
/// three down.
#pragma once

#include "device/model/device_model.hpp"
#include "protocols/simulation/subject_model.hpp"

#include <cstdint>

namespace touchtrial {

/// A vibration along the plane while the hand strokes a smooth wall.
struct Vibration {
  double frequency_hz = 0.0;
  double force_n = 0.0;  ///< peak
};

struct TrackResult {
  double force_n = 0.0;   ///< peak at which 79.4 % of answers are right, mean over tracks
  double error_db = 0.0;  ///< standard error of its level
};

/// The weakest vibration that is told from none.
/// \param tracks  of 8 reversals after the first two, each by a person of its own seed
[[nodiscard]] TrackResult detected(const simulation::SubjectModel& subject, double frequency_hz,
                                   int tracks, std::uint64_t seed);

/// The smallest difference of amplitude that is told from none.
/// \param standard_n  peak force of the weaker vibration
/// \return force_n of the stronger one at the threshold
[[nodiscard]] TrackResult told_apart(const simulation::SubjectModel& subject, double frequency_hz,
                                     double standard_n, int tracks, std::uint64_t seed);

/// How far a vibration moves the tip, from two hands on the same way, with it and without.
/// \return m, peak at its frequency, for a force of 1 N
[[nodiscard]] double displacement_m_per_n(const simulation::SubjectModel& subject,
                                          double frequency_hz, double force_n);

/// \return the summed power of the tip's acceleration, (m/s^2)^2, that a vibration makes in the hand
///   of a default subject on the ideal device
[[nodiscard]] double vibration_power(double frequency_hz, double force_n);

}  // namespace touchtrial
