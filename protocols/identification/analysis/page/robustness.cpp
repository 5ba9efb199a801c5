#include "analysis/report/page/frame_sections.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/named.hpp"
#include "protocols/identification/analysis/page/sections.hpp"

#include <array>
#include <cstddef>

namespace touchtrial::analysis::identification {
namespace {

const char* words_of(TrialSubset subset) {
  using enum TrialSubset;
  static constexpr auto kNames = std::to_array<Named<TrialSubset>>(
      {{"as counted (a missing response is wrong)", counted},
       {"trials without a response left out", answered},
       {"trials that break the validity rule left out", valid},
       {"excluded participants' sessions put back", with_excluded_sessions}});
  return name_in(kNames, subset).data();
}

Table robustness_table(const StudyReport& report, std::size_t index) {
  Table table{"with-and-without-" + method_slug(report, index),
              method_prefix(report, index) + "the mean accuracy with other choices of trials",
              {{"trials", Align::left},
               {"n"},
               {"right"},
               {"pooled"},
               {"participants"},
               {"mean"},
               {"t 95% (%)"}}};
  for (const SubsetAccuracy& one : report.methods[index].robustness) {
    table.rows.push_back({words_of(one.subset), std::to_string(one.pooled.n),
                          std::to_string(one.pooled.correct), share_figure(one.pooled.share()),
                          std::to_string(one.mean.participants), share_figure(one.mean.mean),
                          one.mean.participants > 1 ? share_range(one.mean.interval) : kNoFigure});
  }
  table.notes = {
      {"Mean over participants with Student's t interval. If a row's conclusion differs "
       "from the first's, say so beside the result.",
       {Source::student}}};
  return table;
}

}  // namespace

Section robustness_section(const StudyReport& report) {
  Section section{"servo-and-validity", "Servo and validity", {}};
  if (const auto servo = servo_table(report.collection)) {
    section.blocks.emplace_back(*servo);
  } else {
    section.blocks.emplace_back(
        Cited{"There is no table and no figure of the servo: no trial ran in real time. In "
              "virtual time every tick is on time by construction, and says nothing about a "
              "device.",
              {}});
  }
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (report.methods[i].robustness.empty()) continue;
    section.blocks.emplace_back(robustness_table(report, i));
  }
  return section;
}

Section methods_section(const StudyReport& /*report*/) {
  Section section{"methods", "How these numbers were computed", {}, true};
  section.blocks.emplace_back(Cited{
      "Every number is computed by the program named above from the database named above; "
      "results.json, beside this page, holds the same numbers with all their digits. A note under "
      "each table says what its numbers are and where the method comes from. Intervals hold 95% "
      "nominally. Resampling draws from a random stream of fixed seed, so that the same database "
      "gives the same numbers on every machine.",
      {}});
  section.blocks.emplace_back(Definitions{
      {{"unit of analysis",
        "The participant. Trials pooled over participants are shown for information; intervals "
        "and tests that treat them as independent are marked."},
       {"missing responses",
        "Wrong in every accuracy; left out of information transfer and of the choice model. The "
        "tables with and without them show what depends on this."},
       {"right or wrong",
        "An answer is right if its picture belongs to the class that was presented, whatever the "
        "exemplar."},
       {"blinding",
        "What was presented was sealed before trial 1 and opened by a recorded event; touchtrial "
        "verify DB checks every event, the seal and the schedules against each other, and the "
        "head of the file's chain named above shows whether this report is of the same file."}}});
  return section;
}

}  // namespace touchtrial::analysis::identification
