#include "protocols/procedures/procedure.hpp"

#include "protocols/procedures/kinds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace touchtrial::procedures {
namespace {

// QUEST+ without nuisance parameters equals the psi method of Kontsevich and Tyler.
constexpr std::array kKinds{
    ProcedureKind{"constant-stimuli", make_constant_stimuli},
    ProcedureKind{"up-down", make_up_down},
    ProcedureKind{"weighted-up-down", make_weighted_up_down},
    ProcedureKind{"quest-plus", make_min_entropy<Nuisance::none>},
    ProcedureKind{"psi", make_min_entropy<Nuisance::none>},
    ProcedureKind{"psi-marginal", make_min_entropy<Nuisance::lapse>},
    ProcedureKind{"psi-marginal-threshold", make_min_entropy<Nuisance::slope_and_lapse>},
};

}  // namespace

std::span<const ProcedureKind> procedure_kinds() {
  return kKinds;
}

std::unique_ptr<Procedure> make_procedure(const TrackSettings& settings, RandomStream& stream) {
  const std::vector<double>& levels = settings.levels;
  const bool is_finite =
      std::all_of(levels.begin(), levels.end(), [](double v) { return std::isfinite(v); });
  const bool is_ascending =
      std::adjacent_find(levels.begin(), levels.end(), std::greater_equal<>()) == levels.end();
  if (levels.empty() || !is_finite || !is_ascending) {
    throw std::invalid_argument("a track's levels must be an ascending list of numbers");
  }
  if (settings.trials < 1) throw std::invalid_argument("a track needs at least one trial");
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const ProcedureKind& listed) {
    return listed.name == settings.procedure;
  });
  if (kind == kKinds.end()) {
    throw std::invalid_argument("the procedure \"" + settings.procedure + "\" does not exist");
  }
  return kind->make(settings, stream);
}

}  // namespace touchtrial::procedures
