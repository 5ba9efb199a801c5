/// \file How each kind of procedure is made: what the list in procedure.cpp names.
#pragma once

#include "protocols/procedures/procedure.hpp"

#include <memory>

namespace touchtrial::procedures {

/// Every level equally often, in random order or in blocks of random order.
std::unique_ptr<Procedure> make_constant_stimuli(const TrackSettings& settings,
                                                 RandomStream& stream);

/// A transformed staircase (Levitt 1971).
std::unique_ptr<Procedure> make_up_down(const TrackSettings& settings, RandomStream& stream);

/// A weighted staircase (Kaernbach 1991): one answer moves it, further up than down.
std::unique_ptr<Procedure> make_weighted_up_down(const TrackSettings& settings,
                                                 RandomStream& stream);

/// The level with the least expected entropy of all parameters but the nuisance.
template <Nuisance nuisance>
std::unique_ptr<Procedure> make_least_entropy(const TrackSettings& settings, RandomStream& stream);

}  // namespace touchtrial::procedures
