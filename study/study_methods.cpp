/// \file The study file's "methods".
#include "core/text.hpp"
#include "study/study_options.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::study {
namespace {

/// A key besides "name", and the methods that use it.
struct MethodKey {
  std::string_view key;
  std::vector<engine::Method> methods;
};

const std::vector<MethodKey>& method_keys() {
  using enum engine::Parameter;
  static const std::vector<MethodKey> keys = {
      {"radius", methods_with(radius)},
      {"order", methods_with(order)},
      {"norm", methods_with(norm)},
      {"gradient", methods_with(gradient)},
      {"combine", methods_with(combine)},
      {"levels", methods_with(levels)},
      {"sigma_px", methods_with(sigma)},
      {"threshold", methods_with(threshold)},
      {"divisor", methods_with(divisor)},
      {"lambda", methods_with(lambda)},
      {"components", methods_with(components)},
      {"gap", methods_with(gap)},
      {"max_steps", methods_with(max_steps)},
  };
  return keys;
}

std::vector<std::string_view> known_keys() {
  std::vector<std::string_view> keys = {"name", "label", "control"};
  for (const MethodKey& entry : method_keys()) keys.push_back(entry.key);
  return keys;
}

bool belongs_to(engine::Method method, const MethodKey& entry) {
  return std::find(entry.methods.begin(), entry.methods.end(), method) != entry.methods.end();
}

/// "the method fixed", "the methods adaptive and fixed"
std::string owners_of(const MethodKey& entry) {
  return (entry.methods.size() == 1 ? "the method " : "the methods ") +
         listed(entry.methods, " and ", [](engine::Method method) { return name_of(method); });
}

engine::Method read_name(const JsonValue& place) {
  const std::vector<std::string> names = engine::method_names();
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::size_t chosen = place.choice(std::span<const std::string_view>(views));
  const auto method = engine::method_from_name(names[chosen]);
  if (!method) place.refuse("is not a method of this version; choose another");
  return *method;
}

void refuse_foreign_keys(const JsonObject& object, engine::Method method) {
  for (const MethodKey& entry : method_keys()) {
    const auto member = object.find(entry.key);
    if (!member || belongs_to(method, entry)) continue;
    member->refuse("belongs to " + owners_of(entry) + ", not to " + std::string(name_of(method)) +
                   "; remove it");
  }
}

/// Reads a list, or the word "auto".
void read_components(const JsonValue& place, engine::TvGaborOptions& options) {
  constexpr std::size_t kMost = 64;
  constexpr std::array<std::string_view, 1> kWords = {"auto"};
  options.automatic =
      place.is_text() && place.choice(std::span<const std::string_view>(kWords)) == 0;
  if (options.automatic) return;
  options.components.clear();
  for (const JsonValue& item : place.items(1, kMost)) {
    const JsonObject object = item.object({"frequency", "direction"});
    options.components.push_back(
        {object.at("frequency").number({.low = 0.0, .high = 0.5, .open_low = true}),
         object.at("direction").number({.low = -360.0, .high = 360.0})});
  }
}

template <typename Choice, std::size_t size>
void read_choice(const JsonObject& object, std::string_view key,
                 const std::array<Named<Choice>, size>& names, Choice& choice) {
  if (const auto member = object.find(key)) choice = member->choice(names);
}

void read_method_number(const JsonObject& object, std::string_view key, const NumberRange& range,
                        double& number) {
  if (const auto member = object.find(key)) number = member->number(range);
}

void read_integer(const JsonObject& object, std::string_view key, int low, int high, int& number) {
  if (const auto member = object.find(key)) {
    number = static_cast<int>(member->integer(low, high));
  }
}

engine::TvGaborOptions read_tv_gabor(const JsonObject& object) {
  engine::TvGaborOptions options;
  read_method_number(
      object, "lambda",
      {.low = engine::TvGaborOptions::kMinLambda, .high = engine::TvGaborOptions::kMaxLambda},
      options.lambda);
  if (const auto member = object.find("components")) read_components(*member, options);
  read_method_number(object, "gap", {.low = 0.0, .high = 1.0, .open_low = true}, options.gap);
  read_integer(object, "max_steps", 1, 1'000'000, options.max_steps);
  return options;
}

StudyMethod read_method(const JsonValue& place) {
  using Options = engine::ExtractionOptions;
  const std::vector<std::string_view> known = known_keys();
  const JsonObject object = place.object(std::span<const std::string_view>(known));
  StudyMethod options;
  options.method = read_name(object.at("name"));
  refuse_foreign_keys(object, options.method);
  read_integer(object, "radius", 1, Options::kMaxRadius, options.radius);
  read_method_number(object, "order", {.low = 0.0, .high = 1.0, .open_high = true}, options.order);
  read_choice(object, "norm", engine::kNormNames, options.norm);
  read_choice(object, "gradient", engine::kGradientNames, options.gradient);
  read_choice(object, "combine", engine::kCombineNames, options.combine);
  read_integer(object, "levels", 1, Options::kMaxLevels, options.levels);
  read_method_number(object, "sigma_px",
                     {.low = 0.0, .high = Options::kMaxSigma_px, .open_low = true},
                     options.sigma_px);
  read_method_number(object, "threshold", {.low = 0.0, .high = 255.0}, options.threshold_grey);
  read_method_number(object, "divisor", {.low = Options::kMinDivisor, .high = Options::kMaxDivisor},
                     options.divisor);
  options.tv_gabor = read_tv_gabor(object);
  read_choice(object, "control", engine::kControlNames, options.control);
  const auto label = object.find("label");
  options.label = label ? read_plain_name(*label) : default_label(options);
  return options;
}

nlohmann::json components_json(const engine::TvGaborOptions& options) {
  if (options.automatic) return "auto";
  nlohmann::json list = nlohmann::json::array();
  for (const engine::GaborComponent& component : options.components) {
    list.push_back(
        {{"frequency", component.frequency_cycles_per_px}, {"direction", component.direction_deg}});
  }
  return list;
}

}  // namespace

