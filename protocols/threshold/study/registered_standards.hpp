/// \file The standards that a registered question about thresholds is of.
#pragma once

#include "core/strict_json.hpp"
#include "study/study.hpp"

#include <cstddef>
#include <vector>

namespace touchtrial::study::threshold {

/// Checks that the registered standards are of the study, and as many as the question needs: one of
/// a mean, two of a difference, two or more of an equality.
/// \param file  the whole study file
/// \throws StudyError with the place and the remedy
void check_registered(const JsonValue& file, const Study& study);

/// Indices into standards_of: those that are named, in this order, else all.
/// \pre the study registers a question about thresholds, and was checked
[[nodiscard]] std::vector<std::size_t> registered_standards(const Study& study);

}  // namespace touchtrial::study::threshold
