#include "protocols/simulation/subject_model.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/nearest_name.hpp"
#include "core/strict_json.hpp"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial::simulation {
namespace {

constexpr NumberRange kWeber{0.0, 10.0};
constexpr NumberRange kSpread{0.0, 3.0};
constexpr NumberRange kShare{0.0, 1.0};
constexpr NumberRange kLogOdds{-100.0, 100.0};
constexpr NumberRange kLogOddsSpread{0.0, 10.0};
constexpr NumberRange kExploreS{0.5, 600.0};
constexpr NumberRange kPushN{0.1, 3.0};
constexpr NumberRange kSpeedMmS{1.0, 1000.0};
constexpr int kMostPasses = 1000;
constexpr std::size_t kMostLabels = 64;

void read_number(const JsonObject& object, std::string_view key, const NumberRange& range,
                 double& number) {
  if (const auto value = object.find(key)) number = value->number(range);
}

void read_bias(const JsonValue& value, SubjectModel& model) {
  const JsonObject bias = value.object({"position", "position_spread", "classes", "class_spread"});
  read_number(bias, "position", kLogOdds, model.position_bias);
  read_number(bias, "position_spread", kLogOddsSpread, model.position_bias_spread);
  read_number(bias, "class_spread", kLogOddsSpread, model.class_bias_spread);
  const auto classes = bias.find("classes");
  if (!classes) return;
  for (const JsonValue& item : classes->items(0, kMostLabels)) {
    const JsonObject preferred = item.object({"label", "log_odds"});
    model.class_bias.push_back(
        {preferred.at("label").text(), preferred.at("log_odds").number(kLogOdds)});
  }
}

void read_label_swap(const JsonValue& value, SubjectModel& model) {
  std::set<std::string> used;
  for (const JsonValue& item : value.items(0, kMostLabels)) {
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

void read_speeds(const JsonObject& object, SubjectModel& model) {
  read_number(object, "slowest_mm_s", kSpeedMmS, model.slowest_mm_s);
  read_number(object, "fastest_mm_s", kSpeedMmS, model.fastest_mm_s);
  if (model.slowest_mm_s <= model.fastest_mm_s) return;
  const auto culprit = object.find("slowest_mm_s");
  (culprit ? *culprit : object.at("fastest_mm_s"))
      .refuse("the slowest stroke is faster than the fastest; exchange the two speeds");
}

SubjectModel read_model(const JsonValue& document, const std::string& source) {
  const JsonObject object =
      document.object({"weber", "weber_spread", "lapse", "lapse_spread", "bias", "label_swap",
                       "explore_s", "push_n", "slowest_mm_s", "fastest_mm_s", "training_passes"});
  SubjectModel model;
  model.source = source;
  read_number(object, "weber", kWeber, model.weber);
  read_number(object, "weber_spread", kSpread, model.weber_spread);
  read_number(object, "lapse", kShare, model.lapse);
  read_number(object, "lapse_spread", kSpread, model.lapse_spread);
  if (const auto bias = object.find("bias")) read_bias(*bias, model);
  if (const auto swap = object.find("label_swap")) read_label_swap(*swap, model);
  read_number(object, "explore_s", kExploreS, model.explore_s);
  read_number(object, "push_n", kPushN, model.push_n);
  read_speeds(object, model);
  if (const auto passes = object.find("training_passes")) {
    model.training_passes = static_cast<int>(passes->integer(1, kMostPasses));
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

SubjectModel parse_subject_model(std::string_view text, const std::string& source) {
  return read_model(parse_strict_json(text, source), source);
}

SubjectModel load_subject_model(const std::filesystem::path& path) {
  constexpr std::uintmax_t kLargest = 1U << 20U;
  const Bytes content = read_file(path, kLargest);
  return parse_subject_model(text_of(content), path.string());
}

void SubjectModel::check_labels(const design::Study& study) const {
  std::vector<std::string_view> known;
  for (const design::StudyClass& study_class : study.classes) known.emplace_back(study_class.label);
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
  const Json subject = {{"weber", model.weber},
                        {"weber_spread", model.weber_spread},
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
                        {"training_passes", model.training_passes}};
  return json_text(subject);
}

}  // namespace touchtrial::simulation
