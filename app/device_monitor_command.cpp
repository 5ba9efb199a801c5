// device monitor: a window that shows a device and its servo.
#include "app/commands.hpp"
#include "app/device_words.hpp"
#include "app/monitor/monitor_run.hpp"
#include "app/monitor/monitor_view.hpp"
#include "app/windows/glfw_window.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/device_settings.hpp"
#include "device/mouse/mouse_device.hpp"
#include "device/mouse/pointer_exchange.hpp"
#include "device/platform/stop_signals.hpp"
#include "device/registry.hpp"
#include "device/servo/servo_clock.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct MonitorArguments {
  std::string driver;
  fs::path settings;
  double seconds = 0.0;  ///< 0: until the person closes the window
  fs::path screenshot;
  double rate_hz = device::kServoRateHz;
  bool wall = false;
  std::vector<int> size_px = {1200, 800};
};

/// Shows a device until the person closes the window.
class Monitor {
 public:
  explicit Monitor(const MonitorArguments& arguments)
      : arguments_(arguments),
        settings_(device::device_settings_for(arguments.settings)),
        device_(open()),
        history_(arguments.rate_hz),
        run_(
            *device_, arguments.rate_hz,
            device::stricter_of(device::SafetyLimits{}, settings_.use_of(arguments.driver).limits)),
        window_({"Touchtrial: device monitor, " + arguments.driver, arguments.size_px[0],
                 arguments.size_px[1], false}) {
    if (!arguments_.screenshot.empty()) window_.keep_pictures();
    window_.on_stop_key([this] { run_.comfort_stop(); });
    run_.wall().put(arguments_.wall);
  }

  /// \return the program's exit code
  int show() {
    run_.start();
    const auto end = Clock::now() + std::chrono::duration<double>(arguments_.seconds);
    do {
      window_.begin_frame();
      run_.collect(history_);
      const MonitorRequests requests = draw_monitor(window_, picture());
      window_.end_frame();
      obey(requests);
    } while (!device::StopOnSignals::asked() && !window_.close_asked() &&
             (arguments_.seconds <= 0.0 || Clock::now() < end));
    if (!arguments_.screenshot.empty()) {
      replace_file(arguments_.screenshot, engine::png_bytes(window_.picture()));
    }
    if (!device::StopOnSignals::asked()) {
      refuse_fault();
      return 0;
    }
    std::fprintf(stderr, "touchtrial: %s\n", device::StopOnSignals::message().c_str());
    return device::StopOnSignals::exit_code();
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::unique_ptr<device::HapticDevice> open() {
    // The monitor's own window provides the pointer.
    if (arguments_.driver == device::kMouseDriver)
      return std::make_unique<device::MouseDevice>(pointer_, clock_);
    return device::open_device(arguments_.driver, settings_);
  }

  void obey(const MonitorRequests& requests) {
    pointer_.publish({requests.pointer_mm, requests.pressed, false, 0});
    if (requests.stop) run_.comfort_stop();
    if (requests.resume) run_.start();
    if (requests.calibrate) device_->calibrate();
    if (requests.wall) run_.wall().put(*requests.wall);
  }

  MonitorPicture picture() {
    MonitorPicture picture;
    picture.device = device_->info();
    picture.newest = run_.newest();
    picture.running = run_.running();
    picture.wall_on = run_.wall().is_on();
    picture.wall_n_per_mm = run_.wall().stiffness_n_per_mm();
    picture.needs_reset = device_->readiness() == device::DeviceReadiness::needs_reset;
    picture.rate_hz = arguments_.rate_hz;
    picture.history = &history_;
    const bool ready = picture.newest.tick == 0 || picture.newest.sample.ready;
    picture.state = state_line(
        {ready, device_->readiness(), picture.wall_on, run_.wall().waits(), run_.ended()});
    picture.notes = notes();
    return picture;
  }

  std::vector<std::string> notes() {
    const device::SchedulingObtained& had = run_.scheduling();
    std::vector<std::string> notes = {
        had.policy == device::SchedulingPolicy::fifo
            ? fmt::format("servo in real time, priority {}", had.priority)
            : std::string("servo on an ordinary thread")};
    if (!had.reason.empty()) notes.push_back(had.reason);
    if (const auto ended = run_.ended()) {
      notes.push_back(fmt::format("last run: {:.1f} ticks/s, {} left out, 99 % within {:.0f} µs",
                                  ended->rate_hz, ended->overruns, ended->lateness.p99_us));
    }
    return notes;
  }

  void refuse_fault() {
    const auto ended = run_.ended();
    if (ended && ended->end == device::ServoEnd::fault) {
      throw DeviceError(arguments_.driver + ": " + fault_in_words(*ended));
    }
  }

  MonitorArguments arguments_;
  device::DeviceSettings settings_;
  device::PointerExchange pointer_;
  device::PacedClock clock_{device::PacedClock::Time{}};
  std::unique_ptr<device::HapticDevice> device_;
  MonitorHistory history_;
  MonitorRun run_;     ///< its servo must end before the device is destroyed
  GlfwWindow window_;  ///< opens last, when signals can already stop the program
};

int monitor(const MonitorArguments& arguments) {
  return Monitor(arguments).show();
}

}  // namespace

void add_device_monitor_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<MonitorArguments>();
  CLI::App* command = device.add_subcommand(
      "monitor",
      "Show a device's position and force, and the servo's rate and lateness, in a window");
  add_driver_argument(*command, "NAME", arguments->driver)->required();
  add_settings_option(*command, arguments->settings);
  add_rate_option(*command, arguments->rate_hz);
  command->add_flag("--wall", arguments->wall, "Begin with the wall on");
  command->add_option("--seconds", arguments->seconds, "Close the window after this time, s")
      ->check(CLI::PositiveNumber);
  command->add_option("--screenshot", arguments->screenshot,
                      "Write the last picture as PNG (with --seconds)");
  command->add_option("--size", arguments->size_px, "Width and height of the window, pixels")
      ->expected(2)
      ->check(CLI::Range(320, 8192))
      ->capture_default_str();
  command->callback([=, &action] { action = [=] { return monitor(*arguments); }; });
}

}  // namespace touchtrial::app
