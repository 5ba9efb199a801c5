/// \file Reads and checks the section "threshold" of the study file. Private to
/// protocols/threshold/study.
#pragma once

#include "core/strict_json.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <string>

namespace touchtrial::study::threshold {

/// Reads the section.
/// \throws StudyError with the place of an invalid value
[[nodiscard]] ThresholdOptions read_section(const JsonValue& section);

/// The section's schema in the format of annotated_section().
[[nodiscard]] std::string section_schema();

/// Checks the section against the rest of the study: classes, methods, trials, limits.
/// \throws StudyError with the place and the remedy
void check_section(const JsonValue& file, const Study& study);

/// The section with every key, as compact JSON. Equal options give equal text.
[[nodiscard]] std::string section_json(const ThresholdOptions& options);

}  // namespace touchtrial::study::threshold
