#include "analysis/choices/people_report.hpp"
#include "analysis/report/page/wording.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

Table places_table(const choices::AnswersByPlace& places) {
  Table table = table_of("answers-by-place", "Answers by the picture's place on the screen",
                         places.places, place_measures(places));
  const bool has_equal_values = std::ranges::any_of(
      places.places, [](const choices::PlaceUse& place) { return place.excess.all_equal; });
  table.notes = {
      {fmt::format("Difference: mean over participants of the share of answers minus {}, in "
                   "percentage points, with Student's t interval and p{}. All places together: {}, "
                   "by {} permutations of layouts, because every participant has a different order "
                   "of pictures.",
                   share_figure(1.0 / static_cast<double>(places.places.size())),
                   has_equal_values ? " (by sign flips if all participants are equal)" : "",
                   p_phrase(places.p), places.deals),
       {Source::student, Source::phipson_smyth}}};
  return table;
}

}  // namespace

Section places_section(const StudyReport& report) {
  Section section{"places", "Answers by place", {}};
  if (!report.places) return section;
  const bool has_preferences =
      report.places->preferences.global_null.found() || report.places->p <= kUsualLevel;
  std::vector<Block>& blocks = has_preferences ? section.blocks : section.folded_blocks;
  blocks = {CitedText{choices::preferences_sentence(report.places->preferences, report.classes)},
            places_table(*report.places)};
  return section;
}

}  // namespace touchtrial::analysis::identification
