#include "engine/rendering/surface_gains.hpp"

#include "engine/rendering/field_measures.hpp"
#include "engine/rendering/surface_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNearEnough = 2e-7;       // relative; pools have single precision
constexpr double kSlackOfSurfaces = 1e-6;  // relative; what is over the budget by less is on it
constexpr int kMostTries = 60;

/// The fields of a study, each with the factor that equalises it.
class Surfaces {
 public:
  Surfaces(std::span<const FieldView> fields, const RenderingOptions& options)
      : fields_(fields), wall_n_per_mm_(options.stiffness_n_per_mm) {
    for (const FieldView& field : fields) {
      rms_.push_back(tangential_rms(relief_of(field).view()));
      const double equalising = rms_.back() > 0.0 ? 1.0 / rms_.back() : 0.0;
      factor_.push_back(options.equalise == Equalise::rms ? equalising : 1.0);
    }
    if (!std::ranges::all_of(rms_, [](double value) { return std::isfinite(value); })) {
      throw std::invalid_argument("choose_gains: a field has coefficients that are not finite");
    }
  }

  [[nodiscard]] const std::vector<double>& rms() const noexcept { return rms_; }
  [[nodiscard]] const std::vector<double>& factors() const noexcept { return factor_; }

  /// Stiffness of the normal force, N/mm, for each mm per grey level.
  [[nodiscard]] double normal_stiffness() const {
    return pooled([&](FieldView relief, double factor, std::vector<float>& pool) {
      append_normal_stiffness(relief, factor * wall_n_per_mm_, pool);
    });
  }
  /// Stiffness of the lateral force at the stated load, N/mm, at this many mm per grey level.
  [[nodiscard]] double lateral_stiffness(double mm_per_grey) const {
    return pooled([&](FieldView relief, double factor, std::vector<float>& pool) {
      append_stiffness_at_load(relief, mm_per_grey * factor, wall_n_per_mm_, pool);
    });
  }
  /// The same for each mm per grey level, where heights are small beside the depth.
  [[nodiscard]] double linear_stiffness() const {
    return pooled([](FieldView relief, double factor, std::vector<float>& pool) {
      append_stiffness_at_load(relief, factor, 0.0, pool);
    });
  }

 private:
  template <typename Append>
  [[nodiscard]] double pooled(Append append) const {
    std::vector<float> pool;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (rms_[i] > 0.0) append(relief_of(fields_[i]).view(), factor_[i], pool);
    }
    return typical_stiffness(pool);
  }

  std::span<const FieldView> fields_;
  double wall_n_per_mm_;
  std::vector<double> rms_;
  std::vector<double> factor_;
};

/// alpha at which the lateral force is as stiff as the budget, not above `most`. Stiffness is
/// nearly a power of alpha, the first for small heights and up to the second for great ones: a
/// secant of the logarithms finds it in a few tries, within a bracket.
double lateral_limit(const Surfaces& surfaces, double budget, double most) {
  const double linear = surfaces.linear_stiffness();
  if (linear == 0.0) return most;
  if (most < kInfinity && surfaces.lateral_stiffness(most) <= budget) return most;
  double low = 0.0;
  double high = most;
  double alpha = budget / linear;
  double earlier = 0.0;
  double earlier_short_of = 0.0;
  for (int i = 0; i < kMostTries; ++i) {
    if (!(alpha > low && alpha < high)) alpha = 0.5 * (low + high);
    const double short_of = std::log(budget / surfaces.lateral_stiffness(alpha));
    if (std::abs(short_of) <= kNearEnough) return alpha;
    (short_of > 0.0 ? low : high) = alpha;
    const double power = (earlier_short_of - short_of) / std::log(alpha / earlier);
    const double step = short_of / (earlier > 0.0 ? std::clamp(power, 0.5, 4.0) : 1.0);
    earlier = alpha;
    earlier_short_of = short_of;
    alpha *= std::exp(step);
  }
  return low;
}

double within_budget(const Surfaces& surfaces, double budget) {
  const double normal = surfaces.normal_stiffness();
  const double limit = lateral_limit(surfaces, budget, normal > 0.0 ? budget / normal : kInfinity);
  return limit < kInfinity ? limit : 0.0;
}

}  // namespace

StudyGains choose_surface_gains(std::span<const FieldView> fields,
                                const RenderingOptions& options) {
  const Surfaces surfaces(fields, options);
  const double budget = options.texture_stiffness_n_per_mm;
  StudyGains gains;
  double alpha = 0.0;
  if (options.gains) {
    const bool equal_rms = options.equalise == Equalise::rms;
    alpha = options.gains->height_mm * (equal_rms ? mean_of_nonzero(surfaces.rms()) : 1.0);
    const double stiffest =
        std::max(surfaces.lateral_stiffness(alpha), alpha * surfaces.normal_stiffness());
    gains.over_budget = stiffest > budget * (1.0 + kSlackOfSurfaces);
  } else {
    alpha = within_budget(surfaces, budget);
  }
  for (const double factor : surfaces.factors())
    gains.of_field.push_back({0.0, 0.0, alpha * factor});
  return gains;
}

}  // namespace touchtrial::engine
