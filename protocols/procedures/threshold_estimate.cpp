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
constexpr std::size_t kBlocks = 120;  ///< of the threshold's cells
constexpr std::size_t kCells = 5;     ///< of a block

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
  std::size_t at = 0;
  for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
    for (const double side : {-1.0, 1.0}) {
      const double x = Rule::abscissa()[i];
      if (x == 0.0 && side > 0.0) continue;
      nodes.values[at] = middle + side * half * x;
      nodes.weights[at] = half * Rule::weights()[i];
      ++at;
    }
  }
  return nodes;
}

/// Lapse rates from 0 to kMaxLapse, dense near 0.
Nodes<kLapses> lapse_nodes(double max) {
  Nodes<kLapses> nodes = nodes_between<kLapses>(0.0, 1.0);
  for (std::size_t i = 0; i < kLapses; ++i) {
    const double root = nodes.values[i];
    nodes.values[i] = max * root * root;
    nodes.weights[i] *= 2.0 * root;
  }
  return nodes;
}

/// base^exponent for every base, times `product`.
void multiply_power(std::array<double, kLapses>& product, std::array<double, kLapses> base,
                    std::int64_t exponent) {
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) {
      for (std::size_t i = 0; i < kLapses; ++i) product[i] *= base[i];
    }
    for (std::size_t i = 0; i < kLapses; ++i) base[i] *= base[i];
  }
}

constexpr std::int64_t kMaxPower =
    256;  ///< higher powers of shares may leave the range of a double

/// Multiplies by the powers for right and wrong answers together. Slower, but for any exponents.
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
struct AtThreshold {
  double likelihood = 0.0;  ///< over all observers
  double attentive = 0.0;   ///< over all widths and typical lapse rates
  double weight = 0.0;      ///< over typical observers
  double log_width = 0.0;   ///< mean of typical observers, times weight
  double lapse = 0.0;       ///< mean of typical observers, times weight
};

class AveragedLikelihood {
 public:
  AveragedLikelihood(std::span<const LevelCounts> counts, Shape shape, double guess)
      : counts_(counts.begin(), counts.end()),
        shape_(shape),
        guess_(guess),
        log_widths_(nodes_between<kWidths>(std::log(kMinWidth_db), std::log(kMaxWidth_db))),
        lapses_(lapse_nodes(std::min(kMaxLapse, 1.0 - guess))) {
    // Levels with many answers come first, because they soonest show that an observer is
    // negligible.
    std::stable_sort(counts_.begin(), counts_.end(),
                     [](const LevelCounts& a, const LevelCounts& b) { return a.n > b.n; });
    for (std::size_t i = 0; i < kWidths; ++i) {
      const double off = (log_widths_.values[i] - std::log(kTypicalWidth_db)) / kTypicalSpread;
      any_width_[i] =
          log_widths_.weights[i] * std::exp((1.0 + kWidthPower) * log_widths_.values[i]);
      typical_width_[i] = log_widths_.weights[i] * std::exp(-0.5 * off * off);
    }
    for (std::size_t i = 0; i < kLapses; ++i) {
      const double attends = 1.0 - lapses_.values[i];
      any_lapse_[i] = lapses_.weights[i] * std::pow(attends, kAnyLapse - 1.0);
      typical_lapse_[i] = lapses_.weights[i] * std::pow(attends, kTypicalLapse - 1.0);
    }
  }

  /// \param min_likelihood  likelihoods below it may count as 0
  [[nodiscard]] AtThreshold at(double threshold, double min_likelihood) const {
    AtThreshold sums;
    for (std::size_t w = 0; w < kWidths; ++w) {
      const std::array<double, kLapses> likelihoods =
          likelihoods_of(threshold, std::exp(log_widths_.values[w]), min_likelihood);
      double any = 0.0;
      double typical = 0.0;
      double lapse = 0.0;
      for (std::size_t i = 0; i < kLapses; ++i) {
        any += any_lapse_[i] * likelihoods[i];
        typical += typical_lapse_[i] * likelihoods[i];
        lapse += typical_lapse_[i] * likelihoods[i] * lapses_.values[i];
      }
      sums.likelihood += any_width_[w] * any;
      sums.attentive += any_width_[w] * typical;
      sums.weight += typical_width_[w] * typical;
      sums.log_width += typical_width_[w] * typical * log_widths_.values[w];
      sums.lapse += typical_width_[w] * lapse;
    }
    return sums;
  }

