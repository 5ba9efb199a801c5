/// \file Random orders of symbols, each equally likely among those that keep a rule: runs that are
/// limited, every transition equally often (de Bruijn), rows of a Williams design. Orders with
/// limited runs are counted exactly with whole numbers of any size, never found by trial and error.
#pragma once

#include "core/random.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::design {

/// The symbol before an order begins, and how often it came in a row.
struct RunBefore {
  int symbol = -1;  ///< negative: nothing came before
  int length = 0;   ///< at most the limit of runs
};

/// The run at the end of an order that follows `before`.
[[nodiscard]] RunBefore run_at_end(const std::vector<int>& order, RunBefore before);

/// Whether `counts[s]` copies of each symbol s can be ordered without a run longer than `max_run`.
/// Each symbol needs a place between other symbols (or at an end) for every `max_run` of its
/// copies. \param max_run  at least 1
[[nodiscard]] bool limited_order_exists(const std::vector<int>& counts, int max_run,
                                        RunBefore before = {});

/// Whether counting and drawing take less than about a second and 100 MB. The number of states is
/// the number of multisets of remaining copies, since symbols with equally many copies left are
/// interchangeable; each state looks at every possible next run.
[[nodiscard]] bool limited_orders_are_countable(const std::vector<int>& counts, int max_run);

/// The number of such orders, in decimal digits.
[[nodiscard]] std::string count_limited_orders(const std::vector<int>& counts, int max_run,
                                               RunBefore before = {});

/// Draws one of these orders, each equally likely.
/// \return nothing if there is none
[[nodiscard]] std::optional<std::vector<int>> draw_limited_order(const std::vector<int>& counts,
                                                                 int max_run, RunBefore before,
                                                                 RandomStream& random);

/// Draws a sequence of any symbols, each equally likely among those that keep the limit.
/// \param symbols  at least 2, so that there is such a sequence
/// \param length  not negative
[[nodiscard]] std::vector<int> draw_limited_sequence(int symbols, int length, int max_run,
                                                     RunBefore before, RandomStream& random);

/// Draws a de Bruijn cycle of order 2, each equally likely, starting at a random place: k * k
/// symbols in which every ordered pair (equal symbols too) occurs once as neighbours, the last and
/// the first symbol included. These cycles are the Eulerian circuits of the complete digraph with
/// loops. By the BEST theorem a uniform circuit follows from a uniform spanning arborescence
/// (Wilson 1996) as last exits and any order of the other exits.
/// \param symbols  k, at least 1
[[nodiscard]] std::vector<int> random_de_bruijn_cycle(int symbols, RandomStream& random);

/// One row of a Williams design: carry-over is balanced over all rows.
/// \param symbols  at least 1
/// \param row  not negative; taken modulo williams_rows
/// \return each symbol once. For an odd number of symbols, rows from `symbols` on mirror the others
[[nodiscard]] std::vector<int> williams_row(int symbols, int row);

/// The number of different rows. \param symbols  at least 1
[[nodiscard]] int williams_rows(int symbols);

/// Whether `rows` rows can follow each other without a run longer than `max_run`. Only two symbols
/// cannot, under a limit of 1: their two rows mirror each other.
/// \param max_run  at least 1
[[nodiscard]] bool williams_order_exists(int symbols, int rows, int max_run);

/// Draws rows of Williams squares, one after the other, with random names for the symbols. A
/// square's rows come in random order, each once before any repeats; an odd number of symbols has
/// two squares, which alternate, the first at random. Uniform over all such orders that keep the
/// limit of runs: where two rows break it, the square's rows are drawn anew (more than a fifth of
/// all orders fit). How many orders of later squares fit does not depend on the symbol before them,
/// because a square's rows are translations of each other.
/// \param symbols  at least 2
/// \param max_run  0: no limit
/// \pre williams_order_exists
[[nodiscard]] std::vector<int> random_williams_order(int symbols, int rows, int max_run,
                                                     RunBefore before, RandomStream& random);

}  // namespace touchtrial::design
