/// \file Orders in which every transition occurs equally often. Private to protocols/design.
#pragma once

#include "core/random.hpp"

#include <vector>

namespace touchtrial::design {

/// A de Bruijn cycle of order 2, each equally likely, from a uniformly random place: k*k symbols in
/// which every ordered pair of symbols (equal ones too) occurs once as neighbours, last to first
/// included. Such cycles are the Eulerian circuits of the complete digraph with loops; by the BEST
/// theorem a uniform one comes from a uniform spanning arborescence (Wilson 1996) as last exits and
/// any order of the other exits.
/// \param symbols  k >= 1
[[nodiscard]] std::vector<int> random_de_bruijn_cycle(int symbols, RandomStream& random);

}  // namespace touchtrial::design
