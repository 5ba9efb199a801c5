// A bring-up on device models: what it finds, what it never does before the signs are confirmed,
// and what its file keeps.
#include "device/acceptance/bring_up/bring_up.hpp"

#include "device/acceptance/rehearsal.hpp"
#include "device/drivers/registry.hpp"
#include "device/platform/dynamic_library.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using namespace device;

struct Interrupted {};

const std::vector<UnverifiedFact>& falcon_facts() {
  return device::device_driver("falcon").unverified;
}

double& component(Vec3& v, DeviceAxis axis) {
  if (axis == DeviceAxis::x) return v.x;
  return axis == DeviceAxis::y ? v.y : v.z;
}

/// Bench and person in one, on a device model: a person who feels what the model delivers.
class BringUpRig final : public AcceptanceBench, public AcceptancePerson {
 public:
  explicit BringUpRig(const DeviceModel& model)
      : force_scale_(model.planted_faults.force_sign_scale), rehearsal_(model) {}

  bool feels = true;
  bool suspends = true;
  bool carries_elsewhere = false;
  int calls_left = -1;  ///< until the person ends it; negative: never
  std::set<std::string> skips{};

  [[nodiscard]] DeviceInfo info() const override {
    DeviceInfo info = rehearsal_.info();
    info.name = "falcon";
    info.serial = "SN-4711";
    info.firmware = "1.2 of SN-4711";
    return info;
  }
  [[nodiscard]] SafetyLimits limits() const override { return rehearsal_.limits(); }
  void limit_force(double max_n) override { rehearsal_.limit_force(max_n); }
  [[nodiscard]] ServoReport run(const std::string& name, Measurement& measurement) override {
    count();
    const ServoReport report = rehearsal_.run(name, measurement);
    last_n_ = {};
    for (const ServoSample& sample : measurement.samples()) {
      if (norm(sample.force_n) > norm(last_n_)) last_n_ = sample.force_n;
    }
    if (name != "stroke y" && name != "weight y" && name != "wall") {
      greatest_n = std::max(greatest_n, norm(last_n_));
      greatest_limit_n = std::max(greatest_limit_n, limits().max_force_n);
    } else {
      greatest_confirmed_n = std::max(greatest_confirmed_n, norm(last_n_));
      confirmed_limit_n = limits().max_force_n;
    }
    return report;
  }
  [[nodiscard]] std::optional<ServoReport> run_suspended(Measurement& measurement) override {
    if (!suspends) return std::nullopt;
    return run("suspend", measurement);
  }

  [[nodiscard]] Consent ready(const Prompt& prompt) override {
    count();
    if (skips.contains(std::string(prompt.step))) return Consent::skip;
    Prompt done = prompt;
    if (carries_elsewhere && prompt.axis == DeviceAxis::z) done.axis = DeviceAxis::x;
    return rehearsal_.ready(done);
  }
  [[nodiscard]] std::optional<double> weight_n(DeviceAxis axis, double min_n,
                                               double max_n) override {
    count();
    return rehearsal_.weight_n(axis, min_n, max_n);
  }
  [[nodiscard]] std::optional<double> temperature_c(const std::string& /*question*/) override {
    return std::nullopt;
  }
  [[nodiscard]] std::string ask_observation(const std::string& question) override {
    count();
    if (question.find("ruler") != std::string::npos) return "20.5";
    if (question.find("In which direction") == std::string::npos) return "1";
    return std::to_string(feels ? side() : kNowhere);
  }
  void show(const std::string& /*result*/) override {}

  double greatest_n = 0.0;            ///< of every run before and beside the two below
  double greatest_limit_n = 0.0;      ///< of the safety chain in the same runs
  double greatest_confirmed_n = 0.0;  ///< of weight and wall
  double confirmed_limit_n = 0.0;     ///< of the safety chain in these

 private:
  void count() {
    if (calls_left == 0) throw Interrupted{};
    --calls_left;
  }
  /// The number of the answer: right, left, up, down, towards, away.
  [[nodiscard]] int side() const {
    const Vec3 n = {last_n_.x * force_scale_.x, last_n_.y * force_scale_.y,
                    last_n_.z * force_scale_.z};
    if (std::abs(n.x) > 0.0) return n.x > 0.0 ? 1 : 2;
    if (std::abs(n.y) > 0.0) return n.y > 0.0 ? 3 : 4;
    return n.z > 0.0 ? 5 : 6;
  }

  static constexpr int kNowhere = 7;

  Vec3 force_scale_;
  Rehearsal rehearsal_;
  Vec3 last_n_;
};

