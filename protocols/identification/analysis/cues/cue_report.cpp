#include "protocols/identification/analysis/cues/cue_report.hpp"

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/recorded_pack.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "core/named.hpp"
#include "protocols/identification/analysis/cues/cue_statistics.hpp"
#include "protocols/identification/analysis/cues/felt_trials.hpp"
#include "protocols/identification/analysis/cues/ideal_observer.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

/// The counted trials of a study and their felt features.
struct FeltStudy {
  std::vector<const TrialOutcome*> trials;
  FeltTrials felt;
  int classes = 0;
  int jobs = 0;
};

std::vector<const TrialOutcome*> counted_trials(const Outcomes& outcomes) {
  std::vector<const TrialOutcome*> trials;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.counted) trials.push_back(&trial);
  }
  return trials;
}

StudyPlane plane_for_features(const record::StudyStore& store, const study::StudyKey& key,
                              std::span<const TrialOutcome* const> trials,
                              const CueOptions& options) {
  if (auto plane = study_plane(key, pack_of(store, key, options.pack))) return *plane;
  return {touched_plane(store, key, trials, key.study.rendering.pitch_mm, options.jobs),
          kPlaneFromTraces};
}

/// The places of a method's trials that have a trace.
std::vector<std::size_t> places_with_trace(const FeltStudy& study, int method, MethodCues& cues) {
  std::vector<std::size_t> places;
  for (std::size_t place = 0; place < study.trials.size(); ++place) {
    if (study.trials[place]->stimulus.method != method) continue;
    if (study.felt.has_trace[place]) {
      places.push_back(place);
    } else {
      ++cues.without_trace;
    }
  }
  return places;
}

/// The answers of all observers, in the order of kCues; trials are in the order of `places`.
using Answers = std::vector<ObserverAnswers>;

Answers all_answers(const FeltStudy& study, const std::vector<std::size_t>& places) {
  std::vector<ObservedTrial> observed;
  std::vector<std::optional<int>> responses;
  for (const std::size_t place : places) {
    const TrialOutcome& trial = *study.trials[place];
    observed.push_back(
        {trial.stimulus.class_index, trial.stimulus.exemplar, study.felt.features[place]});
    responses.push_back(trial.response);
  }
  Answers answers;
  for (const Cue cue : kCues) {
    answers.push_back(observer_answers(cue, observed, responses, study.classes, study.jobs));
  }
  return answers;
}

JudgedTrial judged_trial(const TrialOutcome& trial, const Answers& answers, std::size_t i) {
  JudgedTrial judged{trial.stimulus.class_index, trial.response, {}, {}};
  for (std::size_t observer = 0; observer < kCues.size(); ++observer) {
    judged.ideal[observer] = answers[observer].ideal[i];
    judged.matched[observer] = answers[observer].matched[i];
  }
  return judged;
}

/// The answers of participants, in the order of their first trials, which is the order of sessions.
std::vector<ParticipantAnswers> participant_answers(const FeltStudy& study,
                                                    const std::vector<std::size_t>& places,
                                                    const Answers& answers, MethodCues& cues) {
  std::vector<ParticipantAnswers> all;
  std::map<std::string, std::size_t> index_of;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (answers.front().ideal[i].empty()) {
      ++cues.unjudged;
      continue;
    }
    const TrialOutcome& trial = *study.trials[places[i]];
    const auto [entry, is_new] = index_of.try_emplace(trial.participant, all.size());
    if (is_new) all.emplace_back(trial.participant, study.classes);
    all[entry->second].add(judged_trial(trial, answers, i));
  }
  return all;
}

void add_counts(AnswerCounts& sum, const FlatCounts& counts) {
  const std::size_t side = sum.size();
  for (std::size_t i = 0; i < counts.size(); ++i) sum[i / side][i % side] += counts[i];
}

AnswerCounts zero_counts(int classes) {
  const auto side = static_cast<std::size_t>(classes);
  return AnswerCounts(side, std::vector<double>(side, 0.0));
}

