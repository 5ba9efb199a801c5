/// \file Figures of every protocol's report.
#pragma once

#include "analysis/outcomes/study_head.hpp"
#include "analysis/report/figures/figure.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The participant flow from enrolment to analysis; nothing if nobody was lost. For papers: the
/// page shows it as text.
[[nodiscard]] std::optional<Figure> flow_figure(const StudyHead& report);
/// The servo's lateness; nothing for studies in virtual time.
/// \param section  Figure::section
[[nodiscard]] std::optional<Figure> servo_figure(const StudyHead& report,
                                                 const std::string& section);

/// Stamps figures and their text alternatives, in addition to SIMULATED.
/// \param stamp  empty: no change
void stamp_figures(const std::string& stamp, std::vector<Figure>& figures);

}  // namespace touchtrial::analysis
