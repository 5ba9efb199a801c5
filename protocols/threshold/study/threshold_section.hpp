/// \file The study file's "threshold". Private to protocols/threshold/study.
#pragma once

#include "core/strict_json.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <string>

namespace touchtrial::study::threshold {

/// \throws StudyError with the place of a value that is not accepted
[[nodiscard]] ThresholdOptions read_section(const JsonValue& section);

/// \return as annotated_section() makes it
[[nodiscard]] std::string section_schema();

/// What the reader sees only with the whole study: classes, methods, trials, ceilings.
/// \throws StudyError with the place and the remedy
void check_section(const JsonValue& file, const Study& study);

/// The section with every key, as compact JSON. Equal options give equal text.
[[nodiscard]] std::string section_json(const ThresholdOptions& options);

}  // namespace touchtrial::study::threshold
