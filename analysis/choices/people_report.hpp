/// \file Text and JSON of tests over people, for studies whose answers are right or wrong: the
/// global null test, and who prefers a choice.
#pragma once

#include "analysis/choices/preferences.hpp"

#include <string>
#include <vector>

namespace touchtrial::choices {

/// "3 of 12 participants have an own p of 0.05 or less, where chance gives 0.4 at most on average"
[[nodiscard]] std::string alone_words(const GlobalNullResult& anybody);

/// Who prefers which choice, and how accuracy depends on where the right choice is; empty if nobody
/// was found.
/// \param labels  of the choices
[[nodiscard]] std::string preference_words(const Preferences& preferences,
                                           const std::vector<std::string>& labels);

/// The same as a sentence of the page, whether or not somebody was found.
[[nodiscard]] std::string preferences_sentence(const Preferences& preferences,
                                               const std::vector<std::string>& labels);

/// One JSON object each.
[[nodiscard]] std::string global_null_json(const GlobalNullResult& anybody);
[[nodiscard]] std::string preferences_json(const Preferences& preferences,
                                           const std::vector<std::string>& labels);

}  // namespace touchtrial::choices
