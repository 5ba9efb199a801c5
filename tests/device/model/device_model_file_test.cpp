// Files of device models: refusals, and what the program ships.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/model/device_model.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using namespace device;
using nlohmann::json;
namespace fs = std::filesystem;

const fs::path& config() {
  static const fs::path kConfig = fs::path(TOUCHTRIAL_SOURCE_DIR) / "config";
  return kConfig;
}

/// \return the error for a model with this value; empty if it is accepted
std::string refusal_of(const json& model) {
  return message_of<StudyError>([&] { return parse_device_model(model.dump(), "model.json"); });
}

DeviceModel full_model() {
  DeviceModel model = device_model("touch");
  model.viscous_n_s_per_m = 0.5;
  model.static_n = 0.4;
  model.stribeck_mm_s = 7.0;
  model.friction = FrictionShape::per_axis;
  model.lowpass_hz = 120.0;
  model.planted_faults = {{-1.0, 1.2, 1.0}, 0.01, 0.3, 5.0, 6.0, 77};
  return model;
}

}  // namespace

TEST_CASE("a model's file has only what differs from the defaults") {
  const DeviceModel bare = parse_device_model(R"({"name": "test"})", "bare");
  CHECK(device::device_model_json(bare) == "{\n  \"name\": \"test\"\n}\n");
}

TEST_CASE("a model round-trips through its file") {
  std::vector<DeviceModel> models = shipped_device_models();
  models.push_back(full_model());
  for (const DeviceModel& model : models) {
    const std::string text = device::device_model_json(model);
    const DeviceModel again = parse_device_model(text, "written");
    CHECK(device::device_model_json(again) == text);
    CHECK(again.mass_kg == model.mass_kg);
    CHECK(again.structure.stiffness_n_per_mm == model.structure.stiffness_n_per_mm);
    CHECK(again.planted_faults.force_sign_scale == model.planted_faults.force_sign_scale);
    CHECK(again.planted_faults.seed == model.planted_faults.seed);
    CHECK(again.provenance.size() == model.provenance.size());
  }
}

TEST_CASE("parameters that contradict each other are refused, in files and in code") {
  const std::vector<std::pair<json, std::string>> cases = {
      {{{"coulomb_n", 0.3}, {"static_n", 0.2}}, "/static_n coulomb_n"},
      {{{"stribeck_mm_s", 5}}, "/stribeck_mm_s"},
      {{{"max_force_n", 2}, {"continuous_force_n", 3}}, "/continuous_force_n"},
      {{{"velocity_readings", 1}}, "/velocity_readings 1"},
      {{{"structure", {{"stiffness_n_per_mm", 1}, {"tip_share", 0.5}}}}, "/structure"},
      {{{"mass_kg", 0.1}, {"structure", {{"stiffness_n_per_mm", 1}}}}, "/structure/tip_share"},
      {{{"workspace", {{"least_mm", {0, 0, 0}}, {"greatest_mm", {1, 0, 1}}}}},
       "/workspace/greatest_mm least_mm"},
      {{{"mass_kg", -0.1}}, "/mass_kg"},
      {{{"delay_tick", 1}}, "delay_ticks"},
      {{{"provenance", {{"mass_kg", {{"source", "a book"}}}}}}, "/provenance/mass_kg"}};
  for (const auto& [parameters, places] : cases) {
    json model = parameters;
    model["name"] = "test";
    CHECK_THAT(refusal_of(model), names(places));
  }
  CHECK_THAT(refusal_of({{"name", ""}}), names("/name"));
  CHECK_THROWS_AS(parse_device_model(R"({"name": "x", "mass_kg": 1e999})", "model.json"),
                  StudyError);
  CHECK_THROWS_AS(parse_device_model(R"({"name": "x", "mass_kg": NaN})", "model.json"), StudyError);
}

