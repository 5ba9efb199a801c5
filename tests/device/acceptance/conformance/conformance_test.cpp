// The checks that every driver must pass: our own pass them, and a planted fault of a plug-in fails
// exactly the check that is there for it.
#include "device/acceptance/conformance/conformance.hpp"

#include "device/acceptance/conformance/plugin_conformance.hpp"
#include "device/drivers/dhd/dhd_device.hpp"
#include "device/drivers/mouse/mouse_device.hpp"
#include "device/drivers/mouse/scripted_pointer.hpp"
#include "device/drivers/openhaptics/openhaptics_device.hpp"
#include "device/drivers/plugin/lockstep_plugins.hpp"
#include "device/drivers/registry.hpp"
#include "device/fakes/loaded_fake.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using namespace device;
using Checks = std::vector<ConformanceCheck>;
using Ids = std::set<ConformanceId>;

Ids with(const Checks& checks, ConformanceOutcome outcome) {
  Ids ids;
  for (const ConformanceCheck& check : checks) {
    if (check.outcome == outcome) ids.insert(check.id);
  }
  return ids;
}
Ids failed(const Checks& checks) {
  return with(checks, ConformanceOutcome::failed);
}
Ids passed(const Checks& checks) {
  return with(checks, ConformanceOutcome::passed);
}
Ids unobserved(const Checks& checks) {
  return with(checks, ConformanceOutcome::not_observed);
}

std::string text_of(const Checks& checks) {
  std::string text;
  for (const ConformanceCheck& check : checks) {
    text += std::string(check.name) + ": " + std::string(name_of(check.outcome)) + " (" +
            check.finding + ")\n";
  }
  return text;
}

std::string finding(const Checks& checks, ConformanceId id) {
  const auto found = std::ranges::find(checks, id, &ConformanceCheck::id);
  return found == checks.end() ? "no such check" : found->finding;
}

ConformanceOptions brief(bool pushes) {
  ConformanceOptions options;
  options.seconds = 0.5;
  options.pushes = pushes;
  options.judges_calls = false;
  return options;
}

/// Checks a plug-in in the test's time.
Checks checked(const PluginSettings& settings, const ConformanceOptions& options) {
  LockstepClock clock;
  return device::check_plugin_conformance(settings, clock, options,
                                          [&clock] { return clock.plugin_options(); });
}

Checks checked_fault(const std::string& fault, const std::string& more = "") {
  ConformanceOptions options = brief(true);
  options.judges_calls = fault == "calls";
  return checked({TOUCHTRIAL_BROKEN_PLUGIN, R"({"fault":")" + fault + "\"" + more + "}"}, options);
}

const Ids kForceChecks = {ConformanceId::pushing, ConformanceId::lapsing, ConformanceId::halting,
                          ConformanceId::rearming, ConformanceId::closing_zero};

Ids together(Ids a, const Ids& b) {
  a.insert(b.begin(), b.end());
  return a;
}

/// The checks of a driver that passes on a vendor's library, which knows real time alone.
Checks checks_beside_a_library(const ConformanceSubject& subject) {
  PacedClock clock(PacedClock::Time{});
  ConformanceOptions options = brief(true);
  options.judges_time = false;
  const Checks checks = check_conformance(subject, clock, options);
  INFO(text_of(checks));
  CHECK(failed(checks) == Ids{});
  for (const ConformanceId id :
       {ConformanceId::pushing, ConformanceId::rearming, ConformanceId::closing_zero,
        ConformanceId::rest_zero, ConformanceId::opening_twice, ConformanceId::reopening}) {
    CHECK(passed(checks).count(id) == 1);
  }
  return checks;
}

}  // namespace

TEST_CASE("conformance: the example plug-in passes every check, its calls' time not judged here") {
  const Checks checks =
      checked({TOUCHTRIAL_EXAMPLE_PLUGIN, R"({"homing_ticks":200})"}, brief(true));
  INFO(text_of(checks));
  CHECK(checks.size() == 21);
  CHECK(unobserved(checks) == Ids{ConformanceId::calls});
  CHECK(failed(checks) == Ids{});
  CHECK(conforms(checks));
  CHECK_THAT(finding(checks, ConformanceId::calls), names("99 %"));
  CHECK_THAT(finding(checks, ConformanceId::opening_twice), names("example"));
  // A force lives for 10 ms; after a halt the next exchange sends zero.
  CHECK_THAT(finding(checks, ConformanceId::lapsing), names("11 ms"));
  CHECK_THAT(finding(checks, ConformanceId::halting), names("1 ms"));
}

