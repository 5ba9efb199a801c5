/// \file The sections that every protocol's report has.
#pragma once

#include "analysis/page/document.hpp"
#include "analysis/page/study_document.hpp"

#include <optional>
#include <string>

namespace touchtrial::analysis {

[[nodiscard]] Section warnings_section(const std::vector<std::string>& warnings);

/// The flow of participants, the conditions, and deviations from the protocol. Contains nothing
/// about outcomes.
[[nodiscard]] Section participants_section(const Collection& collection);
/// What was registered before the study.
[[nodiscard]] Section registration_section(const design::Registration& registration);
/// The timing of the servo over the trials that ran in real time.
/// \return nothing if there is no such trial
[[nodiscard]] std::optional<Table> servo_table(const Collection& collection);

/// The part of the header about the state of the study and the evidence for the report.
[[nodiscard]] Definitions evidence_header(const Provenance& provenance);

}  // namespace touchtrial::analysis
