#include "device/acceptance/motion_figures.hpp"

#include "core/cholesky.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace touchtrial::device {
namespace {

/// Motion must exceed this many encoder steps.
constexpr double kMinMotionSteps = 5.0;
constexpr double kMaxMissedShare = 0.02;  ///< share of missed servo ticks
constexpr double kUnknownStepMm = 0.01;

/// \name Minimum errors, for error sources that do not scatter within a run
///@{
constexpr double kLoadFloorN = 0.01;
constexpr double kFrictionFloorN = 0.02;
constexpr double kFrictionShare = 0.10;
constexpr double kMassFloorKg = 0.003;
constexpr double kMassShare = 0.05;
constexpr double kViscousFloor = 0.3;
constexpr double kDelayFloorMs = 0.5;
constexpr double kDelayMsUnexplained = 50.0;  ///< at most 1 ms, because of kRigidUnexplained
constexpr double kReversalsFloorMs = 1.0;
constexpr double kLagShare = 0.25;
///@}

/// In all built-in models with a structure, soft arms yield first, which bends the path early.
constexpr double kReversalsEarlyTicks = 0.4;

/// One axis at every tick, with missed ticks filled in.
struct EvenSeries {
  std::vector<double> position_mm;
  std::vector<double> force_n;
  double missed_share = 0.0;  ///< share of missed ticks
};

EvenSeries even_series(std::span<const ServoSample> samples, Vec3 axis) {
  EvenSeries series;
  std::size_t filled = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double position_mm = dot(samples[i].position_mm, axis);
    if (i > 0) {
      const std::int64_t gap = samples[i].tick - samples[i - 1].tick;
      const double previous_mm = dot(samples[i - 1].position_mm, axis);
      for (std::int64_t k = 1; k < gap; ++k, ++filled) {
        const double share = static_cast<double>(k) / static_cast<double>(gap);
        series.position_mm.push_back(previous_mm + share * (position_mm - previous_mm));
        series.force_n.push_back(dot(samples[i - 1].force_n, axis));
      }
    }
    series.position_mm.push_back(position_mm);
    series.force_n.push_back(dot(samples[i].force_n, axis));
  }
  if (!series.position_mm.empty()) {
    series.missed_share =
        static_cast<double>(filled) / static_cast<double>(series.position_mm.size());
  }
  return series;
}

