#include "protocols/procedures/estimates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/quadrature/gauss.hpp>

namespace touchtrial::procedures {
namespace {

constexpr std::size_t kWidths = 15;
constexpr std::size_t kLapses = 15;
constexpr std::size_t kBlocks = 120;  ///< blocks of cells over the range of thresholds
constexpr std::size_t kCells = 5;     ///< cells in a block

constexpr double kMinRange_db = 20.0;

/// Nodes and weights of a quadrature.
template <std::size_t count>
struct Nodes {
  std::array<double, count> values{};
  std::array<double, count> weights{};
};

/// Gauss-Legendre quadrature.
template <std::size_t count>
Nodes<count> nodes_between(double low, double high) {
  using Rule = boost::math::quadrature::gauss<double, static_cast<unsigned>(count)>;
  const double middle = std::midpoint(low, high);
  const double half = 0.5 * (high - low);
  Nodes<count> nodes;
  std::size_t count_so_far = 0;
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      const double x = Rule::abscissa()[i];
      if (x == 0.0 && side > 0.0) continue;
      nodes.values[count_so_far] = middle + side * half * x;
      nodes.weights[count_so_far] = half * Rule::weights()[i];
      ++count_so_far;
    }
  }
  return nodes;
}

/// Lapse rates from 0 to `max`, dense near 0.
Nodes<kLapses> lapse_nodes(double max) {
  Nodes<kLapses> nodes = nodes_between<kLapses>(0.0, 1.0);
  for (std::size_t i = 0; i < kLapses; ++i) {
    const double root = nodes.values[i];
    nodes.values[i] = max * root * root;
    nodes.weights[i] *= 2.0 * root;
  }
  return nodes;
}

/// Multiplies each element of `product` by base^exponent.
void multiply_power(std::array<double, kLapses>& product, std::array<double, kLapses> base,
                    std::int64_t exponent) {
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) {
      for (std::size_t i = 0; i < kLapses; ++i) product[i] *= base[i];
    }
    for (std::size_t i = 0; i < kLapses; ++i) base[i] *= base[i];
  }
}

/// Higher powers of shares may exceed the range of a double.
constexpr std::int64_t kMaxPower = 256;

/// Multiplies by the powers for right and wrong answers. Slower, but suits all exponents.
void multiply_by_logarithms(std::array<double, kLapses>& product,
                            const std::array<double, kLapses>& right, std::int64_t correct,
                            const std::array<double, kLapses>& wrong, std::int64_t errors) {
  const auto logarithm_of = [](double base, std::int64_t exponent) {
    return exponent > 0 ? static_cast<double>(exponent) * std::log(base) : 0.0;
  };
  for (std::size_t i = 0; i < kLapses; ++i) {
    product[i] *= std::exp(logarithm_of(right[i], correct) + logarithm_of(wrong[i], errors));
  }
}

/// Averages of the likelihood at one threshold, without common factors.
struct Averages {
  double likelihood = 0.0;            ///< over all observers
  double attentive_likelihood = 0.0;  ///< over all widths and typical lapse rates
  double weight = 0.0;                ///< over typical observers
  double log_width = 0.0;             ///< mean of typical observers, times weight
  double lapse = 0.0;                 ///< mean of typical observers, times weight
};

class AveragedLikelihood {
 public:
  AveragedLikelihood(std::span<const LevelCounts> counts, Shape shape, double guess)
      : counts_(counts.begin(), counts.end()),
        shape_(shape),
        guess_(guess),
        log_widths_(nodes_between<kWidths>(std::log(kMinWidth_db), std::log(kMaxWidth_db))),
        lapses_(lapse_nodes(std::min(kMaxLapse, 1.0 - guess))) {
    // Levels with many answers come first, because they exclude negligible observers soonest.
    std::stable_sort(counts_.begin(), counts_.end(),
                     [](const LevelCounts& a, const LevelCounts& b) { return a.n > b.n; });
    for (std::size_t i = 0; i < kWidths; ++i) {
      const double deviation =
          (log_widths_.values[i] - std::log(kTypicalWidth_db)) / kTypicalSpread;
      width_weights_[i] =
          log_widths_.weights[i] * std::exp((1.0 + kWidthPower) * log_widths_.values[i]);
      typical_width_weights_[i] = log_widths_.weights[i] * std::exp(-0.5 * deviation * deviation);
    }
    for (std::size_t i = 0; i < kLapses; ++i) {
      const double attention = 1.0 - lapses_.values[i];
      lapse_weights_[i] = lapses_.weights[i] * std::pow(attention, kLapseBeta - 1.0);
      typical_lapse_weights_[i] = lapses_.weights[i] * std::pow(attention, kTypicalLapseBeta - 1.0);
    }
  }

