#include "protocols/simulation/subject_model.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/nearest_name.hpp"
#include "core/strict_json.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "protocols/simulation/subject_changes_json.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial::simulation {
namespace {

constexpr NumberRange kNoise{0.0, 10.0};
constexpr NumberRange kSpread{0.0, 3.0};
constexpr NumberRange kShare{0.0, 1.0};
constexpr NumberRange kLogOdds{-100.0, 100.0};
constexpr NumberRange kLogOddsSpread{0.0, 10.0};
constexpr NumberRange kExploreS{0.5, 600.0};
constexpr NumberRange kPushN{0.1, 3.0};
constexpr NumberRange kSpeedMmS{1.0, 1000.0};
constexpr std::array kHands{Named<device::HandKind>{"point_mass", device::HandKind::point_mass},
                            Named<device::HandKind>{"stylus_grip", device::HandKind::stylus_grip}};
constexpr NumberRange kHandSpread{0.0, 1.0};
constexpr int kMaxPasses = 1000;
constexpr NumberRange kThresholdSpreadDb{0.0, 40.0};
constexpr std::size_t kMaxLabels = 64;

using Sense = std::optional<engine::ThresholdCurve>;
constexpr std::array kSenses{Named<Sense>{"flat", {}},
                             Named<Sense>{"israr_2006", engine::ThresholdCurve::israr_2006},
                             Named<Sense>{"tan_1994", engine::ThresholdCurve::tan_1994}};

void read_bias(const JsonValue& value, SubjectModel& model) {
  const JsonObject bias = value.object({"position", "position_spread", "classes", "class_spread"});
  read_number(bias, "position", kLogOdds, model.position_bias);
  read_number(bias, "position_spread", kLogOddsSpread, model.position_bias_spread);
  read_number(bias, "class_spread", kLogOddsSpread, model.class_bias_spread);
  const auto classes = bias.find("classes");
  if (!classes) return;
  for (const JsonValue& item : classes->items(0, kMaxLabels)) {
    const JsonObject preferred = item.object({"label", "log_odds"});
    model.class_bias.push_back(
        {preferred.at("label").text(), preferred.at("log_odds").number(kLogOdds)});
  }
}

void read_label_swap(const JsonValue& value, SubjectModel& model) {
  std::set<std::string> used;
  for (const JsonValue& item : value.items(0, kMaxLabels)) {
    const std::vector<JsonValue> pair = item.items(2, 2);
    for (const JsonValue& label : pair) {
      if (!used.insert(label.text()).second) {
        label.refuse("the label " + in_quotes(label.text()) +
                     " is swapped already; a label can be in one pair");
      }
    }
    model.label_swap.emplace_back(pair[0].text(), pair[1].text());
  }
}

constexpr std::array kTrainings{Named<Training>{"shared", Training::shared},
                                Named<Training>{"own", Training::own}};

void read_training(const JsonObject& object, SubjectModel& model) {
  if (const auto training = object.find("training")) model.training = training->choice(kTrainings);
  read_number(object, "memory_noise", kNoise, model.memory_noise);
}

void read_speeds(const JsonObject& object, SubjectModel& model) {
  read_number(object, "slowest_mm_s", kSpeedMmS, model.slowest_mm_s);
  read_number(object, "fastest_mm_s", kSpeedMmS, model.fastest_mm_s);
  if (model.slowest_mm_s <= model.fastest_mm_s) return;
  const auto culprit = object.find("slowest_mm_s");
  (culprit ? *culprit : object.at("fastest_mm_s"))
      .refuse("the slowest stroke is faster than the fastest; exchange the two speeds");
}

void read_hand(const JsonValue& value, SubjectModel& model) {
  const JsonObject hand = value.object({"model", "spread"});
  if (const auto name = hand.find("model")) model.hand = name->choice(kHands);
  read_number(hand, "spread", kHandSpread, model.hand_spread);
}

SubjectModel read_model(const JsonValue& document, const std::string& source) {
  const JsonObject object = document.object({"sense",
                                             "threshold_spread_db",
                                             "feature_noise",
                                             "common_noise",
                                             "feature_noise_spread",
                                             "lapse",
                                             "lapse_spread",
                                             "bias",
                                             "label_swap",
                                             "explore_s",
                                             "push_n",
                                             "slowest_mm_s",
                                             "fastest_mm_s",
                                             "hand",
                                             "training_passes",
                                             "training",
                                             "memory_noise",
                                             "learning",
                                             "period_noise_spread",
                                             "serial",
                                             "fatigue",
                                             "thought",
                                             "given_function"});
  SubjectModel model;
  model.source = source;
  if (const auto sense = object.find("sense")) model.sense = sense->choice(kSenses);
  read_number(object, "threshold_spread_db", kThresholdSpreadDb, model.threshold_spread_db);
  read_number(object, "feature_noise", kNoise, model.feature_noise);
  read_number(object, "common_noise", kNoise, model.common_noise);
  read_number(object, "feature_noise_spread", kSpread, model.feature_noise_spread);
  read_number(object, "lapse", kShare, model.lapse);
  read_number(object, "lapse_spread", kSpread, model.lapse_spread);
  if (const auto bias = object.find("bias")) read_bias(*bias, model);
  if (const auto swap = object.find("label_swap")) read_label_swap(*swap, model);
  read_number(object, "explore_s", kExploreS, model.explore_s);
  read_number(object, "push_n", kPushN, model.push_n);
  read_speeds(object, model);
  if (const auto hand = object.find("hand")) read_hand(*hand, model);
  if (const auto passes = object.find("training_passes")) {
    model.training_passes = static_cast<int>(passes->integer(1, kMaxPasses));
  }
  read_training(object, model);
  read_number(object, "period_noise_spread", kSpread, model.period_noise_spread);
  if (const auto learning = object.find("learning")) model.learning = learning_from(*learning);
  if (const auto serial = object.find("serial")) model.serial = serial_from(*serial);
  if (const auto fatigue = object.find("fatigue")) model.fatigue = fatigue_from(*fatigue);
  if (const auto thought = object.find("thought")) model.thought = thought_from(*thought);
  if (const auto given = object.find("given_function")) {
    model.given_function = given_function_from(*given);
  }
  return model;
}

/// Refuses a label that the study lacks.
/// \param pointer  the label's place in the subject file
void check_label(const std::string& label, const std::string& pointer, const std::string& source,
                 const std::vector<std::string_view>& known) {
  if (std::ranges::find(known, label) != known.end()) return;
  const auto nearest = nearest_name(label, known);
  throw StudyError(one_line(source + ": " + pointer + ": the study has no class " +
                            in_quotes(label) + "; " +
                            (nearest ? "did you mean " + in_quotes(*nearest) + "?"
                                     : "use labels of the study's classes")));
}

}  // namespace

