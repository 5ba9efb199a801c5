#include "analysis/choices/people_report.hpp"
#include "protocols/threshold/analysis/measures.hpp"

namespace touchtrial::analysis::threshold {
namespace {

using Json = nlohmann::ordered_json;

/// Right answers, pooled and by participant.
Json right_answers_json(const GuessingTests& answers, double guess) {
  Json object = object_of(answers.pooled, right_measures(false));
  object["guess"] = guess;
  object["participants"] = objects_of(answers.people, right_measures(true));
  return object;
}

Json control_json(const ThresholdReport& report) {
  if (!report.control) return nullptr;
  const SoundReport& control = *report.control;
  Json object = right_answers_json(control, report.guess);
  object["anybody"] = Json::parse(choices::global_null_json(control.global_null));
  object["detectable"] = {{"trials", control.detectable.trials},
                          {"right", control.detectable.right},
                          {"share", figure_json(control.detectable.share)},
                          {"with", choices::kDetectionPower}};
  object["hearers"] = control.hearers;
  object["without_hearers"] = Json::array();
  for (std::size_t i = 0; i < control.without_hearers.size(); ++i) {
    Json entry{{"standard", report.standards[i].words},
               {"participants", control.without_hearers[i].participants}};
    entry.update(object_of(control.without_hearers[i], censored_measures("mean")));
    object["without_hearers"].push_back(std::move(entry));
  }
  return object;
}

Json catch_json(const ThresholdReport& report) {
  if (!report.catches) return nullptr;
  Json object = right_answers_json(*report.catches, report.guess);
  object["attentive"] = choices::kMinCatchAccuracy;
  for (std::size_t i = 0; i < report.attention.size(); ++i) {
    const choices::Attention& attention = report.attention[i];
    object["participants"][i]["attending"] = {
        {"p", attention.p}, {"p_holm", attention.p_holm}, {"doubtful", attention.is_doubtful()}};
  }
  return object;
}

Json same_different_json(const ThresholdReport& report) {
  if (report.has_thresholds()) return nullptr;
  return {{"levels", objects_of(report.same_different, level_measures(report))},
          {"groups", objects_of(report.same_different_groups, group_measures(report))}};
}

Json settings_json(const ThresholdReport& report) {
  const study::threshold::ThresholdOptions& options = report.options();
  return {{"task", study::threshold::name_of(options.task)},
          {"question", study::threshold::name_of(options.question)},
          {"along", study::threshold::name_of(options.along)},
          {"procedure", options.track.procedure},
          {"unit", study::threshold::unit_of_level(options)},
          {"guess", report.guess},
          {"criterion", figure_json(report.criterion)},
          {"levels", options.track.levels},
          {"without_answer", report.without_answer}};
}

}  // namespace

std::string report_json(const ThresholdReport& report) {
  Json members = settings_json(report);
  members["tracks"] = objects_of(report.tracks, track_measures(report));
  members["standards"] = objects_of(report.standards, standard_measures(report));
  members["differences"] = objects_of(report.differences, difference_measures(report));
  members["control"] = control_json(report);
  members["catch"] = catch_json(report);
  members["intervals"] = objects_of(report.choice_use, choice_measures());
  members["preferences"] =
      report.preferences.people.empty()
          ? Json(nullptr)
          : Json::parse(choices::preferences_json(report.preferences, report.choices));
  members["sequence"] = {{"after_right", object_of(report.after_right, repetition_measures())},
                         {"after_wrong", object_of(report.after_wrong, repetition_measures())}};
  members["learning"] = object_of(report.learning_db, test_measures("change_db"));
  members["same_different"] = same_different_json(report);
  return framed_json(report, members.dump());
}

}  // namespace touchtrial::analysis::threshold
