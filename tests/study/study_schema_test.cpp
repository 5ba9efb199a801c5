/// Compares the JSON Schema with the reader: tries every statement of the schema on the reader, and
/// looks up the reader's keys and values in the schema.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "study/languages.hpp"
#include "study/study_examples.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <functional>
#include <set>
#include <vector>

namespace touchtrial {
namespace {

using nlohmann::json;
using Pointer = json::json_pointer;

json schema() {
  const std::filesystem::path root = TOUCHTRIAL_SOURCE_DIR;
  return json::parse(text_of(read_file(root / "config/schema/study.schema.json")));
}

/// The schema, combined with its rules for one rendering model, and for the protocols without a
/// section, which has tests of its own (tests/protocols).
json schema_for(const std::string& model) {
  json whole = schema();
  for (const json& rule : whole["allOf"]) {
    if (!rule["if"]["properties"]["protocol"].contains("enum")) continue;
    whole["properties"]["classes"].update(rule["then"]["properties"]["classes"]);
  }
  json& rendering = whole["properties"]["rendering"];
  const bool of_surface =
      model == rendering["if"]["properties"]["model"]["const"].get<std::string>();
  const json branch = rendering[of_surface ? "then" : "else"];
  for (const auto& [key, property] : branch["properties"].items()) {
    rendering["properties"][key].update(property);
  }
  return whole;
}

const json kPaper = json::parse(R"({"model": "paper", "friction": 0, "touchdown_ramp_n": 0.2,
  "gains": {"tangential_n": 0.01, "normal_n": 0.01}})");
const json kSurface = json::parse(R"({"model": "surface", "friction": 0.2, "touchdown_ramp_n": 0,
  "gains": {"height_mm": 0.01}})");

/// The sections beside the method and the model, with every key.
json full_plans() {
  json plans = json::parse(R"({
    "rendering": {"pitch_mm": 0.2, "stiffness_n_per_mm": 0.4, "damping_n_s_per_mm": 0,
      "filter_mm": 0.4, "texture_stiffness_n_per_mm": 0.4, "equalise": "none",
      "reference_grey": 128, "neighbourhood": 3, "max_force_n": 3.3},
    "trials": {"repeats": 2, "order": "shuffled", "explore_limit_s": 60, "on_timeout": "fade",
      "practice": 0, "break_every": 0, "break_after_min": 0, "catch": 0, "lead_in": 0,
      "blocks": "by-method", "max_run": 0, "rove_db": 0, "resume_within_h": 24,
      "on_interruption": "repeat", "answer_after": {"contact_s": 0.5, "path_mm": 25},
      "validity": {"exploring_s": 5, "contact_s": 5, "path_mm": 300, "least_median_n": 0.2,
        "largest_median_n": 2, "saturated_share": 0.01}},
    "practice": {"classes": [{"label": "learnt", "images": ["learnt.png"]},
      {"label": "too", "images": ["too.png"]}], "criterion": 2, "rounds": 1},
    "session": {"language": "en", "texts": {"en": {"screens": {"next": "On"}}}, "text_scale": 1,
      "high_contrast": false, "sight": "curtain", "masking": {"wanted": true, "level_dbfs": -30},
      "handedness": true, "confidence": 0, "day_sheet": ["Door shut"], "consent_version": "3",
      "ethics_number": "2026-17", "closing": true,
      "closing_questions": [{"id": "cue", "kind": "choice", "required": true}]},
    "visits": {"count": 2, "least_days": 0, "most_days": 3650, "methods": "all"},
    "groups": {"labels": ["one", "two"], "open": false},
    "registration": {"hypothesis": "They can.", "participants": 20, "stopping_rule": "At 20.",
      "exclusions": "None.", "primary_test": "Sign flips.", "estimand": "difference",
      "methods": [], "test": "sign-flip", "sides": "two", "alpha": 0.05, "smallest_effect": 0.07,
      "looks": [], "spending": "obrien-fleming", "visits": "all",
      "exclusion_rules": {"deviations": [], "own_deviations": [], "invalid_trials": 0.25}},
    "blinding": "double", "seed": 1})");
  json text;
  for (const std::string_view code : study::language_codes()) {
    text[std::string(code)] = "Which?";
    plans["session"]["instructions"][std::string(code)] = {"Feel."};
  }
  json& question = plans["session"]["closing_questions"][0];
  question.update({{"text", text}, {"options", {text, text}}});
  return plans;
}

/// A study with every possible key, in which any single value can be changed.
json full_study(const json& method, const json& model = kPaper) {
  json study = comparison_of(2);
  const char* other = method["name"] == "adaptive" ? "fixed" : "adaptive";
  study["methods"] = {method, {{"name", other}}};
  study.update(full_plans());
  study["rendering"].update(model);
  return study;
}

