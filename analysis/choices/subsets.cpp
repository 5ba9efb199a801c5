#include "analysis/choices/subsets.hpp"

#include "analysis/statistics/d_prime.hpp"
#include "core/named.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::choices {
namespace {

using analysis::participant_mean;
using analysis::quartiles;
using analysis::Quartiles;
using analysis::RatedAnswer;

/// A counted trial and its place.
struct PlacedTrial {
  const TrialOutcome* trial = nullptr;
  int place = 0;  ///< from 1, among the participant's scored trials with the method
};

std::vector<PlacedTrial> placed_trials(const Outcomes& outcomes, int method) {
  std::vector<PlacedTrial> result;
  const TrialOutcome* previous = nullptr;
  int place = 0;
  for (const TrialOutcome* trial : trials_in_felt_order(outcomes)) {
    if (previous == nullptr || previous->row.session != trial->row.session) place = 0;
    const bool is_scored = trial->scored && trial->stimulus.method == method;
    if (is_scored) ++place;
    if (is_scored && trial->counted) result.push_back({trial, place});
    previous = trial;
  }
  return result;
}

/// A group's sort key and name.
using Group = std::pair<int, std::string>;

Group exemplar_group(const Outcomes& outcomes, const TrialOutcome& trial) {
  const auto [class_index, exemplar, method] = trial.stimulus;
  constexpr int kMaxExemplars = 1 << 16;
  return {class_index * kMaxExemplars + exemplar,
          outcomes.classes[class_index] + ": " + outcomes.exemplars[class_index][exemplar]};
}

/// The methods of each participant in the order in which they were first presented.
std::map<int, std::vector<int>> method_orders(const Outcomes& outcomes,
                                              const FirstSessions& people) {
  // Session, trial and method.
  std::map<int, std::vector<std::tuple<int, int, int>>> first_trials;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.role != study::Role::catch_trial) {
      first_trials[people.first_of(trial.row.session)].emplace_back(
          trial.row.session, trial.row.trial, trial.stimulus.method);
    }
  }
  std::map<int, std::vector<int>> orders;
  for (auto& [person, presented] : first_trials) {
    std::ranges::sort(presented);
    std::vector<int>& order = orders[person];
    for (const auto& [session, trial, method] : presented) {
      if (std::ranges::find(order, method) == order.end()) order.push_back(method);
    }
  }
  return orders;
}

Group order_group_of(const Outcomes& outcomes, const std::vector<int>& order) {
  int sort_key = 0;
  std::vector<std::string> labels;
  for (const int method : order) {
    sort_key = sort_key * static_cast<int>(outcomes.methods.size()) + method;
    labels.push_back(outcomes.methods[method]);
  }
  return {sort_key, fmt::format("{}", fmt::join(labels, ", then "))};
}

/// The mean over participants; those without a trial are left out.
template <typename Id>
MeanEstimate mean_of_shares(const std::map<Id, Proportion>& people) {
  std::vector<double> shares;
  for (const auto& [id, right] : people) {
    if (const auto share = right.share()) shares.push_back(*share);
  }
  return participant_mean(shares);
}

/// Counts trials and correct answers by the group that `group_of` returns.
template <typename GroupOf>
Breakdown breakdown_by(BreakdownKind kind, const std::vector<PlacedTrial>& trials,
                       GroupOf group_of) {
  std::map<Group, Proportion> groups;
  for (const PlacedTrial& placed_trial : trials) {
    groups[group_of(placed_trial)].add(placed_trial.trial->correct());
  }
  Breakdown breakdown{kind, {}};
  for (const auto& [group, accuracy] : groups) {
    breakdown.groups.push_back({group.second, accuracy, wilson_interval(accuracy)});
  }
  return breakdown;
}

