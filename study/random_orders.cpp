#include "study/random_orders.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include <boost/multiprecision/cpp_int.hpp>

namespace touchtrial::study {
namespace {

// Orders with limited runs.

using BigCount = boost::multiprecision::cpp_int;

/// Draws a uniform whole number in [0, bound) by rejection, with fewer than two tries on average.
/// \pre bound >= 1
BigCount draw_below(const BigCount& bound, RandomStream& random) {
  constexpr unsigned kWord = 64;
  if (bound == 1) return 0;
  const unsigned bits = boost::multiprecision::msb(BigCount(bound - 1)) + 1;
  const unsigned words = (bits + kWord - 1) / kWord;
  while (true) {
    std::vector<std::uint64_t> drawn(words);
    for (std::uint64_t& word : drawn) word = random.bits();
    BigCount number;
    boost::multiprecision::import_bits(number, drawn.begin(), drawn.end());
    number >>= words * kWord - bits;
    if (number < bound) return number;
  }
}

/// The number of symbols with 0, 1, .. remaining copies, then 1 + the remaining copies of the last
/// symbol.
using State = std::u16string;

/// Counts sequences of runs. A run is a symbol and its number of repetitions; adjacent runs have
/// different symbols.
class RunCounter {
 public:
  RunCounter(const std::vector<int>& counts, int max_run)
      : remaining_(counts),
        max_run_(max_run),
        histogram_(static_cast<std::size_t>(*std::ranges::max_element(counts)) + 1, u'\0') {
    for (const int count : counts) ++histogram_[static_cast<std::size_t>(count)];
  }

  [[nodiscard]] int remaining(int symbol) const {
    return remaining_[static_cast<std::size_t>(symbol)];
  }
  [[nodiscard]] int symbols() const { return static_cast<int>(remaining_.size()); }
  [[nodiscard]] int max_length(int copies) const { return std::min(copies, max_run_); }

  /// Uses up copies of a symbol; a negative number returns them.
  void take(int symbol, int copies) {
    int& copies_left = remaining_[static_cast<std::size_t>(symbol)];
    move(copies_left, copies_left - copies);
    copies_left -= copies;
  }

  /// The number of completions after a run of `last_symbol` (negative: no symbol precedes). The
  /// next symbol differs from it.
  [[nodiscard]] BigCount completions(int last_symbol) {
    return count(last_symbol < 0 ? -1 : remaining(last_symbol));
  }

 private:
  /// Records that a symbol with `from` copies left now has `to`.
  void move(int from, int to) {
    --histogram_[static_cast<std::size_t>(from)];
    ++histogram_[static_cast<std::size_t>(to)];
  }

  /// Counts completions from the current state.
  /// \param copies_of_last  remaining copies of the preceding symbol; negative if there is none
  const BigCount& count(int copies_of_last) {
    State state = histogram_;
    state.push_back(static_cast<char16_t>(copies_of_last + 1));
    if (const auto stored = counts_.find(state); stored != counts_.end()) return stored->second;
    BigCount total = 0;
    bool any_left = false;
    for (int copies = 1; copies < static_cast<int>(histogram_.size()); ++copies) {
      const int symbols = histogram_[static_cast<std::size_t>(copies)];
      any_left = any_left || symbols > 0;
      const int next_symbols = symbols - (copies_of_last == copies ? 1 : 0);
      if (next_symbols > 0) total += next_symbols * count_after_any_run(copies);
    }
    if (!any_left) total = 1;
    return counts_.emplace(std::move(state), std::move(total)).first->second;
  }

  BigCount count_after_any_run(int copies) {
    BigCount sum = 0;
    for (int run = 1; run <= max_length(copies); ++run) {
      move(copies, copies - run);
      sum += count(copies - run);
      move(copies - run, copies);
    }
    return sum;
  }