std::size_t ticks_of(double seconds) {
  return static_cast<std::size_t>(std::llround(seconds * kServoRateHz));
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// \return the standard error of the mean; 0 for fewer than two values
double standard_error_of(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const auto n = static_cast<double>(values.size());
  return std::sqrt(squares / (n - 1.0) / n);
}

double quantile_of(std::vector<double>& values, double share) {
  const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

/// The encoder step along one axis.
struct AxisStep {
  bool has_motion = false;
  bool is_resolved = false;
  double step_mm = 0.0;  ///< if not resolved: the median change, an upper bound of the step
  double spread_mm = 0.0;
};

AxisStep axis_step(const EvenSeries& series) {
  constexpr std::size_t kHalf = 25;  // ticks to either side, for the speed
  constexpr double kMinSpeedMmS = 1.0;
  constexpr std::size_t kMinSamples = 100;
  std::vector<double> changes;
  std::size_t moving = 0;
  const std::vector<double>& x = series.position_mm;
  for (std::size_t i = kHalf; i + kHalf < x.size(); ++i) {
    const double mm_s = (x[i + kHalf] - x[i - kHalf]) / (2.0 * kHalf * kServoTickS);
    if (std::abs(mm_s) < kMinSpeedMmS) continue;
    ++moving;
    const double change = std::abs(x[i] - x[i - 1]);
    if (change > 1e-9) changes.push_back(change);
  }
  AxisStep step;
  if (moving < kMinSamples || changes.size() < kMinSamples / 2) return step;
  step.has_motion = true;
  step.step_mm = quantile_of(changes, 0.5);
  step.spread_mm = 0.5 * (quantile_of(changes, 0.75) - quantile_of(changes, 0.25));
  const auto equal = std::ranges::count_if(changes, [&](double change) {
    return std::abs(change - step.step_mm) < 0.05 * step.step_mm;
  });
  const double unchanged = 1.0 - static_cast<double>(changes.size()) / static_cast<double>(moving);
  step.is_resolved =
      unchanged > 0.3 || static_cast<double>(equal) > 0.6 * static_cast<double>(changes.size());
  return step;
}

constexpr std::size_t kUnknowns = 4;
using FitRow = std::array<double, kUnknowns>;

/// The least-squares solution; unused entries are 0.
struct Solution {
  FitRow factors{};
  FitRow inverse_diagonal{};  ///< of the normal matrix
  double explained = 0.0;     ///< explained part of the sum of squares
};

/// Least squares by the normal equations.
class LeastSquares {
 public:
  /// \param row  the values of the functions whose weighted sum approximates `value`
  void add(const FitRow& row, double value) {
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      right_[i] += row[i] * value;
      for (std::size_t k = 0; k < kUnknowns; ++k) normal_[i][k] += row[i] * row[k];
    }
  }
  /// \param n  number of functions to use, from the first
  /// \return the solution; nothing if the functions are not independent
  [[nodiscard]] std::optional<Solution> solve(std::size_t n) const {
    std::array<double, kUnknowns * kUnknowns> numbers{};
    const std::span factor = std::span(numbers).first(n * n);
    for (std::size_t i = 0; i < n; ++i) std::copy_n(normal_[i].begin(), n, &factor[i * n]);
    if (!factorise(factor, n)) return std::nullopt;
    Solution solution;
    const std::span factors = std::span(solution.factors).first(n);
    std::copy_n(right_.begin(), n, factors.begin());
    solve_lower(factor, factors);
    solve_upper(factor, factors);
    for (std::size_t i = 0; i < n; ++i) {
      solution.explained += right_[i] * factors[i];
      FitRow unit{};
      unit[i] = 1.0;
      solve_lower(factor, std::span(unit).first(n));
      for (const double part : unit) solution.inverse_diagonal[i] += part * part;
    }
    return solution;
  }

 private:
  std::array<FitRow, kUnknowns> normal_{};
  FitRow right_{};
};

constexpr int kMinDelay = -2;  ///< ticks
constexpr int kMaxDelay = 30;
constexpr std::size_t kDelays = kMaxDelay - kMinDelay + 1;

/// Means over one window with the smooth weight, SI units.
struct Window {
  double acceleration = 0.0;
  double velocity = 0.0;
  double direction = 0.0;                 ///< +1 or -1
  std::array<double, kDelays> force_n{};  ///< by delay in ticks

  /// \param delay  in ticks; forces between ticks are interpolated linearly
  [[nodiscard]] double force_at(double delay) const {
    const double offset = delay - kMinDelay;
    const auto below =
        static_cast<std::size_t>(std::clamp(offset, 0.0, static_cast<double>(kDelays - 2)));
    const double share = offset - static_cast<double>(below);
    return (1.0 - share) * force_n[below] + share * force_n[below + 1];
  }
};

/// The weight (1 - u^2)^3 and its derivatives, sampled, and normalised so that a parabola's
/// acceleration and a line's velocity are exact.
struct WindowWeight {
  explicit WindowWeight(std::size_t half_ticks) : half(half_ticks) {
    const auto w = static_cast<double>(half);
    double sum = 0.0;
    double second_sum = 0.0;
    double first_sum = 0.0;
    for (std::size_t i = 0; i <= 2 * half; ++i) {
      const double t = static_cast<double>(i) - w;
      const double u = t / w;
      const double v = 1.0 - u * u;
      value.push_back(v * v * v);
      first.push_back(-6.0 * u * v * v);
      second.push_back(-6.0 * v * v + 24.0 * u * u * v);
      sum += value.back();
      const double t_s = t * kServoTickS;
      first_sum += first.back() * t_s;
      second_sum += second.back() * 0.5 * t_s * t_s;
    }
    for (std::size_t i = 0; i < value.size(); ++i) {
      value[i] /= sum;
      first[i] /= first_sum;
      second[i] /= second_sum;
    }
  }
  std::size_t half;
  std::vector<double> value;
  std::vector<double> first;
  std::vector<double> second;
};

/// \return +1 or -1 if the handle moves in one direction throughout the window, else 0
double direction_in(const std::vector<double>& x, std::size_t middle, std::size_t half,
                    double step_mm) {
  constexpr std::size_t kLocal = 4;
  const double change_mm = x[middle + half] - x[middle - half];
  if (std::abs(change_mm) <= kMinMotionSteps * step_mm) return 0.0;
  const double direction = change_mm > 0.0 ? 1.0 : -1.0;
  for (std::size_t i = middle - half; i <= middle + half; ++i) {
    if (direction * (x[i + kLocal] - x[i - kLocal]) <= 1.01 * step_mm) return 0.0;
  }
  return direction;
}

/// \return the weighted mean of the directions of motion (+1, 0 or -1) in a window
double mean_direction_in(const std::vector<double>& x, std::size_t middle,
                         const WindowWeight& weight) {
  constexpr std::size_t kLocal = 4;
  double direction = 0.0;
  for (std::size_t i = 0; i <= 2 * weight.half; ++i) {
    const std::size_t tick = middle - weight.half + i;
    const double change_mm = x[tick + kLocal] - x[tick - kLocal];
    if (change_mm != 0.0) direction += weight.value[i] * std::copysign(1.0, change_mm);
  }
  return direction;
}

/// Ticks from `begin` up to, but not including, `end`.
struct TickRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

enum class Reversals { excluded, included };

/// \param reversals  whether to include windows in which the handle reverses
std::vector<Window> windows_in(const EvenSeries& series, TickRange ticks, std::size_t half,
                               double step_mm, Reversals reversals) {
  constexpr std::size_t kEdge = 8;
  const WindowWeight weight(half);
  const std::vector<double>& x = series.position_mm;
  std::vector<Window> windows;
  const std::size_t first = ticks.begin + half + static_cast<std::size_t>(kMaxDelay) + kEdge;
  for (std::size_t middle = first; middle + half + kEdge < ticks.end; middle += half / 2) {
    Window window;
    const bool includes_reversals = reversals == Reversals::included;
    window.direction = includes_reversals ? mean_direction_in(x, middle, weight)
                                          : direction_in(x, middle, half, step_mm);
    if (!includes_reversals && window.direction == 0.0) continue;
    for (std::size_t i = 0; i <= 2 * half; ++i) {
      const double offset_m = 0.001 * (x[middle - half + i] - x[middle]);
      window.acceleration += weight.second[i] * offset_m;
      window.velocity += weight.first[i] * offset_m;
      const auto tick = static_cast<std::ptrdiff_t>(middle - half + i);
      for (std::size_t k = 0; k < kDelays; ++k) {
        const std::ptrdiff_t sent = tick - (kMinDelay + static_cast<std::ptrdiff_t>(k));
        window.force_n[k] += weight.value[i] * series.force_n[static_cast<std::size_t>(sent)];
      }
    }
    windows.push_back(window);
  }
  return windows;
}

/// Acceleration as a linear combination of the force without friction, a constant, and the speed:
/// the unknowns are 1 / m, an offset and -b / m. Acceleration is the dependent variable because
/// noise and soft arms disturb it.
FitRow row_of(const Window& window, double friction_n, double delay) {
  return {window.force_at(delay) - friction_n * window.direction, 1.0, window.velocity, 0.0};
}

struct LinearFit {
  FitRow unknowns{};
  double squares = 0.0;
};

/// \param n  unknowns: 3, or 2 without damping
std::optional<LinearFit> fit_at(const std::vector<Window>& windows, double friction_n, double delay,
                                std::size_t n) {
  LeastSquares sums;
  for (const Window& window : windows) {
    sums.add(row_of(window, friction_n, delay), window.acceleration);
  }
  const auto solution = sums.solve(n);
  if (!solution) return std::nullopt;
  LinearFit fit{solution->factors};
  for (const Window& window : windows) {
    const FitRow row = row_of(window, friction_n, delay);
    const double residual =
        std::inner_product(row.begin(), row.end(), fit.unknowns.begin(), -window.acceleration);
    fit.squares += residual * residual;
  }
  return fit;
}

/// Standard errors of the unknowns, followed by the standard error of the delay.
std::optional<FitRow> standard_errors(const std::vector<Window>& windows, const LinearFit& fit,
                                      double friction_n, double delay, std::size_t n) {
  LeastSquares sums;
  for (const Window& window : windows) {
    FitRow row = row_of(window, friction_n, delay);
    row[n] = fit.unknowns[0] * (window.force_at(delay - 0.5) - window.force_at(delay + 0.5));
    sums.add(row, 0.0);
  }
  const auto solution = sums.solve(n + 1);
  if (!solution) return std::nullopt;
  // Neighbouring windows share half of their samples.
  const double variance = 2.0 * fit.squares / static_cast<double>(windows.size() - kUnknowns);
  FitRow errors{};
  for (std::size_t i = 0; i <= n; ++i) {
    errors[i] = std::sqrt(variance * solution->inverse_diagonal[i]);
  }
  return errors;
}

struct WindowFit {
  FitRow unknowns{};
  FitRow errors{};
  double unexplained = 0.0;
  std::size_t windows = 0;
  double delay_ticks = 0.0;
  double delay_error_ticks = 0.0;  ///< standard error
};

/// \param n  as in fit_at
std::optional<WindowFit> best_fit(const std::vector<Window>& windows, double friction_n,
                                  std::size_t n) {
  constexpr double kFine = 0.25;  // ticks
  double squares = 0.0;
  for (const Window& window : windows) squares += window.acceleration * window.acceleration;
  double best_delay = kMinDelay;
  std::optional<LinearFit> best;
  for (double delay = kMinDelay; delay <= kMaxDelay; delay += kFine) {
    const std::optional<LinearFit> fit = fit_at(windows, friction_n, delay, n);
    if (!fit) return std::nullopt;
    if (best && fit->squares >= best->squares) continue;
    best = fit;
    best_delay = delay;
  }
  const std::optional<FitRow> errors = standard_errors(windows, *best, friction_n, best_delay, n);
  if (!errors || !(best->unknowns[0] > 0.0)) return std::nullopt;
  // A force is held until the next tick, so on average it acts half a tick late.
  return WindowFit{best->unknowns, *errors,          std::sqrt(best->squares / squares),
                   windows.size(), best_delay - 0.5, (*errors)[n]};
}

/// The maximum unexplained share of a rigid handle's fit.
constexpr double kRigidUnexplained = 0.02;

/// The fits with windows of several lengths.
struct WindowFits {
  std::optional<WindowFit> best;       ///< among fits without negative damping
  std::optional<Measured> delay_ms{};  ///< if the fits agree, as for a rigid handle
};

WindowFits fits_of(const std::vector<std::vector<Window>>& windows_by_length, double friction_n) {
  constexpr double kAgreeingTicks = 0.5;
  WindowFits fits;
  std::vector<WindowFit> all_fits;
  for (const std::vector<Window>& windows : windows_by_length) {
    std::optional<WindowFit> fit = best_fit(windows, friction_n, 3);
    if (!fit) continue;
    all_fits.push_back(*fit);
    // No device has negative damping: if soft arms mimic it, the fit is repeated without damping.
    if (fit->unknowns[2] > 0.0) fit = best_fit(windows, friction_n, 2);
    if (fit && (!fits.best || fit->unexplained < fits.best->unexplained)) fits.best = fit;
  }
  if (all_fits.empty()) return fits;
  const auto [min, max] =
      std::ranges::minmax(all_fits, {}, [](const WindowFit& fit) { return fit.delay_ticks; });
  const WindowFit& best_explained =
      *std::ranges::min_element(all_fits, {}, &WindowFit::unexplained);
  const double spread = max.delay_ticks - min.delay_ticks;
  if (best_explained.unexplained > kRigidUnexplained || spread > kAgreeingTicks) return fits;
  const double ms = 1000.0 * kServoTickS;
  fits.delay_ms = Measured{best_explained.delay_ticks * ms,
                           (2.0 * best_explained.delay_error_ticks + spread) * ms + kDelayFloorMs +
                               kDelayMsUnexplained * best_explained.unexplained};
  return fits;
}

/// Fits windows so long that the resonance of soft arms is above their pass band. Below resonance a
/// structure does not shift the phase, so any lag is delay or a motor's time constant. Windows of
/// this length include reversals of the handle.
/// \return nothing if too much is unexplained
std::optional<WindowFit> fit_slow_motion(const EvenSeries& series, TickRange ticks,
                                         double friction_n, double step_mm) {
  constexpr std::size_t kLongHalf = 48;  // ticks
  constexpr double kMaxUnexplainedSlowly = 0.05;
  const std::vector<Window> windows =
      windows_in(series, ticks, kLongHalf, step_mm, Reversals::included);
  if (windows.size() <= 2 * kUnknowns) return std::nullopt;
  const std::optional<WindowFit> fit = best_fit(windows, friction_n, 3);
  return fit && fit->unexplained < kMaxUnexplainedSlowly ? fit : std::nullopt;
}

/// A reversal of the push.
struct Reversal {
  double ticks = 0.0;      ///< time; fractional if the slew limit stretched it
  double direction = 0.0;  ///< of the force's change: +1 or -1
};

std::vector<Reversal> reversals_in(const EvenSeries& series, TickRange ticks, double push_n,
                                   std::size_t min_distance) {
  constexpr std::size_t kMaxReversal = 6;  // ticks of a reversal
  const std::vector<double>& f = series.force_n;
  std::vector<std::size_t> starts;
  for (std::size_t i = ticks.begin + 1; i + kMaxReversal < ticks.end; ++i) {
    const bool is_same_reversal = !starts.empty() && i - starts.back() < kMaxReversal;
    if (!is_same_reversal && std::abs(f[i] - f[i - 1]) > 0.4 * push_n) starts.push_back(i);
  }
  std::vector<Reversal> reversals;
  for (std::size_t k = 1; k + 1 < starts.size(); ++k) {
    const std::size_t i = starts[k];
    if (i - starts[k - 1] < min_distance || starts[k + 1] - i < min_distance) continue;
    const double before_n = f[i - 1];
    const double after_n = f[i + kMaxReversal - 1];
    if (std::abs(after_n - before_n) < push_n) continue;
    double lateness = 0.0;
    for (std::size_t j = i; j < i + kMaxReversal; ++j)
      lateness += (after_n - f[j]) / (after_n - before_n);
    reversals.push_back({static_cast<double>(i) + lateness, after_n > before_n ? 1.0 : -1.0});
  }
  return reversals;
}

/// \return the handle's deviation from its parabola at a time after a force step with a time
///   constant; arbitrary unit
double bend_after(double ticks, double lag_ticks) {
  if (ticks <= 0.0) return 0.0;
  const double straight = 0.5 * ticks * ticks;
  if (lag_ticks <= 0.0) return straight;
  return straight - lag_ticks * ticks - lag_ticks * lag_ticks * std::expm1(-ticks / lag_ticks);
}

/// \return the variance of a path segment, mm^2 per tick, that a bend in its middle explains in
///   addition to a parabola; 0 for a bend against the force's change. It is maximal where the path
///   bends: a segment without a bend is a parabola, and an off-centre bend fits worse.
std::optional<double> bend_at(const std::vector<double>& x, double bend, double direction,
                              double half, double lag_ticks) {
  LeastSquares sums;
  const double max = bend_after(half, lag_ticks);
  const auto first = static_cast<std::size_t>(std::ceil(bend - half));
  const auto last = static_cast<std::size_t>(std::floor(bend + half));
  for (std::size_t i = first; i <= last; ++i) {
    const double ticks = static_cast<double>(i) - bend;
    const double t = ticks / half;
    sums.add({1.0, t, t * t, bend_after(ticks, lag_ticks) / max}, x[i] - x[first]);
  }
  const auto bend_solution = sums.solve(4);
  const auto parabola_solution = sums.solve(3);
  if (!bend_solution || !parabola_solution) return std::nullopt;
  if (bend_solution->factors[3] * direction <= 0.0) return 0.0;
  return std::max(bend_solution->explained - parabola_solution->explained, 0.0) /
         static_cast<double>(last - first + 1);
}

/// \name The range of delays searched for a bend, ticks
///@{
constexpr double kMinBendDelay = -2.0;
constexpr double kMaxBendDelay = 14.0;
///@}

/// \return the reversals around which the longest segments fit into the recording
std::vector<Reversal> usable_reversals(const std::vector<Reversal>& reversals, TickRange ticks,
                                       double half) {
  std::vector<Reversal> usable;
  for (const Reversal& reversal : reversals) {
    if (reversal.ticks < static_cast<double>(ticks.begin) + 2.0 * half) continue;
    if (reversal.ticks + kMaxBendDelay + 2.0 * half > static_cast<double>(ticks.end)) continue;
    usable.push_back(reversal);
  }
  return usable;
}

struct BendingDelay {
  double ticks = 0.0;
  double error_ticks = 0.0;  ///< standard error
  bool is_at_limit = false;  ///< at an end of the searched range, so the true delay may be outside
  std::vector<std::pair<double, double>> bend_by_delay;
};

/// Finds the delay after which the path bends when the push reverses. While the handle moves in one
/// direction, friction is constant, so nothing else bends the path as sharply.
std::optional<BendingDelay> bending_delay(const EvenSeries& series,
                                          const std::vector<Reversal>& reversals, double half) {
  constexpr double kFine = 0.25;
  constexpr auto kCandidates =
      static_cast<std::size_t>((kMaxBendDelay - kMinBendDelay) / kFine) + 1;
  const auto delay_of = [&](std::ptrdiff_t candidate) {
    return kMinBendDelay + kFine * static_cast<double>(candidate);
  };
  std::vector<double> sums(kCandidates, 0.0);
  std::vector<double> best_delays;
  for (const Reversal& reversal : reversals) {
    std::vector<double> bends(kCandidates);
    for (std::size_t k = 0; k < kCandidates; ++k) {
      const double bend_ticks = reversal.ticks + delay_of(static_cast<std::ptrdiff_t>(k));
      const auto bend = bend_at(series.position_mm, bend_ticks, reversal.direction, half, 0.0);
      if (!bend) return std::nullopt;
      bends[k] = *bend;
    }
    best_delays.push_back(delay_of(std::ranges::max_element(bends) - bends.begin()));
    for (std::size_t k = 0; k < kCandidates; ++k) sums[k] += bends[k];
  }
  const auto best = std::ranges::max_element(sums) - sums.begin();
  BendingDelay delay;
  delay.is_at_limit = best == 0 || best + 1 == static_cast<std::ptrdiff_t>(kCandidates);
  delay.ticks = delay_of(best);
  // Estimated from quartiles, because of outliers: 1.25 times the interquartile range over 1.35.
  const double spread = quantile_of(best_delays, 0.75) - quantile_of(best_delays, 0.25);
  delay.error_ticks = 0.93 * spread / std::sqrt(static_cast<double>(best_delays.size()));
  for (std::size_t k = 0; k < kCandidates; ++k) {
    delay.bend_by_delay.emplace_back(
        1000.0 * kServoTickS * delay_of(static_cast<std::ptrdiff_t>(k)),
        std::sqrt(sums[k] / static_cast<double>(best_delays.size())));
  }
  return delay;
}

/// The delay and time constant, in ticks, that best explain the path around reversals.
struct LaggingDelay {
  double delay = 0.0;
  double lag = 0.0;
  double explained = 0.0;
};

/// \return the variance that a parabola and a bend explain in a fixed segment around a reversal
std::optional<double> explained_variance(const std::vector<double>& x, double reversal,
                                         double delay, double lag_ticks) {
  constexpr double kBefore = 6.0;  // ticks
  constexpr double kAfter = 14.0;
  LeastSquares sums;
  const auto first = static_cast<std::size_t>(std::ceil(reversal - kBefore));
  const auto last = static_cast<std::size_t>(std::floor(reversal + kAfter));
  const double max = bend_after(kAfter - delay, lag_ticks);
  for (std::size_t i = first; i <= last; ++i) {
    const double ticks = static_cast<double>(i) - reversal;
    const double t = ticks / kAfter;
    sums.add({1.0, t, t * t, bend_after(ticks - delay, lag_ticks) / max}, x[i] - x[first]);
  }
  const auto solution = sums.solve(4);
  if (!solution) return std::nullopt;
  return solution->explained;
}

std::optional<LaggingDelay> lagging_delay(const EvenSeries& series,
                                          const std::vector<Reversal>& reversals) {
  constexpr std::array kLags = {0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0};
  constexpr double kMaxLaggingDelay = 10.0;
  std::optional<LaggingDelay> best;
  for (const double lag : kLags) {
    for (double delay = kMinBendDelay; delay <= kMaxLaggingDelay; delay += 1.0) {
      double sum = 0.0;
      for (const Reversal& reversal : reversals) {
        const auto explained = explained_variance(series.position_mm, reversal.ticks, delay, lag);
        if (!explained) return std::nullopt;
        sum += *explained;
      }
      if (!best || sum > best->explained) best = LaggingDelay{delay, lag, sum};
    }
  }
  return best;
}

/// Soft arms disturb long segments more, encoder steps short ones. Slow motors and soft arms round
/// a bend, so the delay is between the estimates from bends and from slow motion.
/// \param slow_fit  from fit_slow_motion
ValueOrReason<Measured> delay_from_reversals(
    const EvenSeries& series, TickRange ticks, double push_n,
    const std::optional<WindowFit>& slow_fit,
    std::vector<std::pair<double, double>>& bend_by_delay) {
  constexpr double kShortHalf = 5.0;  // ticks
  constexpr double kMiddleHalf = 6.5;
  constexpr double kLongHalf = 8.0;
  constexpr double kNoLag = 1.0;
  constexpr double kSlowEarlyTicks = 0.5;  // as in the shipped models
  constexpr double kSlowTicksUnexplained = 10.0;
  constexpr double kNoSlowFitTicks = 0.5;  // error because a slow motor may remain undetected
  constexpr std::size_t kMinReversals = 8;
  const std::vector<Reversal> reversals =
      usable_reversals(reversals_in(series, ticks, push_n, static_cast<std::size_t>(kLongHalf) + 2),
                       ticks, kLongHalf);
  if (reversals.size() < kMinReversals) {
    return {std::nullopt, "too few reversals of the push were usable"};
  }
  const auto short_bend = bending_delay(series, reversals, kShortHalf);
  const auto middle_bend = bending_delay(series, reversals, kMiddleHalf);
  const auto lagging = lagging_delay(series, reversals);
  if (!short_bend || !middle_bend || !lagging)
    return {std::nullopt, "no bend of the path follows the push"};
  bend_by_delay = short_bend->bend_by_delay;
  const double ms = 1000.0 * kServoTickS;
  if (short_bend->is_at_limit || (middle_bend->is_at_limit && !slow_fit)) {
    return {std::nullopt, "no bend follows the reversals of the push within " +
                              std::to_string(std::lround(kMaxBendDelay * ms)) +
                              " ms: the delay is longer, or something held the handle"};
  }
  double bend = short_bend->ticks + kReversalsEarlyTicks;
  double error = 0.0;
  if (lagging->lag > kNoLag) {
    bend = std::max(bend, lagging->delay + lagging->lag);
    error += kLagShare * lagging->lag;
  }
  const double slow_ticks = slow_fit ? slow_fit->delay_ticks + kSlowEarlyTicks : bend;
  error += 0.5 * std::abs(slow_ticks - bend);
  error += slow_fit ? kSlowTicksUnexplained * slow_fit->unexplained
                    : 2.0 * short_bend->error_ticks +
                          std::abs(short_bend->ticks - middle_bend->ticks) + kNoSlowFitTicks;
  return {Measured{0.5 * (bend + slow_ticks) * ms, error * ms + kReversalsFloorMs}};
}

ValueOrReason<ShakeFigures> no_figures(std::string reason) {
  return {std::nullopt, std::move(reason)};
}

}  // namespace