/// The record as its file has it after every step.
BringUp brought_up(BringUpRig& rig) {
  BringUp record = bring_up_of(rig.info());
  record.program = "test";
  record.scheduling = "other";
  std::string saved;
  const auto save = [&] { saved = bring_up_json(record); };
  save();
  try {
    device::bring_up(rig, rig, falcon_facts(), record, save);
  } catch (const Interrupted&) {
    save();
  }
  CHECK(saved == bring_up_json(record));
  return record;
}

}  // namespace

TEST_CASE("a bring-up finds signs, lengths, readings, force and a wall of a sound device") {
  for (const std::string name : {"falcon", "touch", "omega_3", "inverse3"}) {
    CAPTURE(name);
    BringUpRig rig(device_model(name));
    const BringUp record = brought_up(rig);
    CHECK(record.ended == BringUpEnd::complete);
    CHECK(record.signs_confirmed());
    CHECK(record.number("ruler_mm y") == 20.5);
    CHECK(record.find("felt -z")->word == "away");
    CHECK(record.number("new_readings_hz") == Approx(1000.0).epsilon(0.01));
    CHECK(record.find("encoder_step_mm") != nullptr);
    const std::vector<double> reach_mm = record.find("reach_mm x")->numbers;
    CHECK(reach_mm.at(1) > reach_mm.at(0));
    const std::vector<double> scale = record.find("force_scale_and_error")->numbers;
    CHECK(scale.at(0) == Approx(1.0).margin(scale.at(1)));
    CHECK(record.number("contact_s") > 1.0);
    CHECK(record.find("time_ms")->numbers.size() > 1500);
    CHECK(std::ranges::max(record.find("force_up_mn")->numbers) > 300.0);
    CHECK(rig.greatest_confirmed_n <= kConfirmedN);
    CHECK(rig.confirmed_limit_n == kConfirmedN);
    CHECK(rig.greatest_n <= kSecondPushN + 1e-9);
    CHECK(rig.greatest_limit_n <= kSecondPushN);
    CHECK(record.find("lights")->word == "red");
    CHECK(record.outcome(BringUpStep::cable) == StepOutcome::failed);  // nobody pulled it
    CHECK(record.find("force_without_program") != nullptr);
  }
}

TEST_CASE("a wrong sign of a force ends a bring-up after small pushes alone") {
  for (const DeviceAxis axis : kDeviceAxes) {
    CAPTURE(name_of(axis));
    DeviceModel model = device_model("falcon");
    component(model.planted_faults.force_sign_scale, axis) = -1.0;
    BringUpRig rig(model);
    const BringUp record = brought_up(rig);
    CHECK(record.ended == BringUpEnd::wrong_sign);
    CHECK_FALSE(record.signs_confirmed());
    CHECK(record.findings.back().name == "moved_mm +" + std::string(name_of(axis)));
    CHECK(rig.greatest_n <= kFirstPushN + 1e-9);
    CHECK(rig.greatest_confirmed_n == 0.0);
    CHECK(record.outcome(BringUpStep::push) == StepOutcome::interrupted);
    CHECK(record.outcome(BringUpStep::wall) == StepOutcome::not_reached);
  }
}

TEST_CASE("a reading that runs along another axis ends a bring-up before any force") {
  BringUpRig rig(device_model("falcon"));
  rig.carries_elsewhere = true;
  const BringUp record = brought_up(rig);
  CHECK(record.ended == BringUpEnd::wrong_sign);
  CHECK(record.findings.back().name == "carried_mm z");
  CHECK(rig.greatest_n == 0.0);
  CHECK(record.outcome(BringUpStep::push) == StepOutcome::not_reached);
}

TEST_CASE("pushes that were not felt or were skipped confirm nothing") {
  BringUpRig numb(device_model("falcon"));
  numb.feels = false;
  const BringUp felt_nothing = brought_up(numb);
  CHECK(felt_nothing.ended == BringUpEnd::complete);
  CHECK(felt_nothing.number("push_n -z") == kSecondPushN);
  for (const std::string step : {"ways", "push"}) {
    BringUpRig skipping(device_model("falcon"));
    skipping.skips = {step};
    const BringUp record = brought_up(skipping);
    CHECK(record.ended == BringUpEnd::complete);
    CHECK(skipping.greatest_confirmed_n == 0.0);
    CHECK(record.outcome(BringUpStep::weight) == StepOutcome::left_out);
  }
  CHECK(numb.greatest_n <= kSecondPushN + 1e-9);
  CHECK(numb.greatest_confirmed_n == 0.0);
  CHECK(felt_nothing.outcome(BringUpStep::wall) == StepOutcome::left_out);
}

