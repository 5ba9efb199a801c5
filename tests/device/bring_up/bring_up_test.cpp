// A bring-up on device models: what it finds, what it never does before the signs are confirmed,
// and what its file keeps and refuses.
#include "device/bring_up/bring_up.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "device/acceptance/rehearsal.hpp"
#include "device/platform/dynamic_library.hpp"
#include "device/registry.hpp"
#include "protocols/design/refusal.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using device::BringUp;
using device::BringUpEnd;
using device::BringUpStep;
using device::DeviceAxis;
using device::StepOutcome;
using nlohmann::json;

struct Interrupted {};

const std::vector<device::UnverifiedFact>& falcon_facts() {
  return device::device_driver("falcon").unverified;
}

double& component(Vec3& v, DeviceAxis axis) {
  if (axis == DeviceAxis::x) return v.x;
  return axis == DeviceAxis::y ? v.y : v.z;
}

/// Bench and person in one, on a device model: a person who feels what the model delivers.
class BringUpRig final : public device::AcceptanceBench, public device::AcceptancePerson {
 public:
  explicit BringUpRig(const device::DeviceModel& model)
      : force_scale_(model.planted.force_sign_scale), rehearsal_(model) {}

  bool feels = true;
  bool suspends = true;
  bool carries_elsewhere = false;
  int calls_left = -1;  ///< until the person ends it; negative: never
  std::set<std::string> skips{};

