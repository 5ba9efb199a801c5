/// \file Statements by people, for the page and the JSON of every study whose answers are right or
/// wrong: whether anybody does something, and who prefers a choice.
#pragma once

#include "analysis/choices/preferences.hpp"
#include "analysis/report/page/document.hpp"

#include <string>
#include <vector>

namespace touchtrial::choices {

/// "3 of 12 participants have an own p of 0.05 or less, where chance gives 0.4 at most on average"
[[nodiscard]] std::string alone_words(const Anybody& anybody);

/// Who prefers what, and how that changes with where the right choice is; empty if nobody was
/// found.
/// \param labels  of the choices
[[nodiscard]] std::string preference_words(const Preferences& preferences,
                                           const std::vector<std::string>& labels);

/// One row a participant, in the order of `preferences`; without notes.
/// \param noun  what is preferred: "answer", "picture"
[[nodiscard]] analysis::Table preferences_table(const Preferences& preferences,
                                                const std::vector<std::string>& labels,
                                                const std::string& noun);

/// One JSON object each.
[[nodiscard]] std::string anybody_json(const Anybody& anybody);
[[nodiscard]] std::string preferences_json(const Preferences& preferences,
                                           const std::vector<std::string>& labels);

}  // namespace touchtrial::choices
