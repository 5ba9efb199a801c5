// The driver on the emulated service: real sockets, another program at their far end.
#include "device/drivers/inverse3/inverse3_device.hpp"

#include "core/errors.hpp"
#include "device/drivers/inverse3/haply_service.hpp"
#include "device/drivers/inverse3/stepped_inverse3.hpp"
#include "device/drivers/registry.hpp"
#include "device/fakes/loaded_fake.hpp"
#include "device/flat_wall.hpp"
#include "device/servo/servo.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

using device::DeviceFault;
using device::inverse3::Inverse3Device;
using fakes::eventually;
using fakes::next_sample;
using fakes::write_until;
using nlohmann::json;
using testing::HaplyService;
using testing::patient_options;
using testing::SteppedInverse3;

std::unique_ptr<Inverse3Device> opened(const HaplyService& service) {
  return std::make_unique<Inverse3Device>(service.settings(), patient_options());
}

/// \return the error with which it does not open
std::string refusal(const device::Inverse3Settings& settings) {
  return message_of<DeviceError>([&] { const Inverse3Device device(settings, patient_options()); });
}

std::string refusal_by(std::vector<std::string> options) {
  const HaplyService service(std::move(options));
  return refusal(service.settings());
}

bool near(const json& vector, Vec3 expected) {
  const Vec3 found{vector.at(0), vector.at(1), vector.at(2)};
  return norm(found - expected) < 1e-12;
}

/// Writes until the service has got this force in its own axes.
bool reaches(HaplyService& service, device::HapticDevice& device, Vec3 force_n, Vec3 expected) {
  return write_until(device, force_n, [&] { return near(service.report().at("force"), expected); });
}

/// Writes until the fault is there.
DeviceFault fault_of(device::HapticDevice& device) {
  CHECK(write_until(device, {0.0, 0.5, 0.0}, [&] { return device.fault() != DeviceFault::none; }));
  return device.fault();
}

}  // namespace

TEST_CASE("inverse3: place and velocity arrive with x right, y up, z towards the person, in mm") {
  HaplyService service;
  const auto device = opened(service);
  // To the right, away, down.
  service.send_command("hold [[0.01, 0.02, -0.03], [0.1, -0.2, 0.3]]");
  REQUIRE(eventually([&] {
    return norm(next_sample(*device).position_mm - Vec3{10.0, -30.0, -20.0}) < 1e-9;
  }));
  const device::DeviceSample sample = next_sample(*device);
  CHECK(norm(sample.velocity_mm_s - Vec3{100.0, 300.0, 200.0}) < 1e-9);
  CHECK(sample.ready);
  CHECK(sample.buttons == 0);
}

TEST_CASE("inverse3: a force reaches the service in its own axes, and halts") {
  HaplyService service;
  const auto time = std::make_shared<testing::TestTime>();
  Inverse3Device device(service.settings(), patient_options(time));
  // To the right, up, towards the person; there: right, away, up.
  REQUIRE(reaches(service, device, {0.5, 1.0, 1.5}, {0.5, -1.5, 1.0}));
  device.halt();
  CHECK(reaches(service, device, {0.5, 1.0, 1.5}, {}));
  device.rearm();
  CHECK(reaches(service, device, {0.5, 1.0, 1.5}, {0.5, -1.5, 1.0}));
  // The servo falls silent.
  time->store(std::chrono::milliseconds(11));
  CHECK(eventually([&] { return service.report().at("zeros_last") > 5; }));
  CHECK(service.report().at("complaints") == json::array());
}

TEST_CASE("inverse3: filters are off, the frame is centred, and the session has a name") {
  HaplyService service;
  const auto device = opened(service);
  const json report = service.report();
  CHECK(report.at("gate") == 0.0);
  CHECK(report.at("damping") == json::array({0.0, 0.0, 0.0, 0.0}));
  CHECK(report.at("preset") == "arm_front_centered");
  CHECK(report.at("profile") == "touchtrial");
  CHECK(report.at("full_states") == 1);
  CHECK(report.at("listeners") == 1);
  const device::DeviceInfo info = device->info();
  CHECK(info.name == "inverse3");
  CHECK(info.model == "Haply Inverse3");
  CHECK(info.serial == "049D");
  CHECK(info.firmware ==
        "7.4, service 3.5, right-handed, force gate 0, damping 0, torque scaling on, gravity "
        "compensation 1, home return off");
  CHECK(info.max_force_n == 5.0);
  CHECK_FALSE(info.simulated);
  REQUIRE(info.workspace);
  CHECK(info.workspace->shape == device::WorkspaceShape::ellipsoid);
  CHECK(info.workspace->max_mm == Vec3{100.0, 100.0, 100.0});
}

