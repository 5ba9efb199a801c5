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

using choices::OwnTrials;
using choices::Person;
using choices::Selection;
using procedures::Censored;
using study::Estimand;

using Tracks = std::vector<TrackReport>;

/// The people of a selection with all required visits, and their trials.
std::vector<Person> people_in(const Outcomes& outcomes, const Selection& selection) {
  const choices::FirstSessions first(outcomes);
  const std::set<int> whole = choices::people_with_all_visits(outcomes, selection, first);
  std::map<int, Person> people;
  for (const TrialOutcome& trial : outcomes.trials) {
    const int person = first.of(trial.row.session);
    if (!is_answer(trial) || !selection.admits(trial)) continue;
    if (!outcomes.design.enters_analysis(trial.visit) || !whole.contains(person)) continue;
    people[person].name = trial.participant;
    people[person].trials.push_back(&trial);
  }
  std::vector<Person> all;
  for (auto& [session, person] : people) {
    choices::sort_as_felt(person.trials);
    all.push_back(std::move(person));
  }
  return all;
}

/// A cache of tracks by their trials, so that most selections need no new estimates.
class KnownTracks {
 public:
  KnownTracks(const Outcomes& outcomes, const ThresholdReport& report) : design_(report.design) {
    for (Person& person : people_of(outcomes)) {
      Tracks& own = known_[std::move(person.trials)];
      for (const TrackReport& track : report.tracks) {
        if (track.participant == person.name) own.push_back(track);
      }
    }
  }

  void estimate(const std::vector<std::vector<Person>>& choices, int jobs) {
    std::vector<Person> missing;
    for (const std::vector<Person>& people : choices) {
      for (const Person& person : people) {
        if (!known_.try_emplace(person.trials).second) continue;
        missing.push_back({std::to_string(missing.size()), person.trials});
      }
    }
    for (TrackReport& track : track_reports(design_, missing, jobs)) {
      const Person& person = missing[std::stoul(track.participant)];
      known_[person.trials].push_back(std::move(track));
    }
  }

  [[nodiscard]] const Tracks& of(const Person& person) const { return known_.at(person.trials); }

 private:
  const study::Study& design_;
  std::map<OwnTrials, Tracks> known_;
};

/// One participant's threshold at a standard.
std::optional<PersonThreshold> own_threshold(const ThresholdReport& report, const Tracks& tracks,
                                             std::size_t standard) {
  std::vector<procedures::ThresholdEstimate> own;
  for (const TrackReport& track : tracks) {
    if (track.standard == standard && track.estimate) own.push_back(*track.estimate);
  }
  if (own.empty()) return std::nullopt;
  return person_threshold(own, report.standards[standard].levels);
}

/// One participant's thresholds, by the study's standards; nothing without a track.
using OwnThresholds = std::vector<std::optional<PersonThreshold>>;

/// The people of a selection.
struct Sample {
  std::vector<OwnThresholds> people;
  int trials = 0;

  /// The thresholds of the people who have one, or both.
  [[nodiscard]] std::vector<PersonThreshold> of(std::size_t standard) const {
    std::vector<PersonThreshold> all;
    for (const OwnThresholds& own : people) {
      if (own[standard]) all.push_back(*own[standard]);
    }
    return all;
  }
  [[nodiscard]] std::vector<PersonThreshold> of(std::size_t first, std::size_t second) const {
    std::vector<PersonThreshold> all;
    for (const OwnThresholds& own : people) {
      if (own[first] && own[second]) all.push_back(difference_of(*own[first], *own[second]));
    }
    return all;
  }
};

Sample sample_of(const ThresholdReport& report, const std::vector<Person>& people,
                 const KnownTracks& known) {
  Sample sample;
  for (const Person& person : people) {
    const Tracks& tracks = known.of(person);
    if (tracks.empty()) continue;
    OwnThresholds& own = sample.people.emplace_back(report.standards.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
      own[i] = own_threshold(report, tracks, i);
    }
    for (const TrackReport& track : tracks) sample.trials += track.answers.n + track.catches.n;
  }
  return sample;
}