  /// \param min_likelihood  likelihoods below it may count as 0
  [[nodiscard]] Averages averages_at(double threshold, double min_likelihood) const {
    Averages sums;
    for (std::size_t w = 0; w < kWidths; ++w) {
      const std::array<double, kLapses> likelihoods =
          likelihoods_of(threshold, std::exp(log_widths_.values[w]), min_likelihood);
      double likelihood = 0.0;
      double typical_likelihood = 0.0;
      double lapse_sum = 0.0;
      for (std::size_t i = 0; i < kLapses; ++i) {
        likelihood += lapse_weights_[i] * likelihoods[i];
        typical_likelihood += typical_lapse_weights_[i] * likelihoods[i];
        lapse_sum += typical_lapse_weights_[i] * likelihoods[i] * lapses_.values[i];
      }
      sums.likelihood += width_weights_[w] * likelihood;
      sums.attentive_likelihood += width_weights_[w] * typical_likelihood;
      sums.weight += typical_width_weights_[w] * typical_likelihood;
      sums.log_width += typical_width_weights_[w] * typical_likelihood * log_widths_.values[w];
      sums.lapse += typical_width_weights_[w] * lapse_sum;
    }
    return sums;
  }

 private:
  /// The likelihood at every lapse rate, divided by the likelihood of the observed proportions; at
  /// most 1.
  [[nodiscard]] std::array<double, kLapses> likelihoods_of(double threshold, double width,
                                                           double min_likelihood) const {
    const double slope = width_at_slope_one(shape_) / width;
    std::array<double, kLapses> product;
    product.fill(1.0);
    for (const LevelCounts& point : counts_) {
      const AnswerShares f = shares_at({shape_, threshold, slope, 0.0, 0.0}, point.level);
      const double n = static_cast<double>(point.n);
      const std::int64_t wrong = point.n - point.correct;
      const double right_factor = point.correct > 0 ? n / static_cast<double>(point.correct) : 0.0;
      const double wrong_factor = wrong > 0 ? n / static_cast<double>(wrong) : 0.0;
      std::array<double, kLapses> right_share;
      std::array<double, kLapses> wrong_share;
      for (std::size_t i = 0; i < kLapses; ++i) {
        const double scale = 1.0 - guess_ - lapses_.values[i];
        right_share[i] = (guess_ + scale * f.correct) * right_factor;
        wrong_share[i] = (lapses_.values[i] + scale * f.wrong) * wrong_factor;
      }
      if (point.n <= kMaxPower) {
        multiply_power(product, right_share, point.correct);
        multiply_power(product, wrong_share, wrong);
      } else {
        multiply_by_logarithms(product, right_share, point.correct, wrong_share, wrong);
      }
      if (*std::max_element(product.begin(), product.end()) < min_likelihood) return {};
    }
    return product;
  }

  std::vector<LevelCounts> counts_;
  Shape shape_;
  double guess_;
  Nodes<kWidths> log_widths_;
  Nodes<kLapses> lapses_;
  std::array<double, kWidths> width_weights_{};
  std::array<double, kWidths> typical_width_weights_{};
  std::array<double, kLapses> lapse_weights_{};
  std::array<double, kLapses> typical_lapse_weights_{};
};

struct Cell {
  double middle = 0.0;
  Averages averages;
};

/// The likelihood in cells of equal width over the range of thresholds. Where it is negligible,
/// only the middle cell of a block is present.
struct Profile {
  std::vector<Cell> cells;
  double width = 0.0;           ///< of a cell
  double max_likelihood = 0.0;  ///< over the cells
};