TEST_CASE("inverse3: a session's record distinguishes left and right arms") {
  HaplyService service({"--handedness", "left", "--home-return", "unknown"});
  const std::string firmware = opened(service)->info().firmware;
  CHECK_THAT(firmware, names("left-handed"));
  HaplyService other({"--handedness", "left"});
  CHECK(opened(other)->info().firmware != firmware);
}

TEST_CASE("inverse3: an arm that goes home by itself is refused") {
  const std::string message = refusal_by({"--home-return", "on"});
  CHECK_THAT(message, names("/inverse3/049D/config/home_return"));
}

TEST_CASE("inverse3: a service whose HTTP is on a port of its own is found there") {
  HaplyService service({"--http-apart"});
  const device::Inverse3Settings settings = service.settings();
  REQUIRE(settings.http_port != settings.port);
  const auto device = opened(service);
  CHECK_THAT(device->info().firmware, names("3.5"));
  CHECK(reaches(service, *device, {0.5, 1.0, 1.5}, {0.5, -1.5, 1.0}));
  device::DeviceSettings lab;
  lab.inverse3 = settings;
  CHECK(device::device_driver("inverse3").list(lab).at(0).present);
}

TEST_CASE("inverse3: unknown services are distinguished by their answers") {
  // Older than 3.1: HTTP, but no /version.
  CHECK_THAT(refusal_by({"--http-apart", "--no-version"}), names("3.1"));
  // A simulation channel, and no HTTP anywhere.
  HaplyService service({"--http-apart"});
  device::Inverse3Settings settings = service.settings();
  settings.http_port = 1;
  CHECK(refusal(settings).find("inverse3.http_port") != std::string::npos);
  // Nobody at all.
  settings.port = 1;
  CHECK_THAT(refusal(settings), names("Haply"));
  settings.host = "no such host";
  CHECK(refusal(settings).find("inverse3.host") != std::string::npos);
}

TEST_CASE("inverse3: a Minverse reaches less far, and a grip has buttons") {
  HaplyService service({"--type", "minverse", "--grip"});
  const auto device = opened(service);
  CHECK(device->info().model == "Haply Minverse");
  CHECK(device->info().workspace->min_mm == Vec3{-40.0, -40.0, -40.0});
  CHECK(next_sample(*device).buttons == 5);
}

TEST_CASE("inverse3: version 3.1 gets its forces as values, in the frame of the arm's base") {
  HaplyService service({"--version", "3.1", "--no-events"});
  const auto device = opened(service);
  service.send_command("hold [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]");
  CHECK(eventually([&] { return norm(next_sample(*device).position_mm) < 1e-9; }));
  CHECK(reaches(service, *device, {0.5, 1.0, 1.5}, {0.5, -1.5, 1.0}));
  CHECK_THAT(device->info().firmware, names("3.1 right-handed on"));
  CHECK_FALSE(next_sample(*device).delivered_n);
  CHECK(service.report().at("complaints") == json::array());
}

TEST_CASE("inverse3: problems of opening are reported with the remedy") {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--gate-on"}, "0.3"},
      {{"--hub-scale"}, "touchtrial"},
      {{"--other-session"}, "co.haply.hub::demo-orb"},
      {{"--version", "3.1", "--other-session"}, "049D"},
      {{"--no-events"}, "inverse3.events_port"},
      {{"--version", "2.9"}, "2.9"},
      {{"--version", "4.0"}, "4.0"},
      {{"--no-device"}, "Inverse3"},
      {{"--no-power"}, "049D"},
      {{"--twins"}, "049D 04BB inverse3.device_id"},
      {{"--http-nonsense"}, "inverse3.port"}};
  for (const auto& [options, places] : cases) {
    const std::string message = refusal_by(options);
    INFO(options.front() << ": " << message);
    CHECK_THAT(message, names(places));
    CHECK(message.find('\n') == std::string::npos);
  }
}

