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

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

/// In which the texture rises out of the wall.
constexpr double kBlendS = 0.2;
/// 40 mm, which every supported device has room for.
constexpr int kPlacedSidePx = 200;
/// 100 mm, the plane of devices that have all the room of the plane frame.
constexpr int kFreeSidePx = 500;

struct TestArguments {
  std::string driver;
  fs::path settings;
  double seconds = 30.0;
  double rate_hz = device::kServoRateHz;
  bool wall_only = false;
  bool json = false;
  fs::path fault_record;
};

/// The device as the servo wants it: placed, if it has a frame of its own.
class DeviceForTest {
 public:
  DeviceForTest(const TestArguments& arguments, const device::DeviceSettings& settings)
      : use_(settings.use_of(arguments.driver)),
        opened_(arguments.driver, settings, {kFreeSideMm, kFreeSideMm}),
        texture_(opened_.device().info().workspace ? kPlacedSidePx : kFreeSidePx) {
    const device::WorkspaceFit fit =
        device::fit_plane(texture_.plane(), opened_.device().info().workspace, use_);
    if (fit.placement) placed_.emplace(opened_.device(), *fit.placement);
  }

  [[nodiscard]] OpenedDevice& opened() noexcept { return opened_; }
  [[nodiscard]] device::HapticDevice& device() noexcept {
    return placed_ ? static_cast<device::HapticDevice&>(*placed_) : opened_.device();
  }
  [[nodiscard]] const TestTexture& texture() const noexcept { return texture_; }
  [[nodiscard]] device::SafetyLimits limits() const noexcept {
    return device::stricter_of({}, use_.limits);
  }

 private:
  static constexpr double kFreeSideMm = kFreeSidePx * PlaneGeometry{}.pitch_mm;

  device::DeviceUse use_;
  OpenedDevice opened_;
  TestTexture texture_;
  std::optional<device::PlacedDevice> placed_;
};

fs::path record_path(const TestArguments& arguments) {
  return arguments.fault_record.empty() ? fs::path("device-test-" + arguments.driver + "-fault.csv")
                                        : arguments.fault_record;
}

/// One run: the wall, and then, unless it is to be the wall alone, the texture.
void feel(const TestArguments& arguments, const TestTexture& shown, AttendedRun& run,
          DeviceTest& test) {
  const engine::RenderingModel wall = shown.wall();
  const engine::RenderingModel texture = shown.texture();
  session::ModelForce first(wall);
  session::ModelForce second(texture);
  const double change_s = arguments.seconds * (arguments.wall_only ? 2.0 : 0.5);
  device::ForceSequence sequence(first, second, std::llround(change_s * arguments.rate_hz),
                                 std::llround(kBlendS * arguments.rate_hz));
  const auto phase = [&](std::int64_t tick) {
    return sequence.is_second(tick) ? "texture" : "wall";
  };
  std::fputs(
      "q ends the test, space lets go, - and + change its strength, Ctrl-C halts at once\n"
      "shown: time, position (right, down, off the plane), force, ticks a second, lateness\n",
      stderr);
  test.run = run.run(phase, sequence, arguments.seconds, {}, &sequence);
  if (!test.run) return;
  test.phases.push_back({"wall", sequence.first()});
  if (sequence.second().ticks > 0) test.phases.push_back({"texture", sequence.second()});
}

/// What the summary does not say by itself: how the program ends.
int outcome_of(const DeviceTest& test, const AttendedRun& run) {
  if (run.stop() == AttendedStop::signal) {
    std::fprintf(stderr, "touchtrial: %s\n", device::StopOnSignals::message().c_str());
    return device::StopOnSignals::exit_code();
  }
  if (!test.run || test.run->end != device::ServoEnd::fault) return 0;
  throw DeviceError(one_line(test.device.name + ": fault while the " + test.phases.back().name +
                             " was felt: " + fault_text(*test.run) + "; the last seconds are in " +
                             test.fault_record.string()));
}

int test_device(const TestArguments& arguments) {
  const device::DeviceSettings settings = device::device_settings_for(arguments.settings);
  DeviceForTest tested(arguments, settings);
  AttendedRun run(tested.opened(), tested.device(), tested.limits(), arguments.rate_hz);
  run.wait_until_ready(kReadyLimitS);
  run.let_choose_strength();
  DeviceTest test;
  test.device = tested.device().info();
  feel(arguments, tested.texture(), run, test);
  test.scheduling = run.scheduling();
  test.quit = run.stop() == AttendedStop::quit;
  if (test.run && test.run->end == device::ServoEnd::fault && run.stop() != AttendedStop::signal) {
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

}  // namespace touchtrial::app