std::string default_label(const engine::ExtractionOptions& method) {
  std::string label(name_of(method.method));
  if (method.control != engine::Control::none)
    label += "-" + std::string(name_in(engine::kControlNames, method.control));
  return label;
}

std::vector<StudyMethod> read_methods(const JsonValue& place) {
  std::vector<StudyMethod> methods;
  for (const JsonValue& item : place.items(1, kMaxMethods)) {
    StudyMethod method = read_method(item);
    if (std::ranges::count(methods, method.label, &StudyMethod::label) > 0) {
      item.refuse(in_quotes(method.label) +
                  " is there twice; list it once, or give one of the two another label");
    }
    for (const StudyMethod& other : methods) {
      refuse_same_label(item, method.label, other.label, "method");
    }
    methods.push_back(std::move(method));
  }
  return methods;
}

engine::ExtractionOptions parse_method(std::string_view text, const std::string& source) {
  return read_method(parse_strict_json(text, source));
}

nlohmann::json to_json(const engine::ExtractionOptions& method) {
  const nlohmann::json all = {{"radius", method.radius},
                              {"order", method.order},
                              {"norm", name_in(engine::kNormNames, method.norm)},
                              {"gradient", name_in(engine::kGradientNames, method.gradient)},
                              {"combine", name_in(engine::kCombineNames, method.combine)},
                              {"levels", method.levels},
                              {"sigma_px", method.sigma_px},
                              {"threshold", method.threshold_grey},
                              {"divisor", method.divisor},
                              {"lambda", method.tv_gabor.lambda},
                              {"components", components_json(method.tv_gabor)},
                              {"gap", method.tv_gabor.gap},
                              {"max_steps", method.tv_gabor.max_steps}};
  nlohmann::json object = {{"name", name_of(method.method)}};
  for (const MethodKey& entry : method_keys()) {
    if (belongs_to(method.method, entry)) object[std::string(entry.key)] = all.at(entry.key);
  }
  if (method.control != engine::Control::none)
    object["control"] = name_in(engine::kControlNames, method.control);
  return object;
}

nlohmann::json to_json(const StudyMethod& method) {
  nlohmann::json object = to_json(static_cast<const engine::ExtractionOptions&>(method));
  if (method.label != default_label(method)) object["label"] = method.label;
  return object;
}

}  // namespace touchtrial::study