TEST_CASE("inverse3: a device is chosen by its name") {
  HaplyService service({"--twins"});
  device::Inverse3Settings settings = service.settings();
  settings.device_id = "049D";
  CHECK(Inverse3Device(settings, patient_options()).info().serial == "049D");
  settings.device_id = "04CC";
  const std::string message = refusal(settings);
  CHECK_THAT(message, names("04CC 049D 04BB"));
}

TEST_CASE("inverse3: without calibration or power the force stays zero") {
  HaplyService service({"--uncalibrated"});
  const auto device = opened(service);
  CHECK_FALSE(next_sample(*device).ready);
  CHECK(device->readiness() == device::DeviceReadiness::needs_inkwell);
  REQUIRE(
      write_until(*device, {0.0, 1.0, 0.0}, [&] { return service.report().at("messages") > 50; }));
  service.send_command("calibrate");
  REQUIRE(reaches(service, *device, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}));
  CHECK(device->readiness() == device::DeviceReadiness::ready);
  CHECK(service.report().at("forces_uncalibrated") == 0);
  service.send_command("power off");
  CHECK(eventually([&] { return !next_sample(*device).ready; }));
  CHECK(device->readiness() == device::DeviceReadiness::needs_calibration);
  CHECK(reaches(service, *device, {0.0, 1.0, 0.0}, {}));
  CHECK(device->fault() == DeviceFault::none);
}

TEST_CASE("inverse3: a service that falls silent is a lost link") {
  HaplyService service({"--silence-after", "50"});
  device::inverse3::Inverse3Options options = patient_options();
  options.answer_timeout = std::chrono::milliseconds(50);
  Inverse3Device device(service.settings(), std::move(options));
  CHECK(fault_of(device) == DeviceFault::link_lost);
  CHECK(device.write({0.0, 1.0, 0.0}) == device::DeviceStatus::fault);
  device::DeviceSample sample;
  CHECK(device.read(sample) == device::DeviceStatus::fault);
}

TEST_CASE("inverse3: a service that ends is a lost link, and invalid messages are bad data") {
  const auto [option, value, fault] = GENERATE(table<const char*, const char*, DeviceFault>({
      {"--disconnect-after", "50", DeviceFault::link_lost},
      {"--garbage", "gone", DeviceFault::link_lost},  // the device
      {"--garbage", "text", DeviceFault::bad_data},
      {"--garbage", "far", DeviceFault::bad_data},
      {"--garbage", "twice", DeviceFault::bad_data},
      {"--garbage", "huge", DeviceFault::bad_data},
  }));
  HaplyService service({option, value});
  const auto device = opened(service);
  INFO(value);
  CHECK(fault_of(*device) == fault);
}

TEST_CASE("inverse3: events of the device's own safety, and its loss, are faults") {
  const auto [event, fault] = GENERATE(table<json, DeviceFault>({
      {{{"name", "device-safety-triggered"},
        {"data", {{"device_id", "049D"}, {"safety_type", "ebrake_triggered"}}}},
       DeviceFault::limit_passed},
      {{{"name", "device-safety-triggered"}, {"data", {{"safety_type", "stall_detected"}}}},
       DeviceFault::limit_passed},
      {{{"name", "device-safety-triggered"},
        {"data", {{"device_id", "049D"}, {"safety_type", "stability_ceiling"}}}},
       DeviceFault::limit_passed},
      {{{"name", "device-disconnected"}, {"data", {{"device_id", "049D"}}}},
       DeviceFault::link_lost},
      {{{"name", "device-busy"}, {"data", {{"device_id", "049D"}}}}, DeviceFault::driver},
      {{{"name", "session-opened"}, {"category", "session"}, {"data", {{"session_id", 99}}}},
       DeviceFault::driver},
  }));
  HaplyService service;
  const auto device = opened(service);
  // These concern others, or nobody's safety.
  service.send_event({{"name", "device-disconnected"}, {"data", {{"device_id", "04BB"}}}});
  service.send_event({{"name", "device-battery-low"}, {"data", {{"device_id", "049D"}}}});
  service.send_event({{"name", "device-safety-triggered"},
                      {"data", {{"device_id", "049D"}, {"safety_type", "ebrake_released"}}}});
  service.send_event(
      {{"name", "session-opened"}, {"category", "session"}, {"data", {{"session_id", 7}}}});
  REQUIRE(reaches(service, *device, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}));
  REQUIRE(device->fault() == DeviceFault::none);
  service.send_event(event);
  CHECK(fault_of(*device) == fault);
}

