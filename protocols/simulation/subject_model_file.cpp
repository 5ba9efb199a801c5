/// \file Subject files: describes every key for reading, writing and the schema.
#include "core/describe.hpp"
#include "core/files.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "protocols/simulation/subject_schema.hpp"

#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial::simulation {
namespace {

constexpr NumberRange kNoise{0.0, 10.0};
constexpr NumberRange kSpread{0.0, 3.0};
constexpr NumberRange kShare{0.0, 1.0};
constexpr NumberRange kLogOdds{-100.0, 100.0};
constexpr NumberRange kLogOddsSpread{0.0, 10.0};
constexpr NumberRange kSpeedMmS{1.0, 1000.0};
constexpr NumberRange kMedianS{0.01, 60.0};
constexpr std::size_t kMaxLabels = 64;

using Sense = std::optional<engine::ThresholdCurve>;
constexpr std::array kSenses{Named<Sense>{"flat", {}},
                             Named<Sense>{"israr_2006", engine::ThresholdCurve::israr_2006},
                             Named<Sense>{"tan_1994", engine::ThresholdCurve::tan_1994}};
constexpr std::array kHands{Named<device::HandKind>{"point_mass", device::HandKind::point_mass},
                            Named<device::HandKind>{"stylus_grip", device::HandKind::stylus_grip}};
constexpr std::array kTrainings{Named<Training>{"shared", Training::shared},
                                Named<Training>{"own", Training::own}};

void describe_class_bias(ObjectIo& io, ClassBias& bias) {
  io.text("label", bias.label, {}, {.meaning = "label of the class", .required = true});
  io.number("log_odds", bias.log_odds, kLogOdds,
            {.meaning = "preference for its picture over the others", .required = true});
}

void describe_bias(ObjectIo& io, SubjectModel& model) {
  io.number("position", model.position_bias, kLogOdds,
            {.meaning = "preference for the first picture over the last, decreasing linearly",
             .unit = "log odds"});
  io.number("position_spread", model.position_bias_spread, kLogOddsSpread,
            {.meaning = "SD of `position`", .unit = "log odds"});
  io.list("classes", model.class_bias, {.max = kMaxLabels},
          {.meaning = "preference for the pictures of some classes over the others: a list of "
                      "`label`, `log_odds`"},
          [](ValueIo& item, ClassBias& bias) { item.part(bias, describe_class_bias); });
  io.number("class_spread", model.class_bias_spread, kLogOddsSpread,
            {.meaning = "SD of the preference for each class", .unit = "log odds"});
}

void describe_pair(ValueIo& io, std::pair<std::string, std::string>& pair) {
  std::vector<std::string> labels = {pair.first, pair.second};
  io.list(labels, {.min = 2, .max = 2},
          [](ValueIo& item, std::string& label) { item.text(label, {}); });
  pair = {labels[0], labels[1]};
}

void refuse_second_swap(const JsonValue& place, const SubjectModel& model) {
  std::set<std::string> used;
  for (std::size_t i = 0; i < model.label_swap.size(); ++i) {
    const auto& [first, second] = model.label_swap[i];
    for (const std::string* label : {&first, &second}) {
      if (used.insert(*label).second) continue;
      place.refuse_below(
          "/label_swap/" + std::to_string(i) + (label == &first ? "/0" : "/1"),
          "the label " + in_quotes(*label) + " is in two pairs; use each label in one pair only");
    }
  }
}

void describe_hand(ObjectIo& io, SubjectModel& model) {
  io.choice("model", model.hand, kHands,
            {"the grip of the stylus: a mass on a spring and a damper, or the grip that Fu and "
             "Cavusoglu measured: [hands](devices/hands.md)"});
  io.number("spread", model.hand_spread, {0.0, 1.0},
            {"stiffness, damping and mass of the hand, each times exp(spread · z)"});
}

void describe_learning(ObjectIo& io, Learning& learning) {
  io.number("factor", learning.factor, {1.0, 10.0},
            {"factor on the noise of the first presentation; A = ln(factor) exp(spread · z)"});
  io.number("trials", learning.trials, {1.0, 10'000.0},
            {"presentations after which A has fallen to A / e; n counts all presentations so far, "
             "including lead-ins, catch trials and earlier visits"});
  io.number("forgotten", learning.forgotten, kShare,
            {"share of n that is forgotten after each visit"});
  io.number("spread", learning.spread, kSpread, {"spread of A"});
}

void describe_serial(ObjectIo& io, SerialDependence& serial) {
  constexpr NumberRange kLeaning{-10.0, 10.0};
  io.number("answer", serial.answer, kLeaning,
            {.meaning = "added to the picture answered in the previous trial; above 0: repetition",
             .unit = "log odds"});
  io.number("answer_spread", serial.answer_spread, kLogOddsSpread,
            {.meaning = "SD of `answer`", .unit = "log odds"});
  io.number("stimulus", serial.stimulus, kLeaning,
            {.meaning = "added to the picture of the class presented in the previous trial",
             .unit = "log odds"});
  io.number("stimulus_spread", serial.stimulus_spread, kLogOddsSpread,
            {.meaning = "SD of `stimulus`", .unit = "log odds"});
}

void describe_fatigue(ObjectIo& io, Fatigue& fatigue) {
  io.number("noise_per_min", fatigue.noise_per_min, kShare,
            {"added to the log of noise per minute of exploration, t, since the visit began"});
  io.number("lapse_per_min", fatigue.lapse_per_min, {0.0, 10.0},
            {.meaning = "added to the log odds of a lapse per minute of exploration",
             .unit = "log odds/min"});
  io.number("recovered", fatigue.recovered, kShare, {"share of t that a break removes"});
}

void describe_thought(ObjectIo& io, ThoughtTime& thought) {
  io.number("shift_s", thought.shift_s, {0.0, 60.0}, {"minimum"});
  io.number("easy_s", thought.easy_s, kMedianS,
            {"median above the shift if one picture is clearly best; at most `hard_s`"});
  io.number("hard_s", thought.hard_s, kMedianS,
            {"median above the shift if two pictures are equally good"});
  io.number("margin", thought.margin, {0.01, 100.0},
            {.meaning = "margin m at which the additional time of `hard_s` has fallen to 1/e",
             .unit = "log odds"});
  io.number("spread", thought.spread, kSpread, {"standard deviation of the log time"});
  io.number("longest_s", thought.max_s, {0.1, 600.0}, {"maximum; more than `shift_s`"});
  io.rule([&thought](const JsonValue& place, const JsonObject& /*object*/) {
    if (thought.hard_s < thought.easy_s) {
      place.refuse("hard_s is less than easy_s; raise hard_s, or lower easy_s");
    }
    if (thought.max_s <= thought.shift_s) {
      place.refuse("longest_s must be greater than shift_s; raise longest_s");
    }
  });
}

void describe_given_function(ObjectIo& io, GivenFunction& function) {
  io.number("threshold", function.threshold, {-200.0, 200.0},
            {.meaning = "median over participants, in units of the level", .required = true});
  io.number("spread", function.spread, {0.0, 100.0}, {"SD of the threshold"});
  io.number("standard_step", function.standard_step, {-100.0, 100.0},
            {"threshold of each standard minus that of the previous one"});
  io.number("standard_spread", function.standard_spread, {0.0, 100.0},
            {"SD of participants' deviations at each standard"});
  io.number("slope", function.slope, {0.0, 1000.0, true},
            {.meaning = "slope of a function of the shape in the study's grid", .required = true});
  io.number("lapse", function.lapse, {0.0, 0.5, false, true},
            {"probability of a wrong answer at any level"});
}

void describe_paths(ObjectIo& io, SubjectModel& model) {
  io.number("explore_s", model.explore_s, {0.5, 600.0},
            {"exploration time of a trial and of a training presentation"});
  io.number("push_n", model.push_n, {0.1, 3.0}, {"constant push on the plane"});
  io.number("slowest_mm_s", model.slowest_mm_s, kSpeedMmS,
            {"slowest stroke; at most `fastest_mm_s`"});
  io.number("fastest_mm_s", model.fastest_mm_s, kSpeedMmS, {"fastest stroke"});
  io.rule([&model](const JsonValue& place, const JsonObject& object) {
    if (model.slowest_mm_s <= model.fastest_mm_s) return;
    place.refuse_below(object.find("slowest_mm_s") ? "/slowest_mm_s" : "/fastest_mm_s",
                       "slowest_mm_s is greater than fastest_mm_s; swap the two speeds");
  });
}

void describe(ObjectIo& io, SubjectModel& model) {
  io.choice(
      "sense", model.sense, kSenses,
      {"`flat`: feels the servo's forces above 2 mN; `israr_2006` (more sensitive), `tan_1994` "
       "(conservative): feels the tip's accelerations above the thresholds of that "
       "[published curve](perception.md)"});
  io.number("threshold_spread_db", model.threshold_spread_db, {0.0, 40.0},
            {"a person's thresholds are lower by spread · z dB; no effect on `flat`"});
  io.number("feature_noise", model.feature_noise, kNoise,
            {"SD of independent noise on the log of each felt intensity"});
  io.number("common_noise", model.common_noise, kNoise,
            {"SD of noise common to all intensities of a presentation"});
  io.number("feature_noise_spread", model.feature_noise_spread, kSpread,
            {"both noises are multiplied by exp(spread · z)"});
  io.number("lapse", model.lapse, kShare, {"probability of a random answer"});
  io.number("lapse_spread", model.lapse_spread, kSpread,
            {.meaning = "SD of the lapse's log odds; a lapse of 0 or 1 does not vary",
             .unit = "log odds"});
  io.part("bias", model, {"preferences for pictures, independent of felt features"}, describe_bias);
  io.list("label_swap", model.label_swap, {.max = kMaxLabels},
          {.meaning =
               "pairs of labels whose pictures participants swap; each label in at most one pair",
           .range = "pairs of labels"},
          describe_pair);
  io.rule([&model](const JsonValue& place, const JsonObject& /*object*/) {
    refuse_second_swap(place, model);
  });
  describe_paths(io, model);
  io.part("hand", model, {"how participants hold the stylus"}, describe_hand);
  io.integer("training_passes", model.training_passes, 1, 1000,
             {"explorations of each stimulus before the first trial"});
  io.choice("training", model.training, kTrainings,
            {"`shared`: all participants remember the same explorations of each stimulus; `own`: "
             "each participant remembers different ones: [Training](#training)"});
  io.number("memory_noise", model.memory_noise, kNoise, {"error of each remembered log intensity"});
  io.part("learning", model.learning,
          {"noise is larger at first; its log decreases with the number of presentations"},
          describe_learning);
  io.number(
      "period_noise_spread", model.period_noise_spread, kSpread,
      {"SD of the log of noise between blocks and visits of a participant, each with its own z"});
  io.part("serial", model.serial, {"effect of the previous trial on the choice of picture"},
          describe_serial);
  io.part("fatigue", model.fatigue, {"effect of each minute of exploration"}, describe_fatigue);
  io.optional(
      "thought", model.thought,
      {"thinking time: `shift_s` plus a lognormal time; without this key, uniform from 0.8 to 4 s"},
      [](ValueIo& value, ThoughtTime& thought) { value.part(thought, describe_thought); });
  io.optional("given_function", model.given_function,
              {"for threshold studies: [observers who answer by a "
               "function](thresholds.md#simulated-participants), independent of felt features"},
              [](ValueIo& value, GivenFunction& function) {
                value.part(function, describe_given_function);
              });
}

}  // namespace

std::string_view name_of_sense(const Sense& sense) noexcept {
  return name_in(kSenses, sense);
}

SubjectModel parse_subject_model(std::string_view text, const std::string& source) {
  SubjectModel model;
  model.source = source;
  read_settings(parse_strict_json(text, source), [&](ObjectIo& io) { describe(io, model); });
  return model;
}

SubjectModel load_subject_model(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes = 1U << 20U;
  const Bytes content = read_file(path, kMaxBytes);
  return parse_subject_model(text_of(content), path.string());
}

std::string subject_model_json(const SubjectModel& model) {
  SubjectModel copy = model;
  SubjectModel defaults;
  return json_text(nlohmann::ordered_json::parse(described_json(
      [&](ObjectIo& io) { describe(io, copy); }, [&](ObjectIo& io) { describe(io, defaults); })));
}

std::string subject_model_schema() {
  SubjectModel defaults;
  return annotated_schema(
      "Touchtrial subject model",
      "How simulated participants explore, perceive, err and answer. The defaults are those of a "
      "participant who makes no errors. SD: standard deviation between participants; z: a "
      "standard normal number, drawn for each participant.",
      R"([{"feature_noise": 0.3, "feature_noise_spread": 0.2, "lapse": 0.02},
          {"feature_noise": 0.3, "training": "own", "memory_noise": 0.1,
           "learning": {"factor": 1.5, "trials": 30}, "thought": {}},
          {"label_swap": [["bark", "straw"]],
           "bias": {"position": 0.5, "classes": [{"label": "brick", "log_odds": 1}]}}])",
      [&](ObjectIo& io) { describe(io, defaults); });
}

}  // namespace touchtrial::simulation
