/// \file The registered analysis in words: noun phrases shared by the preregistration page, the
/// report's table of the registration, and its methods. Thread-safe.
#pragma once

#include "study/session_plan.hpp"

#include <string>
#include <utility>

namespace touchtrial::study {

/// "mean over participants of the share of right answers, against chance"
[[nodiscard]] std::string estimand_words(const RegisteredAnalysis& analysis);
/// "Student's t test over participants, one-sided"; "none: ..." for an estimate without a test.
[[nodiscard]] std::string test_words(const RegisteredAnalysis& analysis);
/// "at 6 participants; levels by ..."; "none" without looks.
[[nodiscard]] std::string looks_words(const RegisteredAnalysis& analysis);
/// Why sessions are excluded: "a session with a deviation ..."; "none, besides ..." without rules.
[[nodiscard]] std::string rules_words(const ExclusionRules& rules);
/// The margin, or the smallest effect of interest, with its name; the value is "not stated" if
/// there is neither.
[[nodiscard]] std::pair<std::string, std::string> size_field(const RegisteredAnalysis& analysis);

}  // namespace touchtrial::study
