#include "analysis/choices/people_report.hpp"
#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/measures.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

Table control_table(const GuessingTests& control) {
  std::vector<RightAnswers> rows = control.people;
  rows.push_back(control.pooled);
  return table_of("control-block", "Right answers with the hand off the device", rows,
                  right_measures(true));
}

struct HearersRow {
  const StandardReport* standard;
  const CensoredMean* without_hearers;
};

Table hearers_table(const ThresholdReport& report) {
  using Row = HearersRow;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < report.control->without_hearers.size(); ++i) {
    rows.push_back({&report.standards[i], &report.control->without_hearers[i]});
  }
  const auto threshold = [](const CensoredMean& mean, const Row& row) {
    return threshold_text(mean_threshold(mean), row.standard->levels);
  };
  return table_of(
      "thresholds-without-hearers",
      "Thresholds without those who could hear, means over participants", rows,
      {column_of<Row>("standard", [](const Row& row) { return row.standard->words; }),
       count_of<Row>("", "n", [](const Row& row) { return row.standard->mean.participants; }),
       column_of<Row>("all (dB)",
                      [=](const Row& row) { return threshold(row.standard->mean, row); }),
       count_of<Row>("", "n, without",
                     [](const Row& row) { return row.without_hearers->participants; }),
       column_of<Row>("without (dB)",
                      [=](const Row& row) { return threshold(*row.without_hearers, row); })
           .with_note(fmt::format("Excluded here: {}. The result includes them.",
                                  listed(report.control->hearers, " and ")))});
}

std::string detectable_words(const SoundReport& control) {
  const choices::DetectableAccuracy& detectable = control.detectable;
  const std::string people =
      counted(static_cast<std::int64_t>(control.people.size()), "participant");
  if (!detectable.share) {
    return fmt::format(" {} are too few to detect a hearing participant among {}.",
                       counted(detectable.trials, "trial"), people);
  }
  return fmt::format(
      " Among {}, a participant with {} right in {} would be detected with a probability of {}; "
      "weaker hearing may go undetected.",
      people, share_figure(detectable.share), counted(detectable.trials, "trial"),
      choices::kDetectionPower);
}

/// "; without them bark: −20.1 [−22.0, −18.2] dB (9 participants)"
std::string without_hearers_words(const ThresholdReport& report) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < report.control->without_hearers.size(); ++i) {
    const CensoredMean& mean = report.control->without_hearers[i];
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
      "In the control block the hand was off the moving device, so only its sound remained. "
      "Guessing gives {} right. A higher share means that participants could hear the difference, "
      "and thresholds may reflect hearing.",
      share_figure(report.guess));
}

std::string test_words(bool has_equal_values) {
  return std::string("p by Student's t over participants") +
         (has_equal_values ? ", by sign flips if all of them are equal." : ".");
}

Table choices_table(const ThresholdReport& report) {
  Table table = table_of("named-choices",
                         "Frequency of each answer, and how often it was right; trials of tracks",
                         report.choice_use, choice_measures());
  const bool has_equal_values = std::ranges::any_of(
      report.choice_use, [](const ChoiceUse& use) { return use.excess.all_equal; });
  table.notes = {
      {"Difference: mean over participants of the share given minus the share right, in "
       "percentage points; " +
           test_words(has_equal_values),
       {Source::student}}};
  return table;
}

std::string learning_sentence(const ThresholdReport& report) {
  const MeanEstimate& mean = report.learning_db.mean;
  if (!mean.mean) return "";
  std::string text = fmt::format(
      "Learning: the threshold changed by {} dB on average from the first to the last trial of a "
      "track",
      signed_plain_figure(mean.mean, 1));
  if (mean.known_interval()) {
    text += fmt::format(" {}, {} ({})", plain_range(mean.known_interval(), 1),
                        p_phrase(report.learning_db.p.value_or(1.0)),
                        counted(mean.participants, "participant"));
  }
  return text + ". A negative change is an improvement.";
}

}  // namespace

bool was_heard(const ThresholdReport& report) {
  return report.control && report.control->global_null.found();
}

std::string sound_sentence(const ThresholdReport& report) {
  if (!report.control) {
    return "There was no control block with the hand off the device, so it is unknown whether the "
           "textures could be heard.";
  }
  const SoundReport& control = *report.control;
  const RightAnswers& pooled = control.pooled;
  const std::string counts = fmt::format(
      "With the hand off the device {} of {} answers were right ({} {}; guessing gives {})",
      pooled.answers.correct, pooled.answers.n, share_figure(pooled.answers.share()),
      share_range(pooled.interval), share_figure(report.guess));
  const std::string p = p_phrase(control.global_null.p);
  if (!control.global_null.found()) {
    return fmt::format("{}: no evidence that any participant could hear it ({}).{}", counts, p,
                       detectable_words(control));
  }
  if (control.hearers.empty()) {
    return fmt::format(
        "{}: more than by guessing ({}), though no single participant stands out. Participants "
        "could hear something, and every threshold may reflect hearing.",
        counts, p);
  }
  return fmt::format(
      "{}. Some participants could hear it ({}): {}. Their thresholds may reflect hearing{}.",
      counts, p, hearers_words(control), without_hearers_words(report));
}

Section control_section(const ThresholdReport& report) {
  Section section{"control", "Sound and attention", {}};
  if (report.tracks.empty()) return section;
  if (!was_heard(report)) section.blocks.emplace_back(CitedText{sound_sentence(report)});
  if (report.control) {
    section.folded_blocks.emplace_back(CitedText{control_meaning(report)});
    section.folded_blocks.emplace_back(control_table(*report.control));
    if (!report.control->hearers.empty()) section.blocks.emplace_back(hearers_table(report));
  }
  return section;
}

Section habits_section(const ThresholdReport& report) {
  Section section{"habits", "Response bias and learning", {}};
  if (report.tracks.empty()) return section;
  const auto add = [&](Block block) { section.folded_blocks.emplace_back(std::move(block)); };
  const std::string learning = learning_sentence(report);
  if (!learning.empty()) add(CitedText{learning});
  add(choices_table(report));
  if (!report.preferences.people.empty()) {
    add(CitedText{choices::preferences_sentence(report.preferences, report.choices)});
  }
  return section;
}

}  // namespace touchtrial::analysis::threshold
