#include "analysis/page/wording.hpp"
#include "analysis/text_figures.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

std::vector<Cell> time_row(const std::string& name, const ReactionTimes& times) {
  return {name,
          std::to_string(times.from_plane_on.n),
          plain_figure(times.from_plane_on.lower, 2),
          plain_figure(times.from_plane_on.median, 2),
          plain_figure(times.from_plane_on.upper, 2),
          plain_figure(times.from_contact.lower, 2),
          plain_figure(times.from_contact.median, 2),
          plain_figure(times.from_contact.upper, 2)};
}

Table times_table(const StudyReport& report, std::size_t index) {
  Table table{"reaction-times-" + method_slug(report, index),
              method_prefix(report, index) +
                  "reaction times in seconds by the texture presented: quartiles and medians",
              {{"texture", Align::left},
               {"n"},
               {"plane on, 25%"},
               {"plane on, median"},
               {"plane on, 75%"},
               {"contact, 25%"},
               {"contact, median"},
               {"contact, 75%"}}};
  const std::vector<ReactionTimes>& times = report.methods[index].reaction;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool all = i >= report.classes.size();
    table.rows.push_back(time_row(all ? "all" : report.classes[i], times[i]));
  }
  table.notes = {
      {"Trials with a response, right or wrong. From the moment the plane can be felt, "
       "and from first contact, to the answer; one monotonic clock, the servo's. "
       "Quantiles by interpolation (definition 7).",
       {Source::hyndman_fan}}};
  if (const int paused = times.empty() ? 0 : times.back().paused; paused > 0) {
    table.notes.push_back({fmt::format("{} waited for the end of a pause and {} left out.",
                                       counted(paused, "response"), paused == 1 ? "is" : "are")});
  }
  return table;
}

}  // namespace

Section times_section(const StudyReport& report) {
  Section section{"reaction-times", "Reaction times", {}};
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (report.methods[i].reaction.empty()) continue;
    section.blocks.emplace_back(times_table(report, i));
  }
  return section;
}

}  // namespace touchtrial::analysis::identification
