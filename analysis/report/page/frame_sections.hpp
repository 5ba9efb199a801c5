/// \file The sections that every protocol's report has.
#pragma once

#include "analysis/report/page/document.hpp"
#include "analysis/report/page/study_document.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// How data collection proceeds.
[[nodiscard]] std::vector<Section> quality_sections(const QualityReport& report);

/// Adds the answer to the registered question, and the estimate under every choice of sessions and
/// trials, which is folded if no choice changes it. Nothing if the study has no question.
void add_verdict(const StudyHead& head, Section& section);
/// Adds to every table and every sentence with a p that it is not adjusted for unregistered looks.
void note_unadjusted(const std::vector<Look>& looks, std::vector<Section>& sections);

/// The flow of participants, dates and conditions, and deviations from the protocol; nothing about
/// outcomes.
/// \param head  of a study that is unblinded: adds the numbers of people, what they told about
/// themselves in bands, and looks at outcomes; null: none of these
[[nodiscard]] Section participants_section(const Collection& collection,
                                           const StudyHead* head = nullptr);
/// Answers to closing questions: counts of options, quartiles of numbers, and texts.
/// \return without blocks if nobody answered any
[[nodiscard]] Section questionnaire_section(const StudyHead& head);
/// What was registered before the study.
[[nodiscard]] std::vector<Block> registration_blocks(const study::Registration& registration);
/// "touch (12 sessions), ideal device (3 sessions)", by model; empty for none.
[[nodiscard]] std::string device_summary(const Collection& collection);
/// The timing of the servo over the trials that ran in real time.
/// \return nothing if there is no such trial
[[nodiscard]] std::optional<Table> servo_table(const Collection& collection);

}  // namespace touchtrial::analysis
