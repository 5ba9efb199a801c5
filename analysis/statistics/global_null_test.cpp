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

void require_deals(std::span<const double> values, std::size_t expected) {
  if (values.size() != expected) {
    throw std::invalid_argument("a global null test needs one observed value and one per deal");
  }
}

/// The largest rank such that at most kSignificanceLevel of all deals reach it or are significant
/// by Holm. If the deals significant by Holm exceed that level, the result is a rank that no deal
/// reaches.
double rank_at_level(std::span<const double> holm_p, std::span<const double> rank) {
  std::vector<double> candidates;
  for (std::size_t i = 0; i < rank.size(); ++i) {
    if (holm_p[i] > kSignificanceLevel) candidates.push_back(rank[i]);
  }
  std::ranges::sort(candidates);
  const auto deal_count = static_cast<double>(rank.size());
  const double allowed = std::floor(kSignificanceLevel * deal_count) -
                         (deal_count - static_cast<double>(candidates.size()));
  const double unreached_rank = 0.5 / deal_count;
  if (allowed < 1.0) return unreached_rank;
  auto last = candidates.begin() + static_cast<std::ptrdiff_t>(allowed);
  if (last == candidates.end()) return candidates.back();
  // Deals that tie at a rank are counted together.
  last = std::ranges::lower_bound(candidates.begin(), last, *last);
  return last == candidates.begin() ? unreached_rank : *std::prev(last);
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
  const auto is_valid = [](double one) { return one > 0.0 && one <= 1.0; };
  if (!std::ranges::all_of(p, is_valid)) {
    throw std::invalid_argument("a p must be in (0, 1]");
  }
  ++added_;
  for (std::size_t i = 0; i < p.size(); ++i) {
    smallest_[i] = std::min(smallest_[i], p[i]);
    product_[i] -= std::log(p[i]);
    if (p[i] <= kSignificanceLevel) ++(i == 0 ? significant_ : significant_in_deals_);
  }
}

GlobalNullResult GlobalNullTest::result(std::span<const double> pooled) const {
  require_deals(pooled, smallest_.size());
  if (added_ != people_) {
    throw std::invalid_argument(
        "a global null test needs the number of people that it was constructed with");
  }
  std::vector<double> holm_p(smallest_.size());
  for (std::size_t i = 0; i < holm_p.size(); ++i) holm_p[i] = smallest_[i] * people_;
  const std::vector<double> product_rank = ranked_p(product_);
  const std::vector<double> pooled_rank = ranked_p(pooled);
  std::vector<double> rank(smallest_.size());
  for (std::size_t i = 0; i < rank.size(); ++i) rank[i] = std::min(product_rank[i], pooled_rank[i]);
  const double level_scale = rank_at_level(holm_p, rank) / kSignificanceLevel;
  std::vector<double> evidence(smallest_.size());
  for (std::size_t i = 0; i < evidence.size(); ++i) {
    evidence[i] = -std::log(std::min(holm_p[i], rank[i] / level_scale));
  }
  GlobalNullResult result;
  result.deals = static_cast<int>(smallest_.size()) - 1;
  result.people = people_;
  result.alone = significant_;
  result.alone_by_chance = static_cast<double>(significant_in_deals_) / result.deals;
  if (people_ == 0) return result;
  result.p = ranked_p(evidence).front();
  // If Holm's p is significant by itself, p is at most Holm's: the exact value is better than the
  // Monte Carlo one.
  if (holm_p.front() <= kSignificanceLevel) result.p = std::min(result.p, holm_p.front());
  return result;
}

}  // namespace touchtrial::analysis
