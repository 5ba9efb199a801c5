#include "protocols/design/williams_order.hpp"

#include "protocols/design/schedule.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace touchtrial::design {
namespace {

std::vector<int> shuffled_numbers(int first, int count, RandomStream& random) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), first);
  shuffle(std::span<int>(numbers), random);
  return numbers;
}

/// The rows one after the other.
std::vector<int> joined(int symbols, std::span<const int> rows) {
  std::vector<int> order;
  for (const int row : rows) {
    const std::vector<int> permutation = williams_row(symbols, row);
    order.insert(order.end(), permutation.begin(), permutation.end());
  }
  return order;
}

bool keeps_limit(const std::vector<int>& order, int max_run, RunBefore before) {
  return std::ranges::all_of(order, [&](int symbol) {
    before = run_at_end({symbol}, before);
    return before.length <= max_run;
  });
}

/// Some rows of the square whose first is `first`, in an order that keeps the limit.
std::vector<int> square_rows(int symbols, int first, int rows, int max_run, RunBefore before,
                             RandomStream& random) {
  while (true) {
    const std::vector<int> all = shuffled_numbers(first, symbols, random);
    std::vector<int> order = joined(symbols, std::span(all).first(static_cast<std::size_t>(rows)));
    if (max_run == 0 || keeps_limit(order, max_run, before)) return order;
  }
}

}  // namespace

bool williams_order_exists(int symbols, int rows, int max_run) {
  return symbols > 2 || rows < 2 || max_run > 1;
}

std::vector<int> random_williams_order(int symbols, int rows, int max_run, RunBefore before,
                                       RandomStream& random) {
  const std::vector<int> names = shuffled_numbers(0, symbols, random);
  if (before.symbol >= 0) {
    before.symbol = static_cast<int>(std::ranges::find(names, before.symbol) - names.begin());
  }
  std::vector<int> order;
  std::vector<int> squares;
  for (int left = rows; left > 0; left -= symbols) {
    if (squares.empty()) squares = shuffled_numbers(0, symbols % 2 == 0 ? 1 : 2, random);
    const int first = squares.back() * symbols;
    squares.pop_back();
    const std::vector<int> drawn =
        square_rows(symbols, first, std::min(left, symbols), max_run, before, random);
    before = run_at_end(drawn, before);
    order.insert(order.end(), drawn.begin(), drawn.end());
  }
  for (int& symbol : order) symbol = names[static_cast<std::size_t>(symbol)];
  return order;
}

}  // namespace touchtrial::design
