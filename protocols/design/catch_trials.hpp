/// \file Presentations of a plane without texture among the others. Private to protocols/design.
#pragma once

#include "core/random.hpp"
#include "protocols/design/schedule.hpp"

#include <vector>

namespace touchtrial::design {

/// Spreads catch trials among presentations: every choice of places is equally likely, but for the
/// first place of all. A catch trial belongs to the block of the presentation before it. Trial
/// numbers are left as they are. \pre there is a presentation if `count` > 0
[[nodiscard]] std::vector<Presentation> with_catch_trials(const std::vector<Presentation>& shown,
                                                          int count, RandomStream& random);

}  // namespace touchtrial::design
