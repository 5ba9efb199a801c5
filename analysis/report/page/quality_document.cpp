#include "analysis/report/page/frame_sections.hpp"
#include "analysis/report/page/study_document.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/statistics/confusion.hpp"
#include "core/text.hpp"
#include "study/deviation_codes.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

Table sessions_table(const SessionCounts& counts) {
  Table table{
      "session-counts", "Sessions, each counted once", {{"state", Align::left}, {"sessions"}}};
  const auto add = [&](const char* name, int n) {
    table.rows.push_back({name, std::to_string(n)});
  };
  add("completed", counts.completed);
  add("open", counts.open);
  add("stopped", counts.stopped);
  add("excluded", counts.excluded);
  add("replaced", counts.replaced);
  add("withdrawn, data erased", counts.erased);
  table.notes = {
      {"A session that is withdrawn, replaced or excluded is counted only there, in this order."}};
  return table;
}

Table trials_table(const TrialQuality& quality) {
  Table table{"trial-counts", "Trials", {{"trials", Align::left}, {"number"}, {"share"}}};
  const auto add = [&](const char* name, int n, int total) {
    const auto share = percentage(n, total);
    table.rows.push_back(
        {name, std::to_string(n), share ? plain_figure(share, 1) + "%" : kNoFigure});
  };
  add("presented", quality.presented, quality.presented);
  add("answered", quality.answered, quality.presented);
  add("answered after a pause, without a reaction time", quality.paused, quality.answered);
  add("no response: time ran out", quality.no_response, quality.presented);
  add("interrupted presentations, repeated or not", quality.interrupted, 0);
  add("interrupted, and not repeated yet", quality.not_repeated, quality.presented);
  add("with a trace", quality.with_trace, quality.presented);
  add("valid by the public part of the study's rule", quality.valid, quality.with_trace);
  add("with late servo ticks", quality.with_overruns, quality.with_trace);
  table.notes = {
      {"Shares of presented trials; for pauses, of answered trials; for validity and late ticks, "
       "of trials with a trace."}};
  return table;
}

Table answers_table(const Collection& collection) {
  Table table{"answers-by-session",
              "Answers in the sessions that have ended",
              {{"session", Align::left}, {"answers"}, {"one key"}}};
  for (const SessionRecord& session : collection.sessions) {
    if (!session.answers) continue;
    table.rows.push_back({std::to_string(session.row.session), std::to_string(*session.answers),
                          session.one_key ? "yes" : ""});
  }
  table.notes = {
      {"One key: at least 95% of 20 or more answers came from one key, although the right answers "
       "are spread over all keys. Nobody who can distinguish some of the textures answers like "
       "this. Not evaluated for trials with several planes. All other properties of answers are "
       "outcomes, and stay blind."}};
  return table;
}

Table hands_table(const Collection& collection) {
  Table table{
      "hands-by-session",
      "Trials in which the hand was outside a window",
      {{"session", Align::left}, {"with a trace"}, {"contact"}, {"path"}, {"force"}, {"speed"}}};
  for (const SessionRecord& session : collection.sessions) {
    const HandCounts& outside = session.outside;
    if (outside.trials == 0) continue;
    table.rows.push_back({std::to_string(session.row.session), std::to_string(outside.trials),
                          std::to_string(outside.contact), std::to_string(outside.path),
                          std::to_string(outside.force), std::to_string(outside.speed)});
  }
  const study::ValidityRule& rule = collection.prescription.validity;
  table.notes = {{fmt::format(
      "Contact: less than {} s at the plane, at most 3 mm above it. Path: less than {} mm along "
      "it. Force: mean below {} N or above {} N. Speed: mean below {} or above {} mm/s. These "
      "numbers show who did not press or move, but not what was presented.",
      rule.min_contact_s, rule.min_path_mm, rule.min_median_n, rule.max_median_n,
      study::kMinStrokeMmS, study::kMaxStrokeMmS)}};
  return table;
}

Section servo_section(const QualityReport& report) {
  Section section{"servo", "Servo", {}};
  if (auto servo = servo_table(report.collection)) {
    section.blocks.emplace_back(std::move(*servo));
  } else {
    section.blocks.emplace_back(
        CitedText{"No trial ran in real time, so servo timing is unknown.", {}});
  }
  if (report.servo) {
    section.blocks.emplace_back(CitedText{
        "Scheduling of servo threads: " + listed(report.servo->scheduling, " and ") + ".", {}});
  }
  return section;
}

}  // namespace

std::vector<Section> quality_sections(const QualityReport& report) {
  std::vector<Section> sections = {
      {"counts",
       "Sessions and trials",
       {sessions_table(report.sessions), trials_table(report.quality)}},
      participants_section(report.collection),
      {"answers", "Answers by session", {answers_table(report.collection)}},
      {"hands", "Hands by session", {hands_table(report.collection)}},
      servo_section(report)};
  if (!report.notes.empty()) {
    sections.push_back({"to-bear-in-mind", "What to bear in mind", {Warnings{report.notes}}});
  }
  return sections;
}

}  // namespace touchtrial::analysis