TEST_CASE("a model that was made in code is checked before it runs") {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<std::function<double&(DeviceModel&)>> numbers = {
      [](DeviceModel& m) -> double& { return m.mass_kg; },
      [](DeviceModel& m) -> double& { return m.viscous_n_s_per_m; },
      [](DeviceModel& m) -> double& { return m.coulomb_n; },
      [](DeviceModel& m) -> double& { return m.static_n; },
      [](DeviceModel& m) -> double& { return m.stribeck_mm_s; },
      [](DeviceModel& m) -> double& { return m.position_step_mm; },
      [](DeviceModel& m) -> double& { return m.force_step_n; },
      [](DeviceModel& m) -> double& { return m.max_force_n; },
      [](DeviceModel& m) -> double& { return m.continuous_force_n; },
      [](DeviceModel& m) -> double& { return m.lowpass_hz; },
      [](DeviceModel& m) -> double& { return m.structure.stiffness_n_per_mm; },
      [](DeviceModel& m) -> double& { return m.structure.tip_share; },
      [](DeviceModel& m) -> double& { return m.structure.damping_ratio; },
      [](DeviceModel& m) -> double& { return m.workspace->max_mm.y; },
      [](DeviceModel& m) -> double& { return m.workspace->min_mm.x; },
      [](DeviceModel& m) -> double& { return m.max_stiffness_n_per_mm; },
      [](DeviceModel& m) -> double& { return m.planted_faults.force_sign_scale.z; },
      [](DeviceModel& m) -> double& { return m.planted_faults.position_noise_mm; },
      [](DeviceModel& m) -> double& { return m.planted_faults.gravity_n; },
      [](DeviceModel& m) -> double& { return m.planted_faults.silent_after_s; },
      [](DeviceModel& m) -> double& { return m.planted_faults.lost_after_s; }};
  CHECK_NOTHROW(check_device_model(full_model()));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    INFO(i);
    for (const double absurd : {kNaN, kInfinity, -kInfinity, 1e9, -1e9}) {
      DeviceModel model = full_model();
      numbers[i](model) = absurd;
      CHECK_THROWS_AS(check_device_model(model), std::invalid_argument);
      CHECK_THROWS_AS(DeviceDynamics(model), std::invalid_argument);
    }
  }
  for (const int absurd : {-1, 101}) {
    DeviceModel model = full_model();
    model.delay_ticks = absurd;
    CHECK_THROWS_AS(ModelledDevice(model), std::invalid_argument);
    model.delay_ticks = 1;
    model.velocity_readings = absurd;
    CHECK_THROWS_AS(check_device_model(model), std::invalid_argument);
  }
}

TEST_CASE(
    "the built-in models are the files in config, and each states the sources of its numbers") {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(config() / "devices")) {
    const json file = json::parse(text_of(read_file(entry.path())));
    const DeviceModel model = read_device_model(entry.path());
    INFO(entry.path().string());
    CHECK(model.name == entry.path().stem().string());
    CHECK_FALSE(model.title.empty());
    CHECK(device::device_model_json(device_model(model.name)) == device::device_model_json(model));
    for (const auto& [key, unused] : file.items()) {
      if (key == "name" || key == "title" || key == "provenance") continue;
      CHECK(key != "planted");
      REQUIRE(model.provenance.contains(key));
      CHECK_FALSE(model.provenance.at(key).source.empty());
      // Nobody had a device.
      CHECK(model.provenance.at(key).confidence != Confidence::measured);
    }
    for (const auto& [key, unused] : model.provenance) CHECK(file.contains(key));
    names.insert(model.name);
  }
  CHECK(names.size() == shipped_device_models().size());
  for (const char* name : {"ideal", "touch", "touch_x", "premium_1_5", "falcon"}) {
    CHECK(names.contains(name));
  }
}

TEST_CASE("a model is found by name or by file, and a misspelt one by the nearest name") {
  CHECK(device_model("falcon").title == "Novint Falcon");
  CHECK_THROWS_WITH(device_model("flacon"), names("flacon falcon"));
  CHECK_THROWS_AS(device_model("flacon"), UsageError);
  CHECK_THROWS_WITH(device_model("zzzzzzzzz"), holds_text("touchtrial device models"));
  const TempFolder folder;
  const fs::path file = folder.path() / "ours.json";
  replace_file(file, device::device_model_json(full_model()));
  CHECK(device_model(file.string()).lowpass_hz == 120.0);
  CHECK_THROWS_AS(device_model((folder.path() / "gone.json").string()), FileError);
  replace_file(file, R"({"name": "ours", "mass_kg": 50})");
  CHECK_THROWS_WITH(device_model(file.string()), holds_text("ours.json: /mass_kg"));
}

}  // namespace touchtrial
