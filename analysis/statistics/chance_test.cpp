#include "analysis/statistics/chance_test.hpp"

#include "analysis/statistics/common.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include <boost/math/distributions/binomial.hpp>
#include <boost/multiprecision/cpp_int.hpp>

namespace touchtrial::analysis {
namespace {

using Integer = boost::multiprecision::cpp_int;
using Polynomial = std::vector<Integer>;

void require_matching_counts(const ClassCounts& counts, int trials) {
  int presented = 0;
  int answered = 0;
  for (const auto& [presentations, answers] : counts) {
    if (presentations < 0 || answers < 0) throw std::invalid_argument("a count cannot be negative");
    presented += presentations;
    answered += answers;
  }
  if (presented != trials || answered > trials) {
    throw std::invalid_argument("presentations and answers do not fit the number of trials");
  }
}

/// The numbers of ways to place 0, 1, .. non-attacking rooks on a board of `rows` x `columns`.
Polynomial rook_polynomial(int rows, int columns) {
  Polynomial ways{1};
  for (int k = 0; k < std::min(rows, columns); ++k) {
    ways.push_back(ways.back() * (rows - k) * (columns - k) / (k + 1));
  }
  return ways;
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial result(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  }
  return result;
}

/// Converts the coefficients of a polynomial in t - 1 to those in t.
void shift_by_one(Polynomial& coefficients) {
  const std::size_t n = coefficients.size();
  for (std::size_t start = 0; start + 1 < n; ++start) {
    for (std::size_t k = n - 1; k > start; --k) coefficients[k - 1] -= coefficients[k];
  }
}

double ratio(const Integer& part, const Integer& whole) {
  if (part == 0) return 0.0;
  const int bits_short =
      std::max(0, static_cast<int>(msb(whole)) - static_cast<int>(msb(part)) + 66);
  const Integer quotient = (part << bits_short) / whole;
  return std::ldexp(quotient.convert_to<double>(), -bits_short);
}

/// Longer blocks would take too long to count.
constexpr int kMaxCountedBlock = 400;
/// Probabilities below this are dropped at a distribution's ends.
constexpr double kNegligible = 1e-290;
/// The floor of p: more than the sum of all dropped probabilities.
constexpr double kMinP = 1e-280;

void require_in_range(int classes, int index) {
  if (index < 0 || index >= classes) {
    throw std::invalid_argument("a chance test's class is out of range");
  }
}

void require_valid(int classes, std::span<const AnsweredBlock> blocks) {
  for (const AnsweredBlock& block : blocks) {
    if (block.presented.size() != block.answered.size()) {
      throw std::invalid_argument(
          "a chance test needs one answer (or a missing one) per presentation");
    }
    for (const int presented : block.presented) require_in_range(classes, presented);
    for (const std::optional<int>& answer : block.answered) {
      if (answer) require_in_range(classes, *answer);
    }
  }
}

int matches(std::span<const int> presented, std::span<const std::optional<int>> answered) {
  int right = 0;
  for (std::size_t i = 0; i < presented.size(); ++i) right += answered[i] == presented[i] ? 1 : 0;
  return right;
}

ClassCounts counts_of(int classes, const AnsweredBlock& block) {
  ClassCounts counts(static_cast<std::size_t>(classes));
  for (const int presented : block.presented) ++counts[presented].first;
  for (const std::optional<int>& answer : block.answered) {
    if (answer) ++counts[*answer].second;
  }
  std::sort(counts.begin(), counts.end());  // the classes' order does not matter
  return counts;
}

/// The distribution of a sum of counts, without negligible probabilities at its ends.
struct Distribution {
  int first = 0;  ///< the count of the first probability
  std::vector<double> probability{1.0};

  void add(const std::vector<double>& other) {
    std::vector<double> sum(probability.size() + other.size() - 1);
    for (std::size_t i = 0; i < other.size(); ++i) {
      for (std::size_t k = 0; k < probability.size(); ++k) sum[k + i] += probability[k] * other[i];
    }
    probability = std::move(sum);
    const auto is_relevant = [](double p) { return p > kNegligible; };
    const auto begin = std::find_if(probability.begin(), probability.end(), is_relevant);
    const auto end = std::find_if(probability.rbegin(), probability.rend(), is_relevant).base();
    first += static_cast<int>(begin - probability.begin());
    probability = std::vector<double>(begin, end);
  }

  [[nodiscard]] double at_least(int count) const {
    const auto start = static_cast<std::size_t>(std::max(0, count - first));
    if (start >= probability.size()) return 0.0;
    // Adds the smallest first to limit rounding.
    return std::min(1.0, std::accumulate(probability.rbegin(), probability.rend() - start, 0.0));
  }

