#include "protocols/simulation/subject_changes_json.hpp"

#include "core/named.hpp"

#include <array>

#include <nlohmann/json.hpp>

namespace touchtrial::simulation {
namespace {

constexpr NumberRange kUnit{0.0, 1.0};
constexpr NumberRange kLogSpread{0.0, 3.0};
constexpr NumberRange kLeaning{-10.0, 10.0};
constexpr NumberRange kLeaningSpread{0.0, 10.0};
constexpr NumberRange kFactor{1.0, 10.0};
constexpr NumberRange kTrials{1.0, 10'000.0};
constexpr NumberRange kLogNoisePerMin{0.0, 1.0};
constexpr NumberRange kLogOddsPerMin{0.0, 10.0};
constexpr NumberRange kShiftS{0.0, 60.0};
constexpr NumberRange kMedianS{0.01, 60.0};
constexpr NumberRange kMargin{0.01, 100.0};
constexpr NumberRange kLongestS{0.1, 600.0};

}  // namespace

void read_number(const JsonObject& object, std::string_view key, const NumberRange& range,
                 double& number) {
  if (const auto value = object.find(key)) number = value->number(range);
}

Learning learning_from(const JsonValue& value) {
  const JsonObject object = value.object({"factor", "trials", "forgotten", "spread"});
  Learning learning;
  read_number(object, "factor", kFactor, learning.factor);
  read_number(object, "trials", kTrials, learning.trials);
  read_number(object, "forgotten", kUnit, learning.forgotten);
  read_number(object, "spread", kLogSpread, learning.spread);
  return learning;
}

SerialDependence serial_from(const JsonValue& value) {
  const JsonObject object =
      value.object({"answer", "answer_spread", "stimulus", "stimulus_spread"});
  SerialDependence serial;
  read_number(object, "answer", kLeaning, serial.answer);
  read_number(object, "answer_spread", kLeaningSpread, serial.answer_spread);
  read_number(object, "stimulus", kLeaning, serial.stimulus);
  read_number(object, "stimulus_spread", kLeaningSpread, serial.stimulus_spread);
  return serial;
}

Fatigue fatigue_from(const JsonValue& value) {
  const JsonObject object = value.object({"noise_per_min", "lapse_per_min", "recovered"});
  Fatigue fatigue;
  read_number(object, "noise_per_min", kLogNoisePerMin, fatigue.noise_per_min);
  read_number(object, "lapse_per_min", kLogOddsPerMin, fatigue.lapse_per_min);
  read_number(object, "recovered", kUnit, fatigue.recovered);
  return fatigue;
}

ThoughtTime thought_from(const JsonValue& value) {
  const JsonObject object =
      value.object({"shift_s", "easy_s", "hard_s", "margin", "spread", "longest_s"});
  ThoughtTime thought;
  read_number(object, "shift_s", kShiftS, thought.shift_s);
  read_number(object, "easy_s", kMedianS, thought.easy_s);
  read_number(object, "hard_s", kMedianS, thought.hard_s);
  read_number(object, "margin", kMargin, thought.margin);
  read_number(object, "spread", kLogSpread, thought.spread);
  read_number(object, "longest_s", kLongestS, thought.longest_s);
  if (thought.hard_s < thought.easy_s) {
    value.refuse("hard_s is less than easy_s: the harder a trial, the longer the thought");
  }
  if (thought.longest_s <= thought.shift_s) {
    value.refuse("longest_s is not more than shift_s: raise longest_s");
  }
  return thought;
}

GivenFunction given_function_from(const JsonValue& value) {
  const JsonObject object =
      value.object({"threshold", "spread", "standard_step", "standard_spread", "slope", "lapse"});
  GivenFunction given;
  given.threshold = object.at("threshold").number({-200.0, 200.0});
  given.slope = object.at("slope").number({0.0, 1000.0, true});
  read_number(object, "spread", {0.0, 100.0}, given.spread);
  read_number(object, "standard_step", {-100.0, 100.0}, given.standard_step);
  read_number(object, "standard_spread", {0.0, 100.0}, given.standard_spread);
  read_number(object, "lapse", {0.0, 0.5, false, true}, given.lapse);
  return given;
}

nlohmann::ordered_json json_of(const Learning& learning) {
  return {{"factor", learning.factor},
          {"trials", learning.trials},
          {"forgotten", learning.forgotten},
          {"spread", learning.spread}};
}

nlohmann::ordered_json json_of(const SerialDependence& serial) {
  return {{"answer", serial.answer},
          {"answer_spread", serial.answer_spread},
          {"stimulus", serial.stimulus},
          {"stimulus_spread", serial.stimulus_spread}};
}

nlohmann::ordered_json json_of(const Fatigue& fatigue) {
  return {{"noise_per_min", fatigue.noise_per_min},
          {"lapse_per_min", fatigue.lapse_per_min},
          {"recovered", fatigue.recovered}};
}

nlohmann::ordered_json json_of(const ThoughtTime& thought) {
  return {{"shift_s", thought.shift_s}, {"easy_s", thought.easy_s},
          {"hard_s", thought.hard_s},   {"margin", thought.margin},
          {"spread", thought.spread},   {"longest_s", thought.longest_s}};
}

nlohmann::ordered_json json_of(const GivenFunction& given) {
  return {{"threshold", given.threshold},
          {"spread", given.spread},
          {"standard_step", given.standard_step},
          {"standard_spread", given.standard_spread},
          {"slope", given.slope},
          {"lapse", given.lapse}};
}

}  // namespace touchtrial::simulation
