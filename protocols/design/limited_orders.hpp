/// \file Orders in which no symbol comes more than so often in a row, each equally likely. Counted
/// exactly with whole numbers of any size; never by trial and error. Private to protocols/design.
#pragma once

#include "core/random.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::design {

/// What came before an order begins, and how often in a row.
struct RunBefore {
  int symbol = -1;  ///< negative: nothing came before
  int length = 0;   ///< <= the limit
};

/// Whether `counts[s]` copies of each symbol s can be put into such an order at all: each symbol
/// needs a place between others (or at an end) for every `max_run` of its copies.
/// \param max_run  >= 1
[[nodiscard]] bool limited_order_exists(const std::vector<int>& counts, int max_run,
                                        RunBefore before = {});

/// Whether counting and drawing are done within a second or so and some 100 MB: the number of
/// states is the number of multisets of what is left, as symbols of which as much is left are
/// alike, and each state looks at every next run.
[[nodiscard]] bool limited_orders_are_countable(const std::vector<int>& counts, int max_run);

/// How many such orders there are, in decimal digits.
[[nodiscard]] std::string count_limited_orders(const std::vector<int>& counts, int max_run,
                                               RunBefore before = {});

/// One of them, uniformly. \return nothing if there is none
[[nodiscard]] std::optional<std::vector<int>> draw_limited_order(const std::vector<int>& counts,
                                                                 int max_run, RunBefore before,
                                                                 RandomStream& random);

/// A sequence of any symbols, uniformly from all that keep the limit.
/// \param symbols  >= 2, so that there is one  \param length  >= 0
[[nodiscard]] std::vector<int> draw_limited_sequence(int symbols, int length, int max_run,
                                                     RunBefore before, RandomStream& random);

/// The run at the end of what came before and an order after it.
[[nodiscard]] RunBefore run_at_end(const std::vector<int>& order, RunBefore before);

}  // namespace touchtrial::design