Profile profile_of(const AveragedLikelihood& likelihood, std::span<const double> levels,
                   double negligible) {
  const double range = std::max(levels.back() - levels.front(), kMinRange_db);
  const double lowest = levels.front() - range;
  Profile profile;
  profile.width = (levels.back() + range - lowest) / (kBlocks * kCells);
  constexpr double kZeroShare = 1e-8;
  const auto cell_at = [&](std::size_t i) {
    const double middle = lowest + (static_cast<double>(i) + 0.5) * profile.width;
    return Cell{middle,
                likelihood.averages_at(middle, kZeroShare * negligible * profile.max_likelihood)};
  };
  std::vector<Cell> coarse;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    coarse.push_back(cell_at(block * kCells + kCells / 2));
    profile.max_likelihood = std::max(profile.max_likelihood, coarse.back().averages.likelihood);
  }
  const double limit = negligible * profile.max_likelihood;
  const auto is_relevant = [&](std::size_t block) {
    return coarse[block].averages.likelihood > limit;
  };
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const bool is_fine = is_relevant(block) || (block > 0 && is_relevant(block - 1)) ||
                         (block + 1 < kBlocks && is_relevant(block + 1));
    for (std::size_t i = 0; i < kCells; ++i) {
      const bool is_middle = i == kCells / 2;
      if (!is_fine && !is_middle) continue;
      profile.cells.push_back(is_middle ? coarse[block] : cell_at(block * kCells + i));
      profile.max_likelihood =
          std::max(profile.max_likelihood, profile.cells.back().averages.likelihood);
    }
  }
  return profile;
}

using Likelihood = double Averages::*;

/// The threshold at which a likelihood first reaches `min`; `value_if_first` if this is the first
/// cell.
template <typename Iterator>
double first_above(Iterator first, Iterator last, Likelihood member, double min,
                   double value_if_first) {
  const auto above =
      std::find_if(first, last, [&](const Cell& cell) { return cell.averages.*member >= min; });
  if (above == first) return value_if_first;
  const auto below = std::prev(above);
  // Avoids the logarithm of 0. A likelihood this small is never next to one of at least `min`.
  const double floor = std::numeric_limits<double>::min();
  const double log_below = std::log(std::max(below->averages.*member, floor));
  const double share =
      (std::log(min) - log_below) / (std::log(above->averages.*member) - log_below);
  return std::lerp(below->middle, above->middle, share);
}

struct Ends {
  double low = 0.0;
  double high = 0.0;
};

/// The thresholds at which the logarithm of a likelihood is `loss` below its maximum.
Ends ends_of(const Profile& profile, Likelihood member, double loss) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  const std::vector<Cell>& cells = profile.cells;
  const auto top = std::max_element(cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) {
    return a.averages.*member < b.averages.*member;
  });
  double log_largest = std::log((*top).averages.*member);
  if (top != cells.begin() && std::next(top) != cells.end()) {
    // The maximum is refined by a parabola through three cells, because a small error in a flat
    // maximum would move an end far.
    const double drop_before = log_largest - std::log((*std::prev(top)).averages.*member);
    const double drop_after = log_largest - std::log((*std::next(top)).averages.*member);
    const double curvature = drop_before + drop_after;
    if (curvature > 0.0 && std::isfinite(curvature)) {
      log_largest += (drop_before - drop_after) * (drop_before - drop_after) / (8.0 * curvature);
    }
  }
  const double min = std::exp(log_largest - loss);
  return {first_above(cells.begin(), cells.end(), member, min, -kOpen),
          first_above(cells.rbegin(), cells.rend(), member, min, kOpen)};
}

/// The most likely threshold of typical observers between two ends, by a parabola through the
/// logarithms of three cells, and their mean width and lapse rate.
Observer typical_observer(const Profile& profile, const Ends& ends, Shape shape, double guess) {
  double weight = 0.0;
  double log_width = 0.0;
  double lapse = 0.0;
  std::size_t likeliest = profile.cells.size();
  for (std::size_t i = 0; i < profile.cells.size(); ++i) {
    const auto& [middle, averages] = profile.cells[i];
    const double overlap = std::min(ends.high, middle + 0.5 * profile.width) -
                           std::max(ends.low, middle - 0.5 * profile.width);
    if (overlap <= 0.0) continue;
    weight += overlap * averages.weight;
    log_width += overlap * averages.log_width;
    lapse += overlap * averages.lapse;
    if (likeliest == profile.cells.size() ||
        averages.weight > profile.cells[likeliest].averages.weight) {
      likeliest = i;
    }
  }
  double threshold = profile.cells[likeliest].middle;
  if (likeliest > 0 && likeliest + 1 < profile.cells.size()) {
    const auto log_weight = [&](std::size_t i) {
      return std::log(profile.cells[i].averages.weight);
    };
    const double drop_before = log_weight(likeliest) - log_weight(likeliest - 1);
    const double drop_after = log_weight(likeliest) - log_weight(likeliest + 1);
    const double step = profile.cells[likeliest + 1].middle - threshold;
    if (drop_before + drop_after > 0.0 && std::isfinite(drop_before + drop_after)) {
      threshold += 0.5 * step * (drop_before - drop_after) / (drop_before + drop_after);
    }
  }
  return {shape, std::clamp(threshold, ends.low, ends.high),
          width_at_slope_one(shape) / std::exp(log_width / weight), guess, lapse / weight};
}

