/// \file Estimates noise, steps, load, friction, mass and delay of a device from the recorded
///   motion of its handle. Pure functions. Source: docs/devices/acceptance.md.
#pragma once

#include "core/vec.hpp"
#include "device/acceptance/measurement.hpp"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::device {

/// A measured number and the half-width of its interval: twice the standard error from the scatter,
/// plus a minimum for errors that do not scatter.
struct Measured {
  double value = 0.0;
  double error = 0.0;  ///< >= 0
};

/// A value, or the reason why there is none.
template <typename Value>
struct ValueOrReason {
  std::optional<Value> value;
  std::string reason{};  ///< empty if there is a value
};

struct RestFigures {
  double noise_mm = 0.0;  ///< standard deviation of the position: the norm over all three axes
  double drift_mm = 0.0;  ///< distance between the mean positions of the two halves
};
/// \param samples  of a handle at rest; the first half second is ignored
/// \return nothing if there are fewer than 1000 samples
[[nodiscard]] std::optional<RestFigures> rest_figures(std::span<const ServoSample> samples);

/// \param samples  of a handle that a person moves slowly along all three axes
/// \return the smallest difference between readings
[[nodiscard]] ValueOrReason<Measured> encoder_step_mm(std::span<const ServoSample> samples);

/// The results of the slow strokes of one run.
struct StrokeFigures {
  Measured load_n;      ///< commanded to support the load: mean of both directions of motion
  Measured friction_n;  ///< half the difference between the directions
  /// Position along the axis relative to the middle, and commanded force minus the load, for a
  /// plot.
  std::vector<std::pair<double, double>> loop{};
};
/// \param step_mm  encoder step; strokes must exceed five steps; 0: unknown
[[nodiscard]] ValueOrReason<StrokeFigures> stroke_figures(const SlowStrokes& strokes,
                                                          double step_mm);

/// The parameters of m a = F(t - delay) - f sign(v) - b v + c, along one axis, by least squares
/// over windows in which the handle moves in one direction by more than five encoder steps. Both
/// sides are integrated with a smooth weight. Its derivatives replace derivatives of the position,
/// so encoder steps are never differentiated.
struct ShakeFigures {
  Measured mass_kg;
  Measured viscous_n_s_per_m;
  /// The time from a force's tick to the resulting bend of the path, plus the motors' time constant
  /// if it is detected.
  std::optional<Measured> delay_ms;
  std::string no_delay_reason{};  ///< why there is no delay; empty if there is one
  double unexplained = 0.0;       ///< share of the acceleration (ratio of root mean squares)
  std::size_t windows = 0;
  /// Delay in ms, and the root-mean-square deviation around reversals that a bend at this delay
  /// explains, mm.
  std::vector<std::pair<double, double>> bend_by_delay{};
};
/// If more than this share is unexplained, something else moved the handle.
inline constexpr double kMaxUnexplained = 0.3;
/// \param friction_n  of slow strokes, in commanded newtons
[[nodiscard]] ValueOrReason<ShakeFigures> shake_figures(const ShakenStrokes& strokes,
                                                        double friction_n, double step_mm);

}  // namespace touchtrial::device
