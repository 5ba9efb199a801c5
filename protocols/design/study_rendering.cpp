/// The study file's "rendering".
#include "protocols/design/study_names.hpp"
#include "protocols/design/study_sections.hpp"

namespace touchtrial {
namespace {

constexpr std::array kModelNames = {Named<int>{"paper", 0}};

Gains read_explicit_gains(const JsonValue& place) {
  const JsonObject object = place.object({"tangential_n", "normal_n"});
  const NumberRange range{.low = 0.0, .high = 10.0};
  return {object.at("tangential_n").number(range), object.at("normal_n").number(range)};
}

std::optional<Gains> read_gains(const JsonValue& place) {
  constexpr std::array kNames = {Named<int>{"budget", 0}};
  if (!place.is_text()) return read_explicit_gains(place);
  static_cast<void>(place.choice(kNames));
  return std::nullopt;
}

int read_neighbourhood(const JsonValue& place) {
  const auto side = static_cast<int>(place.integer(3, 31));
  if (side % 2 == 0) place.refuse("is " + std::to_string(side) + ", must be odd");
  return side;
}

void read_number(const JsonObject& object, std::string_view key, const NumberRange& range,
                 double& number) {
  if (const auto member = object.find(key)) number = member->number(range);
}

void read_wall(const JsonObject& object, RenderingOptions& options) {
  read_number(object, "pitch_mm", {.low = 0.001, .high = 10.0}, options.pitch_mm);
  read_number(object, "stiffness_n_per_mm", {.low = 0.0, .high = 100.0, .open_low = true},
              options.stiffness_n_per_mm);
  read_number(object, "damping_n_s_per_mm", {.low = 0.0, .high = 1.0}, options.damping_n_s_per_mm);
  read_number(object, "max_force_n", {.low = 0.0, .high = 100.0, .open_low = true},
              options.max_force_n);
}

void read_texture(const JsonObject& object, RenderingOptions& options) {
  read_number(object, "filter_mm", {.low = 0.0, .high = 10.0}, options.filter_mm);
  read_number(object, "texture_stiffness_n_per_mm", {.low = 0.0, .high = 100.0, .open_low = true},
              options.texture_stiffness_n_per_mm);
  read_number(object, "reference_grey", {.low = 0.0, .high = 255.0}, options.reference_grey);
  if (const auto member = object.find("gains")) options.gains = read_gains(*member);
  if (const auto member = object.find("equalise"))
    options.equalise = member->choice(kEqualiseNames);
  if (const auto member = object.find("neighbourhood")) {
    options.neighbourhood = read_neighbourhood(*member);
  }
}

}  // namespace

RenderingOptions read_rendering(const JsonValue& place) {
  const JsonObject object =
      place.object({"model", "pitch_mm", "stiffness_n_per_mm", "damping_n_s_per_mm", "filter_mm",
                    "texture_stiffness_n_per_mm", "gains", "equalise", "reference_grey", "friction",
                    "neighbourhood", "max_force_n"});
  if (const auto model = object.find("model")) static_cast<void>(model->choice(kModelNames));
  if (const auto friction = object.find("friction")) {
    if (friction->number({.low = 0.0, .high = 10.0}) != 0.0) {
      friction->refuse("must be 0: the rendering model paper has no friction");
    }
  }
  RenderingOptions options;
  read_wall(object, options);
  read_texture(object, options);
  return options;
}

nlohmann::json to_json(const RenderingOptions& rendering) {
  nlohmann::json gains = "budget";
  if (rendering.gains) {
    gains = {{"tangential_n", rendering.gains->tangential_n},
             {"normal_n", rendering.gains->normal_n}};
  }
  return {{"model", "paper"},
          {"pitch_mm", rendering.pitch_mm},
          {"stiffness_n_per_mm", rendering.stiffness_n_per_mm},
          {"damping_n_s_per_mm", rendering.damping_n_s_per_mm},
          {"filter_mm", rendering.filter_mm},
          {"texture_stiffness_n_per_mm", rendering.texture_stiffness_n_per_mm},
          {"gains", gains},
          {"equalise", word_for(kEqualiseNames, rendering.equalise)},
          {"reference_grey", rendering.reference_grey},
          {"friction", 0},
          {"neighbourhood", rendering.neighbourhood},
          {"max_force_n", rendering.max_force_n}};
}

}  // namespace touchtrial
