#include "analysis/statistics/d_prime.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <map>

namespace touchtrial::analysis::identification {
namespace {

using RatedAnswers = std::map<int, std::vector<RatedAnswer>>;  ///< by session

RatedAnswers rated_answers(const Outcomes& outcomes, int method) {
  RatedAnswers rated;
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool asked = trial.counted && trial.stimulus.method == method;
    if (!asked || !trial.response || !trial.row.confidence) continue;
    rated[trial.row.session].push_back({*trial.row.confidence, trial.correct()});
  }
  return rated;
}

RatedAccuracy accuracy_at(int rating, const RatedAnswers& rated) {
  RatedAccuracy at{rating, {}, {}};
  std::vector<double> shares;
  for (const auto& [session, answers] : rated) {
    Proportion own;
    for (const RatedAnswer& one : answers) {
      if (one.rating != rating) continue;
      ++own.n;
      if (one.correct) ++own.correct;
    }
    at.accuracy.n += own.n;
    at.accuracy.correct += own.correct;
    if (const auto share = own.share()) shares.push_back(*share);
  }
  at.mean = participant_mean(shares);
  return at;
}

}  // namespace

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

}  // namespace touchtrial::analysis::identification
