#include "analysis/statistics/match_counts.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/multiprecision/cpp_int.hpp>

namespace touchtrial::analysis {
namespace {

using Integer = boost::multiprecision::cpp_int;
using Polynomial = std::vector<Integer>;

void require_fitting(const ClassCounts& counts, int trials) {
  int presented = 0;
  int answered = 0;
  for (const auto& [shown, chosen] : counts) {
    if (shown < 0 || chosen < 0) throw std::invalid_argument("a count cannot be negative");
    presented += shown;
    answered += chosen;
  }
  if (presented != trials || answered > trials) {
    throw std::invalid_argument("presentations and answers do not fit the trials");
  }
}

/// Ways to put 0, 1, .. rooks that do not attack each other on a board of `rows` x `columns`.
Polynomial rooks_on(int rows, int columns) {
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

/// From the polynomial in t - 1 to the one in t.
void shift_by_one(Polynomial& coefficients) {
  const std::size_t n = coefficients.size();
  for (std::size_t from = 0; from + 1 < n; ++from) {
    for (std::size_t k = n - 1; k > from; --k) coefficients[k - 1] -= coefficients[k];
  }
}

double ratio(const Integer& part, const Integer& whole) {
  if (part == 0) return 0.0;
  const int bits_short =
      std::max(0, static_cast<int>(msb(whole)) - static_cast<int>(msb(part)) + 66);
  const Integer quotient = (part << bits_short) / whole;
  return std::ldexp(quotient.convert_to<double>(), -bits_short);
}

}  // namespace

std::vector<double> match_probabilities(const ClassCounts& counts, int trials) {
  require_fitting(counts, trials);
  Polynomial ways{1};
  for (const auto& [shown, chosen] : counts) ways = product(ways, rooks_on(shown, chosen));
  // Orders that match in k chosen places at least: the others stand in any of (trials - k)! ways.
  Integer rest = 1;
  for (int i = 2; i <= trials - static_cast<int>(ways.size()) + 1; ++i) rest *= i;
  for (std::size_t k = ways.size(); k-- > 0;) {
    ways[k] *= rest;
    if (k > 0) rest *= trials - static_cast<int>(k) + 1;
  }
  shift_by_one(ways);
  std::vector<double> probabilities;
  for (const Integer& orders : ways) probabilities.push_back(ratio(orders, rest));
  return probabilities;
}

}  // namespace touchtrial::analysis
