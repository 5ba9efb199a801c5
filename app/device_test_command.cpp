#include "app/attended_run.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/device_test/test_report.hpp"
#include "app/device_test/test_texture.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/registry.hpp"
#include "device/workspace_fit.hpp"
#include "protocols/session/model_force.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

constexpr double kReadyLimitS = 120.0;
/// 40 mm, which every supported device has room for.
constexpr int kPlacedSidePx = 200;
/// 100 mm, the plane of devices that have all the room of the plane frame.
constexpr int kFreeSidePx = 500;

struct TestArguments {
  std::string driver;
  fs::path settings;
  double seconds = 30.0;
  double rate_hz = kServoRateHz;
  bool wall_only = false;
  bool json = false;
  fs::path fault_record;
};

/// The device as the servo wants it: placed, if it has a frame of its own.
class DeviceForTest {
 public:
  DeviceForTest(const TestArguments& arguments, const DeviceSettings& settings)
      : use_(settings.use_of(arguments.driver)),
        opened_(arguments.driver, settings, {kFreeSideMm, kFreeSideMm}),
        texture_(opened_.device().info().workspace ? kPlacedSidePx : kFreeSidePx) {
    const WorkspaceFit fit = fit_plane(texture_.plane(), opened_.device().info().workspace, use_);
    if (fit.placement) placed_.emplace(opened_.device(), *fit.placement);
  }

  [[nodiscard]] OpenedDevice& opened() noexcept { return opened_; }
  [[nodiscard]] HapticDevice& device() noexcept {
    return placed_ ? static_cast<HapticDevice&>(*placed_) : opened_.device();
  }
  [[nodiscard]] const TestTexture& texture() const noexcept { return texture_; }
  [[nodiscard]] SafetyLimits limits() const noexcept { return stricter_of({}, use_.limits); }

 private:
  static constexpr double kFreeSideMm = kFreeSidePx * PlaneGeometry{}.pitch_mm;

  DeviceUse use_;
  OpenedDevice opened_;
  TestTexture texture_;
  std::optional<PlacedDevice> placed_;
};

fs::path record_path(const TestArguments& arguments) {
  return arguments.fault_record.empty() ? fs::path("device-test-" + arguments.driver + "-fault.csv")
                                        : arguments.fault_record;
}

/// \return false if the test is over
bool feel(const std::string& name, const RenderingModel& model, double seconds, AttendedRun& run,
          DeviceTest& test) {
  ModelForce force(model);
  const auto report = run.run(name, force, seconds);
  if (!report) return false;
  test.phases.push_back({name, *report});
  return report->end == ServoEnd::time_limit;
}

/// What the summary does not say by itself: how the program ends.
int outcome_of(const DeviceTest& test, const AttendedRun& run) {
  if (run.stop() == AttendedStop::signal) {
    std::fprintf(stderr, "touchtrial: %s\n", StopOnSignals::message().c_str());
    return StopOnSignals::exit_code();
  }
  for (const TestPhase& phase : test.phases) {
    if (phase.report.end != ServoEnd::fault) continue;
    throw DeviceError(one_line(test.device.name + ": fault in the phase " + phase.name + ": " +
                               fault_text(phase.report) + "; the last seconds are in " +
                               test.fault_record.string()));
  }
  return 0;
}

int test_device(const TestArguments& arguments) {
  const DeviceSettings settings = device_settings_for(arguments.settings);
  DeviceForTest tested(arguments, settings);
  AttendedRun run(tested.opened(), tested.device(), tested.limits(), arguments.rate_hz);
  run.wait_until_ready(kReadyLimitS);
  DeviceTest test;
  test.device = tested.device().info();
  test.scheduling = run.scheduling();
  const RenderingModel wall = tested.texture().wall();
  const RenderingModel texture = tested.texture().texture();
  const double phase_s = arguments.wall_only ? arguments.seconds : arguments.seconds / 2.0;
  if (feel("wall", wall, phase_s, run, test) && !arguments.wall_only) {
    feel("texture", texture, phase_s, run, test);
  }
  const bool faulted = !test.phases.empty() && test.phases.back().report.end == ServoEnd::fault;
  if (faulted && run.stop() != AttendedStop::signal) {
    test.fault_record = record_path(arguments);
    replace_file(test.fault_record, run.flight_record());
  }
  print(arguments.json ? test_json(test) : test_text(test));
  return outcome_of(test, run);
}

}  // namespace

void add_device_test_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<TestArguments>();
  CLI::App* command = device.add_subcommand(
      "test", "Try a device: homing, then a plain wall, then a texture; q stops, space lets go");
  command->add_option("NAME", arguments->driver, "Driver, as touchtrial device list names it")
      ->required();
  add_settings_option(*command, arguments->settings);
  command->add_option("--seconds", arguments->seconds, "Wall and texture together, s")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->add_option("--rate", arguments->rate_hz, "Ticks of the servo a second")
      ->check(CLI::Range(1000.0, 10'000.0))
      ->capture_default_str();
  command->add_flag("--wall-only", arguments->wall_only, "No texture");
  command->add_flag("--json", arguments->json, "The summary as one JSON object");
  command->add_option("--fault-record", arguments->fault_record,
                      "Where the last seconds before a fault go, CSV (default: "
                      "device-test-NAME-fault.csv)");
  command->callback([=, &action] { action = [=] { return test_device(*arguments); }; });
}

}  // namespace touchtrial
