#include "device/acceptance/motion_figures.hpp"

#include "core/cholesky.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace touchtrial::device {
namespace {

/// Motion counts if it exceeds this many encoder steps.
constexpr double kStepsOfMotion = 5.0;
constexpr double kMaxLeftOut = 0.02;  ///< share of missed servo ticks
constexpr double kUnknownStepMm = 0.01;

/// \name Minimum stated errors, for error sources that do not scatter within one run
///@{
constexpr double kLoadFloorN = 0.01;
constexpr double kFrictionFloorN = 0.02;
constexpr double kFrictionShare = 0.10;
constexpr double kMassFloorKg = 0.003;
constexpr double kMassShare = 0.05;
constexpr double kViscousFloor = 0.3;
constexpr double kDelayFloorMs = 0.5;
constexpr double kDelayMsUnexplained = 50.0;  ///< at most 1 ms: kRigidUnexplained
constexpr double kTurnsFloorMs = 1.0;
constexpr double kLagShare = 0.25;
///@}

/// Soft arms yield first and bend the path early in all built-in models with a structure.
constexpr double kTurnsEarlyTicks = 0.4;

/// One axis at every tick, with missed ticks filled in.
struct EvenSeries {
  std::vector<double> position_mm;
  std::vector<double> force_n;
  double left_out = 0.0;  ///< share
};

EvenSeries even_series(std::span<const ServoSample> samples, Vec3 axis) {
  EvenSeries series;
  std::size_t filled = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double place_mm = dot(samples[i].position_mm, axis);
    if (i > 0) {
      const std::int64_t gap = samples[i].tick - samples[i - 1].tick;
      const double from_mm = dot(samples[i - 1].position_mm, axis);
      for (std::int64_t k = 1; k < gap; ++k, ++filled) {
        const double share = static_cast<double>(k) / static_cast<double>(gap);
        series.position_mm.push_back(from_mm + share * (place_mm - from_mm));
        series.force_n.push_back(dot(samples[i - 1].force_n, axis));
      }
    }
    series.position_mm.push_back(place_mm);
    series.force_n.push_back(dot(samples[i].force_n, axis));
  }
  if (!series.position_mm.empty()) {
    series.left_out = static_cast<double>(filled) / static_cast<double>(series.position_mm.size());
  }
  return series;
}

