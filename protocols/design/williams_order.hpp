/// \file Trials as permutations that are rows of a Williams design. Private to protocols/design.
#pragma once

#include "core/random.hpp"
#include "protocols/design/limited_orders.hpp"

#include <vector>

namespace touchtrial::design {

/// Whether `rows` of them can follow each other without a symbol coming more than `max_run` times
/// in a row. Only two symbols cannot, with a limit of 1: their two rows are each other's mirror
/// image. \param max_run  >= 1
[[nodiscard]] bool williams_order_exists(int symbols, int rows, int max_run);

/// Permutations of the symbols, one after the other. Rows of a square are taken in a random order,
/// each once, before any comes again; an odd number of symbols has two squares, taken in turn, the
/// first at random. Which symbol is which is random. Uniform over all such orders that keep the
/// limit: where one is broken between two permutations, the square's rows are drawn anew; how many
/// orders of the later squares fit does not depend on the symbol before them, as a square's rows
/// are each other's translations. More than every fifth order fits.
/// \param symbols  >= 2  \param max_run  0: no limit  \pre williams_order_exists
[[nodiscard]] std::vector<int> random_williams_order(int symbols, int rows, int max_run,
                                                     RunBefore before, RandomStream& random);

}  // namespace touchtrial::design
