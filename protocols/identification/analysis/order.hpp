/// \file Whether answers depend on when a presentation came or on what came before it, tested over
/// the orders that the design could have produced.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/statistics/order_effects.hpp"

#include <optional>

namespace touchtrial::analysis::identification {

/// Of one method's counted trials, each moved within its block. The presentation before a trial may
/// be a lead-in, of another method, or not counted; those stay where they were. With 1,999 draws,
/// fewer (at least 99) in large studies.
///
/// \return nothing if no trial counts
[[nodiscard]] std::optional<OrderEffects> order_of(const Outcomes& outcomes, int method);

}  // namespace touchtrial::analysis::identification
