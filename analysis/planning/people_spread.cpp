#include "analysis/planning/people_spread.hpp"

#include "analysis/planning/fit_problem.hpp"
#include "analysis/planning/noise_lines.hpp"
#include "analysis/planning/optimiser.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/interpolators/makima.hpp>

namespace touchtrial::planning {
namespace {

/// Equally likely groups of people.
constexpr int kGroupsOfPeople = 32;
/// The spreads at which the profile is computed.
constexpr std::array<double, 16> kSpreads{0.0,  0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5,
                                          0.65, 0.8,  1.0, 1.25, 1.5, 2.0, 2.5, 3.0};
/// Half the 95 % point of chi-square with one degree of freedom.
constexpr double kHalfChiSquare = 1.920729;

using Curve = boost::math::interpolators::makima<std::vector<double>>;

/// One nonzero cell of a participant's counts.
struct AnswerCount {
  std::size_t cell = 0;
  double count = 0.0;
};
struct Person {
  int layout = 0;
  std::vector<AnswerCount> answers;
};

std::vector<Person> selected_people(std::span<const CountedPerson> people) {
  const std::size_t count = std::min(people.size(), kMaxPeopleOfSpread);
  std::vector<Person> persons;
  for (std::size_t i = 0; i < count; ++i) {
    const CountedPerson& one = people[i * people.size() / count];
    Person& person = persons.emplace_back(Person{one.layout, {}});
    for (std::size_t cell = 0; cell < one.counts.size(); ++cell) {
      if (one.counts[cell] > 0.0) person.answers.push_back({cell, one.counts[cell]});
    }
  }
  return persons;
}

/// A point of the search, and the log likelihood there.
struct Point {
  double log_noise = 0.0;
  double lapse = 0.0;
  double spread = 0.0;
  double value = -std::numeric_limits<double>::infinity();
};

class SpreadLikelihood {
 public:
  SpreadLikelihood(const NoiseAnswers& answers, std::span<const CountedPerson> people)
      : answers_(answers),
        people_(selected_people(people)),
        groups_(normal_groups(kGroupsOfPeople)) {
    for (std::size_t i = 0; i < answers.answers.size(); ++i) {
      log_noises_.push_back(answers.min_log_noise + static_cast<double>(i) * answers.step);
    }
  }

  [[nodiscard]] double min_log_noise() const { return log_noises_.front(); }
  [[nodiscard]] double max_log_noise() const { return log_noises_.back(); }

  /// Each person's log likelihood as a function of ln noise.
  [[nodiscard]] std::vector<Curve> curves(double lapse) const {
    std::vector<Curve> all;
    for (const Person& person : people_) {
      std::vector<double> values;
      for (const Cells& cells : answers_.answers) {
        values.push_back(log_likelihood(person, cells[person.layout], lapse));
      }
      all.emplace_back(std::vector<double>(log_noises_), std::move(values));
    }
    return all;
  }

  [[nodiscard]] double value(const std::vector<Curve>& curves, double log_noise,
                             double spread) const {
    double sum = 0.0;
    for (const Curve& curve : curves) sum += person_log_likelihood(curve, log_noise, spread);
    return sum;
  }

 private:
  [[nodiscard]] double log_likelihood(const Person& person, const std::vector<double>& felt,
                                      double lapse) const {
    const double guessed = lapse / static_cast<double>(answers_.classes);
    double sum = 0.0;
    for (const AnswerCount& one : person.answers) {
      sum += one.count * std::log(clamped_probability((1.0 - lapse) * felt[one.cell] + guessed));
    }
    return sum;
  }

  /// The logarithm of the mean likelihood over the groups of people.
  [[nodiscard]] double person_log_likelihood(const Curve& curve, double log_noise,
                                             double spread) const {
    if (spread == 0.0) return curve(log_noise);
    std::array<double, kGroupsOfPeople> logs{};
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < logs.size(); ++i) {
      logs[i] =
          curve(std::clamp(log_noise + spread * groups_[i], min_log_noise(), max_log_noise()));
      largest = std::max(largest, logs[i]);
    }
    double sum = 0.0;
    for (const double one : logs) sum += std::exp(one - largest);
    return largest + std::log(sum / kGroupsOfPeople);
  }