/// The registered quantity, by indices of standards.
struct Registered {
  Estimand estimand{};
  std::vector<std::size_t> standards;
  Sides sides = Sides::two;
  std::optional<double> margin{};
  double level = 0.05;  ///< alpha: p must not exceed it

  [[nodiscard]] double interval_level() const { return 1.0 - (margin ? 2.0 : 1.0) * level; }
};

std::vector<PersonThreshold> mirrored(std::vector<PersonThreshold> people) {
  for (PersonThreshold& one : people) one.bounds = {-one.bounds.high, -one.bounds.low};
  return people;
}

/// The larger p of the two tests that the mean lies above -margin and below margin.
std::optional<double> equality_p(const std::vector<PersonThreshold>& people, double margin) {
  const auto above = p_of(people, -margin, Sides::one);
  const auto below = p_of(mirrored(people), -margin, Sides::one);
  if (!above || !below) return std::nullopt;
  return std::max(*above, *below);
}

std::string pair_words(const ThresholdReport& report, std::size_t first, std::size_t second) {
  return fmt::format("{}, less {}", report.standards[first].words, report.standards[second].words);
}

std::vector<PrimaryPair> pairs_of(const ThresholdReport& report, const Registered& question,
                                  const Sample& sample) {
  std::vector<PrimaryPair> pairs;
  for (std::size_t i = 0; i < question.standards.size(); ++i) {
    for (std::size_t j = i + 1; j < question.standards.size(); ++j) {
      const std::size_t first = question.standards[i];
      const std::size_t second = question.standards[j];
      const std::vector<PersonThreshold> people = sample.of(first, second);
      const CensoredMean found = mean_of(people, question.interval_level());
      pairs.push_back({pair_words(report, first, second), found.participants, found.mean,
                       found.interval, equality_p(people, *question.margin)});
    }
  }
  return pairs;
}

/// The deciding pair: one without an interval, else the one whose interval extends furthest from 0.
const PrimaryPair& furthest(const std::vector<PrimaryPair>& pairs) {
  const auto reach = [](const PrimaryPair& pair) {
    if (!pair.interval) return std::numeric_limits<double>::infinity();
    return std::max(std::abs(pair.interval->low), std::abs(pair.interval->high));
  };
  return *std::ranges::max_element(pairs, {}, reach);
}

/// The people over whom the question's mean is taken, or their differences.
std::vector<PersonThreshold> people_asked(const Registered& question, const Sample& sample) {
  const std::vector<std::size_t>& of = question.standards;
  return question.estimand == Estimand::mean_threshold ? sample.of(of.front())
                                                       : sample.of(of[0], of[1]);
}

PrimaryChoice choice_of(const ThresholdReport& report, const Registered& question,
                        const Selection& selection, const Sample& sample) {
  PrimaryChoice choice{selection.name, selection.words, static_cast<int>(sample.people.size()),
                       sample.trials};
  if (question.estimand == Estimand::threshold_equality) {
    const std::vector<PrimaryPair> pairs = pairs_of(report, question, sample);
    const PrimaryPair& pair = furthest(pairs);
    choice.estimate = pair.estimate;
    choice.interval = pair.interval;
    choice.pair = pair.words;
    return choice;
  }
  const CensoredMean found = mean_of(people_asked(question, sample), question.interval_level());
  choice.participants = found.participants;
  choice.estimate = found.mean;
  choice.interval = found.interval;
  return choice;
}

/// Adds the results that exist only for the registered selection.
void put_registered_choice(const ThresholdReport& report, const Registered& question,
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
  const std::vector<PersonThreshold> people = people_asked(question, sample);
  result.p = p_of(people, 0.0, question.sides);
  result.statistic = known_t_statistic(bounds_of(people));
  if (question.sides == Sides::two || question.level >= 0.5) return;
  const CensoredMean found = mean_of(people, 1.0 - 2.0 * question.level);
  if (found.interval) result.bound = found.interval->low;
}

/// How people without a threshold enter the mean, after who they are: "1 of 6 at bark".
std::string words_on_unknown(const std::vector<std::string>& who, int open) {
  std::string text = fmt::format(
      "Without a threshold: {}. The mean takes each of them by the likeliest threshold if that "
      "lies inside the levels, else by the side on which it lies.",
      fmt::join(who, "; "));
  if (open > 0) {
    text += fmt::format(" {} {} no share in it: the answers leave both ends open.",
                        counted(open, "threshold"), open == 1 ? "has" : "have");
  }
  return text;
}

