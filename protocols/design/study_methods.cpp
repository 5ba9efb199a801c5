/// The study file's "methods".
#include "core/nearest_name.hpp"
#include "protocols/design/study_sections.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

constexpr std::array<std::string_view, 7> kMethodKeys = {
    "name", "radius", "order", "lambda", "components", "gap", "max_steps"};

bool belongs_to(Method method, std::string_view key) {
  if (key == "name") return true;
  if (key == "radius") return method == Method::adaptive || method == Method::fixed;
  if (key == "order") return method == Method::fixed;
  return method == Method::tv_gabor;
}

std::string owners_of(std::string_view key) {
  if (key == "radius") return "the methods adaptive and fixed";
  return key == "order" ? "the method fixed" : "the method tv-gabor";
}

Method read_name(const JsonValue& place) {
  const std::vector<std::string> names = method_names();
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::size_t chosen = place.choice(std::span<const std::string_view>(views));
  const auto method = method_from_name(names[chosen]);
  if (!method) place.refuse("is not a method of this version; choose another");
  return *method;
}

void refuse_foreign_keys(const JsonObject& object, Method method) {
  for (const std::string_view key : kMethodKeys) {
    const auto member = object.find(key);
    if (!member || belongs_to(method, key)) continue;
    member->refuse("belongs to " + owners_of(key) + ", not to " + std::string(name_of(method)) +
                   "; remove it");
  }
}

std::vector<GaborComponent> read_components(const JsonValue& place) {
  constexpr std::size_t kMost = 64;
  std::vector<GaborComponent> components;
  for (const JsonValue& item : place.items(1, kMost)) {
    const JsonObject object = item.object({"frequency", "direction"});
    components.push_back(
        {object.at("frequency").number({.low = 0.0, .high = 0.5, .open_low = true}),
         object.at("direction").number({.low = -360.0, .high = 360.0})});
  }
  return components;
}

TvGaborOptions read_tv_gabor(const JsonObject& object) {
  TvGaborOptions options;
  if (const auto member = object.find("lambda")) {
    options.lambda = member->number(
        {.low = TvGaborOptions::kMinLambda, .high = TvGaborOptions::kMaxLambda});
  }
  if (const auto member = object.find("components")) options.components = read_components(*member);
  if (const auto member = object.find("gap")) {
    options.gap = member->number({.low = 0.0, .high = 1.0, .open_low = true});
  }
  if (const auto member = object.find("max_steps")) {
    options.max_steps = static_cast<int>(member->integer(1, 1'000'000));
  }
  return options;
}

ExtractionOptions read_method(const JsonValue& place) {
  const JsonObject object = place.object(std::span<const std::string_view>(kMethodKeys));
  ExtractionOptions options;
  options.method = read_name(object.at("name"));
  refuse_foreign_keys(object, options.method);
  if (const auto member = object.find("radius")) {
    options.radius = static_cast<int>(member->integer(1, ExtractionOptions::kMaxRadius));
  }
  if (const auto member = object.find("order")) {
    options.order = member->number({.low = 0.0, .high = 1.0, .open_high = true});
  }
  options.tv_gabor = read_tv_gabor(object);
  return options;
}

}  // namespace

std::vector<ExtractionOptions> read_methods(const JsonValue& place) {
  std::vector<ExtractionOptions> methods;
  for (const JsonValue& item : place.items(1, kMaxMethods)) {
    const ExtractionOptions options = read_method(item);
    const bool taken = std::any_of(methods.begin(), methods.end(), [&](const auto& other) {
      return other.method == options.method;
    });
    if (taken) item.refuse(in_quotes(name_of(options.method)) + " is there twice; list it once");
    methods.push_back(options);
  }
  return methods;
}

nlohmann::json to_json(const ExtractionOptions& method) {
  nlohmann::json object = {{"name", name_of(method.method)}};
  if (belongs_to(method.method, "radius")) object["radius"] = method.radius;
  if (belongs_to(method.method, "order")) object["order"] = method.order;
  if (!belongs_to(method.method, "lambda")) return object;
  object["lambda"] = method.tv_gabor.lambda;
  object["gap"] = method.tv_gabor.gap;
  object["max_steps"] = method.tv_gabor.max_steps;
  object["components"] = nlohmann::json::array();
  for (const GaborComponent& component : method.tv_gabor.components) {
    object["components"].push_back(
        {{"frequency", component.frequency_cycles_per_px}, {"direction", component.direction_deg}});
  }
  return object;
}

}  // namespace touchtrial
