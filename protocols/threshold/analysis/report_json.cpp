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

Json standard_json(const ThresholdReport& report, const StandardReport& one) {
  const auto label = static_cast<std::size_t>(one.of.class_index);
  Json object{
      {"standard", one.words},
      {"class", label < report.classes.size() ? Json(report.classes[label]) : Json(nullptr)},
      {"value", figure_json(one.of.value)},
      {"highest_level", one.levels.empty() ? Json(nullptr) : figure_json(one.levels.back())},
      {"tracks", one.tracks},
      {"n", one.mean.participants},
      {"censored_below", one.censored_below},
      {"censored_above", one.censored_above}};
  put_mean(object, one.mean);
  object["sd"] = figure_json(one.mean.sd);
  object["weber"] = quantity_json(quantity_of(report.options(), one.of, mean_threshold(one.mean)));
  return object;
}

void put_test(Json& object, const std::string& name, const GroupTest& test) {
  object[name] = figure_json(test.mean.mean);
  object["interval"] = interval_json(test.mean.known_interval());
  object["participants"] = test.mean.participants;
  object["p"] = figure_json(test.p);
}

Json difference_json(const ThresholdReport& report, const DifferenceReport& one) {
  Json object{{"first", report.standards[one.first].words},
              {"second", report.standards[one.second].words}};
  put_test(object, "difference", one.difference);
  object["p_holm"] = figure_json(one.p_holm);
  return object;
}

Json right_json(const RightAnswers& one) {
  return {{"n", one.answers.n},
          {"right", one.answers.correct},
          {"share", figure_json(one.answers.share())},
          {"interval", interval_json(known(one.interval, one.answers))},
          {"p", figure_json(one.p)}};
}

Json outside_json(const std::optional<AgainstGuessing>& outside, double guess) {
  if (!outside) return nullptr;
  Json object = right_json(outside->pooled);
  object["guess"] = guess;
  object["participants"] = array_json(outside->people, [](const RightAnswers& one) {
    Json own{{"participant", one.participant}};
    own.update(right_json(one));
    own["p_holm"] = figure_json(one.p_holm);
    return own;
  });
  return object;
}

Json choice_json(const ChoiceUse& one) {
  Json object{{"choice", one.choice}, {"named", one.named}, {"targets", one.targets}};
  put_test(object, "difference", one.excess);
  return object;
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
  Json object{{"participants", mean.participants}};
  put_mean(object, mean);
  return object;
}

Json same_different_json(const ThresholdReport& report) {
  if (report.has_thresholds()) return nullptr;
  Json levels = array_json(report.same_different,
                           [&](const SameDifferentLevel& one) { return level_json(report, one); });
  Json groups = array_json(report.same_different_groups, [&](const SameDifferentGroup& one) {
    return Json{{"standard", report.standards[one.standard].words},
                {"level", one.level},
                {"differencing", mean_json(one.differencing)},
                {"independent", mean_json(one.independent)}};
  });
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
  const auto of_report = [&](auto one_json) {
    return [&report, one_json](const auto& one) { return one_json(report, one); };
  };
  members["tracks"] = array_json(report.tracks, of_report(track_json));
  members["standards"] = array_json(report.standards, of_report(standard_json));
  members["differences"] = array_json(report.differences, of_report(difference_json));
  members["control"] = outside_json(report.control, report.guess);
  members["catch"] = outside_json(report.catches, report.guess);
  members["intervals"] = array_json(report.choice_use, choice_json);
  members["sequence"] = {{"after_right", repetition_json(report.after_right)},
                         {"after_wrong", repetition_json(report.after_wrong)}};
  members["learning"] = Json::object();
  put_test(members["learning"], "change_db", report.learning_db);
  members["same_different"] = same_different_json(report);
  return framed_json(report, members.dump());
}

}  // namespace touchtrial::analysis::threshold