  const NoiseAnswers& answers_;
  std::vector<Person> people_;
  std::vector<double> groups_;
  std::vector<double> log_noises_;
};

/// The parameters to estimate.
struct Free {
  bool noise = true;
  bool lapse = true;
  bool spread = false;
};

/// Half the difference quotient's step.
constexpr double kSlopeStep = 1e-4;

/// The derivative by one number, from differences within its bounds.
double slope(const std::function<double(double)>& value, double point, double lower, double upper) {
  if (lower == upper) return 0.0;
  const double low = std::max(lower, point - kSlopeStep);
  const double high = std::min(upper, point + kSlopeStep);
  return (value(high) - value(low)) / (high - low);
}

Point maximise_likelihood(const SpreadLikelihood& likelihood, const Point& start,
                          const Free& free) {
  const auto bound = [](bool is_free, double fixed, double end) { return is_free ? end : fixed; };
  const Bounds bounds{{bound(free.noise, start.log_noise, likelihood.min_log_noise()),
                       bound(free.lapse, start.lapse, 0.0), bound(free.spread, start.spread, 0.0)},
                      {bound(free.noise, start.log_noise, likelihood.max_log_noise()),
                       bound(free.lapse, start.lapse, kMaxLapse),
                       bound(free.spread, start.spread, kSpreads.back())}};
  const SmoothFunction function = [&](std::span<const double> point, std::span<double> slopes) {
    const std::vector<Curve> curves = likelihood.curves(point[1]);
    if (!slopes.empty()) {
      const auto set_slope = [&](std::size_t i, auto value) {
        slopes[i] = slope(value, point[i], bounds.lower[i], bounds.upper[i]);
      };
      set_slope(0, [&](double noise) { return likelihood.value(curves, noise, point[2]); });
      set_slope(1, [&](double lapse) {
        return likelihood.value(likelihood.curves(lapse), point[0], point[2]);
      });
      set_slope(2, [&](double spread) { return likelihood.value(curves, point[0], spread); });
    }
    return likelihood.value(curves, point[0], point[2]);
  };
  const Optimum best =
      maximise(function, {start.log_noise, start.lapse, start.spread}, bounds,
               {.tolerance = 1e-7, .max_evaluations = 40, .scales = {0.2, 0.05, 0.2}});
  return {best.point[0], best.point[1], best.point[2], best.value};
}

/// The best points for each of a list of fixed spreads. Each search also starts from its
/// neighbours' points, because the likelihood can have several maxima: with more spread, fewer
/// lapses explain the same errors.
std::vector<Point> profile(const SpreadLikelihood& likelihood, const SpreadStart& start,
                           const Free& free) {
  std::vector<Point> points;
  const auto improve = [&](std::size_t i, Point from) {
    from.spread = kSpreads[i];
    const Point maximum = maximise_likelihood(likelihood, from, free);
    if (maximum.value > points[i].value) points[i] = maximum;
  };
  Point from{std::clamp(start.log_noise, likelihood.min_log_noise(), likelihood.max_log_noise()),
             start.lapse};
  for (std::size_t i = 0; i < kSpreads.size(); ++i) {
    points.emplace_back();
    improve(i, i == 0 ? from : points[i - 1]);
  }
  for (std::size_t i = kSpreads.size() - 1; i > 0; --i) improve(i - 1, points[i]);
  return points;
}

/// The spread between two points of the profile at which the profile has this value.
double crossing(const Point& below, const Point& above, double value) {
  const double share = (value - below.value) / (above.value - below.value);
  return below.spread + share * (above.spread - below.spread);
}

/// The spreads at which the profile lies less than 1.92 below its maximum.
OpenInterval interval_of(const std::vector<Point>& points, const Point& best) {
  const double limit = best.value - kHalfChiSquare;
  OpenInterval interval{0.0, std::nullopt};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Point& current = points[i];
    const Point& next = points[i + 1];
    // The best point lies between two of the profile.
    if (current.value < limit && current.spread < best.spread) {
      interval.lower = crossing(current, next.value < limit ? best : next, limit);
    }
    if (next.value < limit && next.spread > best.spread && !interval.upper) {
      interval.upper = crossing(current.value < limit ? best : current, next, limit);
    }
  }
  return interval;
}

/// The p of a spread by the likelihood ratio. A spread of 0 lies on the boundary, where the ratio
/// is 0 half of the time.
double p_of(double loss, bool is_boundary) {
  if (loss <= 0.0) return 1.0;
  const boost::math::chi_squared_distribution<> chi_squared(1.0);
  const double p = boost::math::cdf(boost::math::complement(chi_squared, 2.0 * loss));
  return is_boundary ? 0.5 * p : p;
}

void check(const NoiseAnswers& answers, const SpreadStart& start) {
  if (answers.answers.size() < 4 || !(answers.step > 0.0) || answers.classes < 1) {
    throw std::invalid_argument("people_spread: needs four or more amounts of noise, and classes");
  }
  if (!(start.spread >= 0.0) || !(start.lapse >= 0.0 && start.lapse <= kMaxLapse)) {
    throw std::invalid_argument("people_spread: spread and lapse must be >= 0");
  }
}

}  // namespace

std::optional<PeopleSpread> people_spread(const NoiseAnswers& answers,
                                          std::span<const CountedPerson> people,
                                          const SpreadStart& start) {
  check(answers, start);
  if (people.size() < 2) return std::nullopt;
  const SpreadLikelihood likelihood(answers, people);
  Free free{start.noise_is_free, start.lapse_is_free, false};
  const std::vector<Point> points = profile(likelihood, start, free);
  Point assumed = points.front();
  if (start.spread > 0.0) {
    const auto nearest = std::ranges::min_element(
        points, {}, [&](const Point& one) { return std::abs(one.spread - start.spread); });
    assumed = *nearest;
    assumed.spread = start.spread;
    assumed = maximise_likelihood(likelihood, assumed, free);
  }
  free.spread = true;
  Point best =
      maximise_likelihood(likelihood, *std::ranges::max_element(points, {}, &Point::value), free);
  if (best.value < points.front().value) best = points.front();
  if (best.value < assumed.value) best = assumed;
  return PeopleSpread{best.spread,
                      interval_of(points, best),
                      best.log_noise,
                      best.lapse,
                      p_of(best.value - points.front().value, true),
                      p_of(best.value - assumed.value, start.spread == 0.0)};
}

}  // namespace touchtrial::planning
