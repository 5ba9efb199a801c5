#include "analysis/choices/people_report.hpp"
#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using study::threshold::Along;

using Warnings = std::vector<std::string>;

void warn_of_sound(const ThresholdReport& report, Warnings& all) {
  if (!report.control) {
    all.emplace_back(
        "There was no control block with the hand off the device, so it is unknown whether "
        "participants could hear what they should feel.");
    return;
  }
  if (!report.control->anybody.found()) return;
  const std::string who = hearers_words(*report.control);
  if (who.empty()) {
    all.push_back(fmt::format(
        "With the hand off the device participants together did better than guessing ({}): they "
        "could hear something, and every threshold may reflect hearing.",
        p_phrase(report.control->anybody.p)));
    return;
  }
  all.push_back(
      fmt::format("With the hand off the device {}. They could hear something, and their "
                  "thresholds may reflect "
                  "hearing. The result includes them; a table has the means without them.",
                  who));
}

void warn_of_censored(const ThresholdReport& report, Warnings& all) {
  for (const StandardReport& one : report.standards) {
    const int inside = one.number_of(procedures::Censored::no);
    if (inside == std::ssize(one.people)) continue;
    const std::string known = fmt::format("{}: of {} {} {} a threshold inside the levels",
                                          one.words, counted(std::ssize(one.people), "participant"),
                                          inside, inside == 1 ? "has" : "have");
    if (one.mean.lack == Lack::most) {
      all.push_back(known +
                    ", fewer than half, so there is no mean. Present a wider range of "
                    "levels, or a texture that is easier to feel.");
    } else if (one.mean.mean) {
      const std::string taken = taken_words(one);
      all.push_back(known + ". " + (taken.empty() ? "" : taken + ". ") +
                    "The mean counts those beyond the levels by their side, and assumes that all "
                    "thresholds together are normally distributed in dB.");
    }
  }
}

void warn_of_attention(const ThresholdReport& report, Warnings& all) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < report.attention.size(); ++i) {
    if (!report.attention[i].is_doubtful()) continue;
    const RightAnswers& one = report.catches->people[i];
    names.push_back(
        fmt::format("{} ({} of {})", one.participant, one.answers.correct, one.answers.n));
  }
  if (names.empty()) return;
  all.push_back(
      fmt::format("Too few right answers in catch trials, which are at the highest level ({} or "
                  "more are expected; Holm over participants), by {}: inattention, "
                  "misunderstanding, or levels that are too low.",
                  share_figure(choices::kAttentive), listed(names, " and ")));
}

void warn_of_fit(const ThresholdReport& report, Warnings& all) {
  int tracks = 0;
  int rejected = 0;
  for (const TrackReport& track : report.tracks) {
    if (!track.fit) continue;
    ++tracks;
    rejected += track.fit->p <= kUsualLevel ? 1 : 0;
  }
  if (tracks == 0 || rejected * 10 <= tracks) return;
  all.push_back(
      fmt::format("The fit of {} of {} is rejected at the 5% level; 5% would be by chance. The "
                  "function or the independence of trials may not hold.",
                  rejected, counted(tracks, "track")));
}

void warn_of_habits(const ThresholdReport& report, Warnings& all) {
  const GroupTest& learning = report.learning_db;
  if (learning.p && *learning.p <= kUsualLevel) {
    all.push_back(fmt::format(
        "Participants became {} during their tracks ({}), so one threshold does not "
        "describe a track.",
        learning.mean.mean.value_or(0.0) < 0.0 ? "better" : "worse", p_phrase(*learning.p)));
  }
  const std::string who = choices::preference_words(report.preferences, report.choices);
  if (who.empty()) return;
  std::string text =
      fmt::format("{} ({}, by people).", who, p_phrase(report.preferences.anybody.p));
  if (!report.preferences.of_those_who_prefer().empty()) {
    text +=
        " Answers that follow a preference are right only by chance, so the thresholds of "
        "people who have one may be too high: by 0.4 dB if, at the threshold, those shares are "
        "94 % and 70 %, by 1.4 dB if they are 99 % and 64 %.";
  }
  all.push_back(std::move(text));
}

void warn_of_design(const ThresholdReport& report, Warnings& all) {
  const auto& options = report.options();
  if (study::threshold::missing_catch_trials(report.design) > 0) {
    all.emplace_back(
        "Fewer than six trials, or a tenth, of a track were certain to be at its highest level, "
        "where only lapses cause errors. Lapses then raise the estimated thresholds.");
  }
  if (options.along == Along::order && options.rove_db == 0.0) {
    all.emplace_back(
        "Orders also differ in strength, and gains were not roved: participants may have compared "
        "strengths.");
  }
}

}  // namespace

std::vector<std::string> threshold_warnings(const ThresholdReport& report) {
  Warnings all;
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