const json kAdaptive = {{"name", "adaptive"}, {"label", "plain"},   {"control", "none"},
                        {"radius", 2},        {"norm", "additive"}, {"gradient", "sobel"},
                        {"combine", "sum"},   {"levels", 1}};
const json kFixed = {{"name", "fixed"}, {"radius", 2}, {"order", 0.5}, {"norm", "additive"}};
const json kTvGabor = {{"name", "tv-gabor"},
                       {"lambda", 0.01},
                       {"components", {{{"frequency", 0.25}, {"direction", 0}}}},
                       {"gap", 1e-5},
                       {"max_steps", 2000}};
const json kGaussian = {{"name", "gaussian"}, {"sigma_px", 2}};
const json kMedian = {{"name", "median"}, {"radius", 2}, {"threshold", 4}};
const json kEdge = {{"name", "edge"}, {"divisor", 4}};
const json kLuminance = {{"name", "luminance"}};
const std::vector<json> kMethods = {kAdaptive, kFixed, kTvGabor,  kGaussian,
                                    kMedian,   kEdge,  kLuminance};

/// A full study for each method and for each model.
std::vector<json> full_studies() {
  std::vector<json> studies = {full_study(kAdaptive, kSurface)};
  for (const json& method : kMethods) studies.push_back(full_study(method));
  return studies;
}

/// One property of the schema at its place in one of the full studies.
struct Property {
  json schema;
  json study;
  Pointer place;
  bool required = false;

  [[nodiscard]] std::string refusal_with(const json& value) const {
    json changed = study;
    changed[place] = value;
    return refusal_of(changed);
  }
  [[nodiscard]] std::string refusal_without() const {
    json changed = study;
    changed[place.parent_pointer()].erase(place.back());
    return refusal_of(changed);
  }
};

/// The object or list form of a schema that also has a word form ("gains", "components"), else the
/// schema itself.
json structured_form(const json& node) {
  if (!node.contains("oneOf")) return node;
  for (const json& form : node["oneOf"]) {
    if (form.contains("type")) return form;
  }
  return node;
}

using Visit = std::function<void(const json& object_schema, const Pointer& place)>;

/// Calls `visit` for every object in the study, with its schema.
void for_each_object(const json& node, const json& study, const Pointer& place,
                     const Visit& visit) {
  const json form = structured_form(node);
  if (form.contains("items") && study[place].is_array()) {
    for_each_object(form["items"], study, place / std::size_t{0}, visit);
  }
  if (!form.contains("properties")) return;
  visit(form, place);
  for (const auto& [key, property] : form["properties"].items()) {
    if (study[place].contains(key)) for_each_object(property, study, place / key, visit);
  }
}

std::vector<Property> all_properties() {
  std::vector<Property> properties;
  for (const json& study : full_studies()) {
    const json schema = schema_for(study["rendering"]["model"]);
    for_each_object(schema, study, Pointer(), [&](const json& object, const Pointer& place) {
      const json required = object.value("required", json::array());
      for (const auto& [key, property] : object["properties"].items()) {
        if (!study[place].contains(key)) continue;
        const bool is_required = std::find(required.begin(), required.end(), key) != required.end();
        properties.push_back({property, study, place / key, is_required});
      }
    });
  }
  return properties;
}

/// The comma-separated names after `mark` in the reader's message.
std::set<std::string> listed_after(const std::string& message, const std::string& mark) {
  std::set<std::string> names;
  std::string rest = message.substr(message.find(mark) + mark.size()) + ", ";
  for (std::size_t end = rest.find(", "); end != std::string::npos; end = rest.find(", ")) {
    std::string name = rest.substr(0, end);
    if (name.front() == '"') name = name.substr(1, name.size() - 2);
    names.insert(name);
    rest.erase(0, end + 2);
  }
  return names;
}

bool allows_type(const json& property, const json& value) {
  if (property.contains("oneOf")) {
    return value.is_string() || allows_type(structured_form(property), value);
  }
  if (property.contains("const")) return value.is_number();
  if (property.contains("enum")) return value.is_string();
  const std::string type = property["type"];
  if (type == "string") return value.is_string();
  if (type == "array") return value.is_array();
  if (type == "boolean") return value.is_boolean();
  return type == "object" ? value.is_object() : value.is_number();
}

/// Whether other keys depend on this one, or it is required only beside others; such keys have
/// tests of their own.
bool has_rules_of_its_own(const Pointer& place) {
  const std::string key = place.back();
  return key == "model" || key == "name" || key == "kind" || key == "options" || key == "en" ||
         key == "estimand";
}

/// The smallest step that leaves a bound.
double step_of(const json& property) {
  return property["type"] == "integer" ? 1.0 : 1e-9;
}

}  // namespace