void set_participants(MethodCues& cues, const std::vector<ParticipantAnswers>& all, int classes) {
  cues.human_confusion = zero_counts(classes);
  cues.no_response.assign(static_cast<std::size_t>(classes), 0);
  for (const ParticipantAnswers& participant : all) {
    cues.trials += participant.trials;
    cues.participants.push_back(participant.participant);
    cues.participant_trials.push_back(participant.trials);
    cues.human_accuracy.push_back(participant.human_accuracy());
    add_counts(cues.human_confusion, participant.human);
    for (int i = 0; i < classes; ++i) cues.no_response[i] += participant.no_response[i];
  }
  cues.human_mean = participant_mean(cues.human_accuracy);
}

int min_per_class(const std::vector<ParticipantAnswers>& all) {
  int fewest = all.front().trials;
  for (const ParticipantAnswers& participant : all) {
    fewest = std::min(fewest, std::ranges::min(participant.presented));
  }
  return fewest;
}

ObserverFigures observer_figures(std::size_t observer, const std::vector<ParticipantAnswers>& all,
                                 const CueStatistics& statistics) {
  ObserverFigures result;
  result.cue = kCues[observer];
  result.confusion = zero_counts(all.front().classes);
  result.matched_confusion = result.confusion;
  for (const ParticipantAnswers& participant : all) {
    result.accuracy.push_back(participant.observer_accuracy(observer));
    add_counts(result.confusion, participant.ideal[observer]);
    add_counts(result.matched_confusion, participant.matched[observer]);
  }
  result.mean = participant_mean(result.accuracy);
  result.efficiency = statistics.efficiency[observer];
  result.corrected_efficiency = statistics.corrected_efficiency[observer];
  result.divergence = statistics.divergence[observer];
  result.matched_divergence = statistics.matched_divergence[observer];
  return result;
}

MethodCues method_cues(const FeltStudy& study, int method, const std::string& label) {
  MethodCues cues;
  cues.method = label;
  const std::vector<std::size_t> places = places_with_trace(study, method, cues);
  const Answers answers = all_answers(study, places);
  const std::vector<ParticipantAnswers> all = participant_answers(study, places, answers, cues);
  set_participants(cues, all, study.classes);
  if (all.empty()) return cues;
  const CueStatistics statistics =
      cue_statistics(all, static_cast<std::uint64_t>(method), study.jobs);
  for (std::size_t observer = 0; observer < kCues.size(); ++observer) {
    cues.observers.push_back(observer_figures(observer, all, statistics));
    static_cast<MatchingNoise&>(cues.observers.back()) = answers[observer];
  }
  cues.match = statistics.match;
  if (cues.match) {
    cues.match->is_distinct &=
        std::ranges::find(cues.observers, cues.match->best, &ObserverFigures::cue)
            ->is_as_uncertain();
  }
  cues.min_per_class = min_per_class(all);
  return cues;
}

using WarningTexts = std::vector<std::string>;

constexpr int kMinTrialsPerClass = 2;

void add_study_warnings(const Outcomes& outcomes, const CueReport& report, WarningTexts& warnings) {
  if (outcomes.visual) {
    warnings.emplace_back("Seen on a screen, not felt: the observers use forces that nobody felt.");
  }
  if (report.plane_source == kPlaneFromTraces) {
    warnings.emplace_back(
        "Neither the study's pack nor its images were found: the plane's size is inferred from "
        "where hands had contact, so `everything` is slightly less accurate.");
  }
}

void add_trial_warnings(const MethodCues& cues, WarningTexts& warnings) {
  if (cues.without_trace > 0) {
    warnings.push_back(
        fmt::format("{}: {} without a trace omitted; accuracy is that of the other trials.",
                    cues.method, counted(cues.without_trace, "trial")));
  }
  if (cues.unjudged > 0) {
    warnings.push_back(fmt::format(
        "{}: {} omitted, because the observers cannot learn the class from another trial.",
        cues.method, counted(cues.unjudged, "trial")));
  }
}

