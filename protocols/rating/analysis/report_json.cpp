#include "analysis/report/json_figures.hpp"
#include "protocols/rating/analysis/report.hpp"

namespace touchtrial::analysis::rating {
namespace {

using Json = nlohmann::ordered_json;

/// Adds participants, mean, interval and sd.
void put_estimate(Json& object, const MeanEstimate& mean) {
  object["participants"] = mean.participants;
  put_mean(object, mean);
  object["sd"] = figure_json(mean.sd);
}

Json items_json(const RatingReport& report, const ScaleReport& scale) {
  Json all = Json::array();
  for (const ItemMean& one : scale.means.items) {
    Json object{{"class", report.classes[static_cast<std::size_t>(one.item.texture_class)]},
                {"method", report.methods[static_cast<std::size_t>(one.item.method)]}};
    put_estimate(object, one.mean);
    all.push_back(std::move(object));
  }
  return all;
}

Json groups_json(const char* key, const std::vector<std::string>& labels,
                 const std::vector<GroupMean>& means) {
  Json all = Json::array();
  for (const GroupMean& one : means) {
    Json object{{key, labels[static_cast<std::size_t>(one.group)]}, {"items", one.items}};
    put_estimate(object, one.mean);
    all.push_back(std::move(object));
  }
  return all;
}

Json d_z_json(const std::optional<StandardisedDifference>& one) {
  if (!one) return nullptr;
  const auto& jackknifed = one->jackknifed;
  return {{"estimate", figure_json(one->d_z)},
          {"interval", interval_json(one->interval)},
          {"jackknife", jackknifed ? Json{{"estimate", figure_json(jackknifed->value)},
                                          {"interval", interval_json(jackknifed->interval)}}
                                   : Json(nullptr)}};
}

Json differences_json(const RatingReport& report, const ScaleReport& scale) {
  const auto p_of = [](const std::optional<FamilyP>& test) {
    return figure_json(test ? std::optional(test->p) : std::nullopt);
  };
  const auto holm_of = [](const std::optional<FamilyP>& test) {
    return figure_json(test ? std::optional(test->holm) : std::nullopt);
  };
  Json all = Json::array();
  for (const MethodDifference& one : scale.differences) {
    all.push_back({{"first", report.methods[static_cast<std::size_t>(one.first)]},
                   {"second", report.methods[static_cast<std::size_t>(one.second)]},
                   {"classes", one.classes},
                   {"participants", one.difference.participants},
                   {"difference", figure_json(one.difference.mean)},
                   {"interval", interval_json(one.difference.known_interval())},
                   {"sd", figure_json(one.difference.sd)},
                   {"p", p_of(one.sign_flip)},
                   {"p_holm", holm_of(one.sign_flip)},
                   {"t", figure_json(one.t)},
                   {"t_p", p_of(one.t_test)},
                   {"t_p_holm", holm_of(one.t_test)},
                   {"d_z", d_z_json(one.standardised)}});
  }
  return all;
}

Json correlation_json(const std::optional<IntraclassCorrelation>& one) {
  if (!one) return nullptr;
  return {{"estimate", figure_json(one->estimate)}, {"interval", interval_json(one->interval)}};
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
  Json object{{"participants", retest.participants},
              {"mean", figure_json(retest.mean)},
              {"interval", interval_json(retest.interval)},
              {"cut", retest.cut}};
  object["own"] = quartiles_json(retest.quartiles);
  return object;
}

Json use_json(const RatingReport& report, const ScaleReport& scale) {
  Json people = Json::array();
  for (std::size_t i = 0; i < report.people.size(); ++i) {
    const ScaleUse& one = scale.use.participants[i];
    people.push_back({{"participant", report.people[i]},
                      {"n", one.at_low.n},
                      {"at_low", one.at_low.correct},
                      {"at_high", one.at_high.correct},
                      {"mean", figure_json(one.mean)},
                      {"sd", figure_json(one.sd)},
                      {"distinct", one.distinct},
                      {"narrow", one.narrow},
                      {"scatter", figure_json(scale.scatter[i])},
                      {"retest", figure_json(scale.retest.own[i])}});
  }
  return {{"n", scale.use.at_low.n},
          {"at_low", scale.use.at_low.correct},
          {"at_high", scale.use.at_high.correct},
          {"narrow", scale.use.narrow},
          {"participants", std::move(people)}};
}

Json catches_json(const RatingReport& report, const CatchComparison& catches) {
  if (catches.participants.empty()) return nullptr;
  Json object;
  put_estimate(object, catches.catches);
  object["difference"] = figure_json(catches.difference.mean);
  object["difference_interval"] = interval_json(catches.difference.known_interval());
  object["not_lower"] = catches.not_lower;
  object["per_participant"] = Json::array();
  for (const CatchRating& one : catches.participants) {
    object["per_participant"].push_back(
        {{"participant", report.people[static_cast<std::size_t>(one.participant)]},
         {"catch", figure_json(one.catches)},
         {"scored", figure_json(one.scored)}});
  }
  return object;
}

Json scale_json(const RatingReport& report, const ScaleReport& scale) {
  return {{"id", scale.scale.id},
          {"text", scale.scale.text},
          {"low", scale.scale.low},
          {"high", scale.scale.high},
          {"points", scale.scale.points},
          {"items", items_json(report, scale)},
          {"methods", groups_json("method", report.methods, scale.means.methods)},
          {"classes", groups_json("class", report.classes, scale.means.classes)},
          {"differences", differences_json(report, scale)},
          {"agreement", agreement_json(scale.agreement)},
          {"retest", retest_json(scale.retest)},
          {"use", use_json(report, scale)},
          {"catch", catches_json(report, scale.catches)}};
}

}  // namespace

std::string report_json(const RatingReport& report) {
  Json members{{"methods", report.methods}, {"without_answer", report.without_answer}};
  members["scales"] = Json::array();
  for (const ScaleReport& scale : report.scales) {
    members["scales"].push_back(scale_json(report, scale));
  }
  return framed_json(report, members.dump());
}

}  // namespace touchtrial::analysis::rating