  std::vector<int> remaining_;
  int max_run_;
  State histogram_;
  std::unordered_map<State, BigCount> counts_;
};

/// The maximum number of copies of the preceding symbol that may come first, >= 0.
int max_continuation(const RunCounter& counter, int max_run, PrecedingRun before) {
  return std::min(max_run - before.length, counter.remaining(before.symbol));
}

BigCount count_all(RunCounter& counter, int max_run, PrecedingRun before) {
  if (before.symbol < 0) return counter.completions(-1);
  BigCount total = 0;
  const int max_length = max_continuation(counter, max_run, before);
  for (int run = 0; run <= max_length; ++run) {
    counter.take(before.symbol, run);
    total += counter.completions(before.symbol);
    counter.take(before.symbol, -run);
  }
  return total;
}

/// Finds the order with a given number in the list of all orders, run by run.
class Descent {
 public:
  Descent(RunCounter& counter, BigCount number) : counter_(counter), number_(std::move(number)) {}

  /// Appends a run if the order with this number continues with it.
  /// \return whether the run was appended
  bool append_if_next(int symbol, int run) {
    counter_.take(symbol, run);
    const BigCount below = counter_.completions(symbol);
    if (number_ >= below) {
      number_ -= below;
      counter_.take(symbol, -run);
      return false;
    }
    order_.insert(order_.end(), static_cast<std::size_t>(run), symbol);
    return true;
  }

  /// Appends the next run.
  /// \return the run's symbol
  int append_next_run(int last_symbol) {
    for (int symbol = 0; symbol < counter_.symbols(); ++symbol) {
      if (symbol == last_symbol) continue;
      const int max_length = counter_.max_length(counter_.remaining(symbol));
      for (int run = 1; run <= max_length; ++run) {
        if (append_if_next(symbol, run)) return symbol;
      }
    }
    return last_symbol;
  }

  [[nodiscard]] std::vector<int>& order() { return order_; }

 private:
  RunCounter& counter_;
  BigCount number_;
  std::vector<int> order_;
};

/// For m = 0 .. length + 1, the number of sequences with fewer than `m` symbols whose first symbol
/// differs from the preceding one. These are cumulative sums, so that one difference gives the
/// number for a range of lengths.
std::vector<BigCount> sequences_below(int symbols, int length, int max_run) {
  std::vector<BigCount> below = {0, 1};
  for (int m = 1; m <= length; ++m) {
    const auto first = static_cast<std::size_t>(std::max(m - max_run, 0));
    below.push_back(below.back() + (symbols - 1) * BigCount(below.back() - below[first]));
  }
  return below;
}

/// Draws the length of the next run, in proportion to the number of sequences that can follow it.
int draw_run(const std::vector<BigCount>& below, int symbols_left, int min_length, int max_length,
             RandomStream& random) {
  // A run of r symbols is followed by symbols_left - r. The numbers begin with the shortest run.
  const auto at = [&below](int length) -> const BigCount& {
    return below[static_cast<std::size_t>(length)];
  };
  const BigCount& top = at(symbols_left - min_length + 1);
  const BigCount number = draw_below(BigCount(top - at(symbols_left - max_length)), random);
  for (int run = min_length; run < max_length; ++run) {
    if (number < top - at(symbols_left - run)) return run;
  }
  return max_length;
}

// De Bruijn cycles.

constexpr int kRoot = 0;  // any vertex will do, because circuits have no beginning

/// Wilson's algorithm: walks at random from each vertex to the tree. The last exit that the walk
/// takes from a vertex becomes its edge, which erases the walk's loops.
/// \return the exit of each vertex
std::vector<int> random_arborescence(int vertices, RandomStream& random) {
  const auto count = static_cast<std::size_t>(vertices);
  std::vector<int> exit(count, kRoot);
  std::vector<bool> in_tree(count, false);
  in_tree[kRoot] = true;
  for (int start = 0; start < vertices; ++start) {
    for (int v = start; !in_tree[v]; v = exit[v]) {
      exit[v] = static_cast<int>(random.below(count));
    }
    for (int v = start; !in_tree[v]; v = exit[v]) in_tree[v] = true;
  }
  return exit;
}

/// The exits of one vertex in the order in which the circuit uses them.
/// \param last_exit  the exit that is used last; negative: any
std::vector<int> ordered_exits(int vertices, int last_exit, RandomStream& random) {
  std::vector<int> exits(static_cast<std::size_t>(vertices));
  std::iota(exits.begin(), exits.end(), 0);
  std::span<int> free = exits;
  if (last_exit >= 0) {
    std::swap(exits[static_cast<std::size_t>(last_exit)], exits.back());
    free = free.first(free.size() - 1);
  }
  shuffle(free, random);
  return exits;
}

// Williams designs.

std::vector<int> shuffled_numbers(int first, int count, RandomStream& random) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), first);
  shuffle(std::span<int>(numbers), random);
  return numbers;
}

