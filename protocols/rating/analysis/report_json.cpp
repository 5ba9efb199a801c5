#include "protocols/rating/analysis/measures.hpp"

namespace touchtrial::analysis::rating {
namespace {

using Json = nlohmann::ordered_json;

/// Adds participants, mean, interval and sd.
void put_estimate(Json& object, const MeanEstimate& mean) {
  object["participants"] = mean.participants;
  put_mean(object, mean);
  object["sd"] = figure_json(mean.sd);
}

Json correlation_json(const std::optional<IntraclassCorrelation>& correlation) {
  if (!correlation) return nullptr;
  return {{"estimate", figure_json(correlation->estimate)},
          {"interval", interval_json(correlation->interval)}};
}

Json mean_squares_json(const std::optional<TwoWayMeanSquares>& squares) {
  if (!squares) return nullptr;
  return {{"items", figure_json(squares->between_rows)},
          {"participants", figure_json(squares->between_columns)},
          {"residual", figure_json(squares->residual)}};
}

Json agreement_json(const Agreement& agreement) {
  return {{"items", agreement.items},
          {"participants", agreement.participants},
          {"left_out", agreement.left_out},
          {"single", correlation_json(agreement.single)},
          {"average", correlation_json(agreement.average)},
          {"mean_squares", mean_squares_json(agreement.mean_squares)}};
}

Json retest_json(const RetestReliability& retest) {
  return {{"participants", retest.participants},
          {"mean", figure_json(retest.mean)},
          {"interval", interval_json(retest.interval)},
          {"cut", retest.clamped},
          {"own", quartiles_json(retest.quartiles)}};
}

Json use_json(const RatingReport& report, const ScaleReport& scale) {
  return {{"n", scale.use.at_low.n},
          {"at_low", scale.use.at_low.correct},
          {"at_high", scale.use.at_high.correct},
          {"narrow", scale.use.narrow_count},
          {"participants", objects_of(people_indices(report), use_measures(report, scale))}};
}

Json catches_json(const RatingReport& report, const CatchComparison& catches) {
  if (catches.participants.empty()) return nullptr;
  Json object;
  put_estimate(object, catches.catches);
  object["difference"] = figure_json(catches.difference.mean);
  object["difference_interval"] = interval_json(catches.difference.known_interval());
  object["not_lower"] = catches.not_lower;
  object["per_participant"] = objects_of(catches.participants, catch_measures(report));
  return object;
}

Json scale_json(const RatingReport& report, const ScaleReport& scale) {
  return {{"id", scale.scale.id},
          {"text", scale.scale.text},
          {"low", scale.scale.low},
          {"high", scale.scale.high},
          {"points", scale.scale.points},
          {"items", objects_of(scale.means.items, item_measures(report))},
          {"methods", objects_of(scale.means.methods, group_measures("method", report.methods))},
          {"classes", objects_of(scale.means.classes, group_measures("class", report.classes))},
          {"differences", objects_of(scale.differences, difference_measures(report))},
          {"agreement", agreement_json(scale.agreement)},
          {"retest", retest_json(scale.retest)},
          {"use", use_json(report, scale)},
          {"catch", catches_json(report, scale.catches)}};
}

}  // namespace

std::string report_json(const RatingReport& report) {
  Json members{{"methods", report.methods}, {"without_answer", report.without_answer}};
  members["scales"] = array_json(
      report.scales, [&](const ScaleReport& scale) { return scale_json(report, scale); });
  return framed_json(report, members.dump());
}

}  // namespace touchtrial::analysis::rating
