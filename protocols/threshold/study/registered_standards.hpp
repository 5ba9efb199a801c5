/// \file The standards of a registered question about thresholds.
#pragma once

#include "core/strict_json.hpp"
#include "study/study.hpp"

#include <cstddef>
#include <vector>

namespace touchtrial::study::threshold {

/// Checks that the study has the registered standards, and the number that the question needs: one
/// for a mean, two for a difference, two or more for an equality.
/// \param file  the whole study file
/// \throws StudyError with the place and the remedy
void check_registered(const JsonValue& file, const Study& study);

/// Indices into standards_of() of the registered standards, in the order of registration; all
/// standards if none is named.
/// \pre the study registers a question about thresholds and passed check_registered
[[nodiscard]] std::vector<std::size_t> registered_standards(const Study& study);

}  // namespace touchtrial::study::threshold
