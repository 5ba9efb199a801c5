/// \file The sections that every protocol's report has.
#pragma once

#include "analysis/page/document.hpp"
#include "analysis/page/study_document.hpp"

#include <optional>
#include <string>

namespace touchtrial::analysis {

[[nodiscard]] Section warnings_section(const std::vector<std::string>& warnings);

/// How participants came, and what of the protocol was not kept: tells nothing of outcomes.
[[nodiscard]] Section participants_section(const Collection& collection);
/// What was deposited beforehand.
[[nodiscard]] Section registration_section(const design::Registration& registration);
/// How the servo kept its time, over trials in real time. \return without blocks if there is none
[[nodiscard]] std::optional<Table> servo_table(const Collection& collection);

/// What the header says of study and evidence.
[[nodiscard]] Definitions evidence_header(const Provenance& provenance);

}  // namespace touchtrial::analysis