TEST_CASE("inverse3: closing leaves no force, whatever the servo wrote last") {
  HaplyService service;
  {
    const auto device = opened(service);
    REQUIRE(reaches(service, *device, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}));
    (void)device->write({0.0, 1.0, 0.0});
  }
  CHECK(service.report().at("zeros_last") >= Inverse3Device::kFinalPackets);
  CHECK(eventually([&] {
    const json report = service.report();
    return report.at("clients") == 0 && report.at("listeners") == 0;
  }));
}

TEST_CASE("inverse3: a force beyond the setting is shortened, and NaN becomes zero") {
  HaplyService service;
  device::Inverse3Settings settings = service.settings();
  settings.max_force_n = 2.0;
  Inverse3Device device(settings, patient_options());
  CHECK(device.info().max_force_n == 2.0);
  CHECK(reaches(service, device, {1.0, 4.0, 0.0}, {0.5, 0.0, 2.0}));
  CHECK(service.report().at("largest") < 2.1);
  CHECK(reaches(service, device, {0.0, std::numeric_limits<double>::quiet_NaN(), 0.0}, {}));
}

TEST_CASE("inverse3: a wall carries the hand, in a whole run of the servo") {
  HaplyService service;
  SteppedInverse3 device(service.settings());
  service.send_command("explore");
  // A horizontal plane 10 mm below the middle.
  device::PlacedDevice placed(device, {device::PlaneOrientation::horizontal, {0.0, -10.0, 0.0}});
  FlatWall wall;
  KeptSamples kept;
  const device::ServoReport report =
      device::run_servo_in_virtual_time(placed, wall, kept, {.limit_ticks = 1500});
  CHECK(report.end == device::ServoEnd::time_limit);
  REQUIRE(kept.samples.size() > 1200);
  // 0.7 N on 0.4 N/mm.
  for (std::size_t i = 800; i < 1200; ++i) {
    CHECK(std::abs(kept.samples[i].position_mm.z + 1.75) < 0.1);
    CHECK(std::abs(kept.samples[i].force_n.z - 0.7) < 0.05);
  }
  // The gate is off: the service delivers what it is told.
  CHECK(report.delivered_share == Approx(1.0).margin(1e-9));
  // And says so in the frame of its positions.
  REQUIRE(placed.write({0.1, 0.2, 0.5}) == device::DeviceStatus::ok);
  device::DeviceSample sample;
  REQUIRE(placed.read(sample) == device::DeviceStatus::ok);
  CHECK(norm(sample.delivered_n.value() - Vec3{0.1, 0.2, 0.5}) < 1e-12);
  CHECK(service.report().at("complaints") == json::array());
}

TEST_CASE("inverse3: the list names the service's devices and what they need") {
  device::DeviceSettings settings;
  const auto listed = [&] { return device::device_driver("inverse3").list(settings); };
  {
    HaplyService service({"--uncalibrated", "--twins"});
    settings.inverse3 = service.settings();
    const std::vector<device::DeviceListing> both = listed();
    REQUIRE(both.size() == 2);
    CHECK(both[0].present);
    CHECK(both[0].model == "Haply Inverse3");
    CHECK(both[0].serial == "049D");
    CHECK(both[1].serial == "04BB");
    CHECK_THAT(both[0].where, names("3.5"));
    REQUIRE(both[0].missing.size() == 1);
    CHECK(service.report().at("messages") == 0);
  }
  const std::vector<device::DeviceListing> none = listed();
  REQUIRE(none.size() == 1);
  CHECK_FALSE(none[0].present);
  REQUIRE(none[0].missing.size() == 1);
  CHECK_THAT(none[0].missing[0], names("Haply"));
}

}  // namespace touchtrial
