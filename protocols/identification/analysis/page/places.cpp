#include "analysis/choices/people_report.hpp"
#include "analysis/report/page/wording.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

Table places_table(const choices::AnswersByPlace& places) {
  Table table{"answers-by-place", "Answers by the picture's place on the screen",
              columns_of({"place", "answers", "difference (points)", "t 95%", "p"})};
  for (std::size_t i = 0; i < places.places.size(); ++i) {
    const choices::PlaceUse& one = places.places[i];
    table.rows.push_back({std::to_string(i + 1), std::to_string(one.named),
                          points_figure(one.excess.mean.mean),
                          share_range(one.excess.mean.known_interval()), p_figure(one.excess.p)});
  }
  const bool alike = std::ranges::any_of(
      places.places, [](const choices::PlaceUse& one) { return one.excess.alike; });
  table.notes = {
      {fmt::format("Difference: mean over participants of the share of answers less {}, in "
                   "percentage points, with Student's t interval and p{}. All places together: {}, "
                   "of layouts dealt anew {} times, because every participant has the pictures in "
                   "an order of their own.",
                   share_figure(1.0 / static_cast<double>(places.places.size())),
                   alike ? " (by sign flips where all participants are alike)" : "",
                   p_phrase(places.p), places.deals),
       {Source::student, Source::phipson_smyth}}};
  return table;
}

Table own_preferences_table(const StudyReport& report) {
  const choices::Preferences& own = report.places->own;
  Table table = choices::preferences_table(own, report.classes, "picture");
  table.notes = {
      {fmt::format(
           "Of the wrong answers that take one of two textures for the other, which picture "
           "was named does not depend on the participant if nobody has preferences of their "
           "own: p, of names exchanged between participants {} times; by Holm: adjusted over "
           "participants. Whether the picture or its place is preferred cannot be told.",
           own.anybody.deals),
       {Source::holm, Source::phipson_smyth}}};
  return table;
}

std::string preferences_sentence(const StudyReport& report) {
  const choices::Preferences& own = report.places->own;
  const std::string who = choices::preference_words(own, report.classes);
  return fmt::format("Preferences of participants' own ({}, by people): {}.",
                     p_phrase(own.anybody.p), who.empty() ? "no sign" : who);
}

}  // namespace

Section places_section(const StudyReport& report) {
  Section section{"places", "Answers by place", {}};
  if (!report.places) return section;
  const bool found = report.places->own.anybody.found() || report.places->p <= kUsualLevel;
  std::vector<Block>& blocks = found ? section.blocks : section.more;
  blocks = {Cited{preferences_sentence(report)}, places_table(*report.places),
            own_preferences_table(report)};
  return section;
}

}  // namespace touchtrial::analysis::identification