/// Concatenates rows of a Williams design.
std::vector<int> concatenate_rows(int symbols, std::span<const int> rows) {
  std::vector<int> order;
  for (const int row : rows) {
    const std::vector<int> permutation = williams_row(symbols, row);
    order.insert(order.end(), permutation.begin(), permutation.end());
  }
  return order;
}

bool respects_limit(const std::vector<int>& order, int max_run, PrecedingRun before) {
  return std::ranges::all_of(order, [&](int symbol) {
    before = run_at_end({symbol}, before);
    return before.length <= max_run;
  });
}

/// Draws `rows` rows of the square that starts at row `first`, in an order that respects the limit.
std::vector<int> square_rows(int symbols, int first, int rows, int max_run, PrecedingRun before,
                             RandomStream& random) {
  while (true) {
    const std::vector<int> all = shuffled_numbers(first, symbols, random);
    std::vector<int> order =
        concatenate_rows(symbols, std::span(all).first(static_cast<std::size_t>(rows)));
    if (max_run == 0 || respects_limit(order, max_run, before)) return order;
  }
}

}  // namespace

bool limited_order_exists(const std::vector<int>& counts, int max_run, PrecedingRun before) {
  const int total = std::accumulate(counts.begin(), counts.end(), 0);
  for (int symbol = 0; symbol < static_cast<int>(counts.size()); ++symbol) {
    const int copies = counts[static_cast<std::size_t>(symbol)];
    // The preceding run uses part of the first place.
    const int used = symbol == before.symbol ? before.length : 0;
    const std::int64_t places = std::int64_t{total} - copies + 1;
    if (copies + used > places * max_run) return false;
  }
  return true;
}

bool limited_orders_are_countable(const std::vector<int>& counts, int max_run) {
  constexpr double kMaxStates = 150'000.0;
  constexpr double kMaxRuns = 2'000'000.0;
  const auto symbols = static_cast<int>(counts.size());
  const int copies = *std::ranges::max_element(counts);
  double states = std::min(symbols, copies + 1);
  for (int i = 1; i <= std::min(symbols, copies); ++i) {
    states *= static_cast<double>(symbols + copies - i + 1) / i;
  }
  const double runs = states * std::min(symbols, copies) * std::min(max_run, copies);
  return states <= kMaxStates && runs <= kMaxRuns;
}

std::optional<std::vector<int>> draw_limited_order(const std::vector<int>& counts, int max_run,
                                                   PrecedingRun before, RandomStream& random) {
  RunCounter counter(counts, max_run);
  const BigCount total = count_all(counter, max_run, before);
  if (total == 0) return std::nullopt;
  Descent descent(counter, draw_below(total, random));
  if (before.symbol >= 0) {
    const int max_length = max_continuation(counter, max_run, before);
    for (int run = 0; run <= max_length; ++run) {
      if (descent.append_if_next(before.symbol, run)) break;
    }
  }
  const auto length = static_cast<std::size_t>(std::accumulate(counts.begin(), counts.end(), 0));
  int last_symbol = before.symbol;
  while (descent.order().size() < length) last_symbol = descent.append_next_run(last_symbol);
  return descent.order();
}