  [[nodiscard]] device::DeviceInfo info() const override {
    device::DeviceInfo info = rehearsal_.info();
    info.name = "falcon";
    info.serial = "SN-4711";
    info.firmware = "1.2 of SN-4711";
    return info;
  }
  [[nodiscard]] device::SafetyLimits limits() const override { return rehearsal_.limits(); }
  void limit_force(double most_n) override { rehearsal_.limit_force(most_n); }
  [[nodiscard]] device::ServoReport run(const std::string& name,
                                        device::Measurement& measurement) override {
    count();
    const device::ServoReport report = rehearsal_.run(name, measurement);
    last_n_ = {};
    for (const device::ServoSample& sample : measurement.samples()) {
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
  [[nodiscard]] std::optional<device::ServoReport> run_suspended(
      device::Measurement& measurement) override {
    if (!suspends) return std::nullopt;
    return run("suspend", measurement);
  }

  [[nodiscard]] device::Consent ready(const device::Prompt& prompt) override {
    count();
    if (skips.contains(std::string(prompt.step))) return device::Consent::skip;
    device::Prompt done = prompt;
    if (carries_elsewhere && prompt.axis == DeviceAxis::z) done.axis = DeviceAxis::x;
    return rehearsal_.ready(done);
  }
  [[nodiscard]] std::optional<double> weight_n(DeviceAxis axis, double least_n,
                                               double most_n) override {
    count();
    return rehearsal_.weight_n(axis, least_n, most_n);
  }
  [[nodiscard]] std::optional<double> temperature_c(const std::string& /*question*/) override {
    return std::nullopt;
  }
  [[nodiscard]] std::string saw(const std::string& question) override {
    count();
    if (question.find("ruler") != std::string::npos) return "20.5";
    if (question.find("Towards which side") == std::string::npos) return "1";
    return std::to_string(feels ? side() : kNowhere);
  }
  void tell(const std::string& /*result*/) override {}

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
  device::Rehearsal rehearsal_;
  Vec3 last_n_;
};

/// The record as its file has it after every step.
BringUp brought_up(BringUpRig& rig) {
  BringUp record = device::bring_up_of(rig.info());
  record.program = "test";
  record.scheduling = "other";
  std::string saved;
  const auto save = [&] { saved = device::bring_up_json(record); };
  save();
  try {
    device::bring_up(rig, rig, falcon_facts(), record, save);
  } catch (const Interrupted&) {
    save();
  }
  BringUp read = device::parse_bring_up(saved, "saved");
  CHECK(device::bring_up_json(read) == device::bring_up_json(record));
  return read;
}

const std::string& whole_file() {
  static const std::string file = [] {
    BringUpRig rig(device::device_model("falcon"));
    return device::bring_up_json(brought_up(rig));
  }();
  return file;
}

const device::UnverifiedFact& fact_of(const std::string& driver, const std::string& id) {
  const auto& facts = device::device_driver(driver).unverified;
  return *std::ranges::find(facts, id, &device::UnverifiedFact::id);
}

}  // namespace

TEST_CASE("a bring-up finds signs, lengths, readings, force and a wall of a sound device") {
  for (const std::string name : {"falcon", "touch", "omega_3", "inverse3"}) {
    CAPTURE(name);
    BringUpRig rig(device::device_model(name));
    const BringUp record = brought_up(rig);
    CHECK(record.ended == BringUpEnd::complete);
    CHECK(record.signs_confirmed());
    CHECK(record.number("ruler y") == 20.5);
    CHECK(record.find("felt -z")->word == "away");
    CHECK(record.number("new readings") == Approx(1000.0).epsilon(0.01));
    CHECK(record.find("encoder step") != nullptr);
    const std::vector<double> reach_mm = record.find("reach x")->numbers;
    CHECK(reach_mm.at(1) > reach_mm.at(0));
    const std::vector<double> scale = record.find("force scale and error")->numbers;
    CHECK(scale.at(0) == Approx(1.0).margin(scale.at(1)));
    CHECK(record.number("contact") > 1.0);
    CHECK(record.find("time")->numbers.size() > 1500);
    CHECK(std::ranges::max(record.find("force up")->numbers) > 300.0);
    CHECK(rig.greatest_confirmed_n <= device::kConfirmedN);
    CHECK(rig.confirmed_limit_n == device::kConfirmedN);
    CHECK(rig.greatest_n <= device::kSecondPushN + 1e-9);
    CHECK(rig.greatest_limit_n <= device::kSecondPushN);
    CHECK(record.find("lights")->word == "red");
    CHECK(record.outcome(BringUpStep::cable) == StepOutcome::failed);  // nobody pulled it
    CHECK(record.find("force without program") != nullptr);
  }
}

TEST_CASE("a wrong sign of a force ends a bring-up after small pushes alone") {
  for (const DeviceAxis axis : device::kDeviceAxes) {
    CAPTURE(device::name_of(axis));
    device::DeviceModel model = device::device_model("falcon");
    component(model.planted.force_sign_scale, axis) = -1.0;
    BringUpRig rig(model);
    const BringUp record = brought_up(rig);
    CHECK(record.ended == BringUpEnd::wrong_sign);
    CHECK_FALSE(record.signs_confirmed());
    CHECK(record.findings.back().name == "moved +" + std::string(device::name_of(axis)));
    CHECK(rig.greatest_n <= device::kFirstPushN + 1e-9);
    CHECK(rig.greatest_confirmed_n == 0.0);
    CHECK(record.outcome(BringUpStep::push) == StepOutcome::interrupted);
    CHECK(record.outcome(BringUpStep::wall) == StepOutcome::not_reached);
    CHECK(record.settles(fact_of("falcon", "signs")));
  }
}

TEST_CASE("a reading that runs along another axis ends a bring-up before any force") {
  BringUpRig rig(device::device_model("falcon"));
  rig.carries_elsewhere = true;
  const BringUp record = brought_up(rig);
  CHECK(record.ended == BringUpEnd::wrong_sign);
  CHECK(record.findings.back().name == "carried z");
  CHECK(rig.greatest_n == 0.0);
  CHECK(record.outcome(BringUpStep::push) == StepOutcome::not_reached);
}

TEST_CASE("pushes that nobody feels, or that were left out, confirm nothing") {
  BringUpRig numb(device::device_model("falcon"));
  numb.feels = false;
  const BringUp felt_nothing = brought_up(numb);
  CHECK(felt_nothing.ended == BringUpEnd::complete);
  CHECK(felt_nothing.number("push -z") == device::kSecondPushN);
  for (const std::string step : {"ways", "push"}) {
    BringUpRig skipping(device::device_model("falcon"));
    skipping.skips = {step};
    const BringUp record = brought_up(skipping);
    CHECK(record.ended == BringUpEnd::complete);
    CHECK(skipping.greatest_confirmed_n == 0.0);
    CHECK_FALSE(record.settles(fact_of("falcon", "signs")));
    CHECK(record.outcome(BringUpStep::weight) == StepOutcome::left_out);
  }
  CHECK(numb.greatest_n <= device::kSecondPushN + 1e-9);
  CHECK(numb.greatest_confirmed_n == 0.0);
  CHECK(felt_nothing.outcome(BringUpStep::wall) == StepOutcome::left_out);
}

TEST_CASE("a bring-up that ends at any moment keeps what it has and names the rest") {
  int calls = 0;
  std::set<BringUpStep> interrupted;
  for (; calls < 200; ++calls) {
    BringUpRig rig(device::device_model("falcon"));
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
  CHECK(interrupted.size() == device::kBringUpSteps - 1);  // it is opened before
}

TEST_CASE("a device that is lost ends a bring-up as a fault") {
  device::DeviceModel model = device::device_model("falcon");
  model.planted.lost_after_s = 40.0;
  BringUpRig rig(model);
  const BringUp record = brought_up(rig);
  CHECK(record.ended == BringUpEnd::fault);
  CHECK_FALSE(record.why.empty());
  CHECK(record.find("noise") != nullptr);
}

TEST_CASE("the file of a bring-up has no serial number, and tells two devices apart") {
  CHECK(whole_file().find("4711") == std::string::npos);
  device::DeviceInfo one;
  one.name = "falcon";
  CHECK(device::bring_up_of(one).device_mark.empty());
  one.serial = "A1";
  device::DeviceInfo other = one;
  other.serial = "A2";
  CHECK(device::bring_up_of(one).device_mark.size() == 4);
  CHECK(device::bring_up_of(one).device_mark != device::bring_up_of(other).device_mark);
}

TEST_CASE("a bring-up's file settles the facts that its steps were made for, and no others") {
  const BringUp record = device::parse_bring_up(whole_file(), "whole");
  for (const std::string id :
       {"signs", "lengths", "zero_angle", "force_scale", "homing", "lights", "program_silent"}) {
    CAPTURE(id);
    CHECK(record.settles(fact_of("falcon", id)));
  }
  for (const std::string id : {"cable_silent", "beyond_peak", "warm_motors"}) {
    CAPTURE(id);
    CHECK_FALSE(record.settles(fact_of("falcon", id)));
  }
  const BringUp nothing = device::bring_up_of({});
  for (const device::UnverifiedFact& fact : falcon_facts()) CHECK_FALSE(nothing.settles(fact));
}

TEST_CASE("a stand-in is called one, and its file settles no fact") {
  device::DeviceInfo real;
  real.name = "dhd";
  real.model = "omega.3";
  real.library = "3.17.5.1900";
  CHECK(device::stand_in_of(real, {}).empty());
  const auto is_stand_in = [&](auto&& change) {
    device::DeviceInfo info = real;
    device::DeviceSettings settings;
    change(info, settings);
    return !device::stand_in_of(info, settings).empty();
  };
  CHECK(is_stand_in([](auto& info, auto&) { info.simulated = true; }));
  CHECK(is_stand_in([](auto& info, auto&) { info.visual = true; }));
  CHECK(is_stand_in([](auto& info, auto&) { info.model = "omega Simulator"; }));
  CHECK(is_stand_in([](auto& info, auto&) { info.library = "3.17 (EMULATED)"; }));
  CHECK(is_stand_in([](auto&, auto& settings) { settings.dhd.library = "/opt/libfake_dhd.so"; }));
  CHECK(is_stand_in([](auto&, auto& settings) { settings.dhd.library = "/opt/fake/libdhd.so"; }));

  BringUp record = device::parse_bring_up(whole_file(), "whole");
  record.stand_in = "an emulator";
  const BringUp read = device::parse_bring_up(device::bring_up_json(record), "marked");
  CHECK(read.stand_in == "an emulator");
  for (const device::UnverifiedFact& fact : falcon_facts()) CHECK_FALSE(read.settles(fact));
}

TEST_CASE("a loaded stand-in is marked under any name") {
  const TempFolder folder;
  device::DeviceInfo info;
  info.name = "openhaptics";
  device::DeviceSettings settings;
  settings.openhaptics.library = folder.path() / "libHD.so.3.4";
  std::filesystem::copy_file(TOUCHTRIAL_FAKE_HD, settings.openhaptics.library);
  CHECK(device::stand_in_of(info, settings).empty());
  const device::DynamicLibrary loaded(settings.openhaptics.library, device::Unload::never, "");
  CHECK_FALSE(device::stand_in_of(info, settings).empty());
}

TEST_CASE("a file settles no fact by what was never found") {
  const auto is_settled = [](const std::string& id, auto&& change) {
    BringUp record = device::parse_bring_up(whole_file(), "whole");
    change(record);
    return record.settles(fact_of("falcon", id));
  };
  CHECK(is_settled("lengths", [](BringUp&) {}));
  CHECK_FALSE(is_settled("signs", [](BringUp& record) {
    record.findings.clear();
    record.outcomes = {};
    record.ended = BringUpEnd::wrong_sign;
  }));
  CHECK_FALSE(is_settled("lengths", [](BringUp& r) { r.model = "omega.3 simulator"; }));
  const device::UnverifiedFact readings{"readings", "", device::Evidence::readings};
  for (const std::vector<double>& numbers : {std::vector{0.0}, std::vector{-5.0}, {}}) {
    BringUp record = device::parse_bring_up(whole_file(), "whole");
    CHECK(record.settles(readings));
    record.note("new readings", numbers);
    CHECK_FALSE(record.settles(readings));
  }
  for (const StepOutcome outcome : {StepOutcome::left_out, StepOutcome::failed}) {
    BringUp record = device::parse_bring_up(whole_file(), "whole");
    record.outcome(BringUpStep::rest) = outcome;
    CHECK_FALSE(record.settles(readings));
  }
  CHECK_FALSE(is_settled("lengths", [](BringUp& record) {
    for (const std::string axis : {"x", "y", "z"}) record.note("ruler " + axis, {0.0});
  }));
}

TEST_CASE("a hostile file of a bring-up is refused at its place") {
  const json whole = json::parse(whole_file());
  const auto refused = [&](const std::string& pointer, const json& value) {
    json file = whole;
    file[json::json_pointer(pointer)] = value;
    CAPTURE(pointer, value.dump());
    CHECK(
        refuses<StudyError>([&] { return device::parse_bring_up(file.dump(), "file"); }, pointer));
  };
  refused("/kind", "touchtrial device bring-up 2");
  refused("/driver", "no-such");
  refused("/driver", 7);
  refused("/host", "lab-pc");
  refused("/device_mark", "SN-4711");
  refused("/model", "two\nlines");
  refused("/firmware", std::string(201, 'x'));
  refused("/ended", "well");
  refused("/steps/rest", "maybe");
  refused("/steps/dance", "done");
  refused("/stand_in", "two\nlines");
  refused("/findings/0/value", 1e300);
  refused("/findings/0/value", "0 1  2");
  refused("/findings/0/value", "0 1 ");
  refused("/findings/0/value", json::array({1, 2}));
  refused("/findings/0/name", "dance");
  refused("/findings/1/name", whole["findings"][0]["name"]);
  refused("/findings/0/step", "wall");
  refused("/findings/0/unit", "m");
  refused("/findings/0/who", "somebody");
  for (const auto& [name, word] : {std::pair{"felt +x", "sideways"}, std::pair{"lights", "purple"},
                                   std::pair{"fault without program", "none of these"}}) {
    const auto is_named = [&](const json& finding) { return finding["name"] == name; };
    const auto at = std::ranges::find_if(whole["findings"], is_named) - whole["findings"].begin();
    refused("/findings/" + std::to_string(at) + "/value", word);
  }
  json unreached = whole;
  unreached["steps"]["rest"] = "not_reached";
  CHECK(refuses<StudyError>([&] { return device::parse_bring_up(unreached.dump(), "file"); },
                            "/step"));
  json unconfirmed = whole;
  std::erase_if(unconfirmed["findings"].get_ref<json::array_t&>(),
                [](const json& finding) { return finding["step"] == "push"; });
  CHECK(refuses<StudyError>([&] { return device::parse_bring_up(unconfirmed.dump(), "file"); },
                            "/step"));
  for (const auto& [key, value] : whole.items()) {
    json missing = whole;
    missing.erase(key);
    CAPTURE(key);
    CHECK(refuses<StudyError>([&] { return device::parse_bring_up(missing.dump(), "file"); }, key));
  }
}

TEST_CASE("bytes of a bring-up's file that change by chance are read or refused in one line") {
  RandomStream random(4, "hostile files");
  for (int i = 0; i < 300; ++i) {
    std::string text = whole_file();
    for (int change = 0; change < 3; ++change) {
      text[random.below(text.size())] = static_cast<char>(random.below(256));
    }
    try {
      const BringUp record = device::parse_bring_up(text, "file");
      CHECK(device::bring_up_json(device::parse_bring_up(device::bring_up_json(record), "again")) ==
            device::bring_up_json(record));
    } catch (const StudyError& error) {
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
}

TEST_CASE("every driver with hardware lists what is unverified, each fact once") {
  for (const std::string driver : {"falcon", "dhd", "openhaptics", "inverse3"}) {
    CAPTURE(driver);
    std::set<std::string> ids;
    for (const device::UnverifiedFact& fact : device::device_driver(driver).unverified) {
      CAPTURE(fact.id);
      CHECK(ids.insert(fact.id).second);
      CHECK_FALSE(fact.what.empty());
      const bool asks = fact.evidence == device::Evidence::answer;
      CHECK(asks == (fact.answers.size() >= 2));
      CHECK(asks == !fact.question.empty());
    }
    CHECK(ids.size() >= 5);
  }
}

}  // namespace touchtrial
