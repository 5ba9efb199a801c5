#include "protocols/threshold/analysis/primary.hpp"

#include "analysis/choices/selections.hpp"
#include "analysis/statistics/censored_mean.hpp"
#include "core/text.hpp"
#include "protocols/threshold/study/registered_standards.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::analysis::threshold {
namespace {

using choices::Person;
using choices::PersonTrials;
using choices::Selection;
using procedures::Censored;
using study::Estimand;

using Tracks = std::vector<TrackReport>;

/// The people of a selection with all required visits, and their trials.
std::vector<Person> selected_people(const Outcomes& outcomes, const Selection& selection) {
  const choices::FirstSessions first(outcomes);
  const std::set<int> complete = choices::people_with_all_visits(outcomes, selection, first);
  std::map<int, Person> people;
  for (const TrialOutcome& trial : outcomes.trials) {
    const int person = first.first_of(trial.row.session);
    if (!is_answer(trial) || !selection.includes_any(trial)) continue;
    if (!outcomes.design.enters_analysis(trial.visit) || !complete.contains(person)) continue;
    people[person].name = trial.participant;
    people[person].trials.push_back(&trial);
  }
  std::vector<Person> all;
  for (auto& [session, person] : people) {
    choices::sort_in_felt_order(person.trials);
    all.push_back(std::move(person));
  }
  return all;
}

/// A cache of tracks by their trials, so that most selections need no new estimates.
class TrackCache {
 public:
  TrackCache(const Outcomes& outcomes, const ThresholdReport& report) : design_(report.design) {
    for (Person& person : people_of(outcomes)) {
      Tracks& tracks = tracks_[std::move(person.trials)];
      for (const TrackReport& track : report.tracks) {
        if (track.participant == person.name) tracks.push_back(track);
      }
    }
  }

  void estimate(const std::vector<std::vector<Person>>& people_by_selection, int jobs) {
    std::vector<Person> new_people;
    for (const std::vector<Person>& people : people_by_selection) {
      for (const Person& person : people) {
        if (!tracks_.try_emplace(person.trials).second) continue;
        new_people.push_back({std::to_string(new_people.size()), person.trials});
      }
    }
    for (TrackReport& track : track_reports(design_, new_people, jobs)) {
      const Person& person = new_people[std::stoul(track.participant)];
      tracks_[person.trials].push_back(std::move(track));
    }
  }

  [[nodiscard]] const Tracks& tracks_of(const Person& person) const {
    return tracks_.at(person.trials);
  }

 private:
  const study::Study& design_;
  std::map<PersonTrials, Tracks> tracks_;
};

std::optional<PersonThreshold> threshold_at(const ThresholdReport& report, const Tracks& tracks,
                                            std::size_t standard) {
  std::vector<procedures::ThresholdEstimate> estimates;
  for (const TrackReport& track : tracks) {
    if (track.standard == standard && track.estimate) estimates.push_back(*track.estimate);
  }
  if (estimates.empty()) return std::nullopt;
  return person_threshold(estimates, report.standards[standard].levels);
}

/// One participant's thresholds by standard; nothing without a track.
using PersonThresholds = std::vector<std::optional<PersonThreshold>>;

/// The thresholds of the people of one selection.
struct Sample {
  std::vector<PersonThresholds> people;
  int trials = 0;

  [[nodiscard]] std::vector<PersonThreshold> thresholds_at(std::size_t standard) const {
    std::vector<PersonThreshold> all;
    for (const PersonThresholds& thresholds : people) {
      if (thresholds[standard]) all.push_back(*thresholds[standard]);
    }
    return all;
  }
  [[nodiscard]] std::vector<PersonThreshold> differences(std::size_t first,
                                                         std::size_t second) const {
    std::vector<PersonThreshold> all;
    for (const PersonThresholds& thresholds : people) {
      if (thresholds[first] && thresholds[second]) {
        all.push_back(difference_of(*thresholds[first], *thresholds[second]));
      }
    }
    return all;
  }
};

Sample sample_of(const ThresholdReport& report, const std::vector<Person>& people,
                 const TrackCache& cache) {
  Sample sample;
  for (const Person& person : people) {
    const Tracks& tracks = cache.tracks_of(person);
    if (tracks.empty()) continue;
    PersonThresholds& thresholds = sample.people.emplace_back(report.standards.size());
    for (std::size_t i = 0; i < thresholds.size(); ++i) {
      thresholds[i] = threshold_at(report, tracks, i);
    }
    for (const TrackReport& track : tracks) sample.trials += track.answers.n + track.catches.n;
  }
  return sample;
}

/// The registered quantity, by indices of standards.
struct RegisteredQuantity {
  Estimand estimand{};
  std::vector<std::size_t> standards;
  Sides sides = Sides::two;
  std::optional<double> margin{};
  double level = 0.05;  ///< the maximum p

