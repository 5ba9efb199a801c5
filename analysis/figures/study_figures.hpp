/// \file The figures that every protocol's report has.
#pragma once

#include "analysis/figures/figure.hpp"
#include "analysis/study_head.hpp"

#include <optional>

namespace touchtrial::analysis {

/// Participants from enrolment to analysis.
[[nodiscard]] std::optional<Figure> flow_figure(const StudyHead& report);
/// The servo's lateness; nothing for studies in virtual time.
[[nodiscard]] std::optional<Figure> servo_figure(const StudyHead& report);

}  // namespace touchtrial::analysis
