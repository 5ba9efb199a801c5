#include "analysis/statistics/cochran_q.hpp"

#include "core/random.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include <boost/math/distributions/chi_squared.hpp>

namespace touchtrial::analysis {
namespace {

using Occasions = std::span<const std::vector<bool>>;
using RightByMethod = std::vector<std::int64_t>;

void require_as_long(Occasions occasions, std::size_t methods) {
  for (const std::vector<bool>& occasion : occasions) {
    if (occasion.size() != methods) {
      throw std::invalid_argument("Cochran's Q needs an answer of every method on every occasion");
    }
  }
}

std::int64_t right_on(const std::vector<bool>& occasion) {
  return std::count(occasion.begin(), occasion.end(), true);
}

bool methods_differ(Occasions occasions) {
  return std::any_of(occasions.begin(), occasions.end(), [](const std::vector<bool>& occasion) {
    const std::int64_t right = right_on(occasion);
    return right > 0 && right < static_cast<std::int64_t>(occasion.size());
  });
}

RightByMethod right_by_method(Occasions occasions, std::size_t methods) {
  RightByMethod right(methods);
  for (const std::vector<bool>& occasion : occasions) {
    for (std::size_t j = 0; j < methods; ++j) right[j] += occasion[j] ? 1 : 0;
  }
  return right;
}

std::int64_t sum_of_squares(const RightByMethod& right) {
  return std::inner_product(right.begin(), right.end(), right.begin(), std::int64_t{0});
}

/// The sum of squares after the methods were exchanged within every participant.
std::int64_t exchanged(std::vector<RightByMethod>& participants, RandomStream& random) {
  RightByMethod right(participants.front().size());
  for (RightByMethod& mine : participants) {
    shuffle(std::span(mine), random);
    for (std::size_t j = 0; j < right.size(); ++j) right[j] += mine[j];
  }
  return sum_of_squares(right);
}

}  // namespace

std::optional<CochranQ> cochran_q(Occasions occasions) {
  if (occasions.empty()) return std::nullopt;
  const std::size_t methods = occasions.front().size();
  require_as_long(occasions, methods);
  if (methods < 2 || !methods_differ(occasions)) return std::nullopt;
  const RightByMethod right = right_by_method(occasions, methods);
  const std::int64_t all = std::accumulate(right.begin(), right.end(), std::int64_t{0});
  std::int64_t squares_of_occasions = 0;
  for (const std::vector<bool>& occasion : occasions) {
    squares_of_occasions += right_on(occasion) * right_on(occasion);
  }
  const auto k = static_cast<std::int64_t>(methods);
  const auto between = static_cast<double>(k * sum_of_squares(right) - all * all);
  CochranQ result;
  result.degrees_of_freedom = static_cast<int>(k - 1);
  result.q =
      result.degrees_of_freedom * between / static_cast<double>(k * all - squares_of_occasions);
  const boost::math::chi_squared_distribution<> chi_squared(result.degrees_of_freedom);
  result.p = boost::math::cdf(boost::math::complement(chi_squared, result.q));
  return result;
}

std::optional<double> cochran_q_permuted_p(
    std::span<const std::vector<std::vector<bool>>> by_participant, int deals,
    std::uint64_t index) {
  if (deals < 1) throw std::invalid_argument("a permutation test needs at least one deal");
  std::optional<std::size_t> methods;
  std::vector<RightByMethod> participants;
  bool differ = false;
  for (const std::vector<std::vector<bool>>& occasions : by_participant) {
    if (occasions.empty()) continue;
    if (!methods) methods = occasions.front().size();
    require_as_long(occasions, *methods);
    participants.push_back(right_by_method(occasions, *methods));
    differ = differ || methods_differ(occasions);
  }
  if (!methods || *methods < 2 || !differ) return std::nullopt;
  // Exchanging methods changes nothing of Q but the sum of the methods' squares.
  RightByMethod observed(*methods);
  for (const RightByMethod& mine : participants) {
    for (std::size_t j = 0; j < *methods; ++j) observed[j] += mine[j];
  }
  const std::int64_t threshold = sum_of_squares(observed);
  RandomStream random(0, "Cochran's Q", index);
  int as_far = 0;
  for (int deal = 0; deal < deals; ++deal) {
    if (exchanged(participants, random) >= threshold) ++as_far;
  }
  return (as_far + 1.0) / (deals + 1.0);
}

}  // namespace touchtrial::analysis
