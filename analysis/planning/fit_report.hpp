/// \file A fit in words and in JSON. Format: docs/data-dictionary.md, "Fit".
#pragma once

#include "analysis/planning/accuracy_fit.hpp"
#include "analysis/planning/subject_fit.hpp"

#include <cstdint>
#include <string>

namespace touchtrial::planning {

/// What a fit was made with.
struct FitOrigin {
  std::string study;
  std::string subject;     ///< file of the subject model that it started from
  bool simulated = false;  ///< whether the answers are simulated participants'
  bool pilot = false;
  bool interim = false;
  int explorations = 0;
  int directions = 0;
  std::uint64_t seed = 0;
};

[[nodiscard]] std::string fit_text(const SubjectFit& fit, const FitOrigin& origin);
[[nodiscard]] std::string fit_text(const AccuracyFit& fit, const FitOrigin& origin);

/// One JSON object, indented, ending with a line feed. What does not exist is null.
[[nodiscard]] std::string fit_json(const SubjectFit& fit, const FitOrigin& origin);
[[nodiscard]] std::string fit_json(const AccuracyFit& fit, const FitOrigin& origin);

}  // namespace touchtrial::planning
