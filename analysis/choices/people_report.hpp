/// \file Text and JSON of the global null test and of preferences for a choice, for studies whose
/// answers are right or wrong.
#pragma once

#include "analysis/choices/preferences.hpp"

#include <string>
#include <vector>

namespace touchtrial::choices {

/// "3 of 12 participants have an individual p of 0.05 or less, where chance gives 0.4 at most on
/// average"
[[nodiscard]] std::string individual_p_words(const GlobalNullResult& global_null);

/// Who prefers which choice, and how accuracy depends on the right choice; empty if nobody prefers
/// one.
/// \param labels  of the choices
[[nodiscard]] std::string preference_words(const Preferences& preferences,
                                           const std::vector<std::string>& labels);

/// The preferences as a sentence for the page, even if nobody prefers a choice.
[[nodiscard]] std::string preferences_sentence(const Preferences& preferences,
                                               const std::vector<std::string>& labels);

/// JSON objects.
[[nodiscard]] std::string global_null_json(const GlobalNullResult& global_null);
[[nodiscard]] std::string preferences_json(const Preferences& preferences,
                                           const std::vector<std::string>& labels);

}  // namespace touchtrial::choices