/// Whether the test rejects both a typical observer who feels every level and one who feels none.
bool rejects_constant(const Profile& profile, double loss) {
  double max = 0.0;
  for (const Cell& cell : profile.cells) max = std::max(max, cell.averages.weight);
  const double min = std::exp(-loss) * max;
  return profile.cells.front().averages.weight < min && profile.cells.back().averages.weight < min;
}

Threshold numeric_threshold(double level, const Ends& ends) {
  Threshold threshold;
  threshold.level = level;
  if (std::isfinite(ends.low)) threshold.low = ends.low;
  if (std::isfinite(ends.high)) threshold.high = ends.high;
  return threshold;
}

Threshold censored_threshold(const Ends& ends, std::span<const double> levels) {
  const auto [low, high] = ends;
  Threshold threshold;
  if (low >= levels.back()) {
    threshold.low = levels.back();
    threshold.censored = Censored::above;
  } else if (high <= levels.front()) {
    threshold.high = levels.front();
    threshold.censored = Censored::below;
  } else {
    if (low > levels.front()) threshold.low = low;
    if (high < levels.back()) threshold.high = high;
    threshold.censored = Censored::undetermined;
  }
  return threshold;
}

void require_valid_counts(std::span<const LevelCounts> counts, std::span<const double> levels,
                          double guess, double interval) {
  const auto is_ascending = [](double previous, double next) {
    return std::isfinite(next) && previous < next;
  };
  double previous_level = -std::numeric_limits<double>::infinity();
  for (const double level : levels) {
    if (!is_ascending(previous_level, level))
      throw std::invalid_argument("levels must be an ascending list");
    previous_level = level;
  }
  previous_level = -std::numeric_limits<double>::infinity();
  for (const LevelCounts& point : counts) {
    if (!is_ascending(previous_level, point.level) || point.n < 1 || point.correct < 0 ||
        point.correct > point.n) {
      throw std::invalid_argument(
          "an estimate needs ascending levels, each with 0 <= correct <= n");
    }
    previous_level = point.level;
  }
  if (levels.empty() || !(guess > 0.0 && guess < 1.0) || !(interval > 0.0 && interval < 1.0)) {
    throw std::invalid_argument("an estimate needs levels, and guess and interval between 0 and 1");
  }
}

}  // namespace

ThresholdEstimate estimate_threshold(std::span<const LevelCounts> counts,
                                     std::span<const double> levels, Shape shape, double guess,
                                     double interval) {
  require_valid_counts(counts, levels, guess, interval);
  const double loss = 0.5 * boost::math::quantile(boost::math::chi_squared(1.0), interval);
  constexpr double kNegligible = 0.1;
  const Profile profile =
      profile_of(AveragedLikelihood(counts, shape, guess), levels, kNegligible * std::exp(-loss));
  const Ends ends = ends_of(profile, &Averages::likelihood, loss);
  ThresholdEstimate estimate;
  estimate.observer = typical_observer(profile, ends, shape, guess);
  const double likeliest = estimate.observer.threshold;
  if (levels.front() < likeliest && likeliest < levels.back() && rejects_constant(profile, loss)) {
    estimate.threshold = numeric_threshold(likeliest, ends);
    return estimate;
  }
  estimate.threshold = censored_threshold(ends, levels);
  estimate.attentive =
      censored_threshold(ends_of(profile, &Averages::attentive_likelihood, loss), levels);
  if (estimate.attentive.censored == Censored::above) estimate.threshold = estimate.attentive;
  return estimate;
}

}  // namespace touchtrial::procedures
