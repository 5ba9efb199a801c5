/// \file The page of identification and its sections. Private to protocols/identification.
#pragma once

#include "analysis/page/document.hpp"
#include "analysis/page/study_document.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <cstddef>
#include <string>

namespace touchtrial::analysis::identification {

/// What a reader takes for significant: wording alone depends on it.
inline constexpr double kUsualLevel = 0.05;

[[nodiscard]] Section headline_section(const StudyReport& report);
[[nodiscard]] Section accuracy_section(const StudyReport& report);
[[nodiscard]] Section confusions_section(const StudyReport& report);
/// Of two methods or more.
/// \return a section without blocks if there is one method
[[nodiscard]] Section comparison_section(const StudyReport& report);
[[nodiscard]] Section order_section(const StudyReport& report);
[[nodiscard]] Section times_section(const StudyReport& report);
[[nodiscard]] Section cues_section(const StudyReport& report);
/// Servo and validity, with results with and without.
[[nodiscard]] Section robustness_section(const StudyReport& report);
[[nodiscard]] Section methods_section(const StudyReport& report);

/// The end of the ids of a method's tables: unique in the report.
[[nodiscard]] std::string method_slug(const StudyReport& report, std::size_t method);
/// Puts a subheading where there are several methods.
/// \param section  its id begins the heading's
void add_method_heading(const StudyReport& report, std::size_t method, Section& section);
/// "adaptive: " where there are several methods, else nothing: before captions.
[[nodiscard]] std::string method_prefix(const StudyReport& report, std::size_t method);

/// The report after unblinding.
/// \param pictures  in the order in which they are to stand
[[nodiscard]] Document study_document(const StudyReport& report, const Provenance& provenance,
                                      const Pictures& pictures = {});

}  // namespace touchtrial::analysis::identification