std::optional<RestFigures> rest_figures(std::span<const ServoSample> samples) {
  constexpr std::size_t kSettling = 500;
  constexpr std::size_t kMinSamples = 1000;
  if (samples.size() < kSettling + kMinSamples) return std::nullopt;
  const auto rest_samples = samples.subspan(kSettling);
  Vec3 halves[2];
  double squares = 0.0;
  const std::size_t half = rest_samples.size() / 2;
  const Vec3 first_mm = rest_samples.front().position_mm;
  for (std::size_t i = 0; i < 2 * half; ++i) {
    const Vec3 offset = rest_samples[i].position_mm - first_mm;
    halves[i < half ? 0 : 1] = halves[i < half ? 0 : 1] + offset;
    squares += dot(offset, offset);
  }
  const auto n = static_cast<double>(2 * half);
  const Vec3 mean = (1.0 / n) * (halves[0] + halves[1]);
  return RestFigures{std::sqrt(std::max(squares / n - dot(mean, mean), 0.0)),
                     norm((2.0 / n) * (halves[1] - halves[0]))};
}

ValueOrReason<Measured> encoder_step_mm(std::span<const ServoSample> samples) {
  AxisStep coarsest;
  bool all_resolved = true;
  for (const DeviceAxis axis : kDeviceAxes) {
    const AxisStep step = axis_step(even_series(samples, direction_of(axis)));
    if (!step.has_motion) {
      return {std::nullopt, "the handle was not moved along axis " + std::string(name_of(axis))};
    }
    all_resolved = all_resolved && step.is_resolved;
    if (step.step_mm > coarsest.step_mm) coarsest = step;
  }
  if (!all_resolved) {
    return {std::nullopt,
            "readings change by arbitrary amounts: noise or a filter hides the steps, or they are "
            "finer than " +
                std::to_string(coarsest.step_mm) + " mm"};
  }
  return {Measured{coarsest.step_mm, coarsest.spread_mm + 0.05 * coarsest.step_mm}};
}