 private:
  /// Likelihoods at every lapse rate, divided by that of each level's own proportion; at most 1.
  [[nodiscard]] std::array<double, kLapses> likelihoods_of(double threshold, double width,
                                                           double min_likelihood) const {
    const double slope = width_at_slope_one(shape_) / width;
    std::array<double, kLapses> product;
    product.fill(1.0);
    for (const LevelCounts& at : counts_) {
      const AnswerShares felt = shares_at({shape_, threshold, slope, 0.0, 0.0}, at.level);
      const double n = static_cast<double>(at.n);
      const std::int64_t wrong = at.n - at.correct;
      const double own_right = at.correct > 0 ? n / static_cast<double>(at.correct) : 0.0;
      const double own_wrong = wrong > 0 ? n / static_cast<double>(wrong) : 0.0;
      std::array<double, kLapses> right_share;
      std::array<double, kLapses> wrong_share;
      for (std::size_t i = 0; i < kLapses; ++i) {
        const double scale = 1.0 - guess_ - lapses_.values[i];
        right_share[i] = (guess_ + scale * felt.correct) * own_right;
        wrong_share[i] = (lapses_.values[i] + scale * felt.wrong) * own_wrong;
      }
      if (at.n <= kMaxPower) {
        multiply_power(product, right_share, at.correct);
        multiply_power(product, wrong_share, wrong);
      } else {
        multiply_by_logarithms(product, right_share, at.correct, wrong_share, wrong);
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
  std::array<double, kWidths> any_width_{};
  std::array<double, kWidths> typical_width_{};
  std::array<double, kLapses> any_lapse_{};
  std::array<double, kLapses> typical_lapse_{};
};

struct Cell {
  double middle = 0.0;
  AtThreshold found;
};

/// The likelihood in equal cells of the threshold. Blocks of cells where it is negligible have one
/// value.
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
  constexpr double kCountsAsNone = 1e-8;
  const auto cell_at = [&](std::size_t i) {
    const double middle = lowest + (static_cast<double>(i) + 0.5) * profile.width;
    return Cell{middle, likelihood.at(middle, kCountsAsNone * negligible * profile.max_likelihood)};
  };
  std::vector<Cell> coarse;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    coarse.push_back(cell_at(block * kCells + kCells / 2));
    profile.max_likelihood = std::max(profile.max_likelihood, coarse.back().found.likelihood);
  }
  const double limit = negligible * profile.max_likelihood;
  const auto matters = [&](std::size_t block) { return coarse[block].found.likelihood > limit; };
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const bool fine = matters(block) || (block > 0 && matters(block - 1)) ||
                      (block + 1 < kBlocks && matters(block + 1));
    for (std::size_t i = 0; i < kCells; ++i) {
      const bool known = i == kCells / 2;
      if (!fine && !known) continue;
      profile.cells.push_back(known ? coarse[block] : cell_at(block * kCells + i));
      profile.max_likelihood =
          std::max(profile.max_likelihood, profile.cells.back().found.likelihood);
    }
  }
  return profile;
}

using Likelihood = double AtThreshold::*;

/// The threshold at which a likelihood first reaches `min`; `at_once` if the first cell does.
template <typename Iterator>
double first_above(Iterator first, Iterator last, Likelihood of, double min, double at_once) {
  const auto above =
      std::find_if(first, last, [&](const Cell& cell) { return cell.found.*of >= min; });
  if (above == first) return at_once;
  const auto below = std::prev(above);
  // Avoids the logarithm of 0; a smaller number cannot be adjacent to `min`.
  const double floor = std::numeric_limits<double>::min();
  const double before = std::log(std::max(below->found.*of, floor));
  const double share = (std::log(min) - before) / (std::log(above->found.*of) - before);
  return std::lerp(below->middle, above->middle, share);
}

struct Ends {
  double low = 0.0;
  double high = 0.0;
};

/// The thresholds at which the logarithm of a likelihood is `loss` below its maximum.
Ends ends_of(const Profile& profile, Likelihood of, double loss) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  const std::vector<Cell>& cells = profile.cells;
  const auto top = std::max_element(cells.begin(), cells.end(), [&](const Cell& a, const Cell& b) {
    return a.found.*of < b.found.*of;
  });
  double log_largest = std::log((*top).found.*of);
  if (top != cells.begin() && std::next(top) != cells.end()) {
    // A parabola through three cells, because a small error in a flat maximum moves an end far.
    const double before = log_largest - std::log((*std::prev(top)).found.*of);
    const double after = log_largest - std::log((*std::next(top)).found.*of);
    const double bend = before + after;
    if (bend > 0.0 && std::isfinite(bend)) {
      log_largest += (before - after) * (before - after) / (8.0 * bend);
    }
  }
  const double min = std::exp(log_largest - loss);
  return {first_above(cells.begin(), cells.end(), of, min, -kOpen),
          first_above(cells.rbegin(), cells.rend(), of, min, kOpen)};
}