std::vector<int> draw_limited_sequence(int symbols, int length, int max_run, PrecedingRun before,
                                       RandomStream& random) {
  const std::vector<BigCount> counts = sequences_below(symbols, length, max_run);
  std::vector<int> sequence;
  int last_symbol = before.symbol;
  int symbols_left = length;
  const auto append = [&](int run) {
    sequence.insert(sequence.end(), static_cast<std::size_t>(run), last_symbol);
    symbols_left -= run;
  };
  if (last_symbol >= 0)
    append(
        draw_run(counts, symbols_left, 0, std::min(max_run - before.length, symbols_left), random));
  while (symbols_left > 0) {
    const int choices = last_symbol < 0 ? symbols : symbols - 1;
    const auto drawn = static_cast<int>(random.below(static_cast<std::uint64_t>(choices)));
    last_symbol = last_symbol >= 0 && drawn >= last_symbol ? drawn + 1 : drawn;
    append(draw_run(counts, symbols_left, 1, std::min(max_run, symbols_left), random));
  }
  return sequence;
}

PrecedingRun run_at_end(const std::vector<int>& order, PrecedingRun before) {
  for (const int symbol : order) {
    before.length = symbol == before.symbol ? before.length + 1 : 1;
    before.symbol = symbol;
  }
  return before;
}

std::vector<int> random_de_bruijn_cycle(int symbols, RandomStream& random) {
  const std::vector<int> last_exit = random_arborescence(symbols, random);
  std::vector<std::vector<int>> exits;
  for (int v = 0; v < symbols; ++v) {
    exits.push_back(ordered_exits(symbols, v == kRoot ? -1 : last_exit[v], random));
  }
  const std::size_t length = exits.size() * exits.size();
  std::vector<std::size_t> used(exits.size(), 0);
  std::vector<int> cycle;
  for (int v = kRoot; cycle.size() < length;) {
    cycle.push_back(v);
    v = exits[v][used[v]++];
  }
  const auto start = static_cast<std::ptrdiff_t>(random.below(length));
  std::rotate(cycle.begin(), cycle.begin() + start, cycle.end());
  return cycle;
}

int williams_rows(int symbols) {
  if (symbols < 1) throw std::invalid_argument("williams_rows: needs at least one symbol");
  return symbols % 2 == 1 ? 2 * symbols : symbols;
}

std::vector<int> williams_row(int symbols, int number) {
  if (symbols < 1) throw std::invalid_argument("williams_row: needs at least one symbol");
  if (number < 0) throw std::invalid_argument("williams_row: a row cannot be negative");
  const bool odd = symbols % 2 == 1;
  const int row = number % williams_rows(symbols);
  std::vector<int> order;
  for (int i = 0; i < symbols; ++i) {
    // In 0, 1, m-1, 2, m-2, .. all differences of neighbours are different modulo m.
    const int first_row = i % 2 == 1 ? (i + 1) / 2 : (symbols - i / 2) % symbols;
    order.push_back((first_row + row) % symbols);
  }
  // A single odd square is unbalanced; its mirror image has the missing pairs of neighbours.
  if (odd && row >= symbols) return {order.rbegin(), order.rend()};
  return order;
}

bool williams_order_exists(int symbols, int rows, int max_run) {
  return symbols > 2 || rows < 2 || max_run > 1;
}

std::vector<int> random_williams_order(int symbols, int rows, int max_run, PrecedingRun before,
                                       RandomStream& random) {
  const std::vector<int> permutation = shuffled_numbers(0, symbols, random);
  if (before.symbol >= 0) {
    before.symbol =
        static_cast<int>(std::ranges::find(permutation, before.symbol) - permutation.begin());
  }
  std::vector<int> order;
  std::vector<int> squares;
  for (int rows_left = rows; rows_left > 0; rows_left -= symbols) {
    if (squares.empty()) squares = shuffled_numbers(0, symbols % 2 == 0 ? 1 : 2, random);
    const int first = squares.back() * symbols;
    squares.pop_back();
    const std::vector<int> drawn =
        square_rows(symbols, first, std::min(rows_left, symbols), max_run, before, random);
    before = run_at_end(drawn, before);
    order.insert(order.end(), drawn.begin(), drawn.end());
  }
  for (int& symbol : order) symbol = permutation[static_cast<std::size_t>(symbol)];
  return order;
}

}  // namespace touchtrial::study