ValueOrReason<StrokeFigures> stroke_figures(const SlowStrokes& strokes, double step_mm) {
  constexpr std::size_t kHalf = 50;  // ticks to either side, for the speed
  const Vec3 axis = direction_of(strokes.axis());
  if (strokes.has_run_away()) return {std::nullopt, "the handle left its place"};
  if (strokes.has_swung()) {
    return {std::nullopt,
            "the held handle oscillated because of delay or soft arms, so the device must not hold "
            "it"};
  }
  const EvenSeries series = even_series(strokes.samples(), axis);
  const std::vector<double>& x = series.position_mm;
  const std::size_t begin = ticks_of(strokes.hold_s());
  const std::size_t period = ticks_of(SlowStrokes::kPeriodS);
  const std::size_t end = begin + SlowStrokes::kPeriods * period;
  if (x.size() < end) return {std::nullopt, "the run ended early"};
  if (series.missed_share > kMaxMissedShare)
    return {std::nullopt, "the servo missed too many ticks"};
  std::vector<double> sums;
  std::vector<double> differences;
  StrokeFigures figures;
  const auto [min, max] = std::minmax_element(x.begin() + static_cast<std::ptrdiff_t>(begin),
                                              x.begin() + static_cast<std::ptrdiff_t>(end));
  const double middle_mm = 0.5 * (*min + *max);
  if (*max - *min <= kMinMotionSteps * step_mm) {
    return {std::nullopt, "the handle moved less than five encoder steps"};
  }
  for (int p = 0; p < SlowStrokes::kPeriods; ++p) {
    double force_n[2] = {};
    std::size_t ticks[2] = {};
    for (std::size_t i = begin + static_cast<std::size_t>(p) * period;
         i < begin + static_cast<std::size_t>(p + 1) * period; ++i) {
      const double phase = static_cast<double>(i - begin) / static_cast<double>(period) - p;
      const bool is_back = phase >= 0.25 && phase < 0.75;
      const double direction = is_back ? -1.0 : 1.0;
      const std::size_t ahead = std::min(i + kHalf, x.size() - 1);
      const double mm_s = direction * (x[ahead] - x[i - kHalf]) / (2.0 * kHalf * kServoTickS);
      if (mm_s < 0.5 * SlowStrokes::kSpeedMmS || mm_s > 2.0 * SlowStrokes::kSpeedMmS) continue;
      force_n[is_back ? 1 : 0] += series.force_n[i];
      ++ticks[is_back ? 1 : 0];
    }
    const bool follows_strokes = std::min(ticks[0], ticks[1]) >= period / 15;
    // Friction makes the first stroke lag, because the handle starts off-centre.
    if (!follows_strokes && p == 0) continue;
    if (!follows_strokes) {
      return {std::nullopt, "the handle did not follow the strokes: it sticks, or a hand held it"};
    }
    const double forward_n = force_n[0] / static_cast<double>(ticks[0]);
    const double backward_n = force_n[1] / static_cast<double>(ticks[1]);
    sums.push_back(0.5 * (forward_n + backward_n));
    differences.push_back(0.5 * (forward_n - backward_n));
  }
  figures.load_n = {mean_of(sums), 2.0 * standard_error_of(sums) + kLoadFloorN};
  const double friction_n = mean_of(differences);
  figures.friction_n = {friction_n, 2.0 * standard_error_of(differences) + kFrictionFloorN +
                                        kFrictionShare * std::abs(friction_n)};
  for (std::size_t i = begin; i < end; i += 10) {
    figures.loop.emplace_back(x[i] - middle_mm, series.force_n[i] - figures.load_n.value);
  }
  return {figures, ""};
}