std::string recorded_device(const SubjectModel& model) {
  return model.given_function ? "given-function" : device::words_of_simulated(model.device);
}

std::string_view name_of_sense(const std::optional<engine::ThresholdCurve>& sense) noexcept {
  return sense ? engine::name_of(*sense) : "flat";
}

SubjectModel parse_subject_model(std::string_view text, const std::string& source) {
  return read_model(parse_strict_json(text, source), source);
}

SubjectModel load_subject_model(const std::filesystem::path& path) {
  constexpr std::uintmax_t kLargest = 1U << 20U;
  const Bytes content = read_file(path, kLargest);
  return parse_subject_model(text_of(content), path.string());
}

void SubjectModel::check_labels(const study::Study& study) const {
  std::vector<std::string_view> known;
  for (const study::StudyClass& study_class : study.classes) known.emplace_back(study_class.label);
  for (std::size_t i = 0; i < class_bias.size(); ++i) {
    const std::string pointer = "/bias/classes/" + std::to_string(i) + "/label";
    check_label(class_bias[i].label, pointer, source, known);
  }
  for (std::size_t i = 0; i < label_swap.size(); ++i) {
    const std::string pointer = "/label_swap/" + std::to_string(i);
    check_label(label_swap[i].first, pointer + "/0", source, known);
    check_label(label_swap[i].second, pointer + "/1", source, known);
  }
}

std::string subject_model_json(const SubjectModel& model) {
  using Json = nlohmann::ordered_json;
  Json classes = Json::array();
  for (const ClassBias& bias : model.class_bias) {
    classes.push_back({{"label", bias.label}, {"log_odds", bias.log_odds}});
  }
  Json swaps = Json::array();
  for (const auto& [one, other] : model.label_swap) swaps.push_back({one, other});
  Json hand = {{"model", device::name_of(model.hand)}, {"spread", model.hand_spread}};
  Json subject = {{"sense", name_of_sense(model.sense)},
                  {"threshold_spread_db", model.threshold_spread_db},
                  {"feature_noise", model.feature_noise},
                  {"common_noise", model.common_noise},
                  {"feature_noise_spread", model.feature_noise_spread},
                  {"lapse", model.lapse},
                  {"lapse_spread", model.lapse_spread},
                  {"bias",
                   {{"position", model.position_bias},
                    {"position_spread", model.position_bias_spread},
                    {"classes", std::move(classes)},
                    {"class_spread", model.class_bias_spread}}},
                  {"label_swap", std::move(swaps)},
                  {"explore_s", model.explore_s},
                  {"push_n", model.push_n},
                  {"slowest_mm_s", model.slowest_mm_s},
                  {"fastest_mm_s", model.fastest_mm_s},
                  {"hand", std::move(hand)},
                  {"training_passes", model.training_passes},
                  {"training", name_in(kTrainings, model.training)},
                  {"memory_noise", model.memory_noise},
                  {"learning", json_of(model.learning)},
                  {"period_noise_spread", model.period_noise_spread},
                  {"serial", json_of(model.serial)},
                  {"fatigue", json_of(model.fatigue)}};
  if (model.thought) subject["thought"] = json_of(*model.thought);
  if (model.given_function) subject["given_function"] = json_of(*model.given_function);
  return json_text(subject);
}

}  // namespace touchtrial::simulation