TEST_CASE("a bring-up interrupted at any moment keeps its results and names the missing steps") {
  int calls = 0;
  std::set<BringUpStep> interrupted;
  for (; calls < 200; ++calls) {
    BringUpRig rig(device_model("falcon"));
    rig.calls_left = calls;
    const BringUp record = brought_up(rig);
    if (record.ended == BringUpEnd::complete) break;
    CAPTURE(calls);
    CHECK(record.ended == BringUpEnd::stopped);
    const auto at = std::ranges::find(record.outcomes, StepOutcome::interrupted);
    REQUIRE(at != record.outcomes.end());
    const auto is_reached = [](StepOutcome outcome) { return outcome > StepOutcome::interrupted; };
    CHECK(std::all_of(record.outcomes.begin(), at, is_reached));
    CHECK(std::all_of(at + 1, record.outcomes.end(),
                      [](StepOutcome outcome) { return outcome == StepOutcome::not_reached; }));
    interrupted.insert(static_cast<BringUpStep>(at - record.outcomes.begin()));
  }
  CHECK(calls < 200);
  CHECK(interrupted.size() == kBringUpSteps - 1);  // it is opened before
}

TEST_CASE("a device that is lost ends a bring-up as a fault") {
  DeviceModel model = device_model("falcon");
  model.planted_faults.lost_after_s = 40.0;
  BringUpRig rig(model);
  const BringUp record = brought_up(rig);
  CHECK(record.ended == BringUpEnd::fault);
  CHECK_FALSE(record.reason.empty());
  CHECK(record.find("noise_mm") != nullptr);
}

TEST_CASE("the file of a bring-up has no serial number, but distinguishes two devices") {
  BringUpRig rig(device_model("falcon"));
  const std::string file = bring_up_json(brought_up(rig));
  CHECK(file.find("4711") == std::string::npos);
  CHECK_THAT(file, holds_text(R"("name": "noise_mm")") && holds_text(R"("value": "right")"));
  DeviceInfo one{.name = "falcon"};
  CHECK(bring_up_of(one).device_mark.empty());
  one.serial = "A1";
  DeviceInfo other = one;
  other.serial = "A2";
  CHECK(bring_up_of(one).device_mark.size() == 4);
  CHECK(bring_up_of(one).device_mark != bring_up_of(other).device_mark);
}

TEST_CASE("a stand-in is called one") {
  DeviceInfo real{.name = "dhd", .model = "omega.3", .library = "3.17.5.1900"};
  CHECK(stand_in_of(real, {}).empty());
  const auto is_stand_in = [&](auto&& change) {
    DeviceInfo info = real;
    DeviceSettings settings;
    change(info, settings);
    return !stand_in_of(info, settings).empty();
  };
  CHECK(is_stand_in([](auto& info, auto&) { info.simulated = true; }));
  CHECK(is_stand_in([](auto& info, auto&) { info.visual = true; }));
  CHECK(is_stand_in([](auto& info, auto&) { info.model = "omega Simulator"; }));
  CHECK(is_stand_in([](auto& info, auto&) { info.library = "3.17 (EMULATED)"; }));
  CHECK(is_stand_in([](auto&, auto& settings) { settings.dhd.library = "/opt/libfake_dhd.so"; }));
  CHECK(is_stand_in([](auto&, auto& settings) { settings.dhd.library = "/opt/fake/libdhd.so"; }));
}

TEST_CASE("a loaded stand-in is marked under any name") {
  const TempFolder folder;
  DeviceInfo info{.name = "openhaptics"};
  DeviceSettings settings;
  settings.openhaptics.library = folder.path() / "libHD.so.3.4";
  std::filesystem::copy_file(TOUCHTRIAL_FAKE_HD, settings.openhaptics.library);
  CHECK(stand_in_of(info, settings).empty());
  const device::DynamicLibrary loaded(settings.openhaptics.library, Unload::never, "");
  CHECK_FALSE(stand_in_of(info, settings).empty());
}

TEST_CASE("every driver with hardware lists what is unverified, each fact once") {
  for (const std::string driver : {"falcon", "dhd", "openhaptics", "inverse3"}) {
    CAPTURE(driver);
    std::set<std::string> ids;
    for (const UnverifiedFact& fact : device::device_driver(driver).unverified) {
      CAPTURE(fact.id);
      CHECK(ids.insert(fact.id).second);
      CHECK_FALSE(fact.what.empty());
      CHECK(fact.question.empty() == fact.answers.empty());
    }
    CHECK(ids.size() >= 5);
  }
}

}  // namespace touchtrial