/// Adds the number of people without a threshold at the registered standards, and whether it is too
/// large for a mean, or for that of a difference.
void put_unknown(const ThresholdReport& report, const Registered& question, const Sample& sample,
                 PrimaryResult& result) {
  std::vector<std::string> some;
  std::vector<std::string> most;
  int open = 0;
  const auto add = [&](const std::vector<PersonThreshold>& people, const std::string& of,
                       bool is_noted) {
    const auto known = std::ranges::count(people, Censored::no, &PersonThreshold::censored);
    const std::string words =
        fmt::format("{} of {} at {}", people.size() - known, people.size(), of);
    const CensoredMean mean = mean_of(people);
    if (mean.lack == Lack::most) most.push_back(words);
    if (!is_noted || known == std::ssize(people)) return;
    some.push_back(words);
    open += mean.open;
  };
  for (const std::size_t standard : question.standards) {
    add(sample.of(standard), report.standards[standard].words, true);
  }
  if (most.empty()) {
    for (std::size_t i = 0; i < question.standards.size(); ++i) {
      for (std::size_t j = i + 1; j < question.standards.size(); ++j) {
        const std::size_t first = question.standards[i];
        const std::size_t second = question.standards[j];
        add(sample.of(first, second), pair_words(report, first, second), false);
      }
    }
  }
  if (!most.empty()) {
    result.nothing_follows = fmt::format(
        "More than half of the participants have no threshold ({}), so nothing follows.",
        fmt::join(most, "; "));
  } else if (!some.empty()) {
    result.note = words_on_unknown(some, open);
  }
}

std::string question_words(const ThresholdReport& report, const Registered& question) {
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
  return fmt::format("of {} differences of thresholds, the one that reaches furthest from 0{}",
                     question.standards.size() * (question.standards.size() - 1) / 2, visits);
}

std::string test_words(const Registered& question) {
  if (question.estimand == Estimand::mean_threshold) return "none";
  if (question.estimand == Estimand::threshold_equality) {
    return "two one-sided t tests over participants of every difference";
  }
  return fmt::format("paired t test over participants, {}",
                     question.sides == Sides::one ? "one-sided" : "two-sided");
}

double null_of(const Registered& question) {
  if (question.estimand == Estimand::mean_threshold) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return question.margin.value_or(0.0);
}

Registered registered_question(const study::Study& study) {
  const study::RegisteredAnalysis& registered = *study.registration.analysis;
  return {registered.estimand, study::threshold::registered_standards(study),
          registered.one_sided ? Sides::one : Sides::two, registered.margin, registered.alpha};
}

}  // namespace

std::optional<PrimaryResult> primary_result(const Outcomes& outcomes, const ThresholdReport& report,
                                            int jobs) {
  const auto& registered = outcomes.design.registration.analysis;
  if (!registered) return std::nullopt;
  Registered question = registered_question(outcomes.design);
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
  std::vector<Selection> chosen = choices::selections(outcomes);
  // A trial without an answer belongs to no track.
  std::erase_if(chosen, [](const Selection& one) { return one.only_answered; });
  std::vector<std::vector<Person>> people;
  for (const Selection& selection : chosen) people.push_back(people_in(outcomes, selection));
  KnownTracks known(outcomes, report);
  known.estimate(people, jobs);
  std::vector<Sample> samples;
  for (const std::vector<Person>& one : people) samples.push_back(sample_of(report, one, known));
  const Sample& of_registered = samples.front();
  const StudyCourse course = course_of(outcomes, static_cast<int>(of_registered.people.size()));
  // With registered looks, intervals have the level of the test.
  question.level = level_of(result, course, registered->spending);
  result.level = question.level;
  result.interval_level = question.interval_level();
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    result.choices.push_back(choice_of(report, question, chosen[i], samples[i]));
  }
  put_registered_choice(report, question, of_registered, result);
  put_unknown(report, question, of_registered, result);
  judge(result, course);
  return result;
}

}  // namespace touchtrial::analysis::threshold
