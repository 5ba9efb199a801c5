/// \file The figures that every protocol's report has.
#pragma once

#include "analysis/outcomes/study_head.hpp"
#include "analysis/report/figures/figure.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Participants from enrolment to analysis; nothing if nobody was lost on the way. For papers: a
/// page shows this as text.
[[nodiscard]] std::optional<Figure> flow_figure(const StudyHead& report);
/// The servo's lateness; nothing for studies in virtual time.
/// \param section  Figure::section
[[nodiscard]] std::optional<Figure> servo_figure(const StudyHead& report,
                                                 const std::string& section);

/// Stamps figures and their text alternatives besides SIMULATED.
/// \param stamp  empty: leaves the figures as they are
void stamp_figures(const std::string& stamp, std::vector<Figure>& figures);

}  // namespace touchtrial::analysis
