/// \file The study file's "rendering".
#include "engine/perception/vibration_threshold.hpp"
#include "study/study_options.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <cstddef>

namespace touchtrial::study {
namespace {

/// Text without control characters, of a sane length.
bool is_plain(const std::string& text, std::string_view ending = {}) {
  constexpr std::size_t kLongest = 200;
  return text.size() > ending.size() && text.size() <= kLongest && text.ends_with(ending) &&
         std::ranges::none_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
}

/// A name or a path; whether there is such a file is said where one is needed.
std::string read_curve(const JsonValue& place) {
  const std::string& curve = place.text();
  const bool is_name = std::ranges::any_of(
      engine::kThresholdCurves, [&](auto known) { return curve == engine::name_of(known); });
  if (!is_name && !is_plain(curve, ".db")) {
    place.refuse("must be israr_2006, tan_1994, or the database of a detection study, NAME.db");
  }
  return curve;
}

WantedLevel read_level(const JsonValue& place) {
  const JsonObject object = place.object({"level_db", "curve"});
  return {.db = object.at("level_db").number({.low = 0.0, .high = WantedLevel::kMaxDb}),
          .curve = read_curve(object.at("curve"))};
}

engine::Gains read_explicit_gains(const JsonValue& place, engine::ModelKind model) {
  const NumberRange range{.low = 0.0, .high = 10.0};
  if (model == engine::ModelKind::surface) {
    return {.height_mm = place.object({"height_mm"}).at("height_mm").number(range)};
  }
  const JsonObject object = place.object({"tangential_n", "normal_n"});
  return {.tangential_n = object.at("tangential_n").number(range),
          .normal_n = object.at("normal_n").number(range)};
}

void read_gains(const JsonValue& place, ReadRendering& read) {
  constexpr auto kNames = std::to_array<Named<int>>({{"budget", 0}});
  if (place.is_text()) {
    static_cast<void>(place.choice(kNames));
    return;
  }
  const auto keys = nlohmann::json::parse(place.any_object());
  if (keys.contains("level_db") || keys.contains("curve")) {
    read.level = read_level(place);
  } else {
    read.options.gains = read_explicit_gains(place, read.options.model);
  }
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
  const std::string& device = place.text();
  if (!is_plain(device)) {
    place.refuse("must be a model's name, as touchtrial device models lists them, or a file's");
  }
  return device;
}

void read_texture(const JsonObject& object, ReadRendering& read) {
  engine::RenderingOptions& options = read.options;
  read_number(object, "filter_mm", {.low = 0.0, .high = 10.0}, options.filter_mm);
  read_number(object, "texture_stiffness_n_per_mm", {.low = 0.0, .high = 100.0, .open_low = true},
              options.texture_stiffness_n_per_mm);
  read_number(object, "reference_grey", {.low = 0.0, .high = 255.0}, options.reference_grey);
  if (const auto member = object.find("gains")) read_gains(*member, read);
  if (const auto member = object.find("equalise")) {
    options.equalise = member->choice(kEqualiseNames);
    if (options.equalise == engine::Equalise::level && !read.level) {
      member->refuse("is level, but /gains states none; give gains level_db and curve, or rms");
    }
  }
  if (const auto member = object.find("neighbourhood")) {
    options.neighbourhood = read_neighbourhood(*member);
  }
}

}  // namespace

ReadRendering read_rendering(const JsonValue& place) {
  const JsonObject object =
      place.object({"model", "pitch_mm", "stiffness_n_per_mm", "damping_n_s_per_mm", "filter_mm",
                    "texture_stiffness_n_per_mm", "gains", "equalise", "reference_grey", "friction",
                    "neighbourhood", "touchdown_ramp_n", "max_force_n", "device"});
  ReadRendering read;
  engine::RenderingOptions& options = read.options;
  if (const auto model = object.find("model")) options.model = model->choice(kModelNames);
  read_friction(object, options);
  read_touchdown_ramp(object, options);
  read_wall(object, options);
  read_texture(object, read);
  if (const auto member = object.find("device")) read.device = read_device(*member);
  if (read.level && read.device.empty()) {
    place.refuse_below("/gains", "states a level, which needs the device: add \"device\"");
  }
  return read;
}

engine::RenderingOptions parse_rendering(std::string_view text, const std::string& source) {
  const JsonValue place = parse_strict_json(text, source);
  const ReadRendering read = read_rendering(place);
  if (read.level) place.refuse_below("/gains", "states a level, which only a study has");
  return read.options;
}

std::string written_rendering(const engine::RenderingOptions& rendering) {
  nlohmann::json every_key = to_json(rendering);
  every_key["touchdown_ramp_n"] = rendering.touchdown_ramp_n;
  return every_key.dump();
}

nlohmann::json to_json(const engine::RenderingOptions& rendering) {
  nlohmann::json object = {{"model", name_in(kModelNames, rendering.model)},
                           {"pitch_mm", rendering.pitch_mm},
                           {"stiffness_n_per_mm", rendering.stiffness_n_per_mm},
                           {"damping_n_s_per_mm", rendering.damping_n_s_per_mm},
                           {"filter_mm", rendering.filter_mm},
                           {"texture_stiffness_n_per_mm", rendering.texture_stiffness_n_per_mm},
                           {"gains", gains_json(rendering)},
                           {"equalise", name_in(kEqualiseNames, rendering.equalise)},
                           {"reference_grey", rendering.reference_grey},
                           {"friction", rendering.friction},
                           {"neighbourhood", rendering.neighbourhood},
                           {"max_force_n", rendering.max_force_n}};
  // Left out where there is none, so that studies without it keep their seals.
  if (rendering.touchdown_ramp_n != 0.0) object["touchdown_ramp_n"] = rendering.touchdown_ramp_n;
  return object;
}

}  // namespace touchtrial::study