void add_number_warnings(const MethodCues& cues, WarningTexts& warnings) {
  if (cues.trials == 0) {
    warnings.push_back(cues.method + ": no trial can be judged by the observers.");
    return;
  }
  if (cues.min_per_class < kMinTrialsPerClass) {
    warnings.push_back(fmt::format(
        "{}: a participant has fewer than {} trials of a class, so the observers learn the class "
        "only from other participants, and the available accuracy is too low.",
        cues.method, kMinTrialsPerClass));
  }
  const auto participants = static_cast<int>(cues.participants.size());
  if (participants < kMinForVerdict) {
    warnings.push_back(
        fmt::format("{}: {} cannot decide which cue was used: a verdict needs at least {}, because "
                    "intervals over fewer are too narrow.",
                    cues.method, counted(participants, "participant"), kMinForVerdict));
  } else if (cues.match && !cues.match->difference.interval) {
    warnings.push_back(cues.method +
                       ": the observers' difference has no interval, so there is no verdict on "
                       "which cue was used.");
  }
}

void add_observer_warnings(const MethodCues& cues, double chance, WarningTexts& warnings) {
  for (const ObserverFigures& observer : cues.observers) {
    const std::string_view title = title_of(observer.cue);
    if (observer.mean.mean.value_or(0.0) <= chance) {
      warnings.push_back(fmt::format(
          "{}: {} distinguishes the classes no better than chance, so its use cannot be judged.",
          cues.method, title));
    } else if (observer.target_accuracy > 0.0 && !observer.is_as_uncertain()) {
      const bool is_less_accurate = observer.matched_accuracy < observer.target_accuracy;
      warnings.push_back(fmt::format(
          "{}: {} cannot be as uncertain as participants: {} it is right in {} of trials, "
          "participants in {}. {}",
          cues.method, title, is_less_accurate ? "even without noise" : "even with the most noise",
          share_figure(observer.matched_accuracy), share_figure(observer.target_accuracy),
          is_less_accurate
              ? "They used other cues as well, or the observer has too few trials to learn from."
              : "Participants' errors have causes other than noise."));
    } else if (observer.efficiency.value.value_or(0.0) > 1.0) {
      warnings.push_back(fmt::format(
          "{}: participants did better than with {} only: they used other cues as well, "
          "or the observer has too few trials to learn from.",
          cues.method, title));
    }
  }
}

/// \param report  complete except for its warnings
std::vector<std::string> cue_warnings(const Outcomes& outcomes, const CueReport& report) {
  WarningTexts warnings;
  add_study_warnings(outcomes, report, warnings);
  for (const MethodCues& cues : report.methods) {
    add_trial_warnings(cues, warnings);
    add_number_warnings(cues, warnings);
    add_observer_warnings(cues, report.chance, warnings);
  }
  return warnings;
}

}  // namespace

std::string_view name_of(Cue cue) noexcept {
  using enum Cue;
  static constexpr auto kNames =
      std::to_array<Named<Cue>>({{"rms", rms}, {"spectrum", spectrum}, {"everything", everything}});
  return name_in(kNames, cue);
}

std::string_view title_of(Cue cue) noexcept {
  using enum Cue;
  static constexpr auto kNames = std::to_array<Named<Cue>>({{"force strength (rms)", rms},
                                                            {"spectrum's shape", spectrum},
                                                            {"everything felt", everything}});
  return name_in(kNames, cue);
}

int traces_to_read(const Outcomes& outcomes) {
  return static_cast<int>(counted_trials(outcomes).size());
}

CueReport make_cues(const record::StudyStore& store, const study::StudyKey& key,
                    const Outcomes& outcomes, const CueOptions& options) {
  CueReport report;
  report.simulated = outcomes.simulated;
  report.classes = outcomes.classes;
  report.chance = 1.0 / static_cast<double>(outcomes.classes.size());
  FeltStudy study{
      counted_trials(outcomes), {}, static_cast<int>(outcomes.classes.size()), options.jobs};
  const StudyPlane plane = plane_for_features(store, key, study.trials, options);
  report.plane_source = plane.source;
  study.felt =
      feel_traces(store, key, study.trials, plane.geometry, options.jobs, options.progress);
  for (std::size_t i = 0; i < outcomes.methods.size(); ++i) {
    report.methods.push_back(method_cues(study, static_cast<int>(i), outcomes.methods[i]));
  }
  report.warnings = cue_warnings(outcomes, report);
  return report;
}

}  // namespace touchtrial::analysis::identification
