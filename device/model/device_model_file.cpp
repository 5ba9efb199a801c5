/// \file Reads and writes device model files.
#include "core/describe.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/nearest_name.hpp"
#include "device/model/device_model.hpp"
#include "device/settings_schemas.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace touchtrial::device {
namespace {

constexpr NumberRange kTimeS{.low = 0.0, .high = 1e6};
constexpr NumberRange kCornerMm{.low = -1000.0, .high = 1000.0};
constexpr std::int64_t kMaxSeed = 9'007'199'254'740'991;  // the largest integer exact in JSON

constexpr auto kFrictionShapes = std::to_array<Named<FrictionShape>>(
    {{"isotropic", FrictionShape::isotropic}, {"per_axis", FrictionShape::per_axis}});
constexpr auto kWorkspaceShapes = std::to_array<Named<WorkspaceShape>>(
    {{"box", WorkspaceShape::box}, {"ellipsoid", WorkspaceShape::ellipsoid}});
constexpr auto kConfidences =
    std::to_array<Named<Confidence>>({{"opened", Confidence::opened},
                                      {"transcript", Confidence::transcript},
                                      {"derived", Confidence::derived},
                                      {"memory", Confidence::memory},
                                      {"guess", Confidence::guess},
                                      {"measured", Confidence::measured}});

void describe_friction(ObjectIo& io, DeviceModel& model) {
  io.number("viscous_n_s_per_m", model.viscous_n_s_per_m, {0.0, 100.0},
            {"friction proportional to speed"});
  io.number("coulomb_n", model.coulomb_n, {0.0, 10.0}, {"friction independent of speed"});
  io.number("static_n", model.static_n, {0.0, 10.0},
            {"friction at rest, at least `coulomb_n`; 0: equal to `coulomb_n`"});
  io.number("stribeck_mm_s", model.stribeck_mm_s, {0.0, 1000.0},
            {"speed range over which static friction falls to Coulomb friction; 0: immediately. "
             "Needs `static_n`"});
}

void describe_numbers(ObjectIo& io, DeviceModel& model) {
  io.number("mass_kg", model.mass_kg, {0.0, 5.0}, {"apparent mass at the tip, without the hand"});
  describe_friction(io, model);
  io.number("position_step_mm", model.position_step_mm, {0.0, 1.0},
            {"readings are multiples of this step"});
  io.number("force_step_n", model.force_step_n, {0.0, 1.0}, {"forces are whole steps"});
  io.number("max_force_n", model.max_force_n, {0.0, 100.0},
            {"maximum norm of the force; 0: no limit"});
  io.number("continuous_force_n", model.continuous_force_n, {0.0, 100.0},
            {"force that can be held indefinitely, at most `max_force_n`; 0: unknown"});
  io.number("lowpass_hz", model.lowpass_hz, {0.0, 5000.0},
            {"cut-off of the motors' first-order low-pass; 0: none"});
  io.number("max_stiffness_n_per_mm", model.max_stiffness_n_per_mm, {0.0, 100.0},
            {"maximum stiffness of a wall, as stated by the maker; 0: unknown"});
}

void describe_structure(ObjectIo& io, StructureModel& structure) {
  io.number("stiffness_n_per_mm", structure.stiffness_n_per_mm, {0.0, 1000.0},
            {"spring between motors and tip; 0: rigid. Needs `mass_kg`"});
  io.number("tip_share", structure.tip_share, {0.0, 1.0},
            {"share of the mass that is at the tip; between 0 and 1 with a spring"});
  io.number("damping_ratio", structure.damping_ratio, {0.0, 2.0},
            {"damping ratio of the tip while the motors are held"});
}

void describe_workspace(ObjectIo& io, Workspace& workspace) {
  io.member("least_mm",
            {.meaning = "left, bottom, back corner in the device frame", .required = true}, true,
            [&](ValueIo& value) { value.axes(workspace.min_mm, kCornerMm); });
  io.member("greatest_mm",
            {.meaning = "the opposite corner, greater on each axis", .required = true}, true,
            [&](ValueIo& value) { value.axes(workspace.max_mm, kCornerMm); });
  io.choice("shape", workspace.shape, kWorkspaceShapes,
            {"the whole box, or the ellipsoid inscribed in it"});
}

/// Describes the parameters that have a provenance.
void describe_parameters(ObjectIo& io, DeviceModel& model) {
  describe_numbers(io, model);
  io.choice("friction", model.friction, kFrictionShapes,
            {"friction opposite to the velocity, or on each axis separately"});
  io.integer("velocity_readings", model.velocity_readings, 0, 32,
             {"number of readings for the line fit whose slope is the reported velocity, at least "
              "2; 0: the true velocity"});
  io.integer("delay_ticks", model.delay_ticks, 0, 100, {"servo ticks from a command to its force"});
  io.boolean("zero_order_hold", model.zero_order_hold,
             {"whether a force acts throughout the tick; always so with a structure"});
  io.part("structure", model.structure, {"a second mass at the tip, on a spring"},
          describe_structure);
  io.optional(
      "workspace", model.workspace,
      {"the reachable positions: x to the right, y up, z towards the person"},
      [](ValueIo& value, Workspace& workspace) { value.part(workspace, describe_workspace); });
}

void describe_source(ObjectIo& io, Provenance& provenance) {
  io.text("source", provenance.source, {},
          {.meaning = "source of the number, one line for people", .required = true});
  io.choice("confidence", provenance.confidence, kConfidences,
            {.meaning = "`opened`: read in a public source; `transcript`: read in a transcript of "
                        "a paper; `derived`: computed from such; `memory`: remembered, unverified; "
                        "`guess`: unknown; `measured`: on this device",
             .required = true});
}

void describe_provenance(ObjectIo& io, std::map<std::string, Provenance>& provenance) {
  DeviceModel example;
  std::vector<std::string_view> keys =
      keys_of([&example](ObjectIo& parameters) { describe_parameters(parameters, example); });
  std::ranges::sort(keys);
  for (const std::string_view key : keys) {
    std::optional<Provenance> source;
    if (const auto found = provenance.find(std::string(key)); found != provenance.end()) {
      source = found->second;
    }
    io.optional(key, source, {"of this number"},
                [](ValueIo& value, Provenance& entry) { value.part(entry, describe_source); });
    if (source) provenance[std::string(key)] = *source;
  }
}

void describe_planted(ObjectIo& io, DeviceModel::PlantedFaults& planted) {
  io.member("force_sign_scale", {"factors of the delivered force on each axis"}, true,
            [&](ValueIo& value) {
              value.axes(planted.force_sign_scale, {-10.0, 10.0});
            });
  io.number("position_noise_mm", planted.position_noise_mm, {0.0, 1.0},
            {"standard deviation of white noise on each axis of a reading"});
  io.number("gravity_n", planted.gravity_n, {0.0, 10.0}, {"uncompensated weight of the handle"});
  io.number("silent_after_s", planted.silent_after_s, kTimeS,
            {"time at which readings freeze and forces stop; 0: never"});
  io.number("lost_after_s", planted.lost_after_s, kTimeS,
            {"time at which the link is lost; 0: never"});
  io.integer("seed", planted.seed, 0, kMaxSeed, {"of the noise"});
}

/// Checks parameters against each other.
void check_parameters(const JsonValue& place, const DeviceModel& model) {
  const auto refuse_if = [&](bool is_wrong, const char* pointer, const char* what) {
    if (is_wrong) place.refuse_below(pointer, what);
  };
  refuse_if(model.static_n != 0.0 && model.static_n < model.coulomb_n, "/static_n",
            "is less than coulomb_n; give at least that, or leave it out");
  refuse_if(model.stribeck_mm_s != 0.0 && model.static_n == 0.0, "/stribeck_mm_s",
            "needs static friction; give static_n");
  refuse_if(model.max_force_n != 0.0 && model.continuous_force_n > model.max_force_n,
            "/continuous_force_n", "is more than max_force_n; give at most that");
  refuse_if(model.velocity_readings == 1, "/velocity_readings",
            "is 1, but a slope needs 2 readings; give 0, or at least 2");
  if (model.workspace) {
    const auto& [min, max] = std::pair(model.workspace->min_mm, model.workspace->max_mm);
    refuse_if(min.x >= max.x || min.y >= max.y || min.z >= max.z, "/workspace/greatest_mm",
              "must be greater than least_mm on each axis");
  }
  const StructureModel& structure = model.structure;
  if (structure.stiffness_n_per_mm == 0.0) return;
  refuse_if(model.mass_kg == 0.0, "/structure", "needs a mass to divide; give mass_kg");
  refuse_if(structure.tip_share == 0.0 || structure.tip_share == 1.0, "/structure/tip_share",
            "leaves one of the two without mass; give a number between 0 and 1");
}

/// Describes the parameters that a simulation uses: no names, no sources.
void describe_device(ObjectIo& io, DeviceModel& model) {
  describe_parameters(io, model);
  io.part("planted", model.planted_faults, {"faults of a broken device, for rehearsals only"},
          describe_planted);
  io.rule([&model](const JsonValue& place, const JsonObject& /*object*/) {
    check_parameters(place, model);
  });
}

void describe(ObjectIo& io, DeviceModel& model) {
  io.text("name", model.name, {.min_length = 1, .description = "not empty"},
          {.meaning = "name for commands", .required = true});
  io.text("title", model.title, {}, {"name for people"});
  describe_parameters(io, model);
  io.member("provenance",
            {.meaning = "the source of each number", .range = "by key: `source`, `confidence`"},
            !model.provenance.empty(),
            [&model](ValueIo& value) { value.part(model.provenance, describe_provenance); });
  io.part("planted", model.planted_faults, {"faults of a broken device, for rehearsals only"},
          describe_planted);
  io.rule([&model](const JsonValue& place, const JsonObject& object) {
    if (model.name.empty()) object.at("name").refuse("is empty; give a name");
    check_parameters(place, model);
  });
}

}  // namespace