TEST_CASE("the schema describes every section of the study file") {
  std::set<std::string> places;
  for (const Property& property : all_properties()) places.insert(property.place.to_string());
  CHECK(places.size() == 13 + 2 + 18 + 17 + (13 + 2 + 6 + 2) + (3 + 2) +
                             (14 + 6 + 1 + 2 + 5 + 2 * 6) + 4 + 2 + (15 + 3));
  for (const char* place :
       {"/seed", "/rendering/gains/normal_n", "/rendering/gains/height_mm", "/trials/catch",
        "/methods/0/components/0/direction", "/classes/0/images", "/practice/classes/0/label",
        "/session/closing_questions/0/options/0/de", "/registration/participants"}) {
    CHECK(places.count(place) == 1);
  }
}

TEST_CASE("the reader knows exactly the schema's keys in every object") {
  for (const json& study : full_studies()) {
    const json schema = schema_for(study["rendering"]["model"]);
    for_each_object(schema, study, Pointer(), [&](const json& object, const Pointer& place) {
      INFO("object at " << place.to_string());
      CHECK(object["additionalProperties"] == false);
      json changed = study;
      changed[place]["zzzzzzzzzzzz"] = 1;
      std::set<std::string> keys;
      for (const auto& [key, property] : object["properties"].items()) keys.insert(key);
      CHECK(listed_after(refusal_of(changed), "known here: ") == keys);
    });
  }
}

TEST_CASE("the reader requires exactly what the schema requires") {
  for (const Property& property : all_properties()) {
    if (has_rules_of_its_own(property.place)) continue;
    INFO(property.place.to_string() << ": " << property.refusal_without());
    CHECK(property.refusal_without().empty() != property.required);
  }
}

TEST_CASE("the reader refuses a value of another type than the schema's, with its place") {
  const std::vector<json> values = {json(), true, 7, "qqqqqqqq", json::array(), json::object()};
  for (const Property& property : all_properties()) {
    for (const json& value : values) {
      if (allows_type(property.schema, value)) continue;
      const std::string message = property.refusal_with(value);
      INFO(property.place.to_string() << " = " << value.dump() << ": " << message);
      CHECK(message.find(" " + property.place.to_string() + ": must be ") != std::string::npos);
    }
  }
}

TEST_CASE("the reader accepts exactly the schema's words") {
  for (Property property : all_properties()) {
    // What is registered fits one protocol alone.
    if (property.place.back() == "protocol") property.study.erase("registration");
    json words = property.schema.value("enum", json::array());
    if (property.schema.contains("oneOf")) words = property.schema["oneOf"][0]["enum"];
    if (words.empty()) continue;
    if (has_rules_of_its_own(property.place)) continue;
    INFO(property.place.to_string());
    std::set<std::string> expected;
    for (const json& word : words) {
      if (word == "threshold") {
        CHECK_THAT(property.refusal_with(word), holds_text("/threshold: is missing"));
      } else if (word == "level") {
        CHECK_THAT(property.refusal_with(word), holds_text("/rendering/equalise: is level"));
      } else {
        CHECK(property.refusal_with(word).empty());
      }
      expected.insert(word.get<std::string>());
    }
    CHECK(listed_after(property.refusal_with("qqqqqqqq"), "possible: ") == expected);
  }
}

TEST_CASE("the reader knows exactly the schema's rendering models") {
  const json model = schema()["properties"]["rendering"]["properties"]["model"];
  const std::set<std::string> expected = model["enum"];
  json study = minimal_study();
  for (const std::string& word : expected) {
    study["rendering"] = {{"model", word}};
    CHECK(refusal_of(study).empty());
  }
  study["rendering"] = {{"model", "qqqqqqqq"}};
  CHECK(listed_after(refusal_of(study), "possible: ") == expected);
}

TEST_CASE("the reader keeps the schema's bounds") {
  int bounds = 0;
  for (const Property& property : all_properties()) {
    const json& rule = property.schema;
    INFO(property.place.to_string());
    const auto check = [&](const char* name, double direction, bool bound_itself) {
      if (!rule.contains(name)) return;
      ++bounds;
      const auto bound = rule[name].get<double>();
      CHECK(property.refusal_with(bound).empty() == bound_itself);
      if (std::abs(bound) < 1e15) {
        CHECK_FALSE(property.refusal_with(bound + direction * step_of(rule)).empty());
      }
    };
    check("minimum", -1.0, true);
    check("maximum", 1.0, true);
    check("exclusiveMinimum", -1.0, false);
    check("exclusiveMaximum", 1.0, false);
  }
  CHECK(bounds > 40);
}

