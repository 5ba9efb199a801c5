#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/nearest_name.hpp"
#include "core/strict_json.hpp"
#include "device/model/device_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace touchtrial::device {
namespace {

constexpr NumberRange kScale{.low = -10.0, .high = 10.0};
constexpr NumberRange kTimeS{.low = 0.0, .high = 1e6};
constexpr NumberRange kPlaceMm{.low = -1000.0, .high = 1000.0};
constexpr std::int64_t kMaxDelayTicks = 100;
constexpr std::int64_t kMaxVelocityReadings = 32;
constexpr std::int64_t kMaxSeed = 9'007'199'254'740'991;  // the largest that JSON has exactly

/// A number of a file's object, and its place in the struct.
template <typename Struct>
struct NumberField {
  std::string_view key;
  double Struct::*member;
  NumberRange range;
};

constexpr std::array kFields = {
    NumberField<DeviceModel>{"mass_kg", &DeviceModel::mass_kg, {0.0, 5.0}},
    NumberField<DeviceModel>{"viscous_n_s_per_m", &DeviceModel::viscous_n_s_per_m, {0.0, 100.0}},
    NumberField<DeviceModel>{"coulomb_n", &DeviceModel::coulomb_n, {0.0, 10.0}},
    NumberField<DeviceModel>{"static_n", &DeviceModel::static_n, {0.0, 10.0}},
    NumberField<DeviceModel>{"stribeck_mm_s", &DeviceModel::stribeck_mm_s, {0.0, 1000.0}},
    NumberField<DeviceModel>{"position_step_mm", &DeviceModel::position_step_mm, {0.0, 1.0}},
    NumberField<DeviceModel>{"force_step_n", &DeviceModel::force_step_n, {0.0, 1.0}},
    NumberField<DeviceModel>{"max_force_n", &DeviceModel::max_force_n, {0.0, 100.0}},
    NumberField<DeviceModel>{"continuous_force_n", &DeviceModel::continuous_force_n, {0.0, 100.0}},
    NumberField<DeviceModel>{"lowpass_hz", &DeviceModel::lowpass_hz, {0.0, 5000.0}},
    NumberField<DeviceModel>{
        "max_stiffness_n_per_mm", &DeviceModel::max_stiffness_n_per_mm, {0.0, 100.0}}};

constexpr std::array kStructureFields = {
    NumberField<StructureModel>{
        "stiffness_n_per_mm", &StructureModel::stiffness_n_per_mm, {0.0, 1000.0}},
    NumberField<StructureModel>{"tip_share", &StructureModel::tip_share, {0.0, 1.0}},
    NumberField<StructureModel>{"damping_ratio", &StructureModel::damping_ratio, {0.0, 2.0}}};

constexpr std::array kPlantedFields = {
    NumberField<DeviceModel::Planted>{
        "position_noise_mm", &DeviceModel::Planted::position_noise_mm, {0.0, 1.0}},
    NumberField<DeviceModel::Planted>{"gravity_n", &DeviceModel::Planted::gravity_n, {0.0, 10.0}},
    NumberField<DeviceModel::Planted>{"silent_after_s", &DeviceModel::Planted::silent_after_s,
                                      kTimeS},
    NumberField<DeviceModel::Planted>{"lost_after_s", &DeviceModel::Planted::lost_after_s, kTimeS}};

/// Other keys that a provenance may have.
constexpr std::array<std::string_view, 6> kOtherParameters = {
    "friction", "velocity_readings", "delay_ticks", "zero_order_hold", "structure", "workspace"};

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

/// A parameter that is out of range, or contradicts another one.
struct Problem {
  std::string pointer;
  std::string what;  ///< with the remedy
};

bool is_within(Vec3 a, const NumberRange& range) noexcept {
  return range.contains(a.x) && range.contains(a.y) && range.contains(a.z);
}

template <typename Struct, std::size_t size>
std::optional<Problem> out_of_range(const std::array<NumberField<Struct>, size>& fields,
                                    const Struct& values, const std::string& pointer) {
  for (const NumberField<Struct>& field : fields) {
    if (field.range.contains(values.*field.member)) continue;
    return Problem{
        pointer + "/" + std::string(field.key),
        "must be in [" + number_text(field.range.low) + ", " + number_text(field.range.high) + "]"};
  }
  return std::nullopt;
}

std::optional<Problem> problem_of_ranges(const DeviceModel& model) {
  if (auto problem = out_of_range(kFields, model, "")) return problem;
  if (auto problem = out_of_range(kStructureFields, model.structure, "/structure")) return problem;
  if (auto problem = out_of_range(kPlantedFields, model.planted, "/planted")) return problem;
  if (!is_within(model.planted.force_sign_scale, kScale)) {
    return Problem{"/planted/force_sign_scale", "must be in [-10, 10] on each axis"};
  }
  if (model.planted.seed > static_cast<std::uint64_t>(kMaxSeed)) {
    return Problem{"/planted/seed", "must be in [0, 9007199254740991]"};
  }
  if (model.delay_ticks < 0 || model.delay_ticks > kMaxDelayTicks) {
    return Problem{"/delay_ticks", "must be in [0, 100]"};
  }
  if (model.velocity_readings < 0 || model.velocity_readings > kMaxVelocityReadings) {
    return Problem{"/velocity_readings", "must be in [0, 32]"};
  }
  return std::nullopt;
}

std::optional<Problem> problem_of_structure(const DeviceModel& model) {
  const StructureModel& structure = model.structure;
  if (structure.stiffness_n_per_mm == 0.0) return std::nullopt;
  if (model.mass_kg == 0.0) {
    return Problem{"/structure", "needs a mass that it can share; give mass_kg"};
  }
  if (structure.tip_share == 0.0 || structure.tip_share == 1.0) {
    return Problem{"/structure/tip_share",
                   "leaves one of the two without mass; give a number "
                   "between 0 and 1"};
  }
  return std::nullopt;
}

std::optional<Problem> problem_of_workspace(const Workspace& workspace) {
  const Vec3 least = workspace.least_mm;
  const Vec3 greatest = workspace.greatest_mm;
  if (!is_within(least, kPlaceMm) || !is_within(greatest, kPlaceMm)) {
    return Problem{"/workspace", "must be in [-1000, 1000] mm"};
  }
  if (least.x < greatest.x && least.y < greatest.y && least.z < greatest.z) return std::nullopt;
  return Problem{"/workspace/greatest_mm", "must be greater than least_mm on each axis"};
}

/// \return what the parameters have against each other
std::optional<Problem> contradiction(const DeviceModel& model) {
  if (model.static_n != 0.0 && model.static_n < model.coulomb_n) {
    return Problem{"/static_n", "is less than coulomb_n; give at least that, or leave it out"};
  }
  if (model.stribeck_mm_s != 0.0 && model.static_n == 0.0) {
    return Problem{"/stribeck_mm_s", "has no static friction to fall from; give static_n"};
  }
  if (model.max_force_n != 0.0 && model.continuous_force_n > model.max_force_n) {
    return Problem{"/continuous_force_n", "is more than max_force_n; give at most that"};
  }
  if (model.velocity_readings == 1) {
    return Problem{"/velocity_readings", "is 1, which has no slope; give 0, or at least 2"};
  }
  if (model.workspace) {
    if (auto problem = problem_of_workspace(*model.workspace)) return problem;
  }
  return problem_of_structure(model);
}

template <typename Struct, std::size_t size>
std::vector<std::string_view> keys_of(const std::array<NumberField<Struct>, size>& fields,
                                      std::initializer_list<std::string_view> others) {
  std::vector<std::string_view> keys;
  for (const NumberField<Struct>& field : fields) keys.push_back(field.key);
  keys.insert(keys.end(), others);
  return keys;
}

std::vector<std::string_view> parameter_keys() {
  std::vector<std::string_view> keys = keys_of(kFields, {});
  keys.insert(keys.end(), kOtherParameters.begin(), kOtherParameters.end());
  return keys;
}

template <typename Struct, std::size_t size>
void read_fields(const JsonObject& object, const std::array<NumberField<Struct>, size>& fields,
                 Struct& values) {
  for (const NumberField<Struct>& field : fields) {
    if (const auto member = object.find(field.key)) {
      values.*field.member = member->number(field.range);
    }
  }
}

Vec3 read_axes_of(const JsonValue& place, const NumberRange& range) {
  const std::vector<JsonValue> items = place.items(3, 3);
  return {items[0].number(range), items[1].number(range), items[2].number(range)};
}

StructureModel read_structure(const JsonValue& place) {
  StructureModel structure;
  read_fields(place.object(keys_of(kStructureFields, {})), kStructureFields, structure);
  return structure;
}

Workspace read_workspace(const JsonValue& place) {
  const JsonObject object = place.object({"least_mm", "greatest_mm", "shape"});
  Workspace workspace;
  workspace.least_mm = read_axes_of(object.at("least_mm"), kPlaceMm);
  workspace.greatest_mm = read_axes_of(object.at("greatest_mm"), kPlaceMm);
  if (const auto shape = object.find("shape")) workspace.shape = shape->choice(kWorkspaceShapes);
  return workspace;
}

DeviceModel::Planted read_planted(const JsonValue& place) {
  const JsonObject object = place.object(keys_of(kPlantedFields, {"force_sign_scale", "seed"}));
  DeviceModel::Planted planted;
  read_fields(object, kPlantedFields, planted);
  if (const auto scale = object.find("force_sign_scale")) {
    planted.force_sign_scale = read_axes_of(*scale, kScale);
  }
  if (const auto seed = object.find("seed")) {
    planted.seed = static_cast<std::uint64_t>(seed->integer(0, kMaxSeed));
  }
  return planted;
}

std::map<std::string, Provenance> read_provenance(const JsonValue& place) {
  const std::vector<std::string_view> keys = parameter_keys();
  const JsonObject object = place.object(keys);
  std::map<std::string, Provenance> provenance;
  for (const std::string_view key : keys) {
    const auto member = object.find(key);
    if (!member) continue;
    const JsonObject entry = member->object({"source", "confidence"});
    provenance[std::string(key)] = {entry.at("source").text(),
                                    entry.at("confidence").choice(kConfidences)};
  }
  return provenance;
}

void read_other_parameters(const JsonObject& object, DeviceModel& model) {
  if (const auto shape = object.find("friction")) model.friction = shape->choice(kFrictionShapes);
  if (const auto count = object.find("velocity_readings")) {
    model.velocity_readings = static_cast<int>(count->integer(0, kMaxVelocityReadings));
  }
  if (const auto ticks = object.find("delay_ticks")) {
    model.delay_ticks = static_cast<int>(ticks->integer(0, kMaxDelayTicks));
  }
  if (const auto hold = object.find("zero_order_hold")) model.zero_order_hold = hold->truth();
  if (const auto structure = object.find("structure")) model.structure = read_structure(*structure);
  if (const auto workspace = object.find("workspace")) model.workspace = read_workspace(*workspace);
}

using nlohmann::ordered_json;

ordered_json axes_json(Vec3 a) {
  return ordered_json::array({a.x, a.y, a.z});
}

template <typename Struct, std::size_t size>
void add_fields(ordered_json& object, const std::array<NumberField<Struct>, size>& fields,
                const Struct& values) {
  for (const NumberField<Struct>& field : fields) {
    if (values.*field.member != 0.0) object[std::string(field.key)] = values.*field.member;
  }
}

ordered_json planted_json(const DeviceModel::Planted& planted) {
  const DeviceModel::Planted none;
  ordered_json object = ordered_json::object();
  add_fields(object, kPlantedFields, planted);
  if (planted.force_sign_scale != none.force_sign_scale) {
    object["force_sign_scale"] = axes_json(planted.force_sign_scale);
  }
  if (planted.seed != none.seed) object["seed"] = planted.seed;
  return object;
}

void add_other_parameters(ordered_json& object, const DeviceModel& model) {
  if (model.friction != FrictionShape::isotropic) {
    object["friction"] = name_in(kFrictionShapes, model.friction);
  }
  if (model.velocity_readings != 0) object["velocity_readings"] = model.velocity_readings;
  if (model.delay_ticks != 0) object["delay_ticks"] = model.delay_ticks;
  if (model.zero_order_hold) object["zero_order_hold"] = true;
  if (model.structure.stiffness_n_per_mm != 0.0) {
    object["structure"] = ordered_json::object();
    add_fields(object["structure"], kStructureFields, model.structure);
  }
  if (model.workspace) {
    object["workspace"] = {{"least_mm", axes_json(model.workspace->least_mm)},
                           {"greatest_mm", axes_json(model.workspace->greatest_mm)},
                           {"shape", name_in(kWorkspaceShapes, model.workspace->shape)}};
  }
}

}  // namespace

