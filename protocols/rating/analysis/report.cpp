#include "protocols/rating/analysis/report.hpp"

#include "analysis/statistics/common.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "protocols/rating/study/rating.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>

namespace touchtrial::analysis::rating {
namespace {

std::vector<Item> items_of(const Outcomes& outcomes) {
  std::vector<Item> items;
  for (int class_index = 0; class_index < static_cast<int>(outcomes.classes.size());
       ++class_index) {
    for (int method = 0; method < static_cast<int>(outcomes.methods.size()); ++method) {
      items.push_back({class_index, method});
    }
  }
  return items;
}

/// One participant's answers on one scale.
RatedParticipant scale_answers(std::size_t scale, const RatedTrials& rated) {
  RatedParticipant participant;
  for (const TrialOutcome* trial : rated.trials) {
    const double value = ratings_of(trial->row.answer)[scale];
    if (trial->scored) {
      participant.scored.push_back({{trial->stimulus.class_index, trial->stimulus.method}, value});
    } else {
      participant.catches.push_back(value);
    }
  }
  return participant;
}

/// A participant's mean of an item; nothing without a rating.
std::optional<double> item_mean_of(const RatedParticipant& participant, const Item& item) {
  std::vector<double> values;
  for (const ItemRating& rating : participant.scored) {
    if (rating.item == item) values.push_back(rating.value);
  }
  return values.empty() ? std::nullopt : std::optional(mean_of(values));
}

/// The means of items by participant; nothing unless the participant rated all items.
std::vector<std::optional<std::vector<double>>> complete_means(
    std::span<const RatedParticipant> participants, std::span<const Item> items) {
  std::vector<std::optional<std::vector<double>>> all;
  for (const RatedParticipant& participant : participants) {
    std::vector<double> means;
    for (const Item& item : items) {
      if (const auto mean = item_mean_of(participant, item)) means.push_back(*mean);
    }
    const bool is_complete = !items.empty() && means.size() == items.size();
    all.push_back(is_complete ? std::optional(std::move(means)) : std::nullopt);
  }
  return all;
}

/// ScaleReport::scatter.
std::vector<std::optional<double>> scatter_of(std::span<const RatedParticipant> participants,
                                              std::span<const Item> items) {
  const auto means = complete_means(participants, items);
  std::vector<double> item_effects(items.size());
  double person_count = 0.0;
  for (const auto& ratings : means) {
    if (!ratings) continue;
    person_count += 1.0;
    const double level = mean_of(*ratings);
    for (std::size_t i = 0; i < items.size(); ++i) item_effects[i] += (*ratings)[i] - level;
  }
  std::vector<std::optional<double>> scatter;
  for (const auto& ratings : means) {
    scatter.emplace_back();
    if (!ratings || person_count < 2.0 || items.size() < 2) continue;
    std::vector<double> residuals;
    for (std::size_t i = 0; i < items.size(); ++i) {
      residuals.push_back(
          without_noise((*ratings)[i] - mean_of(*ratings) - item_effects[i] / person_count));
    }
    scatter.back() = standard_deviation(residuals, 0.0, static_cast<double>(items.size()) - 1.0);
  }
  return scatter;
}

ScaleReport scale_report(const study::Scale& scale, std::size_t index,
                         std::span<const RatedTrials> rated, std::span<const Item> items) {
  std::vector<RatedParticipant> participants;
  for (const RatedTrials& person : rated) participants.push_back(scale_answers(index, person));
  const Interval ends = ends_of(scale);
  ScaleReport report{.scale = scale,
                     .means = rating_means(participants, items, ends),
                     .participant_means = {},
                     .differences = method_differences(participants, items, ends),
                     .agreement = agreement(participants, items),
                     .scatter = scatter_of(participants, items),
                     .retest = retest_reliability(participants, items),
                     .use = scale_use(participants, ends),
                     .catches = catch_comparison(participants, items, ends)};
  for (const ItemMean& item : report.means.items) {
    std::vector<double>& item_means = report.participant_means.emplace_back();
    for (const RatedParticipant& participant : participants) {
      if (const auto mean = item_mean_of(participant, item.item)) item_means.push_back(*mean);
    }
  }
  return report;
}

}  // namespace

Interval ends_of(const study::Scale& scale) {
  return {scale.min(), scale.max()};
}

std::vector<RatedTrials> rated_trials(const Outcomes& outcomes) {
  std::vector<RatedTrials> people;
  std::map<std::string, std::size_t> index_by_name;
  std::set<int> counted;
  for (const SessionOutcome& session : outcomes.sessions) {
    if (!session.counted) continue;
    counted.insert(session.row.session);
    const std::string& name = session.row.participant;
    if (index_by_name.emplace(name, people.size()).second) people.push_back({name, {}});
  }
  for (const TrialOutcome& trial : outcomes.trials) {
    const auto person = index_by_name.find(trial.participant);
    if (person == index_by_name.end() || !counted.contains(trial.row.session)) continue;
    const bool is_catch =
        trial.role == study::Role::catch_trial && trial.row.state == record::TrialState::answered;
    if (!(trial.counted || is_catch) || ratings_of(trial.row.answer).empty()) continue;
    people[person->second].trials.push_back(&trial);
  }
  return people;
}

RatingReport make_report(const Outcomes& outcomes) {
  RatingReport report;
  static_cast<StudyHead&>(report) = head_of(outcomes);
  report.methods = outcomes.methods;
  const std::vector<RatedTrials> rated = rated_trials(outcomes);
  for (const RatedTrials& person : rated) report.people.push_back(person.participant);
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.counted && ratings_of(trial.row.answer).empty()) ++report.without_answer;
  }
  const std::vector<Item> items = items_of(outcomes);
  const std::vector<study::Scale> scales = study::rating::scales_of(outcomes.design);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    report.scales.push_back(scale_report(scales[i], i, rated, items));
  }
  report.warnings = rating_warnings(report);
  return report;
}

}  // namespace touchtrial::analysis::rating