TEST_CASE("the reader keeps the schema's constants and multiples") {
  int rules = 0;
  for (const Property& property : all_properties()) {
    INFO(property.place.to_string());
    if (property.schema.contains("const")) {
      ++rules;
      CHECK(property.refusal_with(property.schema["const"]).empty());
      CHECK_FALSE(property.refusal_with(property.schema["const"].get<int>() + 1).empty());
    }
    if (property.schema.contains("not")) {
      ++rules;
      CHECK(property.refusal_with(5).empty());
      CHECK_FALSE(property.refusal_with(6).empty());
    }
  }
  CHECK(rules == 2 * static_cast<int>(kMethods.size()) + 2);
}

TEST_CASE("the reader keeps the schema's lengths of lists") {
  int lists = 0;
  for (const Property& property : all_properties()) {
    const json rule = structured_form(property.schema);
    if (!rule.contains("maxItems")) continue;
    ++lists;
    const auto counted = [&](std::size_t count) {
      json list = json::array();
      for (std::size_t i = 0; i < count; ++i) {
        const json& given = property.study[property.place];
        json item = given.empty() ? json("item") : given[0];
        if (item.contains("label")) item["label"] = "label " + std::to_string(i);
        if (item.is_string()) item = "image " + std::to_string(i);
        list.push_back(item);
      }
      return property.refusal_with(list).find("entries, must have from ") != std::string::npos;
    };
    INFO(property.place.to_string());
    const auto fewest = rule.value("minItems", std::size_t{0});
    if (fewest > 0) CHECK(counted(fewest - 1));
    CHECK_FALSE(counted(fewest));
    CHECK_FALSE(counted(rule["maxItems"]));
    CHECK(counted(rule["maxItems"].get<std::size_t>() + 1));
  }
  CHECK(lists > 6);
}

TEST_CASE("the schema's defaults are the reader's") {
  json document = minimal_study();
  document["practice"]["classes"] = full_plans()["practice"]["classes"];  // required
  document["registration"]["estimand"] = "mean-accuracy";  // required beside the other fields
  document["visits"]["count"] = 2;                         // required, as the next
  document["groups"]["labels"] = {"one", "two"};
  const study::Study bare = parsed(document);
  int defaults = 0;
  for (const Property& property : all_properties()) {
    const std::string place = property.place.to_string();
    const bool of_list = place.find("/methods") == 0 || place.find("_questions/0") < place.size();
    if (!property.schema.contains("default") || of_list) continue;
    json study = document;
    study[property.place] = property.schema["default"];
    INFO(place);
    ++defaults;
    const study::Study written = parsed(study);
    CHECK(written.rendering == bare.rendering);
    CHECK(written.trials == bare.trials);
    CHECK(written.practice == bare.practice);
    CHECK(written.session == bare.session);
    CHECK(written.visits == bare.visits);
    CHECK(written.groups == bare.groups);
    CHECK(written.registration == bare.registration);
    CHECK(written.seed == bare.seed);
  }
  CHECK(defaults == (24 + 9 + 3 + 2 + 14 + 2 + 1 + 10) * (static_cast<int>(kMethods.size()) + 1));
}

TEST_CASE("the schema's defaults of the methods' keys are the reader's") {
  const json properties = schema()["properties"]["methods"]["items"]["properties"];
  for (const json& method : kMethods) {
    json bare = minimal_study();
    bare["methods"] = {{{"name", method["name"]}}};
    json written = bare;
    for (const auto& [key, value] : method.items()) {
      if (key == "name" || key == "label") continue;  // a label's default depends on the others
      written["methods"][0][key] = properties[key]["default"];
    }
    CHECK(parsed(written).methods == parsed(bare).methods);
  }
}

TEST_CASE("the reader gives a method the keys that the schema leaves it") {
  const json items = schema()["properties"]["methods"]["items"];
  std::set<std::string> names;
  for (const json& rule : items["allOf"]) {
    const std::string name = rule["if"]["properties"]["name"]["const"];
    names.insert(name);
    for (const auto& [key, property] : items["properties"].items()) {
      if (key == "name" || key == "label") continue;  // labels have a test of their own
      json study = minimal_study();
      study["methods"] = {{{"name", name}, {key, property["default"]}}};
      INFO(name << " " << key);
      CHECK(refusal_of(study).empty() != rule["then"]["properties"].contains(key));
    }
  }
  std::set<std::string> enumerated = items["properties"]["name"]["enum"];
  CHECK(names == enumerated);
  json study = minimal_study();
  study["methods"][0]["name"] = "qqqqqqqq";
  CHECK(listed_after(refusal_of(study), "possible: ") == enumerated);
}

TEST_CASE("every key of the schema has a row in the documentation") {
  const std::filesystem::path root = TOUCHTRIAL_SOURCE_DIR;
  const std::string text = text_of(read_file(root / "docs/study-file.md"));
  for (const Property& property : all_properties()) {
    INFO(property.place.to_string());
    CHECK(text.find("\n| `" + property.place.back() + "` |") != std::string::npos);
  }
}

}  // namespace touchtrial