std::size_t ticks_of(double seconds) {
  return static_cast<std::size_t>(std::llround(seconds * kServoRateHz));
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The standard error of the mean; 0 for fewer than two values.
double standard_error_of(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const auto n = static_cast<double>(values.size());
  return std::sqrt(squares / (n - 1.0) / n);
}

double quantile_of(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// The encoder step along one axis, if it moved.
struct AxisStep {
  bool moved = false;
  bool resolved = false;
  double step_mm = 0.0;  ///< if not resolved: the median change, which the step does not exceed
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
  step.moved = true;
  step.step_mm = quantile_of(changes, 0.5);
  step.spread_mm = 0.5 * (quantile_of(changes, 0.75) - quantile_of(changes, 0.25));
  const auto alike = std::ranges::count_if(changes, [&](double change) {
    return std::abs(change - step.step_mm) < 0.05 * step.step_mm;
  });
  const double unchanged = 1.0 - static_cast<double>(changes.size()) / static_cast<double>(moving);
  step.resolved =
      unchanged > 0.3 || static_cast<double>(alike) > 0.6 * static_cast<double>(changes.size());
  return step;
}

constexpr std::size_t kUnknowns = 4;
using FitRow = std::array<double, kUnknowns>;

/// The least-squares solution; unused entries are 0.
struct Solution {
  FitRow factors{};
  FitRow inverse_diagonal{};  ///< of the normal matrix
  double explained = 0.0;     ///< share of the sum of squares
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
  /// \param n  only the first functions
  /// \return nothing if they are not independent
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

/// One window: means with the smooth weight, SI units.
struct Window {
  double acceleration = 0.0;
  double velocity = 0.0;
  double way = 0.0;                       ///< +1 or -1
  std::array<double, kDelays> force_n{};  ///< by delay in ticks

  /// Linear interpolation of forces between ticks.
  [[nodiscard]] double force_at(double delay) const {
    const double at = delay - kMinDelay;
    const auto below =
        static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(kDelays - 2)));
    const double share = at - static_cast<double>(below);
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

/// +1 or -1 if the handle moves in one direction in the whole window, else 0.
double way_in(const std::vector<double>& x, std::size_t middle, std::size_t half, double step_mm) {
  constexpr std::size_t kLocal = 4;
  const double change_mm = x[middle + half] - x[middle - half];
  if (std::abs(change_mm) <= kStepsOfMotion * step_mm) return 0.0;
  const double way = change_mm > 0.0 ? 1.0 : -1.0;
  for (std::size_t i = middle - half; i <= middle + half; ++i) {
    if (way * (x[i + kLocal] - x[i - kLocal]) <= 1.01 * step_mm) return 0.0;
  }
  return way;
}

/// The weighted mean of the directions of motion (+1, 0 or -1) in a window.
double mean_way_in(const std::vector<double>& x, std::size_t middle, const WindowWeight& weight) {
  constexpr std::size_t kLocal = 4;
  double way = 0.0;
  for (std::size_t i = 0; i <= 2 * weight.half; ++i) {
    const std::size_t at = middle - weight.half + i;
    const double change_mm = x[at + kLocal] - x[at - kLocal];
    if (change_mm != 0.0) way += weight.value[i] * std::copysign(1.0, change_mm);
  }
  return way;
}

/// Ticks from `from` to before `end`.
struct TickRange {
  std::size_t from = 0;
  std::size_t end = 0;
};

enum class Turning { left_out, kept };

/// \param turning  whether to include windows in which the handle reverses
std::vector<Window> windows_in(const EvenSeries& series, TickRange ticks, std::size_t half,
                               double step_mm, Turning turning) {
  constexpr std::size_t kEdge = 8;
  const WindowWeight weight(half);
  const std::vector<double>& x = series.position_mm;
  std::vector<Window> windows;
  const std::size_t first = ticks.from + half + static_cast<std::size_t>(kMaxDelay) + kEdge;
  for (std::size_t middle = first; middle + half + kEdge < ticks.end; middle += half / 2) {
    Window window;
    const bool keeps = turning == Turning::kept;
    window.way = keeps ? mean_way_in(x, middle, weight) : way_in(x, middle, half, step_mm);
    if (!keeps && window.way == 0.0) continue;
    for (std::size_t i = 0; i <= 2 * half; ++i) {
      const double offset_m = 0.001 * (x[middle - half + i] - x[middle]);
      window.acceleration += weight.second[i] * offset_m;
      window.velocity += weight.first[i] * offset_m;
      const auto at = static_cast<std::ptrdiff_t>(middle - half + i);
      for (std::size_t k = 0; k < kDelays; ++k) {
        const std::ptrdiff_t sent = at - (kMinDelay + static_cast<std::ptrdiff_t>(k));
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
  return {window.force_at(delay) - friction_n * window.way, 1.0, window.velocity, 0.0};
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

/// Standard errors of the unknowns, followed by that of the delay.
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

/// A fit with a smaller unexplained share is accepted as it is.
constexpr double kRigidUnexplained = 0.02;

/// The fits with windows of several lengths.
struct WindowFits {
  std::optional<WindowFit> best;       ///< among fits without negative damping
  std::optional<Measured> delay_ms{};  ///< if the fits agree, as for a rigid handle
};

WindowFits fits_of(const std::vector<std::vector<Window>>& by_length, double friction_n) {
  constexpr double kAgreeingTicks = 0.5;
  WindowFits fits;
  std::vector<WindowFit> free;
  for (const std::vector<Window>& windows : by_length) {
    std::optional<WindowFit> fit = best_fit(windows, friction_n, 3);
    if (!fit) continue;
    free.push_back(*fit);
    // No device has negative damping: if soft arms mimic it, the fit is repeated without damping.
    if (fit->unknowns[2] > 0.0) fit = best_fit(windows, friction_n, 2);
    if (fit && (!fits.best || fit->unexplained < fits.best->unexplained)) fits.best = fit;
  }
  if (free.empty()) return fits;
  const auto [min, max] =
      std::ranges::minmax(free, {}, [](const WindowFit& fit) { return fit.delay_ticks; });
  const WindowFit& clearest = *std::ranges::min_element(free, {}, &WindowFit::unexplained);
  const double spread = max.delay_ticks - min.delay_ticks;
  if (clearest.unexplained > kRigidUnexplained || spread > kAgreeingTicks) return fits;
  const double ms = 1000.0 * kServoTickS;
  fits.delay_ms = Measured{clearest.delay_ticks * ms,
                           (2.0 * clearest.delay_error_ticks + spread) * ms + kDelayFloorMs +
                               kDelayMsUnexplained * clearest.unexplained};
  return fits;
}

/// The fit over windows so long that the resonance of soft arms is above their pass band. Below
/// resonance a structure shifts no phase, so any lag is delay or a motor's time constant. Windows
/// of this length include reversals of the handle.
/// \return nothing if it leaves too much unexplained
std::optional<WindowFit> slow_fit(const EvenSeries& series, TickRange ticks, double friction_n,
                                  double step_mm) {
  constexpr std::size_t kLongHalf = 48;  // ticks
  constexpr double kMaxUnexplainedSlowly = 0.05;
  const std::vector<Window> windows = windows_in(series, ticks, kLongHalf, step_mm, Turning::kept);
  if (windows.size() <= 2 * kUnknowns) return std::nullopt;
  const std::optional<WindowFit> fit = best_fit(windows, friction_n, 3);
  return fit && fit->unexplained < kMaxUnexplainedSlowly ? fit : std::nullopt;
}

/// A reversal of the push.
struct Turn {
  double at = 0.0;   ///< in ticks; fractional if the slew limit stretched it
  double way = 0.0;  ///< of the force's change: +1 or -1
};

std::vector<Turn> turns_in(const EvenSeries& series, TickRange ticks, double push_n,
                           std::size_t apart) {
  constexpr std::size_t kMaxReversal = 6;  // ticks of a reversal
  const std::vector<double>& f = series.force_n;
  std::vector<std::size_t> begins;
  for (std::size_t i = ticks.from + 1; i + kMaxReversal < ticks.end; ++i) {
    const bool continues = !begins.empty() && i - begins.back() < kMaxReversal;
    if (!continues && std::abs(f[i] - f[i - 1]) > 0.4 * push_n) begins.push_back(i);
  }
  std::vector<Turn> turns;
  for (std::size_t k = 1; k + 1 < begins.size(); ++k) {
    const std::size_t i = begins[k];
    if (i - begins[k - 1] < apart || begins[k + 1] - i < apart) continue;
    const double from_n = f[i - 1];
    const double to_n = f[i + kMaxReversal - 1];
    if (std::abs(to_n - from_n) < push_n) continue;
    double late = 0.0;
    for (std::size_t j = i; j < i + kMaxReversal; ++j) late += (to_n - f[j]) / (to_n - from_n);
    turns.push_back({static_cast<double>(i) + late, to_n > from_n ? 1.0 : -1.0});
  }
  return turns;
}

/// The deviation of the handle from its parabola some time after a force step with a time constant;
/// any unit.
double bend_after(double ticks, double lag_ticks) {
  if (ticks <= 0.0) return 0.0;
  const double straight = 0.5 * ticks * ticks;
  if (lag_ticks <= 0.0) return straight;
  return straight - lag_ticks * ticks - lag_ticks * lag_ticks * std::expm1(-ticks / lag_ticks);
}

/// The variance, mm^2 a tick, of a path segment that a bend in its middle explains beyond a
/// parabola; 0 for a bend against the force's change. It peaks where the path bends: a segment
/// without the bend is a parabola, and one with an off-centre bend fits worse.
std::optional<double> bend_at(const std::vector<double>& x, double bend, double way, double half,
                              double lag_ticks) {
  LeastSquares sums;
  const double max = bend_after(half, lag_ticks);
  const auto first = static_cast<std::size_t>(std::ceil(bend - half));
  const auto last = static_cast<std::size_t>(std::floor(bend + half));
  for (std::size_t i = first; i <= last; ++i) {
    const double ticks = static_cast<double>(i) - bend;
    const double t = ticks / half;
    sums.add({1.0, t, t * t, bend_after(ticks, lag_ticks) / max}, x[i] - x[first]);
  }
  const auto with = sums.solve(4);
  const auto without = sums.solve(3);
  if (!with || !without) return std::nullopt;
  if (with->factors[3] * way <= 0.0) return 0.0;
  return std::max(with->explained - without->explained, 0.0) /
         static_cast<double>(last - first + 1);
}

/// \name The range of delays searched for a bend, ticks
///@{
constexpr double kMinBendDelay = -2.0;
constexpr double kMaxBendDelay = 14.0;
///@}

/// The reversals around which the longer segments fit into the recording.
std::vector<Turn> turns_within(const std::vector<Turn>& turns, TickRange ticks, double half) {
  std::vector<Turn> within;
  for (const Turn& turn : turns) {
    if (turn.at < static_cast<double>(ticks.from) + 2.0 * half) continue;
    if (turn.at + kMaxBendDelay + 2.0 * half > static_cast<double>(ticks.end)) continue;
    within.push_back(turn);
  }
  return within;
}

struct BendingDelay {
  double ticks = 0.0;
  double error_ticks = 0.0;  ///< standard error
  bool at_an_end = false;    ///< at an end of the range, so it may be outside
  std::vector<std::pair<double, double>> by_delay;
};

/// The delay after which the path bends when the push reverses. While the handle moves in one
/// direction friction is constant, so nothing else bends the path so sharply.
std::optional<BendingDelay> bending_delay(const EvenSeries& series, const std::vector<Turn>& turns,
                                          double half) {
  constexpr double kFine = 0.25;
  constexpr auto kPlaces = static_cast<std::size_t>((kMaxBendDelay - kMinBendDelay) / kFine) + 1;
  const auto delay_of = [&](std::ptrdiff_t place) {
    return kMinBendDelay + kFine * static_cast<double>(place);
  };
  std::vector<double> sums(kPlaces, 0.0);
  std::vector<double> best_of_turn;
  for (const Turn& turn : turns) {
    std::vector<double> bends(kPlaces);
    for (std::size_t k = 0; k < kPlaces; ++k) {
      const double at = turn.at + delay_of(static_cast<std::ptrdiff_t>(k));
      const auto bend = bend_at(series.position_mm, at, turn.way, half, 0.0);
      if (!bend) return std::nullopt;
      bends[k] = *bend;
    }
    best_of_turn.push_back(delay_of(std::ranges::max_element(bends) - bends.begin()));
    for (std::size_t k = 0; k < kPlaces; ++k) sums[k] += bends[k];
  }
  const auto best = std::ranges::max_element(sums) - sums.begin();
  BendingDelay delay;
  delay.at_an_end = best == 0 || best + 1 == static_cast<std::ptrdiff_t>(kPlaces);
  delay.ticks = delay_of(best);
  // From quartiles, because of outliers: 1.25 times the interquartile range over 1.35.
  const double spread = quantile_of(best_of_turn, 0.75) - quantile_of(best_of_turn, 0.25);
  delay.error_ticks = 0.93 * spread / std::sqrt(static_cast<double>(best_of_turn.size()));
  for (std::size_t k = 0; k < kPlaces; ++k) {
    delay.by_delay.emplace_back(1000.0 * kServoTickS * delay_of(static_cast<std::ptrdiff_t>(k)),
                                std::sqrt(sums[k] / static_cast<double>(best_of_turn.size())));
  }
  return delay;
}

/// The delay and subsequent time constant that together explain the path around reversals best, in
/// ticks.
struct LaggingDelay {
  double delay = 0.0;
  double lag = 0.0;
  double explained = 0.0;
};

/// The variance that a parabola and a bend explain of the same segment around a reversal, at any
/// delay.
std::optional<double> explained_around(const std::vector<double>& x, double turn, double delay,
                                       double lag_ticks) {
  constexpr double kBefore = 6.0;  // ticks
  constexpr double kBehind = 14.0;
  LeastSquares sums;
  const auto first = static_cast<std::size_t>(std::ceil(turn - kBefore));
  const auto last = static_cast<std::size_t>(std::floor(turn + kBehind));
  const double max = bend_after(kBehind - delay, lag_ticks);
  for (std::size_t i = first; i <= last; ++i) {
    const double ticks = static_cast<double>(i) - turn;
    const double t = ticks / kBehind;
    sums.add({1.0, t, t * t, bend_after(ticks - delay, lag_ticks) / max}, x[i] - x[first]);
  }
  const auto solution = sums.solve(4);
  if (!solution) return std::nullopt;
  return solution->explained;
}

std::optional<LaggingDelay> lagging_delay(const EvenSeries& series,
                                          const std::vector<Turn>& turns) {
  constexpr std::array kLags = {0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0};
  constexpr double kMaxLaggingDelay = 10.0;
  std::optional<LaggingDelay> best;
  for (const double lag : kLags) {
    for (double delay = kMinBendDelay; delay <= kMaxLaggingDelay; delay += 1.0) {
      double sum = 0.0;
      for (const Turn& turn : turns) {
        const auto explained = explained_around(series.position_mm, turn.at, delay, lag);
        if (!explained) return std::nullopt;
        sum += *explained;
      }
      if (!best || sum > best->explained) best = LaggingDelay{delay, lag, sum};
    }
  }
  return best;
}

/// Soft arms disturb short segments less, encoder steps long ones. Both slow motors and soft arms
/// round a bend, so the delay is between the estimates of bends and of slow motion.
/// \param slow  slow_fit
ValueOrReason<Measured> delay_by_turns(const EvenSeries& series, TickRange ticks, double push_n,
                                       const std::optional<WindowFit>& slow,
                                       std::vector<std::pair<double, double>>& by_delay) {
  constexpr double kShortHalf = 5.0;  // ticks
  constexpr double kFarHalf = 6.5;
  constexpr double kLongHalf = 8.0;
  constexpr double kNoLag = 1.0;
  constexpr double kSlowEarlyTicks = 0.5;  // as in the shipped models
  constexpr double kSlowTicksUnexplained = 10.0;
  constexpr double kUnseenTicks = 0.5;  // for a slow motor without a usable long window
  constexpr std::size_t kMinTurns = 8;
  const std::vector<Turn> turns = turns_within(
      turns_in(series, ticks, push_n, static_cast<std::size_t>(kLongHalf) + 2), ticks, kLongHalf);
  if (turns.size() < kMinTurns) {
    return {std::nullopt, "too few turns of the push were clear"};
  }
  const auto near = bending_delay(series, turns, kShortHalf);
  const auto far = bending_delay(series, turns, kFarHalf);
  const auto lagging = lagging_delay(series, turns);
  if (!near || !far || !lagging) return {std::nullopt, "no bend of the path follows the push"};
  by_delay = near->by_delay;
  const double ms = 1000.0 * kServoTickS;
  if (near->at_an_end || (far->at_an_end && !slow)) {
    return {std::nullopt, "no bend follows the turns of the push within " +
                              std::to_string(std::lround(kMaxBendDelay * ms)) +
                              " ms: the delay is longer, or something held the handle"};
  }
  double bend = near->ticks + kTurnsEarlyTicks;
  double error = 0.0;
  if (lagging->lag > kNoLag) {
    bend = std::max(bend, lagging->delay + lagging->lag);
    error += kLagShare * lagging->lag;
  }
  const double other = slow ? slow->delay_ticks + kSlowEarlyTicks : bend;
  error += 0.5 * std::abs(other - bend);
  error += slow ? kSlowTicksUnexplained * slow->unexplained
                : 2.0 * near->error_ticks + std::abs(near->ticks - far->ticks) + kUnseenTicks;
  return {Measured{0.5 * (bend + other) * ms, error * ms + kTurnsFloorMs}};
}

ValueOrReason<ShakeFigures> no_shake(std::string why) {
  return {std::nullopt, std::move(why)};
}

}  // namespace

std::optional<RestFigures> rest_figures(std::span<const ServoSample> samples) {
  constexpr std::size_t kSettling = 500;
  constexpr std::size_t kMinSamples = 1000;
  if (samples.size() < kSettling + kMinSamples) return std::nullopt;
  const auto still = samples.subspan(kSettling);
  Vec3 halves[2];
  double squares = 0.0;
  const std::size_t half = still.size() / 2;
  const Vec3 first_mm = still.front().position_mm;
  for (std::size_t i = 0; i < 2 * half; ++i) {
    const Vec3 offset = still[i].position_mm - first_mm;
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
    if (!step.moved) {
      return {std::nullopt, "the handle was not moved along axis " + std::string(name_of(axis))};
    }
    all_resolved = all_resolved && step.resolved;
    if (step.step_mm > coarsest.step_mm) coarsest = step;
  }
  if (!all_resolved) {
    return {std::nullopt,
            "readings change by every amount: noise or a filter hides the steps, or they are finer "
            "than " +
                std::to_string(coarsest.step_mm) + " mm"};
  }
  return {Measured{coarsest.step_mm, coarsest.spread_mm + 0.05 * coarsest.step_mm}};
}

ValueOrReason<StrokeFigures> stroke_figures(const SlowStrokes& strokes, double step_mm) {
  constexpr std::size_t kHalf = 50;  // ticks to either side, for the speed
  const Vec3 axis = direction_of(strokes.axis());
  if (strokes.ran_away()) return {std::nullopt, "the handle left its place"};
  if (strokes.swung()) {
    return {std::nullopt, "the held handle swings: delay, or soft arms; nothing may hold it"};
  }
  const EvenSeries series = even_series(strokes.samples(), axis);
  const std::vector<double>& x = series.position_mm;
  const std::size_t from = ticks_of(strokes.hold_s());
  const std::size_t period = ticks_of(SlowStrokes::kPeriodS);
  const std::size_t end = from + SlowStrokes::kPeriods * period;
  if (x.size() < end) return {std::nullopt, "the run ended early"};
  if (series.left_out > kMaxLeftOut) return {std::nullopt, "the servo missed too many ticks"};
  std::vector<double> sums;
  std::vector<double> differences;
  StrokeFigures figures;
  const auto [min, max] = std::minmax_element(x.begin() + static_cast<std::ptrdiff_t>(from),
                                              x.begin() + static_cast<std::ptrdiff_t>(end));
  const double middle_mm = 0.5 * (*min + *max);
  if (*max - *min <= kStepsOfMotion * step_mm) {
    return {std::nullopt, "the handle moved less than five encoder steps"};
  }
  for (int p = 0; p < SlowStrokes::kPeriods; ++p) {
    double force_n[2] = {};
    std::size_t ticks[2] = {};
    for (std::size_t i = from + static_cast<std::size_t>(p) * period;
         i < from + static_cast<std::size_t>(p + 1) * period; ++i) {
      const double phase = static_cast<double>(i - from) / static_cast<double>(period) - p;
      const bool is_back = phase >= 0.25 && phase < 0.75;
      const double way = is_back ? -1.0 : 1.0;
      const std::size_t to = std::min(i + kHalf, x.size() - 1);
      const double mm_s = way * (x[to] - x[i - kHalf]) / (2.0 * kHalf * kServoTickS);
      if (mm_s < 0.5 * SlowStrokes::kSpeedMmS || mm_s > 2.0 * SlowStrokes::kSpeedMmS) continue;
      force_n[is_back ? 1 : 0] += series.force_n[i];
      ++ticks[is_back ? 1 : 0];
    }
    const bool follows = std::min(ticks[0], ticks[1]) >= period / 15;
    // Friction makes the first stroke lag, because the handle starts off-centre.
    if (!follows && p == 0) continue;
    if (!follows) {
      return {std::nullopt, "the handle did not follow the strokes: it sticks, or a hand held it"};
    }
    const double there = force_n[0] / static_cast<double>(ticks[0]);
    const double back = force_n[1] / static_cast<double>(ticks[1]);
    sums.push_back(0.5 * (there + back));
    differences.push_back(0.5 * (there - back));
  }
  figures.load_n = {mean_of(sums), 2.0 * standard_error_of(sums) + kLoadFloorN};
  const double friction_n = mean_of(differences);
  figures.friction_n = {friction_n, 2.0 * standard_error_of(differences) + kFrictionFloorN +
                                        kFrictionShare * std::abs(friction_n)};
  for (std::size_t i = from; i < end; i += 10) {
    figures.loop.emplace_back(x[i] - middle_mm, series.force_n[i] - figures.load_n.value);
  }
  return {figures, ""};
}

ValueOrReason<ShakeFigures> shake_figures(const ShakenStrokes& strokes, double friction_n,
                                          double step_mm) {
  constexpr std::array<std::size_t, 4> kHalves = {8, 12, 20, 32};
  constexpr std::size_t kMinWindows = 60;
  if (strokes.ran_away()) return no_shake("the handle left its place");
  const EvenSeries series = even_series(strokes.samples(), direction_of(strokes.axis()));
  if (series.left_out > kMaxLeftOut) return no_shake("the servo missed too many ticks");
  const std::size_t from = ticks_of(ShakenStrokes::begins_s());
  const std::size_t end = from + ticks_of(ShakenStrokes::kShakeS) - 1;
  if (series.position_mm.size() < end) return no_shake("the run ended early");
  const double min_mm = step_mm > 0.0 ? step_mm : kUnknownStepMm;
  std::vector<std::vector<Window>> by_length;
  for (const std::size_t half : kHalves) {
    std::vector<Window> windows = windows_in(series, {from, end}, half, min_mm, Turning::left_out);
    if (windows.size() >= kMinWindows) by_length.push_back(std::move(windows));
  }
  if (by_length.empty()) {
    return no_shake("the handle moved too little: less than five encoder steps at a time");
  }
  // Slow strokes take what damping adds at their speed for friction.
  WindowFits fits = fits_of(by_length, friction_n);
  if (fits.best) {
    const double viscous = std::max(-fits.best->unknowns[2] / fits.best->unknowns[0], 0.0);
    friction_n -= 0.001 * SlowStrokes::kSpeedMmS * viscous;
    fits = fits_of(by_length, friction_n);
  }
  const std::optional<WindowFit> slow = slow_fit(series, {from, end}, friction_n, min_mm);
  const std::optional<WindowFit>& best = fits.best;
  if (!best) return no_shake("the mass cannot be estimated from the handle's motion");
  if (best->unexplained > kMaxUnexplained) {
    return no_shake(
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
  const ValueOrReason<Measured> by_turns =
      delay_by_turns(series, {from, end}, strokes.push_n(), slow, figures.by_delay);
  figures.delay_ms = fits.delay_ms ? fits.delay_ms : by_turns.value;
  if (!figures.delay_ms) figures.no_delay = by_turns.why;
  return {figures, ""};
}

}  // namespace touchtrial::device
