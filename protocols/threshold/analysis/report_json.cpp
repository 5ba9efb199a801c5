#include "analysis/choices/people_report.hpp"
#include "analysis/report/json_figures.hpp"
#include "core/named.hpp"
#include "protocols/threshold/analysis/report.hpp"

#include <array>

namespace touchtrial::analysis::threshold {
namespace {

using Json = nlohmann::ordered_json;
using procedures::Censored;

Json threshold_json(const procedures::Threshold& threshold) {
  const std::string_view censored = word_of(threshold.censored);
  return {{"threshold", figure_json(threshold.level)},
          {"low", figure_json(threshold.low)},
          {"high", figure_json(threshold.high)},
          {"censored", censored.empty() ? Json(nullptr) : Json(censored)}};
}

/// The bounds as which a track counts in its participant's.
Json in_mean_json(const TrackReport& track, const StandardReport& standard) {
  if (!track.estimate) return nullptr;
  const Bounds bounds = bounds_of(*track.estimate, standard.levels);
  return interval_json(Interval{bounds.low, bounds.high});
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
  const Quantity weber = track.estimate
                             ? quantity_of(report.options(), standard.of, track.estimate->threshold)
                             : Quantity{};
  return {{"participant", track.participant},
          {"track", track.track},
          {"standard", standard.words},
          {"trials", track.answers.n},
          {"right", track.answers.correct},
          {"catch", {{"n", track.catches.n}, {"right", track.catches.correct}}},
          {"estimate", track.estimate ? threshold_json(track.estimate->threshold) : Json(nullptr)},
          {"in_mean", in_mean_json(track, standard)},
          {"reversals", track.reversals ? threshold_json(*track.reversals) : Json(nullptr)},
          {"weber", quantity_json(weber)},
          {"goodness_of_fit", fit_json(track.fit)},
          {"learning_db", figure_json(track.learning_db)}};
}

/// Adds mean, interval, standard deviation and median, and what keeps the first two away.
void put_censored(Json& object, const std::string& name, const CensoredMean& mean) {
  using enum Lack;
  static constexpr auto kLacks = std::to_array<Named<Lack>>(
      {{"few known", values}, {"most censored", most}, {"all alike", spread}});
  object[name] = figure_json(mean.mean);
  object["interval"] = interval_json(mean.interval);
  object["lack"] = mean.lack == nothing ? Json(nullptr) : Json(name_in(kLacks, mean.lack));
  object["sd"] = figure_json(mean.sd);
  object["median"] = figure_json(mean.median);
  object["median_within"] =
      interval_json(Interval{mean.median_within.low, mean.median_within.high});
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
      {"known", one.number_of(Censored::no)},
      {"below", one.number_of(Censored::below)},
      {"above", one.number_of(Censored::above)},
      {"undetermined", one.number_of(Censored::undetermined)}};
  put_censored(object, "mean", one.mean);
  object["weber"] = quantity_json(quantity_of(report.options(), one.of, mean_threshold(one.mean)));
  return object;
}

void put_test(Json& object, const std::string& name, const GroupTest& test) {
  object[name] = figure_json(test.mean.mean);
  object["interval"] = interval_json(test.mean.known_interval());
  object["participants"] = test.mean.participants;
  object["p"] = figure_json(test.p);
  object["test"] = !test.p ? Json(nullptr) : Json(test.alike ? "sign flips" : "t");
}

Json difference_json(const ThresholdReport& report, const DifferenceReport& one) {
  Json object{{"first", report.standards[one.first].words},
              {"second", report.standards[one.second].words}};
  put_censored(object, "difference", one.difference);
  object["participants"] = one.difference.participants;
  object["known"] = one.difference.exact;
  object["p"] = figure_json(one.p);
  object["p_holm"] = figure_json(one.p_holm);
  object["statistic"] = statistic_json(one.statistic);
  return object;
}

Json right_json(const RightAnswers& one) {
  return {{"n", one.answers.n},
          {"right", one.answers.correct},
          {"share", figure_json(one.answers.share())},
          {"interval", interval_json(known(one.interval, one.answers))},
          {"p", figure_json(one.p)}};
}

Json outside_json(const AgainstGuessing& outside, double guess) {
  Json object = right_json(outside.pooled);
  object["guess"] = guess;
  object["participants"] = array_json(outside.people, [](const RightAnswers& one) {
    Json own{{"participant", one.participant}};
    own.update(right_json(one));
    own["p_holm"] = figure_json(one.p_holm);
    return own;
  });
  return object;
}

Json control_json(const ThresholdReport& report) {
  if (!report.control) return nullptr;
  const SoundReport& control = *report.control;
  Json object = outside_json(control, report.guess);
  object["anybody"] = Json::parse(choices::anybody_json(control.anybody));
  object["detectable"] = {{"trials", control.detectable.trials},
                          {"right", control.detectable.right},
                          {"share", figure_json(control.detectable.share)},
                          {"with", choices::kFoundWith}};
  object["hearers"] = control.hearers;
  object["without_hearers"] = Json::array();
  for (std::size_t i = 0; i < control.without.size(); ++i) {
    Json one{{"standard", report.standards[i].words},
             {"participants", control.without[i].participants}};
    put_censored(one, "mean", control.without[i]);
    object["without_hearers"].push_back(std::move(one));
  }
  return object;
}

Json catch_json(const ThresholdReport& report) {
  if (!report.catches) return nullptr;
  Json object = outside_json(*report.catches, report.guess);
  object["attentive"] = choices::kAttentive;
  for (std::size_t i = 0; i < report.attention.size(); ++i) {
    const choices::Attention& one = report.attention[i];
    object["participants"][i]["attending"] = {
        {"p", one.p}, {"p_holm", one.p_holm}, {"doubtful", one.is_doubtful()}};
  }
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

Json pooled_json(const PooledDPrime& pooled) {
  return {{"d_prime", figure_json(pooled.d_prime)}, {"interval", interval_json(pooled.interval)}};
}

Json same_different_json(const ThresholdReport& report) {
  if (report.has_thresholds()) return nullptr;
  Json levels = array_json(report.same_different,
                           [&](const SameDifferentLevel& one) { return level_json(report, one); });
  Json groups = array_json(report.same_different_groups, [&](const SameDifferentGroup& one) {
    return Json{{"standard", report.standards[one.standard].words},
                {"level", one.level},
                {"participants", one.participants},
                {"differencing", pooled_json(one.differencing)},
                {"independent", pooled_json(one.independent)}};
  });
  return {{"levels", std::move(levels)}, {"groups", std::move(groups)}};
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
  const auto of_report = [&](auto one_json) {
    return [&report, one_json](const auto& one) { return one_json(report, one); };
  };
  members["tracks"] = array_json(report.tracks, of_report(track_json));
  members["standards"] = array_json(report.standards, of_report(standard_json));
  members["differences"] = array_json(report.differences, of_report(difference_json));
  members["control"] = control_json(report);
  members["catch"] = catch_json(report);
  members["intervals"] = array_json(report.choice_use, choice_json);
  members["preferences"] =
      report.preferences.people.empty()
          ? Json(nullptr)
          : Json::parse(choices::preferences_json(report.preferences, report.choices));
  members["sequence"] = {{"after_right", repetition_json(report.after_right)},
                         {"after_wrong", repetition_json(report.after_wrong)}};
  members["learning"] = Json::object();
  put_test(members["learning"], "change_db", report.learning_db);
  members["same_different"] = same_different_json(report);
  return framed_json(report, members.dump());
}

}  // namespace touchtrial::analysis::threshold
