#include "analysis/page/frame_sections.hpp"
#include "analysis/page/study_document.hpp"
#include "analysis/page/wording.hpp"
#include "analysis/statistics/confusion.hpp"
#include "analysis/text_figures.hpp"
#include "core/text.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

Table sessions_table(const SessionCounts& counts) {
  Table table{"session-counts",
              "Sessions, each counted once",
              {{"how they stand", Align::left}, {"sessions"}}};
  const auto add = [&](const char* name, int n) {
    table.rows.push_back({name, std::to_string(n)});
  };
  add("completed", counts.completed);
  add("open", counts.open);
  add("stopped", counts.stopped);
  add("excluded", counts.excluded);
  add("replaced", counts.replaced);
  add("withdrawn", counts.withdrawn);
  table.notes = {{"Withdrawn before replaced before excluded before a session's own state."}};
  return table;
}

Table trials_table(const TrialQuality& quality) {
  Table table{"trial-counts", "Trials", {{"what", Align::left}, {"trials"}, {"share"}}};
  const auto add = [&](const char* name, int n, int of) {
    const auto share = percentage(n, of);
    table.rows.push_back(
        {name, std::to_string(n), share ? plain_figure(share, 1) + "%" : kNoFigure});
  };
  add("presented", quality.presented, quality.presented);
  add("answered", quality.answered, quality.presented);
  add("answer changed before it was given", quality.changed, quality.answered);
  add("no response: time ran out", quality.no_response, quality.presented);
  add("interrupted, and not repeated yet", quality.interrupted, quality.presented);
  add("with a trace", quality.with_trace, quality.presented);
  add("valid by the study's rule, as far as it is in clear", quality.valid, quality.with_trace);
  add("with servo ticks that came late", quality.with_overruns, quality.with_trace);
  table.notes = {
      {"Shares: of presented trials; of changed answers, of answers; of validity and "
       "late ticks, of trials with a trace."}};
  return table;
}

Table positions_table(const TrialQuality& quality) {
  Table table{"answers-by-position",
              "Answers by the picture's place in the layout",
              {{"place", Align::left}, {"answers"}, {"share"}}};
  for (std::size_t i = 0; i < quality.by_position.size(); ++i) {
    const auto share = percentage(quality.by_position[i], quality.answered);
    table.rows.push_back({std::to_string(i + 1), std::to_string(quality.by_position[i]),
                          share ? plain_figure(share, 1) + "%" : kNoFigure});
  }
  table.notes = {
      {"Layouts differ between participants, so a place does not stand for a texture: unequal "
       "shares here show a bias of hand or habit."}};
  return table;
}

std::vector<std::string> banners_of(const QualityReport& report) {
  std::vector<std::string> banners;
  if (report.simulated) {
    banners.emplace_back("SIMULATED: this study's participants are simulated.");
  }
  if (report.pilot) banners.emplace_back("PILOT: not to be pooled with the study's data.");
  if (!report.state.unblinded) {
    banners.emplace_back(
        "BLIND: outcomes are shown once the study has been unblinded. Nothing here reveals them.");
  }
  if (report.visual) {
    banners.emplace_back("Seen on a screen, not felt: never to be pooled with what was felt.");
  }
  return banners;
}

Section servo_section(const QualityReport& report, const Collection& collection) {
  Section section{"servo", "Servo", {}};
  if (auto servo = servo_table(collection)) {
    section.blocks.emplace_back(std::move(*servo));
  } else {
    section.blocks.emplace_back(
        Cited{"No trial was in real time: nothing is known about a servo's lateness.", {}});
  }
  if (report.servo) {
    section.blocks.emplace_back(Cited{"Scheduling that servo threads obtained: " +
                                          listed(report.servo->scheduling, " and ") + ".",
                                      {}});
  }
  return section;
}

}  // namespace

Document quality_document(const QualityReport& report, const Collection& collection,
                          const Provenance& provenance) {
  Document document;
  document.title = "Quality of the study " + report.study;
  document.stamp = report.simulated ? "SIMULATED" : "";
  if (report.pilot) document.stamp += document.stamp.empty() ? "PILOT" : ", PILOT";
  document.banners = banners_of(report);
  document.header = evidence_header(provenance);
  document.header.entries.insert(document.header.entries.begin(),
                                 {{"protocol", report.protocol},
                                  {"participants", std::to_string(report.participants)},
                                  {"trials", std::to_string(report.trials)}});
  document.sections = {{"counts",
                        "Sessions and trials",
                        {sessions_table(report.sessions), trials_table(report.quality)}},
                       participants_section(collection),
                       {"answers", "Answers by place", {positions_table(report.quality)}},
                       servo_section(report, collection)};
  document.colophon = fmt::format("{}touchtrial {}, {}, event {} of the file's chain",
                                  simulated_line(report.simulated), provenance.program_version,
                                  provenance.database, provenance.head.length);
  return document;
}

}  // namespace touchtrial::analysis
