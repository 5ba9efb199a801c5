/// \file The sections of a report, one function each. Private to analysis/page.
#pragma once

#include "analysis/page/document.hpp"
#include "analysis/page/study_document.hpp"

#include <optional>
#include <string>

namespace touchtrial::analysis {

/// What a reader takes for significant: wording alone depends on it.
inline constexpr double kUsualLevel = 0.05;

[[nodiscard]] Section headline_section(const StudyReport& report);
[[nodiscard]] Section warnings_section(const StudyReport& report);
[[nodiscard]] Section accuracy_section(const StudyReport& report);
[[nodiscard]] Section confusions_section(const StudyReport& report);
/// Of two methods or more. \return without blocks if there is one
[[nodiscard]] Section comparison_section(const StudyReport& report);
[[nodiscard]] Section order_section(const StudyReport& report);
[[nodiscard]] Section times_section(const StudyReport& report);
[[nodiscard]] Section cues_section(const StudyReport& report);
/// Servo and validity, with results with and without.
[[nodiscard]] Section robustness_section(const StudyReport& report);
[[nodiscard]] Section methods_section(const StudyReport& report);

/// How participants came, and what of the protocol was not kept: tells nothing of outcomes.
[[nodiscard]] Section participants_section(const Collection& collection);
/// What was deposited beforehand.
[[nodiscard]] Section registration_section(const design::Registration& registration);
/// How the servo kept its time, over trials in real time. \return without blocks if there is none
[[nodiscard]] std::optional<Table> servo_table(const Collection& collection);

/// What the header says of study and evidence.
[[nodiscard]] Definitions evidence_header(const Provenance& provenance);

/// Ids of a method's tables end in this: unique in the report.
[[nodiscard]] std::string method_slug(const StudyReport& report, std::size_t method);
/// Puts a subheading where there are several methods; \param section  its id begins the heading's
void add_method_heading(const StudyReport& report, std::size_t method, Section& section);
/// "adaptive: " where there are several methods, else nothing: before captions.
[[nodiscard]] std::string method_prefix(const StudyReport& report, std::size_t method);

}  // namespace touchtrial::analysis
