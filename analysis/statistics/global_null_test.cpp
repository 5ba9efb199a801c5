#include "analysis/statistics/global_null_test.hpp"

#include "analysis/statistics/chance_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <stdexcept>

namespace touchtrial::analysis {
namespace {

void require_deals(std::span<const double> values, std::size_t wanted) {
  if (values.size() != wanted) {
    throw std::invalid_argument("a global null test needs an observed value and one for each deal");
  }
}

/// The largest rank such that at most kSignificanceLevel of all deals reach it or are significant
/// by Holm. If Holm alone exceeds that level, a rank that no deal reaches.
double rank_at_level(std::span<const double> by_holm, std::span<const double> rank) {
  std::vector<double> others;
  for (std::size_t i = 0; i < rank.size(); ++i) {
    if (by_holm[i] > kSignificanceLevel) others.push_back(rank[i]);
  }
  std::ranges::sort(others);
  const auto all = static_cast<double>(rank.size());
  const double left =
      std::floor(kSignificanceLevel * all) - (all - static_cast<double>(others.size()));
  const double nobody = 0.5 / all;
  if (left < 1.0) return nobody;
  auto last = others.begin() + static_cast<std::ptrdiff_t>(left);
  if (last == others.end()) return others.back();
  // Deals that tie at a rank are counted together.
  last = std::ranges::lower_bound(others.begin(), last, *last);
  return last == others.begin() ? nobody : *std::prev(last);
}

}  // namespace

bool GlobalNullResult::found() const noexcept {
  return p <= kSignificanceLevel;
}

std::vector<double> ranked_p(std::span<const double> statistics) {
  constexpr double kTie = 1e-9;
  std::vector<std::size_t> order(statistics.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return statistics[a] > statistics[b]; });
  std::vector<double> p(statistics.size());
  for (std::size_t first = 0; first < order.size();) {
    const double largest = statistics[order[first]];
    const double least = largest - kTie * std::max(1.0, std::abs(largest));
    std::size_t last = first + 1;
    while (last < order.size() && statistics[order[last]] >= least) ++last;
    const double share = static_cast<double>(last) / static_cast<double>(order.size());
    for (; first < last; ++first) p[order[first]] = share;
  }
  return p;
}

GlobalNullTest::GlobalNullTest(int people, int deals)
    : people_(people),
      smallest_(static_cast<std::size_t>(std::max(deals, 0)) + 1, 1.0),
      product_(smallest_.size(), 0.0) {
  if (people < 0 || deals < 1) {
    throw std::invalid_argument("a global null test needs at least one deal");
  }
}

void GlobalNullTest::add(std::span<const double> p) {
  require_deals(p, smallest_.size());
  const auto possible = [](double one) { return one > 0.0 && one <= 1.0; };
  if (!std::ranges::all_of(p, possible)) {
    throw std::invalid_argument("a p must be in (0, 1]");
  }
  ++added_;
  for (std::size_t i = 0; i < p.size(); ++i) {
    smallest_[i] = std::min(smallest_[i], p[i]);
    product_[i] -= std::log(p[i]);
    if (p[i] <= kSignificanceLevel) ++(i == 0 ? alone_ : alone_in_deals_);
  }
}

GlobalNullResult GlobalNullTest::result(std::span<const double> together) const {
  require_deals(together, smallest_.size());
  if (added_ != people_) {
    throw std::invalid_argument(
        "a global null test needs the number of people that it was constructed with");
  }
  std::vector<double> by_holm(smallest_.size());
  for (std::size_t i = 0; i < by_holm.size(); ++i) by_holm[i] = smallest_[i] * people_;
  const std::vector<double> of_product = ranked_p(product_);
  const std::vector<double> of_together = ranked_p(together);
  std::vector<double> rank(smallest_.size());
  for (std::size_t i = 0; i < rank.size(); ++i) rank[i] = std::min(of_product[i], of_together[i]);
  const double at_level = rank_at_level(by_holm, rank) / kSignificanceLevel;
  std::vector<double> against(smallest_.size());
  for (std::size_t i = 0; i < against.size(); ++i) {
    against[i] = -std::log(std::min(by_holm[i], rank[i] / at_level));
  }
  GlobalNullResult result;
  result.deals = static_cast<int>(smallest_.size()) - 1;
  result.people = people_;
  result.alone = alone_;
  result.alone_by_chance = static_cast<double>(alone_in_deals_) / result.deals;
  if (people_ == 0) return result;
  result.p = ranked_p(against).front();
  // If Holm alone is significant, p is at most Holm's: the exact value is better than the Monte
  // Carlo one.
  if (by_holm.front() <= kSignificanceLevel) result.p = std::min(result.p, by_holm.front());
  return result;
}

}  // namespace touchtrial::analysis