/// breakdown_by with means over participants.
template <typename GroupOf>
Breakdown breakdown_by_people(BreakdownKind kind, const std::vector<PlacedTrial>& trials,
                              GroupOf group_of) {
  Breakdown breakdown = breakdown_by(kind, trials, group_of);
  std::map<Group, std::map<std::string, Proportion>> groups;
  for (const PlacedTrial& placed_trial : trials) {
    groups[group_of(placed_trial)][placed_trial.trial->participant].add(
        placed_trial.trial->correct());
  }
  auto group = breakdown.groups.begin();
  for (const auto& [name, people] : groups) (group++)->mean = mean_of_shares(people);
  return breakdown;
}

bool has_several_exemplars(const Outcomes& outcomes) {
  return std::ranges::any_of(outcomes.exemplars,
                             [](const auto& images) { return images.size() > 1; });
}

constexpr TrialSubset kSubsets[] = {TrialSubset::counted, TrialSubset::answered, TrialSubset::valid,
                                    TrialSubset::with_excluded_sessions};

bool belongs_to(TrialSubset subset, const TrialOutcome& trial, const std::set<int>& excluded) {
  switch (subset) {
    case TrialSubset::counted:
      return trial.counted;
    case TrialSubset::answered:
      return trial.counted && trial.response.has_value();
    case TrialSubset::valid:
      return trial.counted && trial.valid();
    case TrialSubset::with_excluded_sessions:
      break;
  }
  return trial.counted ||
         (trial.scored && has_ended(trial) && excluded.contains(trial.row.session));
}

double seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

/// The reaction times of one class, in seconds.
struct Times {
  std::vector<double> from_plane_on;
  std::vector<double> from_contact;
  int paused = 0;

  void add(const record::TrialRow& row) {
    if (row.paused) ++paused;
    if (const auto time = row.reaction_time()) from_plane_on.push_back(seconds(*time));
    if (const auto time = row.from_contact()) from_contact.push_back(seconds(*time));
  }
};

ReactionTimes summary_of(Times times) {
  std::ranges::sort(times.from_plane_on);
  return {quartiles(times.from_plane_on), quartiles(std::move(times.from_contact)),
          times.from_plane_on, times.paused};
}

using RatedAnswers = std::map<int, std::vector<RatedAnswer>>;  ///< by session

RatedAnswers rated_answers(const Outcomes& outcomes, int method) {
  RatedAnswers rated;
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool is_of_method = trial.counted && trial.stimulus.method == method;
    if (!is_of_method || !trial.response || !trial.row.confidence) continue;
    rated[trial.row.session].push_back({*trial.row.confidence, trial.correct()});
  }
  return rated;
}

RatedAccuracy accuracy_at(int rating, const RatedAnswers& rated) {
  RatedAccuracy accuracy{rating, {}, {}};
  std::map<int, Proportion> by_session;
  for (const auto& [session, answers] : rated) {
    for (const RatedAnswer& answer : answers) {
      if (answer.rating == rating) by_session[session].add(answer.correct);
    }
    accuracy.accuracy += by_session[session];
  }
  accuracy.mean = mean_of_shares(by_session);
  return accuracy;
}

}  // namespace

std::string name_of(BreakdownKind kind) {
  using enum BreakdownKind;
  static constexpr auto kNames =
      std::to_array<Named<BreakdownKind>>({{"exemplar", exemplar},
                                           {"trial", trial},
                                           {"visit", visit},
                                           {"group", group},
                                           {"order_group", order_group}});
  return std::string(name_in(kNames, kind));
}