  [[nodiscard]] double interval_level() const { return 1.0 - (margin ? 2.0 : 1.0) * level; }
};

std::vector<PersonThreshold> negated(std::vector<PersonThreshold> people) {
  for (PersonThreshold& threshold : people)
    threshold.bounds = {-threshold.bounds.high, -threshold.bounds.low};
  return people;
}

/// The larger p of the two one-sided tests against -margin and margin.
std::optional<double> equality_p(const std::vector<PersonThreshold>& people, double margin) {
  const auto above = p_of(people, -margin, Sides::one);
  const auto below = p_of(negated(people), -margin, Sides::one);
  if (!above || !below) return std::nullopt;
  return std::max(*above, *below);
}

std::string pair_words(const ThresholdReport& report, std::size_t first, std::size_t second) {
  return fmt::format("{}, minus {}", report.standards[first].words, report.standards[second].words);
}

std::vector<PrimaryPair> pairs_of(const ThresholdReport& report, const RegisteredQuantity& question,
                                  const Sample& sample) {
  std::vector<PrimaryPair> pairs;
  for (std::size_t i = 0; i < question.standards.size(); ++i) {
    for (std::size_t j = i + 1; j < question.standards.size(); ++j) {
      const std::size_t first = question.standards[i];
      const std::size_t second = question.standards[j];
      const std::vector<PersonThreshold> people = sample.differences(first, second);
      const CensoredMean mean = mean_of(people, question.interval_level());
      pairs.push_back({pair_words(report, first, second), mean.participants, mean.mean,
                       mean.interval, equality_p(people, *question.margin)});
    }
  }
  return pairs;
}

/// The deciding pair: one without an interval, or the one whose interval extends furthest from 0.
const PrimaryPair& deciding_pair(const std::vector<PrimaryPair>& pairs) {
  const auto reach = [](const PrimaryPair& pair) {
    if (!pair.interval) return std::numeric_limits<double>::infinity();
    return std::max(std::abs(pair.interval->low), std::abs(pair.interval->high));
  };
  return *std::ranges::max_element(pairs, {}, reach);
}

/// The thresholds, or differences, whose mean answers the question.
std::vector<PersonThreshold> values_of(const RegisteredQuantity& question, const Sample& sample) {
  const std::vector<std::size_t>& standards = question.standards;
  return question.estimand == Estimand::mean_threshold
             ? sample.thresholds_at(standards[0])
             : sample.differences(standards[0], standards[1]);
}

PrimaryChoice choice_of(const ThresholdReport& report, const RegisteredQuantity& question,
                        const Selection& selection, const Sample& sample) {
  PrimaryChoice choice{selection.name, selection.words, static_cast<int>(sample.people.size()),
                       sample.trials};
  if (question.estimand == Estimand::threshold_equality) {
    const std::vector<PrimaryPair> pairs = pairs_of(report, question, sample);
    const PrimaryPair& pair = deciding_pair(pairs);
    choice.estimate = pair.estimate;
    choice.interval = pair.interval;
    choice.pair = pair.words;
    return choice;
  }
  const CensoredMean mean = mean_of(values_of(question, sample), question.interval_level());
  choice.participants = mean.participants;
  choice.estimate = mean.mean;
  choice.interval = mean.interval;
  return choice;
}

/// Adds the results that only the registered selection has.
void add_registered_results(const ThresholdReport& report, const RegisteredQuantity& question,
                            const Sample& sample, PrimaryResult& result) {
  if (question.estimand == Estimand::mean_threshold) return;
  if (question.estimand == Estimand::threshold_equality) {
    result.pairs = pairs_of(report, question, sample);
    result.p = 0.0;
    for (const PrimaryPair& pair : result.pairs) {
      if (!pair.p) result.p.reset();
      if (result.p) result.p = std::max(*result.p, *pair.p);
    }
    return;
  }
  const std::vector<PersonThreshold> people = values_of(question, sample);
  result.p = p_of(people, 0.0, question.sides);
  result.statistic = known_t_statistic(bounds_of(people));
  if (question.sides == Sides::two || question.level >= 0.5) return;
  const CensoredMean mean = mean_of(people, 1.0 - 2.0 * question.level);
  if (mean.interval) result.bound = mean.interval->low;
}

/// How people without a threshold enter the mean.
/// \param counts  "1 of 6 at bark"
std::string unknown_words(const std::vector<std::string>& counts, int open) {
  std::string text = fmt::format(
      "Without a threshold: {}. They enter the mean by the likeliest threshold if that is within "
      "the levels, else as censored.",
      fmt::join(counts, "; "));
  if (open > 0) {
    text += fmt::format(" {} {} not enter it, because the answers leave both ends open.",
                        counted(open, "threshold"), open == 1 ? "does" : "do");
  }
  return text;
}

/// Notes the number of people without a threshold at the registered standards, and whether it is
/// too large for a mean of thresholds or differences.
void note_unknown(const ThresholdReport& report, const RegisteredQuantity& question,
                  const Sample& sample, PrimaryResult& result) {
  std::vector<std::string> noted;
  std::vector<std::string> too_many;
  int open = 0;
  const auto add = [&](const std::vector<PersonThreshold>& people, const std::string& place,
                       bool is_noted) {
    const auto known_count = std::ranges::count(people, Censored::no, &PersonThreshold::censored);
    const std::string words =
        fmt::format("{} of {} at {}", people.size() - known_count, people.size(), place);
    const CensoredMean mean = mean_of(people);
    if (mean.lack == MissingReason::most) too_many.push_back(words);
    if (!is_noted || known_count == std::ssize(people)) return;
    noted.push_back(words);
    open += mean.open;
  };
  for (const std::size_t standard : question.standards) {
    add(sample.thresholds_at(standard), report.standards[standard].words, true);
  }
  if (too_many.empty()) {
    for (std::size_t i = 0; i < question.standards.size(); ++i) {
      for (std::size_t j = i + 1; j < question.standards.size(); ++j) {
        const std::size_t first = question.standards[i];
        const std::size_t second = question.standards[j];
        add(sample.differences(first, second), pair_words(report, first, second), false);
      }
    }
  }
  if (!too_many.empty()) {
    result.obstacle = fmt::format(
        "More than half of the participants have no threshold ({}), so no conclusion is possible.",
        fmt::join(too_many, "; "));
  } else if (!noted.empty()) {
    result.note = unknown_words(noted, open);
  }
}

std::string question_words(const ThresholdReport& report, const RegisteredQuantity& question) {
  const auto words = [&](std::size_t nth) {
    return report.standards[question.standards[nth]].words;
  };
  const std::string visits = choices::visit_words(report.design);
  switch (question.estimand) {
    case Estimand::mean_threshold:
      return fmt::format("mean over participants of the threshold of {}{}", words(0), visits);
    case Estimand::threshold_difference:
      return fmt::format("mean over participants of the difference of thresholds, {}{}",
                         pair_words(report, question.standards[0], question.standards[1]), visits);
    default:
      break;
  }
  return fmt::format("the largest of {} differences of thresholds{}",
                     question.standards.size() * (question.standards.size() - 1) / 2, visits);
}

std::string test_words(const RegisteredQuantity& question) {
  if (question.estimand == Estimand::mean_threshold) return "none";
  if (question.estimand == Estimand::threshold_equality) {
    return "two one-sided t tests over participants of every difference";
  }
  return fmt::format("paired t test over participants, {}",
                     question.sides == Sides::one ? "one-sided" : "two-sided");
}

double null_of(const RegisteredQuantity& question) {
  if (question.estimand == Estimand::mean_threshold) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return question.margin.value_or(0.0);
}

RegisteredQuantity registered_question(const study::Study& study) {
  const study::RegisteredAnalysis& registered = *study.registration.analysis;
  return {registered.estimand, study::threshold::registered_standards(study),
          registered.one_sided ? Sides::one : Sides::two, registered.margin, registered.alpha};
}

}  // namespace

