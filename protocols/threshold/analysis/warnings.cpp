#include "analysis/choices/people_report.hpp"
#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using study::threshold::LevelQuantity;

using WarningTexts = std::vector<std::string>;

void warn_of_sound(const ThresholdReport& report, WarningTexts& all) {
  if (!report.control) {
    all.emplace_back(
        "There was no control block with the hand off the device, so it is unknown whether "
        "participants could hear what they should feel.");
    return;
  }
  if (!report.control->global_null.found()) return;
  const std::string hearers = hearers_words(*report.control);
  if (hearers.empty()) {
    all.push_back(fmt::format(
        "With the hand off the device participants together did better than guessing ({}): they "
        "could hear something, and every threshold may reflect hearing.",
        p_phrase(report.control->global_null.p)));
    return;
  }
  all.push_back(
      fmt::format("With the hand off the device {}. They could hear something, and their "
                  "thresholds may reflect hearing. The result includes them; a table has the means "
                  "without them.",
                  hearers));
}

void warn_of_censored(const ThresholdReport& report, WarningTexts& all) {
  for (const StandardReport& standard : report.standards) {
    const int known_count = standard.number_of(procedures::Censored::no);
    if (known_count == std::ssize(standard.people)) continue;
    const std::string text =
        fmt::format("{}: of {}, {} {} a threshold within the levels", standard.words,
                    counted(std::ssize(standard.people), "participant"), known_count,
                    known_count == 1 ? "has" : "have");
    if (standard.mean.lack == MissingReason::most) {
      all.push_back(text +
                    ", fewer than half, so there is no mean. Present a wider range of "
                    "levels, or a texture that is easier to feel.");
    } else if (standard.mean.mean) {
      const std::string undetermined = undetermined_words(standard);
      all.push_back(text + ". " + (undetermined.empty() ? "" : undetermined + ". ") +
                    "Thresholds beyond the levels are censored; the mean assumes a normal "
                    "distribution of thresholds in dB.");
    }
  }
}

void warn_of_attention(const ThresholdReport& report, WarningTexts& all) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < report.attention.size(); ++i) {
    if (!report.attention[i].is_doubtful()) continue;
    const RightAnswers& person = report.catches->people[i];
    names.push_back(
        fmt::format("{} ({} of {})", person.participant, person.answers.correct, person.answers.n));
  }
  if (names.empty()) return;
  all.push_back(
      fmt::format("Too few right answers in catch trials, which are at the highest level ({} or "
                  "more are expected; Holm over participants), by {}: inattention, "
                  "misunderstanding, or levels that are too low.",
                  share_figure(choices::kMinCatchAccuracy), listed(names, " and ")));
}

void warn_of_fit(const ThresholdReport& report, WarningTexts& all) {
  int tracks = 0;
  int rejected = 0;
  for (const TrackReport& track : report.tracks) {
    if (!track.fit) continue;
    ++tracks;
    rejected += track.fit->p <= kUsualLevel ? 1 : 0;
  }
  if (tracks == 0 || rejected * 10 <= tracks) return;
  all.push_back(
      fmt::format("The fit of {} of {} is rejected at the 5% level; 5% are expected by chance. The "
                  "function or the independence of trials may not hold.",
                  rejected, counted(tracks, "track")));
}

void warn_of_habits(const ThresholdReport& report, WarningTexts& all) {
  const GroupTest& learning = report.learning_db;
  if (learning.p && *learning.p <= kUsualLevel) {
    all.push_back(fmt::format(
        "Participants became {} during their tracks ({}), so one threshold does not "
        "describe a track.",
        learning.mean.mean.value_or(0.0) < 0.0 ? "better" : "worse", p_phrase(*learning.p)));
  }
  const std::string preferred = choices::preference_words(report.preferences, report.choices);
  if (preferred.empty()) return;
  std::string text = fmt::format("{} ({}, global test over participants).", preferred,
                                 p_phrase(report.preferences.global_null.p));
  if (!report.preferences.people_with_preference().empty()) {
    text +=
        " Answers that follow a preference are right only by chance, so the thresholds of these "
        "people may be too high: by 0.4 dB if, at the threshold, these shares are 94% and 70%, by "
        "1.4 dB if they are 99% and 64%.";
  }
  all.push_back(std::move(text));
}

void warn_of_design(const ThresholdReport& report, WarningTexts& all) {
  const auto& options = report.options();
  if (study::threshold::missing_catch_trials(report.design) > 0) {
    all.emplace_back(
        "Fewer than six trials, or a tenth, of a track were certain to be at its highest level, "
        "where only lapses cause errors. Lapses then raise the estimated thresholds.");
  }
  if (options.along == LevelQuantity::order && options.rove_db == 0.0) {
    all.emplace_back(
        "Orders also differ in strength, and gains were not roved: participants may have compared "
        "strengths.");
  }
}

}  // namespace

std::vector<std::string> threshold_warnings(const ThresholdReport& report) {
  WarningTexts all;
  if (report.tracks.empty()) return all;
  warn_of_sound(report, all);
  warn_of_censored(report, all);
  warn_of_attention(report, all);
  warn_of_fit(report, all);
  warn_of_habits(report, all);
  warn_of_design(report, all);
  return all;
}

}  // namespace touchtrial::analysis::threshold