/// The most likely threshold of typical observers between two ends, by a parabola through the
/// logarithms of three cells, and their mean width and lapse rate.
Observer typical_observer(const Profile& profile, const Ends& ends, Shape shape, double guess) {
  double weight = 0.0;
  double log_width = 0.0;
  double lapse = 0.0;
  std::size_t likeliest = profile.cells.size();
  for (std::size_t i = 0; i < profile.cells.size(); ++i) {
    const auto& [middle, found] = profile.cells[i];
    const double inside = std::min(ends.high, middle + 0.5 * profile.width) -
                          std::max(ends.low, middle - 0.5 * profile.width);
    if (inside <= 0.0) continue;
    weight += inside * found.weight;
    log_width += inside * found.log_width;
    lapse += inside * found.lapse;
    if (likeliest == profile.cells.size() || found.weight > profile.cells[likeliest].found.weight) {
      likeliest = i;
    }
  }
  double threshold = profile.cells[likeliest].middle;
  if (likeliest > 0 && likeliest + 1 < profile.cells.size()) {
    const auto log_weight = [&](std::size_t i) { return std::log(profile.cells[i].found.weight); };
    const double before = log_weight(likeliest) - log_weight(likeliest - 1);
    const double after = log_weight(likeliest) - log_weight(likeliest + 1);
    const double step = profile.cells[likeliest + 1].middle - threshold;
    if (before + after > 0.0 && std::isfinite(before + after)) {
      threshold += 0.5 * step * (before - after) / (before + after);
    }
  }
  return {shape, std::clamp(threshold, ends.low, ends.high),
          width_at_slope_one(shape) / std::exp(log_width / weight), guess, lapse / weight};
}

/// Whether typical observers who feel every level, and those who feel none, are rejected.
bool is_rise(const Profile& profile, double loss) {
  double max = 0.0;
  for (const Cell& cell : profile.cells) max = std::max(max, cell.found.weight);
  const double min = std::exp(-loss) * max;
  return profile.cells.front().found.weight < min && profile.cells.back().found.weight < min;
}

Threshold numbered(double level, const Ends& ends) {
  Threshold found;
  found.level = level;
  if (std::isfinite(ends.low)) found.low = ends.low;
  if (std::isfinite(ends.high)) found.high = ends.high;
  return found;
}

Threshold without_number(const Ends& ends, std::span<const double> levels) {
  const auto [low, high] = ends;
  Threshold found;
  if (low >= levels.back()) {
    found.low = levels.back();
    found.censored = Censored::above;
  } else if (high <= levels.front()) {
    found.high = levels.front();
    found.censored = Censored::below;
  } else {
    if (low > levels.front()) found.low = low;
    if (high < levels.back()) found.high = high;
    found.censored = Censored::undetermined;
  }
  return found;
}

void require_estimate(std::span<const LevelCounts> counts, std::span<const double> levels,
                      double guess, double interval) {
  const auto ascends = [](double before, double after) {
    return std::isfinite(after) && before < after;
  };
  double before = -std::numeric_limits<double>::infinity();
  for (const double level : levels) {
    if (!ascends(before, level)) throw std::invalid_argument("levels must be an ascending list");
    before = level;
  }
  before = -std::numeric_limits<double>::infinity();
  for (const LevelCounts& at : counts) {
    if (!ascends(before, at.level) || at.n < 1 || at.correct < 0 || at.correct > at.n) {
      throw std::invalid_argument(
          "an estimate needs ascending levels, each with 0 <= correct <= n");
    }
    before = at.level;
  }
  if (levels.empty() || !(guess > 0.0 && guess < 1.0) || !(interval > 0.0 && interval < 1.0)) {
    throw std::invalid_argument("an estimate needs levels, and guess and interval between 0 and 1");
  }
}

}  // namespace

ThresholdEstimate estimate_threshold(std::span<const LevelCounts> counts,
                                     std::span<const double> levels, Shape shape, double guess,
                                     double interval) {
  require_estimate(counts, levels, guess, interval);
  const double loss = 0.5 * boost::math::quantile(boost::math::chi_squared(1.0), interval);
  constexpr double kNegligible = 0.1;
  const Profile profile =
      profile_of(AveragedLikelihood(counts, shape, guess), levels, kNegligible * std::exp(-loss));
  const Ends ends = ends_of(profile, &AtThreshold::likelihood, loss);
  ThresholdEstimate estimate;
  estimate.observer = typical_observer(profile, ends, shape, guess);
  const double likeliest = estimate.observer.threshold;
  if (levels.front() < likeliest && likeliest < levels.back() && is_rise(profile, loss)) {
    estimate.threshold = numbered(likeliest, ends);
    return estimate;
  }
  estimate.threshold = without_number(ends, levels);
  estimate.attentive = without_number(ends_of(profile, &AtThreshold::attentive, loss), levels);
  if (estimate.attentive.censored == Censored::above) estimate.threshold = estimate.attentive;
  return estimate;
}

}  // namespace touchtrial::procedures