std::vector<Breakdown> breakdowns(const Outcomes& outcomes, int method) {
  const std::vector<PlacedTrial> trials = placed_trials(outcomes, method);
  std::vector<Breakdown> all;
  const auto add = [&](BreakdownKind kind, auto group_of) {
    Breakdown breakdown = breakdown_by(kind, trials, group_of);
    if (breakdown.groups.size() > 1) all.push_back(std::move(breakdown));
  };
  if (has_several_exemplars(outcomes)) {
    add(BreakdownKind::exemplar, [&](const PlacedTrial& placed_trial) {
      return exemplar_group(outcomes, *placed_trial.trial);
    });
  }
  add(BreakdownKind::trial, [](const PlacedTrial& placed_trial) {
    return Group(placed_trial.place, std::to_string(placed_trial.place));
  });
  if (outcomes.methods.size() > 1 && outcomes.design.trials.blocks == study::Blocks::by_method) {
    const FirstSessions people(outcomes);
    const std::map<int, std::vector<int>> orders = method_orders(outcomes, people);
    add(BreakdownKind::order_group, [&](const PlacedTrial& placed_trial) {
      return order_group_of(outcomes, orders.at(people.first_of(placed_trial.trial->row.session)));
    });
  }
  if (outcomes.design.visits.count > 1) {
    all.push_back(
        breakdown_by_people(BreakdownKind::visit, trials, [](const PlacedTrial& placed_trial) {
          return Group(placed_trial.trial->visit, std::to_string(placed_trial.trial->visit));
        }));
  }
  const std::vector<std::string>& groups = outcomes.design.groups.labels;
  if (!groups.empty()) {
    all.push_back(
        breakdown_by_people(BreakdownKind::group, trials, [&](const PlacedTrial& placed_trial) {
          const int group = placed_trial.trial->group.value_or(-1);
          return Group(group, group < 0 ? "none" : groups[static_cast<std::size_t>(group)]);
        }));
  }
  return all;
}

std::string name_of(TrialSubset subset) {
  using enum TrialSubset;
  static constexpr auto kNames =
      std::to_array<Named<TrialSubset>>({{"counted", counted},
                                         {"answered", answered},
                                         {"valid", valid},
                                         {"with_excluded_sessions", with_excluded_sessions}});
  return std::string(name_in(kNames, subset));
}

std::vector<SubsetAccuracy> robustness(const Outcomes& outcomes, int method) {
  const std::set<int> excluded = excluded_sessions(outcomes);
  std::vector<SubsetAccuracy> all;
  for (const TrialSubset subset : kSubsets) {
    SubsetAccuracy& accuracy = all.emplace_back();
    accuracy.subset = subset;
    std::map<int, Proportion> by_session;
    for (const TrialOutcome& trial : outcomes.trials) {
      const bool is_scored = trial.scored && trial.stimulus.method == method;
      if (!is_scored || !belongs_to(subset, trial, excluded)) continue;
      accuracy.pooled.add(trial.correct());
      by_session[trial.row.session].add(trial.correct());
    }
    accuracy.mean = mean_of_shares(by_session);
  }
  return all;
}

std::vector<ReactionTimes> reaction_times(const Outcomes& outcomes, int method) {
  std::vector<Times> times(outcomes.classes.size() + 1);
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool is_of_method = trial.counted && trial.stimulus.method == method;
    if (!is_of_method || !trial.response || !trial.row.answered_at) continue;
    times[trial.stimulus.class_index].add(trial.row);
    times.back().add(trial.row);
  }
  std::vector<ReactionTimes> all;
  for (Times& class_times : times) all.push_back(summary_of(std::move(class_times)));
  return all;
}

std::optional<ConfidenceReport> confidence_of(const Outcomes& outcomes, int method) {
  const int levels = outcomes.design.session.confidence_levels;
  if (levels == 0) return std::nullopt;
  const RatedAnswers rated = rated_answers(outcomes, method);
  ConfidenceReport report;
  for (int rating = 1; rating <= levels; ++rating) {
    report.ratings.push_back(accuracy_at(rating, rated));
  }
  std::vector<double> areas;
  for (const auto& [session, answers] : rated) {
    const auto area = type_2_area(answers);
    if (area) areas.push_back(*area);
    report.without_area += area ? 0 : 1;
  }
  report.area = participant_mean(areas);
  return report;
}

}  // namespace touchtrial::choices
