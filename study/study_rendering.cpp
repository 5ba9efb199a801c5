/// \file Describes the study file's "rendering".
#include "engine/perception/vibration_threshold.hpp"
#include "study/study_options.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <cstddef>

namespace touchtrial::study {
namespace {

/// Whether a text has no control characters and a reasonable length.
bool is_plain(const std::string& text, std::string_view ending = {}) {
  constexpr std::size_t kMaxLength = 200;
  return text.size() > ending.size() && text.size() <= kMaxLength && text.ends_with(ending) &&
         std::ranges::none_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
}

/// A name or a path. Whether the file exists is checked when it is needed.
constexpr TextRule kCurve{
    .check =
        [](const JsonValue& place) {
          const std::string& curve = place.text();
          const bool is_name = std::ranges::any_of(
              engine::kThresholdCurves,
              [&](auto published_curve) { return curve == engine::name_of(published_curve); });
          if (!is_name && !is_plain(curve, ".db")) {
            place.refuse(
                "must be israr_2006, tan_1994, or the database of a detection study, NAME.db");
          }
        },
    .max_length = 200,
    .pattern = R"(^(israr_2006|tan_1994|.+\.db)$)",
    .description = "`israr_2006`, `tan_1994`, `NAME.db`"};

/// A name or a path. Whether the model exists is checked when it is needed.
constexpr TextRule kDevice{
    .check =
        [](const JsonValue& place) {
          if (is_plain(place.text())) return;
          place.refuse(
              "must be the name of a device model (see `touchtrial device models`) or of a file");
        },
    .min_length = 1,
    .max_length = 200,
    .description = "a product's or a model's name, or a file"};

constexpr NumberRange kGain{.low = 0.0, .high = 10.0};
constexpr NumberRange kStiffness{.low = 0.0, .high = 100.0, .open_low = true};

void describe_level(ObjectIo& io, TargetLevel& level) {
  io.number("level_db", level.db, {.low = 0.0, .high = TargetLevel::kMaxDb},
            {.meaning = "level of the weakest stimulus above its detection threshold on `device`, "
                        "compared with the blank plane",
             .required = true});
  io.text("curve", level.curve, kCurve,
          {.meaning = "a published curve of thresholds, or the unblinded database of a detection "
                      "study with pilot participants, relative to the study's folder; its key and "
                      "pack must be accessible",
           .required = true});
}

void describe_surface_gains(ObjectIo& io, engine::Gains& gains) {
  io.number("height_mm", gains.height_mm, kGain,
            {.meaning = "`surface`: alpha; 0 gives a smooth plane",
             .required = true,
             .unit = "mm per grey level"});
}

void describe_paper_gains(ObjectIo& io, engine::Gains& gains) {
  io.number("tangential_n", gains.tangential_n, kGain,
            {.meaning = "`paper`: k_t; 0 here and in `normal_n` gives a smooth plane",
             .required = true,
             .unit = "N per (grey level per pixel)"});
  io.number("normal_n", gains.normal_n, kGain,
            {.meaning = "`paper`: c", .required = true, .unit = "N per grey level"});
}

bool states_level(const JsonValue& place) {
  if (!place.is_object()) return false;
  const JsonObject gains(place);
  return gains.find("level_db").has_value() || gains.find("curve").has_value();
}

/// Describes gains: the word "budget", a level, or explicit gains of the model.
void describe_gains(ValueIo& io, RenderingSection& rendering) {
  constexpr auto kWords = std::to_array<Named<bool>>({{"budget", true}});
  const auto& [options, device, level] = rendering;
  const bool is_surface = options.model == engine::ModelKind::surface;
  const auto gains = [&rendering](ValueIo& value, const auto& describe_them) {
    engine::Gains explicit_gains = rendering.options.gains.value_or(engine::Gains{});
    value.part(explicit_gains, describe_them);
    rendering.options.gains = explicit_gains;
  };
  const ValueIo::Form forms[] = {{[](const JsonValue& place) { return place.is_text(); },
                                  [&](ValueIo& value) {
                                    bool by_budget = true;
                                    value.choice(by_budget, kWords);
                                  }},
                                 {states_level,
                                  [&](ValueIo& value) {
                                    TargetLevel target;
                                    value.part(target, describe_level);
                                    rendering.level = target;
                                  }},
                                 {[is_surface](const JsonValue& /*place*/) { return is_surface; },
                                  [&](ValueIo& value) { gains(value, describe_surface_gains); }},
                                 {{}, [&](ValueIo& value) { gains(value, describe_paper_gains); }}};
  io.one_of(!options.gains ? 0 : is_surface ? 2 : 3, forms);
}

/// Describes the keys of a single model.
void describe_model_keys(ObjectIo& io, engine::RenderingOptions& options) {
  io.number("friction", options.friction, {.low = 0.0, .high = 10.0},
            {"`surface`: coefficient of the bristle friction. `paper` has no friction and accepts "
             "only 0"});
  io.number("touchdown_ramp_n", options.touchdown_ramp_n, {.low = 0.0, .high = 1.0},
            {.meaning = "`paper`: normal force up to which the lateral force grows in proportion "
                        "to it; 0: full lateral force from first contact. `surface` accepts only "
                        "0, because its lateral force always grows with the normal force",
             .if_changed = true});
  io.rule([&options](const JsonValue& place, const JsonObject& /*object*/) {
    if (options.model == engine::ModelKind::paper && options.friction != 0.0) {
      place.refuse_below("/friction",
                         "must be 0, because the rendering model paper has no friction; remove it, "
                         "or set \"model\": \"surface\"");
    }
    if (options.model == engine::ModelKind::surface && options.touchdown_ramp_n != 0.0) {
      place.refuse_below("/touchdown_ramp_n",
                         "must be 0, because the lateral force of the rendering model surface "
                         "always grows with the load; remove it, or set \"model\": \"paper\"");
    }
  });
}

void describe_wall(ObjectIo& io, engine::RenderingOptions& options) {
  io.number("pitch_mm", options.pitch_mm, {.low = 0.001, .high = 10.0},
            {"size of a pixel: a 500-pixel image is 100 mm wide at 0.2"});
  io.number("stiffness_n_per_mm", options.stiffness_n_per_mm, kStiffness,
            {"stiffness of the wall"});
  io.number("damping_n_s_per_mm", options.damping_n_s_per_mm, {.low = 0.0, .high = 1.0},
            {"damping of the wall"});
  io.number("max_force_n", options.max_force_n, kStiffness,
            {"limit of the total force; at most the device's maximum force"});
}

void describe_texture(ObjectIo& io, RenderingSection& rendering) {
  engine::RenderingOptions& options = rendering.options;
  io.number("filter_mm", options.filter_mm, {.low = 0.0, .high = 10.0},
            {"standard deviation of the reconstruction filter; 0: no filter, as in the paper"});
  io.number("texture_stiffness_n_per_mm", options.texture_stiffness_n_per_mm, kStiffness,
            {"stiffness budget, from which the gains are computed"});
  io.number("reference_grey", options.reference_grey, {.low = 0.0, .high = 255.0},
            {.meaning = "`paper`: grey level without normal force; 0 follows the paper literally, "
                        "with a warning. No effect with `surface`",
             .unit = "grey levels"});
  io.member("gains",
            {.meaning = "the largest gains within the stiffness budget; the gains for a level; or "
                        "explicit gains",
             .range = "`budget`, or as below"},
            true, [&rendering](ValueIo& value) { describe_gains(value, rendering); });
  io.choice("equalise", options.equalise, kEqualiseNames,
            {"`rms`: every stimulus has the same rms force, without effect on explicit gains; "
             "`level`: every stimulus has the level stated in `gains`"});
  io.integer("neighbourhood", options.neighbourhood, 3, 31,
             {.meaning = "`paper`: side of the neighbourhood from which the tangential force is "
                         "computed. No effect with `surface`",
              .unit = "pixels",
              .range = "3 to 31, odd"});
  io.rule([&rendering](const JsonValue& place, const JsonObject& /*object*/) {
    const engine::RenderingOptions& checked = rendering.options;
    if (checked.equalise == engine::Equalise::level && !rendering.level) {
      place.refuse_below("/equalise",
                         "is level, but /gains states no level; add level_db and curve there, or "
                         "use rms");
    }
    if (checked.neighbourhood % 2 == 0) {
      place.refuse_below("/neighbourhood", "is " + std::to_string(checked.neighbourhood) +
                                               ", but must be odd; use " +
                                               std::to_string(checked.neighbourhood + 1));
    }
  });
}

}  // namespace

void describe(ObjectIo& io, RenderingSection& rendering) {
  io.choice("model", rendering.options.model, kModelNames,
            {"the rendering model: tangential forces in addition to a wall, or the gradient of one "
             "potential"});
  describe_model_keys(io, rendering.options);
  describe_wall(io, rendering.options);
  describe_texture(io, rendering);
  io.text(
      "device", rendering.device, kDevice,
      {.meaning =
           "the device that the study is for: a product with a model ([which](devices/README.md)), "
           "a [device model](devices/models.md), or a model's file, relative to the study's; used "
           "for [levels](perception.md), simulated participants, `device fit`, and `gains` of a "
           "level. None: simulated participants use an ideal device",
       .written = false,
       .default_text = "none"});
  io.rule([&rendering](const JsonValue& place, const JsonObject& /*object*/) {
    if (!rendering.level || !rendering.device.empty()) return;
    place.refuse_below("/gains", "states a level, which depends on the device; add \"device\"");
  });
}

engine::RenderingOptions parse_rendering(std::string_view text, const std::string& source) {
  const JsonValue place = parse_strict_json(text, source);
  RenderingSection rendering;
  read_settings(place, [&](ObjectIo& io) { describe(io, rendering); });
  if (rendering.level) {
    place.refuse_below("/gains",
                       "states a level, which only a study file may have; give explicit gains");
  }
  return rendering.options;
}

std::string written_rendering(const engine::RenderingOptions& rendering) {
  nlohmann::json every_key = to_json(rendering);
  every_key["touchdown_ramp_n"] = rendering.touchdown_ramp_n;
  return every_key.dump();
}

nlohmann::json to_json(const engine::RenderingOptions& rendering) {
  return to_json(RenderingSection{.options = rendering, .device = {}, .level = {}});
}

}  // namespace touchtrial::study
