#include "analysis/report/json_figures.hpp"
#include "protocols/threshold/analysis/report.hpp"

namespace touchtrial::analysis::threshold {
namespace {

using Json = nlohmann::ordered_json;
using procedures::Censored;

Json censored_json(Censored side) {
  if (side == Censored::no) return nullptr;
  return side == Censored::below ? "below" : "above";
}

Json threshold_json(const procedures::Threshold& threshold) {
  return {{"threshold", figure_json(threshold.level)},
          {"low", figure_json(threshold.low)},
          {"high", figure_json(threshold.high)},
          {"censored", censored_json(threshold.censored)}};
}

Json estimate_json(const std::optional<TrackEstimate>& estimate) {
  if (!estimate) return nullptr;
  Json object = threshold_json(estimate->threshold);
  object["slope"] = figure_json(estimate->slope);
  object["lapse"] = figure_json(estimate->lapse);
  return object;
}

Json quantity_json(const Quantity& quantity) {
  if (!quantity.value) return nullptr;
  return {{"fraction", figure_json(quantity.value)},
          {"low", figure_json(quantity.low)},
          {"high", figure_json(quantity.high)}};
}

Json fit_json(const std::optional<procedures::GoodnessOfFit>& fit) {
  if (!fit) return nullptr;
  return {{"deviance", figure_json(fit->deviance)},
          {"p", figure_json(fit->p)},
          {"draws", fit->thresholds.size()}};
}

Json track_json(const ThresholdReport& report, const TrackReport& track) {
  const StandardReport& standard = report.standards[track.standard];
  const std::optional<TrackEstimate>& quoted = report.quoted(track);
  const Quantity weber =
      quoted ? quantity_of(report.options(), standard.of, quoted->threshold) : Quantity{};
  return {{"participant", track.participant},
          {"track", track.track},
          {"standard", standard.words},
          {"trials", track.answers.n},
          {"right", track.answers.correct},
          {"posterior", estimate_json(track.posterior)},
          {"likelihood", estimate_json(track.likelihood)},
          {"reversals", track.reversals ? threshold_json(*track.reversals) : Json(nullptr)},
          {"weber", quantity_json(weber)},
          {"goodness_of_fit", fit_json(track.fit)},
          {"learning_db", figure_json(track.learning_db)}};
}

Json tracks_json(const ThresholdReport& report) {
  Json all = Json::array();
  for (const TrackReport& track : report.tracks) all.push_back(track_json(report, track));
  return all;
}

Json standards_json(const ThresholdReport& report) {
  Json all = Json::array();
  for (const StandardReport& one : report.standards) {
    const auto label = static_cast<std::size_t>(one.of.class_index);
    all.push_back(
        {{"standard", one.words},
         {"class", label < report.classes.size() ? Json(report.classes[label]) : Json(nullptr)},
         {"value", figure_json(one.of.value)},
         {"highest_level", one.levels.empty() ? Json(nullptr) : figure_json(one.levels.back())},
         {"tracks", one.tracks},
         {"n", one.mean.participants},
         {"censored_below", one.censored_below},
         {"censored_above", one.censored_above},
         {"mean", figure_json(one.mean.mean)},
         {"interval", interval_json(one.mean.known_interval())},
         {"sd", figure_json(one.mean.sd)},
         {"weber",
          quantity_json(quantity_of(report.options(), one.of, mean_threshold(one.mean)))}});
  }
  return all;
}

void put_test(Json& object, const std::string& name, const GroupTest& test) {
  object[name] = figure_json(test.mean.mean);
  object["interval"] = interval_json(test.mean.known_interval());
  object["participants"] = test.mean.participants;
  object["p"] = figure_json(test.p);
}

Json differences_json(const ThresholdReport& report) {
  Json all = Json::array();
  for (const DifferenceReport& one : report.differences) {
    Json object{{"first", report.standards[one.first].words},
                {"second", report.standards[one.second].words}};
    put_test(object, "difference", one.difference);
    object["p_holm"] = figure_json(one.p_holm);
    all.push_back(std::move(object));
  }
  return all;
}

Json right_json(const RightAnswers& one) {
  return {{"n", one.answers.n},
          {"right", one.answers.correct},
          {"share", figure_json(one.answers.share())},
          {"interval", interval_json(known(one.interval, one.answers))},
          {"p", figure_json(one.p)}};
}

Json outside_json(const std::optional<OutsideTracks>& outside, double guess) {
  if (!outside) return nullptr;
  Json object = right_json(outside->pooled);
  object["guess"] = guess;
  object["participants"] = Json::array();
  for (const RightAnswers& one : outside->people) {
    Json own{{"participant", one.participant}};
    own.update(right_json(one));
    own["p_holm"] = figure_json(one.p_holm);
    object["participants"].push_back(std::move(own));
  }
  return object;
}

Json choices_json(const ThresholdReport& report) {
  Json all = Json::array();
  for (const ChoiceUse& one : report.choice_use) {
    Json object{{"choice", one.choice}, {"named", one.named}, {"targets", one.targets}};
    put_test(object, "difference", one.excess);
    all.push_back(std::move(object));
  }
  return all;
}

Json repetition_json(const Repetition& one) {
  Json object{{"n", one.repeats.n},
              {"repeats", one.repeats.correct},
              {"share", figure_json(one.repeats.share())},
              {"expected", figure_json(one.expected)}};
  put_test(object, "difference", one.excess);
  return object;
}

Json counts_json(const Proportion& of) {
  return {{"n", of.n}, {"said_different", of.correct}};
}

Json level_json(const ThresholdReport& report, const SameDifferentLevel& one) {
  return {{"participant", one.participant.empty() ? Json(nullptr) : Json(one.participant)},
          {"standard", report.standards[one.standard].words},
          {"level", one.level},
          {"different", counts_json(one.different)},
          {"same", counts_json(one.same)},
          {"same_at_all_levels", counts_json(one.same_at_all)},
          {"d_prime_differencing", figure_json(one.d_differencing)},
          {"d_prime_independent", figure_json(one.d_independent)}};
}

Json mean_json(const MeanEstimate& mean) {
  return {{"participants", mean.participants},
          {"mean", figure_json(mean.mean)},
          {"interval", interval_json(mean.known_interval())}};
}

Json same_different_json(const ThresholdReport& report) {
  if (report.has_thresholds()) return nullptr;
  Json levels = Json::array();
  for (const SameDifferentLevel& one : report.same_different) {
    levels.push_back(level_json(report, one));
  }
  Json groups = Json::array();
  for (const SameDifferentGroup& one : report.same_different_groups) {
    groups.push_back({{"standard", report.standards[one.standard].words},
                      {"level", one.level},
                      {"differencing", mean_json(one.differencing)},
                      {"independent", mean_json(one.independent)}});
  }
  return {{"levels", std::move(levels)}, {"groups", std::move(groups)}};
}

Json settings_json(const ThresholdReport& report) {
  const study::threshold::ThresholdOptions& options = report.options();
  const Json quoted = report.by_posterior ? "posterior" : "likelihood";
  return {{"task", study::threshold::name_of(options.task)},
          {"question", study::threshold::name_of(options.question)},
          {"along", study::threshold::name_of(options.along)},
          {"procedure", options.track.procedure},
          {"unit", study::threshold::unit_of_level(options)},
          {"guess", report.guess},
          {"criterion", figure_json(report.criterion)},
          {"quoted", report.has_thresholds() ? quoted : Json(nullptr)},
          {"levels", options.track.levels},
          {"without_answer", report.without_answer}};
}

}  // namespace

std::string report_json(const ThresholdReport& report) {
  Json members = settings_json(report);
  members["tracks"] = tracks_json(report);
  members["standards"] = standards_json(report);
  members["differences"] = differences_json(report);
  members["control"] = outside_json(report.control, report.guess);
  members["catch"] = outside_json(report.catches, report.guess);
  members["intervals"] = choices_json(report);
  members["sequence"] = {{"after_right", repetition_json(report.after_right)},
                         {"after_wrong", repetition_json(report.after_wrong)}};
  members["learning"] = Json::object();
  put_test(members["learning"], "change_db", report.learning_db);
  members["same_different"] = same_different_json(report);
  return framed_json(report, members.dump());
}

}  // namespace touchtrial::analysis::threshold
