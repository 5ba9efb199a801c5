/// \file Sections of every protocol's report.
#pragma once

#include "analysis/report/page/document.hpp"
#include "analysis/report/page/study_document.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

[[nodiscard]] std::vector<Section> quality_sections(const QualityReport& report);

/// Adds the answer to the registered question, and the estimate for every choice of sessions and
/// trials (folded if all agree). Adds nothing if the study has no question.
void add_verdict(const StudyHead& head, Section& section);
/// Adds to every table and sentence with a p that it is not adjusted for unregistered looks.
void add_unadjusted_notes(const std::vector<Look>& looks, std::vector<Section>& sections);

/// The flow of participants, dates and conditions, and deviations from the protocol; nothing about
/// outcomes.
/// \param head  of an unblinded study: adds numbers of people, demographics in bands, and looks at
///   outcomes; null: omits them
[[nodiscard]] Section participants_section(const Collection& collection,
                                           const StudyHead* head = nullptr);
/// Answers to closing questions: counts of options, quartiles of numbers, and texts.
/// \return a section without blocks if there are no answers
[[nodiscard]] Section questionnaire_section(const StudyHead& head);
[[nodiscard]] std::vector<Block> registration_blocks(const study::Registration& registration);
/// "touch (12 sessions), ideal device (3 sessions)", by model; may be empty
[[nodiscard]] std::string device_summary(const Collection& collection);
/// Servo timing over real-time trials.
/// \return nothing if there are none
[[nodiscard]] std::optional<Table> servo_table(const Collection& collection);

}  // namespace touchtrial::analysis