TEST_CASE(
    "conformance: without permission no force is sent, and checks of forces are not observed") {
  const Checks checks = checked({TOUCHTRIAL_EXAMPLE_PLUGIN, "{}"}, brief(false));
  INFO(text_of(checks));
  CHECK(failed(checks) == Ids{});
  CHECK(unobserved(checks) ==
        together(kForceChecks, {ConformanceId::unready_zero, ConformanceId::calls}));
  CHECK(finding(checks, ConformanceId::halting) != finding(checks, ConformanceId::unready_zero));
}

TEST_CASE("conformance: each fault fails the check that is there for it, and no other") {
  const auto [fault, more, id] = GENERATE(table<const char*, const char*, ConformanceId>(
      {{"opening", "", ConformanceId::opening},
       {"description", "", ConformanceId::description},
       {"memory", "", ConformanceId::memory},
       {"staying", "", ConformanceId::staying},
       {"numbering", "", ConformanceId::numbering},
       {"standing", "", ConformanceId::numbering},
       {"silent", "", ConformanceId::numbering},
       {"values", "", ConformanceId::values},
       {"workspace", "", ConformanceId::workspace},
       {"velocity", "", ConformanceId::velocity},
       {"rate", "", ConformanceId::rate},
       {"gaps", "", ConformanceId::gaps},
       {"unready_zero", R"(,"homing_ticks":200)", ConformanceId::unready_zero},
       {"rest_zero", "", ConformanceId::rest_zero},
       {"pushing", "", ConformanceId::pushing},
       {"lapsing", "", ConformanceId::lapsing},
       {"halting", "", ConformanceId::halting},
       {"rearming", "", ConformanceId::rearming},
       {"closing_zero", "", ConformanceId::closing_zero},
       {"opening_twice", "", ConformanceId::opening_twice},
       {"reopening", "", ConformanceId::reopening},
       {"calls", "", ConformanceId::calls}}));
  const Checks checks = checked_fault(fault, more);
  INFO(fault << "\n" << text_of(checks));
  CHECK(failed(checks) == Ids{id});
  CHECK_FALSE(finding(checks, id).empty());
  CHECK_FALSE(conforms(checks));
}

TEST_CASE("conformance: a library without a sound interface fails it, and the rest says nothing") {
  const char* how = GENERATE("nothing", "version", "size", "function", "no_name", "long_name");
  const EnvironmentVariable broken("BROKEN_DEVICE", how);
  const Checks checks = checked({TOUCHTRIAL_BROKEN_PLUGIN, "{}"}, brief(true));
  INFO(how << "\n" << text_of(checks));
  CHECK(failed(checks) == Ids{ConformanceId::library});
  CHECK(passed(checks) == Ids{});
  CHECK(checks.size() == 21);
}

TEST_CASE("conformance: a check that is stopped says so, and passes nothing more") {
  ConformanceOptions options = brief(true);
  int ticks = 0;
  options.stopped = [&ticks] { return ++ticks > 100; };
  const Checks checks = checked({TOUCHTRIAL_EXAMPLE_PLUGIN, "{}"}, options);
  INFO(text_of(checks));
  CHECK(failed(checks) == Ids{});
  CHECK(passed(checks).count(ConformanceId::rate) == 0);
  CHECK(passed(checks).count(ConformanceId::memory) == 0);
  CHECK_FALSE(finding(checks, ConformanceId::halting).empty());
  CHECK(finding(checks, ConformanceId::calls) == finding(checks, ConformanceId::halting));
}