  /// The largest upper tail that does not exceed the level.
  [[nodiscard]] double largest_tail(double level) const {
    double tail = 0.0;
    for (auto one = probability.rbegin(); one != probability.rend(); ++one) {
      if (tail + *one > level) break;
      tail += *one;
    }
    return tail;
  }
};

void count_orders(int classes, std::span<const AnsweredBlock> blocks, MatchCache& cache,
                  ChanceTest& test) {
  Distribution right;
  for (const AnsweredBlock& block : blocks) {
    const auto trials = static_cast<int>(block.presented.size());
    const ClassCounts counts = counts_of(classes, block);
    const auto [entry, is_new] = cache.try_emplace(counts);
    if (is_new) entry->second = match_probabilities(counts, trials);
    right.add(entry->second);
    for (const auto& [presentations, answers] : counts) {
      if (trials > 0) test.expected += static_cast<double>(presentations) * answers / trials;
    }
  }
  test.p = right.at_least(test.correct);
  test.attainable = right.largest_tail(kSignificanceLevel);
}

/// The largest of above(0), above(1), .., above(max_count), which decrease, that does not exceed
/// the level.
template <typename Tail>
double largest_tail_of(const Tail& above, int max_count) {
  int low = -1;  // its tail exceeds the level
  int high = max_count;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    (above(middle) <= kSignificanceLevel ? high : low) = middle;
  }
  return above(high);
}

void apply_binomial(int classes, std::span<const AnsweredBlock> blocks, ChanceTest& test) {
  int answered = 0;
  for (const AnsweredBlock& block : blocks) {
    answered += static_cast<int>(std::count_if(block.answered.begin(), block.answered.end(),
                                               [](const auto& a) { return a.has_value(); }));
  }
  test.expected = static_cast<double>(answered) / classes;
  const boost::math::binomial_distribution<> chance(answered, 1.0 / classes);
  const auto above = [&](int count) {
    return boost::math::cdf(boost::math::complement(chance, count));
  };
  test.attainable = largest_tail_of(above, answered);
  if (test.correct > 0) test.p = above(test.correct - 1);
}

/// The largest of the p values (b + 1) / (deals + 1) that does not exceed the level.
double attainable_of_draws(const std::map<int, int>& counts, int deals) {
  int tail = 0;
  double share = 0.0;
  for (auto one = counts.rbegin(); one != counts.rend(); ++one) {
    tail += one->second;
    const double next = p_of_draws(tail, deals);
    if (next > kSignificanceLevel) break;
    share = next;
  }
  return share;
}

void redraw_orders(int classes, std::span<const AnsweredBlock> blocks, const BlockRedraw& redraw,
                   int deals, ChanceTest& test) {
  if (deals < 1) throw std::invalid_argument("a chance test needs at least one deal");
  int as_extreme = 0;
  double sum = 0.0;
  std::map<int, int> counts;
  for (int deal = 0; deal < deals; ++deal) {
    int right = 0;
    for (std::size_t block = 0; block < blocks.size(); ++block) {
      const std::vector<int> presented = redraw(block, deal);
      if (presented.size() != blocks[block].answered.size()) {
        throw std::invalid_argument("a redrawn block must keep its length");
      }
      for (const int class_index : presented) require_in_range(classes, class_index);
      right += matches(presented, blocks[block].answered);
    }
    sum += right;
    ++counts[right];
    if (right >= test.correct) ++as_extreme;
  }
  test.attainable = attainable_of_draws(counts, deals);
  test.expected = sum / deals;
  test.p = p_of_draws(as_extreme, deals);
  test.exact = false;
  test.deals = deals;
}

/// Shuffles a block's presentations. Reproducible if deals are requested in ascending order.
BlockRedraw shuffling_redraw(std::span<const AnsweredBlock> blocks, RandomStream& random) {
  return [blocks, &random](std::size_t block, int /*deal*/) {
    std::vector<int> presented = blocks[block].presented;
    shuffle(std::span(presented), random);
    return presented;
  };
}

bool is_countable(std::span<const AnsweredBlock> blocks) {
  return std::all_of(blocks.begin(), blocks.end(), [](const AnsweredBlock& block) {
    return block.presented.size() <= std::size_t{kMaxCountedBlock};
  });
}

void test_permuted(int classes, std::span<const AnsweredBlock> blocks, int deals, MatchCache& cache,
                   ChanceTest& test) {
  if (is_countable(blocks)) return count_orders(classes, blocks, cache, test);
  RandomStream random(0, "chance test");
  redraw_orders(classes, blocks, shuffling_redraw(blocks, random), deals, test);
}

}  // namespace

std::vector<double> match_probabilities(const ClassCounts& counts, int trials) {
  require_matching_counts(counts, trials);
  Polynomial ways{1};
  for (const auto& [presentations, answers] : counts)
    ways = product(ways, rook_polynomial(presentations, answers));
  // Orders that match in k given places: the other presentations can be arranged in (trials - k)!
  // ways.
  Integer arrangements = 1;
  for (int i = 2; i <= trials - static_cast<int>(ways.size()) + 1; ++i) arrangements *= i;
  for (std::size_t k = ways.size(); k-- > 0;) {
    ways[k] *= arrangements;
    if (k > 0) arrangements *= trials - static_cast<int>(k) + 1;
  }
  shift_by_one(ways);
  std::vector<double> probabilities;
  for (const Integer& orders : ways) probabilities.push_back(ratio(orders, arrangements));
  return probabilities;
}

std::optional<ChanceTest> chance_test(int classes, std::span<const AnsweredBlock> blocks,
                                      OrderRule order, const BlockRedraw& redraw, int deals,
                                      MatchCache* cache) {
  require_valid(classes, blocks);
  if (order == OrderRule::redrawn && !redraw) {
    throw std::invalid_argument(
        "a chance test of redrawn blocks needs a function that redraws them");
  }
  ChanceTest test;
  for (const AnsweredBlock& block : blocks) {
    test.trials += static_cast<int>(block.presented.size());
    test.correct += matches(block.presented, block.answered);
  }
  if (test.trials == 0) return std::nullopt;
  switch (order) {
    case OrderRule::permuted: {
      MatchCache local_cache;
      test_permuted(classes, blocks, deals, cache != nullptr ? *cache : local_cache, test);
      break;
    }
    case OrderRule::independent:
      apply_binomial(classes, blocks, test);
      break;
    case OrderRule::redrawn:
      redraw_orders(classes, blocks, redraw, deals, test);
      break;
  }
  test.p = std::max(test.p, kMinP);
  return test;
}

}  // namespace touchtrial::analysis
