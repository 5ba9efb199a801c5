/// \file The study file's "rendering".
#include "protocols/design/study_options.hpp"
#include "protocols/design/study_sections.hpp"

#include <algorithm>
#include <cstddef>

namespace touchtrial::design {
namespace {

engine::Gains read_explicit_gains(const JsonValue& place, engine::ModelKind model) {
  const NumberRange range{.low = 0.0, .high = 10.0};
  if (model == engine::ModelKind::surface) {
    return {.height_mm = place.object({"height_mm"}).at("height_mm").number(range)};
  }
  const JsonObject object = place.object({"tangential_n", "normal_n"});
  return {.tangential_n = object.at("tangential_n").number(range),
          .normal_n = object.at("normal_n").number(range)};
}

std::optional<engine::Gains> read_gains(const JsonValue& place, engine::ModelKind model) {
  constexpr std::array kNames = {Named<int>{"budget", 0}};
  if (!place.is_text()) return read_explicit_gains(place, model);
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

void read_wall(const JsonObject& object, engine::RenderingOptions& options) {
  read_number(object, "pitch_mm", {.low = 0.001, .high = 10.0}, options.pitch_mm);
  read_number(object, "stiffness_n_per_mm", {.low = 0.0, .high = 100.0, .open_low = true},
              options.stiffness_n_per_mm);
  read_number(object, "damping_n_s_per_mm", {.low = 0.0, .high = 1.0}, options.damping_n_s_per_mm);
  read_number(object, "max_force_n", {.low = 0.0, .high = 100.0, .open_low = true},
              options.max_force_n);
}

void read_friction(const JsonObject& object, engine::RenderingOptions& options) {
  const auto friction = object.find("friction");
  if (!friction) return;
  options.friction = friction->number({.low = 0.0, .high = 10.0});
  if (options.model == engine::ModelKind::paper && options.friction != 0.0) {
    friction->refuse(
        "must be 0: the rendering model paper has no friction; leave it out or give \"model\": "
        "\"surface\"");
  }
}

void read_touchdown_ramp(const JsonObject& object, engine::RenderingOptions& options) {
  const auto ramp = object.find("touchdown_ramp_n");
  if (!ramp) return;
  options.touchdown_ramp_n = ramp->number({.low = 0.0, .high = 1.0});
  if (options.model == engine::ModelKind::surface && options.touchdown_ramp_n != 0.0) {
    ramp->refuse(
        "must be 0: the lateral force of the rendering model surface grows with the load by "
        "itself; leave it out or give \"model\": \"paper\"");
  }
}

nlohmann::json gains_json(const engine::RenderingOptions& rendering) {
  if (!rendering.gains) return "budget";
  if (rendering.model == engine::ModelKind::surface)
    return {{"height_mm", rendering.gains->height_mm}};
  return {{"tangential_n", rendering.gains->tangential_n}, {"normal_n", rendering.gains->normal_n}};
}

/// A name or a path; whether there is such a model is said where one is needed.
std::string read_device(const JsonValue& place) {
  constexpr std::size_t kLongest = 200;
  const std::string& device = place.text();
  const bool plain =
      std::ranges::none_of(device, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
  if (device.empty() || device.size() > kLongest || !plain) {
    place.refuse("must be a model's name, as touchtrial device models lists them, or a file's");
  }
  return device;
}

void read_texture(const JsonObject& object, engine::RenderingOptions& options) {
  read_number(object, "filter_mm", {.low = 0.0, .high = 10.0}, options.filter_mm);
  read_number(object, "texture_stiffness_n_per_mm", {.low = 0.0, .high = 100.0, .open_low = true},
              options.texture_stiffness_n_per_mm);
  read_number(object, "reference_grey", {.low = 0.0, .high = 255.0}, options.reference_grey);
  if (const auto member = object.find("gains")) options.gains = read_gains(*member, options.model);
  if (const auto member = object.find("equalise"))
    options.equalise = member->choice(kEqualiseNames);
  if (const auto member = object.find("neighbourhood")) {
    options.neighbourhood = read_neighbourhood(*member);
  }
}

}  // namespace

engine::RenderingOptions read_rendering(const JsonValue& place, std::string& device) {
  const JsonObject object =
      place.object({"model", "pitch_mm", "stiffness_n_per_mm", "damping_n_s_per_mm", "filter_mm",
                    "texture_stiffness_n_per_mm", "gains", "equalise", "reference_grey", "friction",
                    "neighbourhood", "touchdown_ramp_n", "max_force_n", "device"});
  engine::RenderingOptions options;
  if (const auto model = object.find("model")) options.model = model->choice(kModelNames);
  read_friction(object, options);
  read_touchdown_ramp(object, options);
  read_wall(object, options);
  read_texture(object, options);
  if (const auto member = object.find("device")) device = read_device(*member);
  return options;
}

engine::RenderingOptions parse_rendering(std::string_view text, const std::string& source) {
  std::string device;
  return read_rendering(parse_strict_json(text, source), device);
}

std::string written_rendering(const engine::RenderingOptions& rendering) {
  return to_json(rendering).dump();
}

nlohmann::json to_json(const engine::RenderingOptions& rendering) {
  nlohmann::json object = {{"model", word_for(kModelNames, rendering.model)},
                           {"pitch_mm", rendering.pitch_mm},
                           {"stiffness_n_per_mm", rendering.stiffness_n_per_mm},
                           {"damping_n_s_per_mm", rendering.damping_n_s_per_mm},
                           {"filter_mm", rendering.filter_mm},
                           {"texture_stiffness_n_per_mm", rendering.texture_stiffness_n_per_mm},
                           {"gains", gains_json(rendering)},
                           {"equalise", word_for(kEqualiseNames, rendering.equalise)},
                           {"reference_grey", rendering.reference_grey},
                           {"friction", rendering.friction},
                           {"neighbourhood", rendering.neighbourhood},
                           {"max_force_n", rendering.max_force_n}};
  // Left out where there is none, so that studies without it keep their seals.
  if (rendering.touchdown_ramp_n != 0.0) object["touchdown_ramp_n"] = rendering.touchdown_ramp_n;
  return object;
}

}  // namespace touchtrial::design
