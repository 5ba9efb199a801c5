#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

Table outside_table(const std::string& id, const std::string& caption,
                    const AgainstGuessing& outside) {
  Table table{id, caption,
              columns_of({"participant", "n", "right", "share", "Clopper-Pearson 95% (%)", "p",
                          "p by Holm"})};
  const auto add = [&](const std::string& name, const RightAnswers& one) {
    table.rows.push_back({name, std::to_string(one.answers.n), std::to_string(one.answers.correct),
                          share_figure(one.answers.share()), share_range(one.interval),
                          p_figure(one.p), p_figure(one.p_holm)});
  };
  for (const RightAnswers& one : outside.people) add(one.participant, one);
  add("all, pooled", outside.pooled);
  table.notes = {
      {"p: exact binomial probability of as many right answers or more by guessing; by "
       "Holm: adjusted over participants. Targets are drawn trial by trial, so under "
       "guessing trials are independent, whoever answers.",
       {Source::clopper_pearson, Source::holm}}};
  return table;
}

std::string control_meaning(const ThresholdReport& report) {
  return fmt::format(
      "In the control block the hand was off the device, which moved by itself: only its sound was "
      "left. Guessing gives {} right. More than that means that people could hear which plane it "
      "was, and thresholds may be of the ear.",
      share_figure(report.guess));
}

Table choices_table(const ThresholdReport& report) {
  Table table{"named-choices",
              "How often each answer was given, and how often it was right; trials of tracks",
              columns_of({"answer", "given", "right answer", "difference (points)", "t 95%", "p"})};
  for (const ChoiceUse& one : report.choice_use) {
    const std::optional<Interval> interval = one.excess.mean.known_interval();
    table.rows.push_back({one.choice, std::to_string(one.named), std::to_string(one.targets),
                          points_figure(one.excess.mean.mean), share_range(interval),
                          p_figure(one.excess.p)});
  }
  table.notes = {
      {"Difference: mean over participants of the share given less the share right, in "
       "percentage points; p by Student's t.",
       {Source::student}}};
  return table;
}

std::vector<Cell> repetition_row(const std::string& name, const Repetition& one) {
  return {name,
          std::to_string(one.repeats.n),
          share_figure(one.repeats.share()),
          share_figure(one.expected),
          points_figure(one.excess.mean.mean),
          share_range(one.excess.mean.known_interval()),
          p_figure(one.excess.p)};
}

Table repetitions_table(const ThresholdReport& report) {
  Table table{
      "repeated-answers", "How often an answer repeated the one before it",
      columns_of({"after", "n", "repeated", "in any order", "difference (points)", "t 95%", "p"})};
  table.rows.push_back(repetition_row("a right answer", report.after_right));
  table.rows.push_back(repetition_row("a wrong answer", report.after_wrong));
  table.notes = {
      {"In any order: what participants' own shares of answers give if answers do not "
       "depend on the one before. Targets are drawn trial by trial and depend on "
       "nothing; p by Student's t over participants.",
       {Source::student}}};
  return table;
}

std::string learning_sentence(const ThresholdReport& report) {
  const MeanEstimate& mean = report.learning_db.mean;
  if (!mean.mean) return "";
  std::string text = fmt::format(
      "Learning: from the first to the last trial of a track the threshold changed by {} dB on "
      "average",
      signed_plain_figure(mean.mean, 1));
  if (mean.known_interval()) {
    text += fmt::format(" {}, {} ({})", plain_range(mean.known_interval(), 1),
                        p_phrase(report.learning_db.p.value_or(1.0)),
                        counted(mean.participants, "participant"));
  }
  return text + ". Below 0 participants became better.";
}

std::string cell_of(const Proportion& of) {
  return fmt::format("{} of {}", of.correct, of.n);
}

Table same_different_table(const ThresholdReport& report, const std::string& id,
                           const std::string& caption, bool pooled) {
  Table table{id, caption,
              columns_of({"participant", "standard", "level (dB)", "hits", "false alarms",
                          "at all levels", "d' differencing", "d' independent"},
                         {"standard"})};
  for (const SameDifferentLevel& one : report.same_different) {
    if (one.participant.empty() != pooled) continue;
    table.rows.push_back({pooled ? "all, pooled" : one.participant,
                          report.standards[one.standard].words, plain_figure(one.level, 1),
                          cell_of(one.different), cell_of(one.same), cell_of(one.same_at_all),
                          plain_figure(one.d_differencing, 2), plain_figure(one.d_independent, 2)});
  }
  return table;
}

Table group_d_prime_table(const ThresholdReport& report) {
  Table table{"d-prime-by-level",
              "d' of same or different: means over participants with t intervals",
              columns_of({"standard", "level (dB)", "n", "d' differencing", "t 95%",
                          "d' independent", "t 95%"})};
  for (const SameDifferentGroup& one : report.same_different_groups) {
    table.rows.push_back(
        {report.standards[one.standard].words, plain_figure(one.level, 1),
         std::to_string(one.differencing.participants), plain_figure(one.differencing.mean, 2),
         plain_range(one.differencing.known_interval(), 2), plain_figure(one.independent.mean, 2),
         plain_range(one.independent.known_interval(), 2)});
  }
  table.notes = {
      {"Differencing: the observer compares how far the two impressions are apart; to quote where "
       "levels are mixed or gains roved. Independent: each impression is judged by itself, which "
       "needs two fixed stimuli; its d' is smaller (Macmillan and Creelman 2005, chapter 9). Hits "
       "are those of the level, false alarms those of all levels of the standard. Half an answer "
       "stands for none and is taken from all. With fewer hits than false alarms a participant's "
       "own d' is 0, which is most likely, and enters these means as minus the d' of the exchanged "
       "shares, so that guessing gives 0 on average."}};
  return table;
}

}  // namespace

Section same_different_section(const ThresholdReport& report) {
  Section section{"same-or-different", "Same or different", {}};
  if (report.same_different.empty()) return section;
  section.blocks.emplace_back(group_d_prime_table(report));
  section.blocks.emplace_back(same_different_table(
      report, "same-different-pooled", "Answers \"different\", all participants pooled", true));
  section.blocks.emplace_back(same_different_table(report, "same-different-participants",
                                                   "Answers \"different\" by participant", false));
  return section;
}

Section control_section(const ThresholdReport& report) {
  Section section{"control", "Sound alone, and attention", {}};
  if (report.control) {
    section.blocks.emplace_back(Cited{control_meaning(report)});
    section.blocks.emplace_back(outside_table(
        "control-block", "Right answers with the hand off the device", *report.control));
  }
  if (report.catches) {
    section.blocks.emplace_back(outside_table(
        "catch-trials", "Right answers in catch trials, which are at the highest level",
        *report.catches));
  }
  return section;
}

Section habits_section(const ThresholdReport& report) {
  Section section{"habits", "Habits and learning", {}};
  if (report.tracks.empty()) return section;
  const std::string learning = learning_sentence(report);
  if (!learning.empty()) section.blocks.emplace_back(Cited{learning});
  section.blocks.emplace_back(choices_table(report));
  section.blocks.emplace_back(repetitions_table(report));
  return section;
}

}  // namespace touchtrial::analysis::threshold
