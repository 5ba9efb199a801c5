#include "app/readings/readings_window.hpp"

#include "app/windows/glfw_support.hpp"
#include "core/errors.hpp"
#include "device/flat_wall.hpp"
#include "device/mouse/mouse_device.hpp"
#include "device/passing_device.hpp"
#include "device/servo/servo_clock.hpp"
#include "device/servo/servo_thread.hpp"
#include "device/servo_fakes.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"
#include "windows/virtual_screen.hpp"

#include <chrono>

namespace touchtrial {
namespace {

/// Keeps the last force that the servo wrote.
class LastWritten final : public PassingDevice {
 public:
  using PassingDevice::PassingDevice;
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override {
    force_n_ = force_n;
    return PassingDevice::write(force_n);
  }

  Vec3 force_n_{1.0, 1.0, 1.0};
};

/// A mouse with its window, a flat wall, and the servo in real time on its own thread.
struct PilotStation {
  PilotStation() {
    thread.start([this] {
      device::PacedClock servo_clock{std::chrono::microseconds(50)};
      // So long that it ends by itself only in a test that hangs.
      const device::ServoOptions options = {.limit_ticks = 3'600'000};
      report = device::run_servo(last, wall, sink, options, servo_clock, {.state = &states});
    });
  }

  /// The servo ends when its window has closed.
  ~PilotStation() { window.reset(); }
  PilotStation(const PilotStation&) = delete;
  PilotStation& operator=(const PilotStation&) = delete;

  /// Draws the window until the servo's state is as wanted.
  /// \return false if it never is
  bool attend_until(const std::function<bool(const device::ServoState&)>& is_as_wanted) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (std::chrono::steady_clock::now() < give_up) {
      window->draw({mouse.info(), "watch", states.get()}, history);
      if (is_as_wanted(states.get())) return true;
    }
    return false;
  }

  device::PointerExchange exchange;
  std::unique_ptr<app::ReadingsWindow> window = std::make_unique<app::ReadingsWindow>(exchange);
  app::ReadingsHistory history{device::kServoRateHz};
  device::PacedClock clock{device::PacedClock::Time{}};
  device::MouseDevice mouse{exchange, clock};
  LastWritten last{mouse};
  FlatWall wall;
  NoSamples sink;
  device::LatestValue<device::ServoState> states;
  device::ServoReport report;
  device::ServoThread thread{{device::SchedulingPolicy::other, 0, false}};
};

bool is_near(Vec3 position_mm, Vec2 where_mm) {
  return norm(Vec2{position_mm.x, position_mm.y} - where_mm) < 0.5;
}

TEST_CASE(
    "injected motion moves the stylus of the running servo, a press makes contact, letting "
    "go ends it") {
  const auto screen = VirtualScreen::open();
  PilotStation station;
  CHECK(station.attend_until([](const device::ServoState& s) { return s.sample.ready; }));
  const Vec2 where_mm = {30.0, 50.0};
  const Vec2 at = station.window->at(where_mm);
  screen->move_pointer(static_cast<int>(at.x), static_cast<int>(at.y));
  CHECK(station.attend_until(
      [&](const device::ServoState& s) { return is_near(s.sample.position_mm, where_mm); }));
  screen->press();
  CHECK(station.attend_until(
      [](const device::ServoState& s) { return s.sample.buttons == 1U && s.force_n.z > 0.65; }));
  CHECK(is_near(station.states.get().sample.position_mm, where_mm));
  screen->release();
  CHECK(station.attend_until(
      [](const device::ServoState& s) { return s.sample.buttons == 0U && s.force_n.z == 0.0; }));
  station.window.reset();
  station.thread.wait();
}

TEST_CASE("a window that closes under a pressed stylus ends the servo with zero force") {
  const auto screen = VirtualScreen::open();
  PilotStation station;
  CHECK(station.attend_until([](const device::ServoState& s) { return s.sample.ready; }));
  const Vec2 at = station.window->at({20.0, 20.0});
  screen->move_pointer(static_cast<int>(at.x), static_cast<int>(at.y));
  screen->press();
  CHECK(station.attend_until([](const device::ServoState& s) { return s.force_n.z > 0.65; }));
  station.window.reset();
  station.thread.wait();
  CHECK(station.report.end == device::ServoEnd::fault);
  CHECK(station.report.device_fault == device::DeviceFault::link_lost);
  CHECK(station.last.force_n_ == Vec3{});
  screen->release();
}

TEST_CASE("the space bar requests a stop") {
  const auto screen = VirtualScreen::open();
  PilotStation station;
  screen->move_pointer(100, 100);
  CHECK(station.attend_until([](const device::ServoState& s) { return s.sample.ready; }));
  CHECK_FALSE(station.window->stop_asked());
  screen->type("space");
  CHECK(station.attend_until(
      [&](const device::ServoState&) { return station.window->stop_asked(); }));
  station.window.reset();
  station.thread.wait();
}

TEST_CASE("without a display the window says what to do about it") {
  const EnvironmentVariable display("DISPLAY", nullptr);
  const EnvironmentVariable wayland("WAYLAND_DISPLAY", nullptr);
  device::PointerExchange exchange;
  CHECK_THROWS_WITH(app::ReadingsWindow{exchange}, holds_text("graphical session"));
}

TEST_CASE("a monitor's stated size is used only if it can be true") {
  CHECK(app::stated_mm_per_unit(508, 1920) == Approx(0.26458).epsilon(1e-4));
  CHECK(app::stated_mm_per_unit(0, 1920) == 0.0);
  CHECK(app::stated_mm_per_unit(160, 1920) == Approx(0.0833).epsilon(1e-3));
  CHECK(app::stated_mm_per_unit(16, 1920) == 0.0);
  CHECK(app::stated_mm_per_unit(1600, 800) == 0.0);
}

TEST_CASE("a size that the system made up for a monitor that states none is known as such") {
  CHECK(app::is_made_up(508, 1920));
  CHECK(app::is_made_up(339, 1280));
  CHECK_FALSE(app::is_made_up(509, 1920));  // 23 inches
  CHECK_FALSE(app::is_made_up(598, 3840));  // 27 inches
}

}  // namespace
}  // namespace touchtrial