TEST_CASE("conformance: further checks of a device that never becomes ready are not observed") {
  ConformanceOptions options = brief(true);
  options.ready_limit_s = 0.1;
  bool advised = false;
  options.advise = [&advised](DeviceReadiness readiness) {
    advised = readiness != DeviceReadiness::ready;
  };
  const Checks checks =
      checked({TOUCHTRIAL_EXAMPLE_PLUGIN, R"({"homing_ticks":1000000})"}, options);
  INFO(text_of(checks));
  CHECK(failed(checks) == Ids{});
  CHECK_FALSE(conforms(checks));
  CHECK(passed(checks).count(ConformanceId::unready_zero) == 1);
  CHECK_FALSE(finding(checks, ConformanceId::numbering).empty());
  CHECK(advised);
}

TEST_CASE("conformance: the simulated hand passes all observable checks") {
  VirtualClock clock;
  ConformanceSubject subject;
  subject.open = [] { return device::open_device("simulated", {}); };
  const Checks checks = check_conformance(subject, clock, brief(true));
  INFO(text_of(checks));
  CHECK(failed(checks) == Ids{});
  CHECK(unobserved(checks) ==
        together(kForceChecks, {ConformanceId::unready_zero, ConformanceId::rest_zero,
                                ConformanceId::workspace}));
}

TEST_CASE("conformance: the mouse passes all observable checks") {
  VirtualClock clock;
  ScriptedPointer pointer(clock, [](double time_s) {
    return PointerState{{50.0 + 20.0 * std::sin(3.0 * time_s), 50.0}, false, false, 0};
  });
  ConformanceSubject subject;
  subject.open = [&] { return std::make_unique<MouseDevice>(pointer, clock); };
  const Checks checks = check_conformance(subject, clock, brief(true));
  INFO(text_of(checks));
  CHECK(failed(checks) == Ids{});
  CHECK(passed(checks).count(ConformanceId::velocity) == 1);
  CHECK(passed(checks).count(ConformanceId::rate) == 1);
}

TEST_CASE("conformance: the Falcon passes every check on its emulator, from homing to closing") {
  using namespace device::falcon;  // NOLINT: the rig's names
  LockstepClock clock;
  FalconEmulator emulator({.firmware_runs = true, .homed = false});
  emulator.set_hand([tick = 0](Vec3) mutable {
    return Vec3{0.0, 0.0, 25.0 * std::sin(2e-3 * std::acos(-1.0) * ++tick)};
  });
  ConformanceSubject subject;
  subject.open = [&]() -> std::unique_ptr<HapticDevice> {
    FalconOptions options{.pace = clock.pace(), .scheduling = {SchedulingPolicy::other, 0, false}};
    return std::make_unique<FalconDevice>(std::make_unique<EmulatorTransport>(emulator),
                                          FalconSettings{}, std::move(options));
  };
  subject.motor_force_n = [&] {
    return emulator.motors() == std::array<std::int16_t, 3>{} ? Vec3{} : emulator.force_n();
  };
  subject.can_open_twice = false;
  const Checks checks = check_conformance(subject, clock, brief(true));
  INFO(text_of(checks));
  CHECK(failed(checks) == Ids{});
  CHECK(unobserved(checks) == Ids{ConformanceId::opening_twice});
}

// The drivers of vendors' libraries know real time alone, which is not judged here.
TEST_CASE("conformance: the dhd driver passes on its stand-in, with real time not judged") {
  fakes::LoadedDhd fake;
  DhdSettings settings{.library = TOUCHTRIAL_FAKE_DHD};
  ConformanceSubject subject;
  subject.open = [&] { return std::make_unique<device::DhdDevice>(settings); };
  subject.motor_force_n = [&fake] {
    const Vec3 dhd = fake->force_n.get();
    return Vec3{dhd.y, dhd.z, dhd.x};
  };
  const Checks checks = checks_beside_a_library(subject);
  CHECK_THAT(finding(checks, ConformanceId::halting), names("ms"));
}

TEST_CASE("conformance: the openhaptics driver passes on its stand-in, real time not judged") {
  fakes::LoadedHd fake;
  OpenHapticsSettings settings{.library = TOUCHTRIAL_FAKE_HD};
  ConformanceSubject subject;
  subject.open = [&] { return std::make_unique<OpenHapticsDevice>(settings); };
  subject.motor_force_n = [&fake] { return fake->force_n.get(); };
  static_cast<void>(checks_beside_a_library(subject));
}

}  // namespace touchtrial
