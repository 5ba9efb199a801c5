/// \file Random orders of symbols under a constraint: limited runs, every transition equally often
/// (de Bruijn), or rows of a Williams design. All orders that satisfy the constraint are equally
/// likely. Orders with limited runs are drawn by exact counting with big integers, not by
/// rejection.
#pragma once

#include "core/random.hpp"

#include <optional>
#include <vector>

namespace touchtrial::study {

/// The run that precedes an order.
struct PrecedingRun {
  int symbol = -1;  ///< negative: no symbol precedes
  int length = 0;   ///< at most the limit on runs
};

/// The run at the end of an order that comes after `before`.
[[nodiscard]] PrecedingRun run_at_end(const std::vector<int>& order, PrecedingRun before);

/// Whether `counts[s]` copies of each symbol s can be ordered without a run longer than `max_run`.
/// Every `max_run` copies of a symbol need a place between other symbols or at an end.
/// \param max_run  at least 1
[[nodiscard]] bool limited_order_exists(const std::vector<int>& counts, int max_run,
                                        PrecedingRun before = {});

/// Whether counting and drawing take less than about a second and 100 MB. The number of states is
/// the number of multisets of remaining copies, because symbols with the same number of copies left
/// are interchangeable. Each state visits every possible next run.
[[nodiscard]] bool limited_orders_are_countable(const std::vector<int>& counts, int max_run);

/// Draws an order without a run longer than `max_run`; all such orders are equally likely.
/// \return the order, or nothing if none exists
[[nodiscard]] std::optional<std::vector<int>> draw_limited_order(const std::vector<int>& counts,
                                                                 int max_run, PrecedingRun before,
                                                                 RandomStream& random);

/// Draws a sequence of symbols; all sequences without a run longer than `max_run` are equally
/// likely.
/// \param symbols  at least 2, so that such a sequence exists
/// \param length  not negative
[[nodiscard]] std::vector<int> draw_limited_sequence(int symbols, int length, int max_run,
                                                     PrecedingRun before, RandomStream& random);

/// Draws a de Bruijn cycle of order 2 that starts at a random place; all cycles are equally likely.
/// A cycle has k * k symbols, in which every ordered pair (also of equal symbols) occurs once as
/// neighbours; the last and the first symbol are neighbours too. These cycles are the Eulerian
/// circuits of the complete digraph with loops. By the BEST theorem, a uniform spanning
/// arborescence (Wilson 1996) as the last exits and a uniform order of the other exits give a
/// uniform circuit.
/// \param symbols  k, at least 1
[[nodiscard]] std::vector<int> random_de_bruijn_cycle(int symbols, RandomStream& random);

/// One row of a Williams design, in which carry-over is balanced over all rows.
/// \param symbols  at least 1
/// \param row  not negative; taken modulo williams_rows
/// \return each symbol once. With an odd number of symbols, rows from `symbols` on are the mirror
///   images of the others
/// \throws std::invalid_argument if `symbols` or `row` is out of range
[[nodiscard]] std::vector<int> williams_row(int symbols, int row);

/// The number of different rows of a Williams design.
/// \param symbols  at least 1
/// \throws std::invalid_argument if `symbols` is less than 1
[[nodiscard]] int williams_rows(int symbols);

/// Whether `rows` rows can follow each other without a run longer than `max_run`. Only two symbols
/// with a limit of 1 cannot, because their two rows mirror each other.
/// \param max_run  at least 1
[[nodiscard]] bool williams_order_exists(int symbols, int rows, int max_run);

/// Draws rows of Williams squares, one square after the other, and permutes the symbols at random.
/// The rows of a square come in random order, each once before any repeats. An odd number of
/// symbols has two squares, which alternate; a random one comes first.
///
/// All such orders that respect the limit on runs are equally likely. If two rows break the limit,
/// the square's rows are redrawn; more than a fifth of all orders respect it. The number of valid
/// orders of later squares does not depend on the preceding symbol, because a square's rows are
/// translations of each other.
/// \param symbols  at least 2
/// \param max_run  0: no limit
/// \pre williams_order_exists(symbols, rows, max_run) if max_run > 0
[[nodiscard]] std::vector<int> random_williams_order(int symbols, int rows, int max_run,
                                                     PrecedingRun before, RandomStream& random);

}  // namespace touchtrial::study