std::optional<PrimaryResult> primary_result(const Outcomes& outcomes, const ThresholdReport& report,
                                            int jobs) {
  const auto& registered = outcomes.design.registration.analysis;
  if (!registered) return std::nullopt;
  RegisteredQuantity question = registered_question(outcomes.design);
  PrimaryResult result{.estimand = question.estimand,
                       .words = question_words(report, question),
                       .test = test_words(question),
                       .null = null_of(question),
                       .sides = question.sides,
                       .alpha = question.level,
                       .level = question.level,
                       .interval_level = question.interval_level(),
                       .smallest_effect = registered->smallest_effect,
                       .margin = question.margin};
  std::vector<Selection> selections = choices::selections(outcomes);
  // A trial without an answer belongs to no track.
  std::erase_if(selections, [](const Selection& selection) { return selection.only_answered; });
  std::vector<std::vector<Person>> people;
  for (const Selection& selection : selections)
    people.push_back(selected_people(outcomes, selection));
  TrackCache cache(outcomes, report);
  cache.estimate(people, jobs);
  std::vector<Sample> samples;
  for (const auto& group : people) samples.push_back(sample_of(report, group, cache));
  const Sample& registered_sample = samples.front();
  const StudyCourse course = course_of(outcomes, static_cast<int>(registered_sample.people.size()));
  // With registered looks, intervals have the level of the test.
  question.level = level_of(result, course, registered->spending);
  result.level = question.level;
  result.interval_level = question.interval_level();
  for (std::size_t i = 0; i < selections.size(); ++i) {
    result.choices.push_back(choice_of(report, question, selections[i], samples[i]));
  }
  add_registered_results(report, question, registered_sample, result);
  note_unknown(report, question, registered_sample, result);
  set_verdict(result, course);
  return result;
}

}  // namespace touchtrial::analysis::threshold
