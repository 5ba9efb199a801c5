/// \file Constructors of the procedures that procedure.cpp lists.
#pragma once

#include "protocols/procedures/procedure.hpp"

#include <memory>

namespace touchtrial::procedures {

/// Presents every level equally often, in random order or in blocks of random order.
std::unique_ptr<Procedure> make_constant_stimuli(const TrackSettings& settings,
                                                 RandomStream& stream);

/// A transformed staircase (Levitt 1971).
std::unique_ptr<Procedure> make_up_down(const TrackSettings& settings, RandomStream& stream);

/// A weighted staircase (Kaernbach 1991): every answer moves it, with larger steps up than down.
std::unique_ptr<Procedure> make_weighted_up_down(const TrackSettings& settings,
                                                 RandomStream& stream);

/// Presents the level with the minimum expected entropy of all parameters except the nuisance.
template <Nuisance nuisance>
std::unique_ptr<Procedure> make_min_entropy(const TrackSettings& settings, RandomStream& stream);

}  // namespace touchtrial::procedures