std::string_view name_of(Confidence confidence) noexcept {
  return name_in(kConfidences, confidence);
}

void check_device_model(const DeviceModel& model) {
  DeviceModel copy = model;
  const Description description = [&copy](ObjectIo& io) { describe_device(io, copy); };
  const std::string text = described_json(description, description);
  try {
    read_settings(parse_strict_json(text, "device model " + model.name), description);
  } catch (const StudyError& error) {
    throw std::invalid_argument(error.what());
  }
}

DeviceModel parse_device_model(std::string_view text, const std::string& source) {
  DeviceModel model;
  read_settings(parse_strict_json(text, source), [&](ObjectIo& io) { describe(io, model); });
  return model;
}

DeviceModel read_device_model(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMaxFileBytes = 1U << 20U;
  const Bytes content = read_file(file, kMaxFileBytes);
  return parse_device_model(text_of(content), file.string());
}

std::string device_model_json(const DeviceModel& model) {
  DeviceModel copy = model;
  DeviceModel defaults;
  return json_text(nlohmann::ordered_json::parse(
      described_json([&](ObjectIo& io) { describe(io, copy); },
                     [&](ObjectIo& io) { describe(io, defaults); }, WrittenKeys::changed)));
}

std::string device_model_schema() {
  DeviceModel defaults;
  return annotated_schema("Touchtrial device model",
                          "The parameters of a device in virtual time. Every key but the name has "
                          "a default; a parameter of zero disables its stage.",
                          R"([{"name": "heavy", "mass_kg": 0.5, "coulomb_n": 0.2,
           "provenance": {"mass_kg": {"source": "kitchen scale", "confidence": "measured"}}},
          {"name": "reversed", "mass_kg": 0.1, "planted": {"force_sign_scale": [-1, 1, 1]}}])",
                          [&](ObjectIo& io) { describe(io, defaults); });
}

const std::vector<DeviceModel>& shipped_device_models() {
  static const std::vector<DeviceModel> kModels = [] {
    std::vector<DeviceModel> models;
    for (const std::string_view text : built_in_device_models()) {
      models.push_back(parse_device_model(text, "a built-in device model"));
    }
    std::ranges::sort(models, {}, &DeviceModel::name);
    return models;
  }();
  return kModels;
}

DeviceModel device_model(const std::string& name) {
  std::vector<std::string_view> names;
  for (const DeviceModel& model : shipped_device_models()) {
    if (model.name == name) return model;
    names.push_back(model.name);
  }
  if (name.find('/') != std::string::npos || name.ends_with(".json")) {
    return read_device_model(name);
  }
  const auto nearest = nearest_product(name, names);
  throw UsageError(
      one_line(name + ": there is no such device model; " +
               (nearest ? "did you mean " + std::string(*nearest) + "?"
                        : "see touchtrial device models, or give a file that ends in .json")));
}

}  // namespace touchtrial::device