std::string_view name_of(Confidence confidence) noexcept {
  return name_in(kConfidences, confidence);
}

void check_device_model(const DeviceModel& model) {
  auto problem = problem_of_ranges(model);
  if (!problem) problem = contradiction(model);
  if (!problem) return;
  throw std::invalid_argument("device model " + model.name + ": " + problem->pointer + ": " +
                              problem->what);
}

DeviceModel parse_device_model(std::string_view text, const std::string& source) {
  std::vector<std::string_view> keys = parameter_keys();
  keys.insert(keys.end(), {"name", "title", "provenance", "planted"});
  const JsonValue root = parse_strict_json(text, source);
  const JsonObject object = root.object(keys);
  DeviceModel model;
  model.name = object.at("name").text();
  if (model.name.empty()) object.at("name").refuse("is empty; give a name");
  if (const auto title = object.find("title")) model.title = title->text();
  read_fields(object, kFields, model);
  read_other_parameters(object, model);
  if (const auto planted = object.find("planted")) model.planted = read_planted(*planted);
  if (const auto sources = object.find("provenance")) model.provenance = read_provenance(*sources);
  if (const auto problem = contradiction(model)) root.refuse_below(problem->pointer, problem->what);
  return model;
}

DeviceModel read_device_model(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargest = 1U << 20U;
  const Bytes content = read_file(file, kLargest);
  return parse_device_model(text_of(content), file.string());
}

std::string device_model_json(const DeviceModel& model) {
  ordered_json object;
  object["name"] = model.name;
  if (!model.title.empty()) object["title"] = model.title;
  add_fields(object, kFields, model);
  add_other_parameters(object, model);
  for (const auto& [key, provenance] : model.provenance) {
    object["provenance"][key] = {{"source", provenance.source},
                                 {"confidence", name_of(provenance.confidence)}};
  }
  if (ordered_json planted = planted_json(model.planted); !planted.empty()) {
    object["planted"] = std::move(planted);
  }
  return json_text(object);
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