ValueOrReason<ShakeFigures> shake_figures(const ShakenStrokes& strokes, double friction_n,
                                          double step_mm) {
  constexpr std::array<std::size_t, 4> kHalves = {8, 12, 20, 32};
  constexpr std::size_t kMinWindows = 60;
  if (strokes.has_run_away()) return no_figures("the handle left its place");
  const EvenSeries series = even_series(strokes.samples(), direction_of(strokes.axis()));
  if (series.missed_share > kMaxMissedShare) return no_figures("the servo missed too many ticks");
  const std::size_t begin = ticks_of(ShakenStrokes::shake_start_s());
  const std::size_t end = begin + ticks_of(ShakenStrokes::kShakeS) - 1;
  if (series.position_mm.size() < end) return no_figures("the run ended early");
  const double min_mm = step_mm > 0.0 ? step_mm : kUnknownStepMm;
  std::vector<std::vector<Window>> windows_by_length;
  for (const std::size_t half : kHalves) {
    std::vector<Window> windows =
        windows_in(series, {begin, end}, half, min_mm, Reversals::excluded);
    if (windows.size() >= kMinWindows) windows_by_length.push_back(std::move(windows));
  }
  if (windows_by_length.empty()) {
    return no_figures("the handle moved too little: less than five encoder steps at a time");
  }
  // The friction of slow strokes includes damping at their speed.
  WindowFits fits = fits_of(windows_by_length, friction_n);
  if (fits.best) {
    const double viscous = std::max(-fits.best->unknowns[2] / fits.best->unknowns[0], 0.0);
    friction_n -= 0.001 * SlowStrokes::kSpeedMmS * viscous;
    fits = fits_of(windows_by_length, friction_n);
  }
  const std::optional<WindowFit> slow_fit =
      fit_slow_motion(series, {begin, end}, friction_n, min_mm);
  const std::optional<WindowFit>& best = fits.best;
  if (!best) return no_figures("the mass cannot be estimated from the handle's motion");
  if (best->unexplained > kMaxUnexplained) {
    return no_figures(
        "the motion does not follow the force: a hand held the handle, it struck "
        "something, or its arms are soft");
  }
  ShakeFigures figures;
  figures.unexplained = best->unexplained;
  figures.windows = best->windows;
  const double mass_kg = 1.0 / best->unknowns[0];
  const double viscous = std::max(0.0, -best->unknowns[2] * mass_kg);
  figures.mass_kg = {mass_kg, 2.0 * best->errors[0] * mass_kg * mass_kg + kMassFloorKg +
                                  (kMassShare + 0.5 * best->unexplained) * mass_kg};
  figures.viscous_n_s_per_m = {
      viscous, 2.0 * best->errors[2] * mass_kg + kViscousFloor + 0.1 * std::abs(viscous)};
  const ValueOrReason<Measured> from_reversals =
      delay_from_reversals(series, {begin, end}, strokes.push_n(), slow_fit, figures.bend_by_delay);
  figures.delay_ms = fits.delay_ms ? fits.delay_ms : from_reversals.value;
  if (!figures.delay_ms) figures.no_delay_reason = from_reversals.reason;
  return {figures, ""};
}

}  // namespace touchtrial::device
