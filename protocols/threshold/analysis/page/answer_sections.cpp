#include "analysis/choices/people_report.hpp"
#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

Table control_table(const AgainstGuessing& control) {
  Table table{"control-block", "Right answers with the hand off the device",
              columns_of({"participant", "n", "right", "share", "p", "p by Holm"})};
  const auto add = [&](const std::string& name, const RightAnswers& one) {
    table.rows.push_back({name, std::to_string(one.answers.n), std::to_string(one.answers.correct),
                          share_figure(one.answers.share()), p_figure(one.p),
                          p_figure(one.p_holm)});
  };
  for (const RightAnswers& one : control.people) add(one.participant, one);
  add("all, pooled", control.pooled);
  table.notes = {
      {"p: exact binomial probability of as many right answers or more by guessing; by Holm: "
       "adjusted over participants. Targets are drawn trial by trial, so under guessing trials are "
       "independent, whoever answers.",
       {Source::holm}}};
  return table;
}

Table without_table(const ThresholdReport& report) {
  Table table{"thresholds-without-hearers",
              "Thresholds without those who could hear, means over participants",
              columns_of({"standard", "n", "all (dB)", "n, without", "without (dB)"})};
  for (std::size_t i = 0; i < report.control->without.size(); ++i) {
    const StandardReport& one = report.standards[i];
    const CensoredMean& without = report.control->without[i];
    table.rows.push_back({one.words, std::to_string(one.mean.participants),
                          threshold_text(mean_threshold(one.mean), one.levels),
                          std::to_string(without.participants),
                          threshold_text(mean_threshold(without), one.levels)});
  }
  table.notes = {{fmt::format("Left out: {}. The result keeps them.",
                              listed(report.control->hearers, " and "))}};
  return table;
}

/// What the control block could have found.
std::string detectable_words(const SoundReport& control) {
  const choices::Detectable& one = control.detectable;
  const std::string people =
      counted(static_cast<std::int64_t>(control.people.size()), "participant");
  if (!one.share) {
    return fmt::format(" {} are too few to find anybody among {}.", counted(one.trials, "trial"),
                       people);
  }
  return fmt::format(
      " Among {}, somebody who is right in {} of {} is found with a probability of {}; who hears "
      "less may pass.",
      people, share_figure(one.share), counted(one.trials, "trial"), choices::kFoundWith);
}

/// "; without them bark: −20.1 [−22.0, −18.2] dB (9 participants)"
std::string without_words(const ThresholdReport& report) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < report.control->without.size(); ++i) {
    const CensoredMean& mean = report.control->without[i];
    if (!mean.mean) continue;
    const StandardReport& standard = report.standards[i];
    all.push_back(fmt::format("{}: {} dB ({})", standard.words,
                              threshold_text(mean_threshold(mean), standard.levels),
                              counted(mean.participants, "participant")));
  }
  return all.empty() ? "" : "; without them " + listed(all, " and ");
}

std::string control_meaning(const ThresholdReport& report) {
  return fmt::format(
      "In the control block the hand was off the device, which moved by itself: only its sound was "
      "left. Guessing gives {} right. More than that means that people could hear which plane it "
      "was, and thresholds may be of the ear.",
      share_figure(report.guess));
}

/// By which test a p over participants is.
std::string test_words(bool alike) {
  return std::string("p by Student's t over participants") +
         (alike ? ", by sign flips where all of them are alike." : ".");
}

Table choices_table(const ThresholdReport& report) {
  Table table{"named-choices",
              "How often each answer was given, and how often it was right; trials of tracks",
              columns_of({"answer", "given", "right answer", "difference (points)", "t 95%", "p"})};
  bool alike = false;
  for (const ChoiceUse& one : report.choice_use) {
    alike = alike || one.excess.alike;
    const std::optional<Interval> interval = one.excess.mean.known_interval();
    table.rows.push_back({one.choice, std::to_string(one.named), std::to_string(one.targets),
                          points_figure(one.excess.mean.mean), share_range(interval),
                          p_figure(one.excess.p)});
  }
  table.notes = {
      {"Difference: mean over participants of the share given less the share right, in "
       "percentage points; " +
           test_words(alike),
       {Source::student}}};
  return table;
}

Table own_preferences_table(const ThresholdReport& report) {
  Table table = choices::preferences_table(report.preferences, report.choices, "answer");
  table.notes = {
      {fmt::format(
           "Without a preference somebody is right as often wherever the right answer is. p: right "
           "answers keep their places and targets are drawn anew, {} times; by Holm: adjusted over "
           "participants.",
           report.preferences.anybody.deals),
       {Source::holm, Source::phipson_smyth}}};
  return table;
}

std::string preferences_sentence(const ThresholdReport& report) {
  const choices::Anybody& anybody = report.preferences.anybody;
  const std::string who = choices::preference_words(report.preferences, report.choices);
  if (who.empty()) {
    return fmt::format("Preferences of participants' own: no sign ({}, by people).",
                       p_phrase(anybody.p));
  }
  return fmt::format("Preferences of participants' own ({}, by people): {}.", p_phrase(anybody.p),
                     who);
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
       "nothing; " +
           test_words(report.after_right.excess.alike || report.after_wrong.excess.alike),
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

}  // namespace

bool was_heard(const ThresholdReport& report) {
  return report.control && report.control->anybody.found();
}

std::string sound_sentence(const ThresholdReport& report) {
  if (!report.control) {
    return "There was no control block with the hand off the device: whether the textures could be "
           "heard is not known.";
  }
  const SoundReport& control = *report.control;
  const RightAnswers& pooled = control.pooled;
  const std::string counts = fmt::format(
      "With the hand off the device {} of {} answers were right ({} {}; guessing gives {})",
      pooled.answers.correct, pooled.answers.n, share_figure(pooled.answers.share()),
      share_range(pooled.interval), share_figure(report.guess));
  const std::string p = p_phrase(control.anybody.p);
  if (!control.anybody.found()) {
    return fmt::format("{}: by people no sign that anybody could hear it ({}).{}", counts, p,
                       detectable_words(control));
  }
  if (control.hearers.empty()) {
    return fmt::format(
        "{}: more than by guessing ({}, by people), though nobody stands out. Participants could "
        "hear something, and every threshold may be of the ear.",
        counts, p);
  }
  return fmt::format(
      "{}. Somebody could hear it ({}, by people): {}. Their thresholds may be of the ear{}.",
      counts, p, hearers_words(control), without_words(report));
}

Section control_section(const ThresholdReport& report) {
  Section section{"control", "Sound alone, and attention", {}};
  if (report.tracks.empty()) return section;
  // What could be heard stands in the result.
  if (!was_heard(report)) section.blocks.emplace_back(Cited{sound_sentence(report)});
  if (report.control) {
    section.more.emplace_back(Cited{control_meaning(report)});
    section.more.emplace_back(control_table(*report.control));
    if (!report.control->hearers.empty()) section.blocks.emplace_back(without_table(report));
  }
  return section;
}

Section habits_section(const ThresholdReport& report) {
  Section section{"habits", "Habits and learning", {}};
  if (report.tracks.empty()) return section;
  const auto add = [&](Block block) { section.more.emplace_back(std::move(block)); };
  const std::string learning = learning_sentence(report);
  if (!learning.empty()) add(Cited{learning});
  add(choices_table(report));
  if (!report.preferences.people.empty()) {
    add(Cited{preferences_sentence(report)});
    add(own_preferences_table(report));
  }
  add(repetitions_table(report));
  return section;
}

}  // namespace touchtrial::analysis::threshold
