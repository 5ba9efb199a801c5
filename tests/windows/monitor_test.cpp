#include "app/monitor/monitor_run.hpp"
#include "app/monitor/monitor_view.hpp"
#include "app/monitor/plot.hpp"
#include "core/random.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "protocols/session/still_time.hpp"
#include "support/catch.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <limits>
#include <thread>

namespace touchtrial {
namespace {

device::DeviceSample at_height(double z_mm) {
  device::DeviceSample sample;
  sample.position_mm.z = z_mm;
  return sample;
}

TEST_CASE("the test wall is gentle, and has no force until it is switched on") {
  app::TestWall wall(1000.0);
  CHECK(wall.force_n(at_height(-2.0)) == Vec3{});
  wall.put(true);
  for (int tick = 0; tick < 200; ++tick) static_cast<void>(wall.force_n(at_height(1.0)));
  CHECK(wall.force_n(at_height(1.0)) == Vec3{});
  CHECK(wall.force_n(at_height(-1.0)).z == Approx(0.4));
  CHECK(wall.force_n(at_height(-50.0)).z == Approx(1.0));
}

TEST_CASE("a wall that is switched on behind the stylus waits until the stylus is in front") {
  app::TestWall wall(1000.0);
  wall.put(true);
  for (int tick = 0; tick < 500; ++tick) CHECK(wall.force_n(at_height(-3.0)) == Vec3{});
  CHECK(wall.waits());
  static_cast<void>(wall.force_n(at_height(0.1)));
  CHECK_FALSE(wall.waits());
}

TEST_CASE("a wall that is switched off fades within 100 ms without a step") {
  app::TestWall wall(1000.0);
  wall.put(true);
  for (int tick = 0; tick < 200; ++tick) static_cast<void>(wall.force_n(at_height(1.0)));
  wall.put(false);
  double before_n = 1.0;
  for (int tick = 0; tick < 100; ++tick) {
    const double force_n = wall.force_n(at_height(-5.0)).z;
    CHECK(before_n - force_n == Approx(0.01).margin(1e-9));
    before_n = force_n;
  }
  CHECK(before_n == Approx(0.0).margin(1e-9));
}

TEST_CASE("the history keeps the extent of each bin, and the newest five seconds") {
  app::MonitorHistory history(1000.0);
  for (std::int64_t tick = 0; tick < 12'000; ++tick) {
    const double time_s = static_cast<double>(tick) * 1e-3;
    history.add({{time_s, 0.0, 0.0}, {0.0, 0.0, tick == 11'990 ? 0.7 : 0.0}, tick});
  }
  const auto x = history.values(app::Channel::x);
  REQUIRE(x.size() == app::MonitorHistory::kBins);
  CHECK(x.front().least == Approx(7.0));
  CHECK(x.back().greatest == Approx(11.999));
  CHECK(x[100].greatest - x[100].least == Approx(0.019));
  CHECK(history.values(app::Channel::force_z).back().greatest == 0.7);
  CHECK(history.rates_hz()[100].least == Approx(1000.0));
}

TEST_CASE("ticks that were left out show as a lower rate and as a gap") {
  app::MonitorHistory history(1000.0);
  for (std::int64_t tick = 0; tick < 5000; ++tick) {
    if (tick < 2000 || tick >= 2100) history.add({{}, {}, tick});
  }
  CHECK(history.values(app::Channel::x)[102].is_empty());
  CHECK_FALSE(history.values(app::Channel::x)[98].is_empty());
  CHECK(history.rates_hz()[103].least < 500.0);
}

TEST_CASE("a new run begins a new history, and lateness belongs to the newest bin") {
  app::MonitorHistory history(1000.0);
  history.add_lateness(5.0);
  for (std::int64_t tick = 0; tick < 100; ++tick) history.add({{1.0, 0.0, 0.0}, {}, tick});
  history.add_lateness(7.0);
  CHECK(history.lateness_us().back().greatest == 7.0);
  CHECK(history.lateness_us()[app::MonitorHistory::kBins - 3].greatest == 7.0);
  history.add({{2.0, 0.0, 0.0}, {}, 0});
  const auto x = history.values(app::Channel::x);
  CHECK(x.back().least == 2.0);
  CHECK(x[app::MonitorHistory::kBins - 2].is_empty());
  CHECK(history.lateness_us().back().is_empty());
}

TEST_CASE("scales cover every value and have ticks at round numbers") {
  const std::vector<app::PlotLine> lines = {
      {"x", app::kBlue, {{-3.2, 17.0}, app::Extent{}, {0.0, 41.0}}}};
  const app::PlotScale scale = app::scale_for(lines, {0.0, 10.0}, 4);
  CHECK(scale.step == Approx(20.0));
  CHECK(scale.least == Approx(-20.0));
  CHECK(scale.greatest == Approx(60.0));
  const app::PlotScale none = app::scale_for({}, {0.0, 0.8}, 4);
  CHECK(none.step == Approx(0.2));
  CHECK(none.greatest == Approx(0.8));
}

TEST_CASE("logarithmic scales cover whole decades") {
  const app::PlotScale scale =
      app::decades_for({{"late", app::kBlue, {{0.2, 2500.0}}}}, {1.0, 1000.0});
  CHECK(scale.least == Approx(1.0));
  CHECK(scale.greatest == Approx(10'000.0));
}

TEST_CASE("the state line describes the state, and faults give the remedy") {
  device::ServoReport lost;
  lost.end = device::ServoEnd::fault;
  lost.fault = device::SafetyFault::device;
  lost.device_fault = device::DeviceFault::link_lost;
  const app::StateLine fault = app::state_line({.ended = lost});
  CHECK(fault.tone == app::StateTone::fault);
  CHECK_THAT(fault.text, holds_text("check its cable"));
  CHECK_THAT(fault.text, holds_text("Force is zero"));
  device::ServoReport stopped;
  stopped.end = device::ServoEnd::comfort_stop;
  CHECK(app::state_line({.ended = stopped}).tone == app::StateTone::stopped);
  const app::StateLine homing =
      app::state_line({.readiness = device::DeviceReadiness::needs_homing});
  CHECK(homing.tone == app::StateTone::waiting);
  CHECK_THAT(homing.text, holds_text("homed"));
  CHECK(app::state_line({}).tone == app::StateTone::running);
  CHECK_THAT(app::state_line({.wall_on = true, .wall_waits = true}).text, holds_text("waits"));
}

/// Waits until a condition holds.
/// \return false if it never does
bool comes(const std::function<bool()>& is_so) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// A simulated hand that keeps the last force.
class WatchedHand final : public device::HapticDevice {
 public:
  WatchedHand() : random_(1, "monitor test"), hand_(options(), path()) {}
  [[nodiscard]] device::DeviceInfo info() const override { return hand_.info(); }
  [[nodiscard]] device::DeviceStatus read(device::DeviceSample& s) noexcept override {
    while (stands_still && halts == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return hand_.read(s);
  }
  [[nodiscard]] device::DeviceStatus write(Vec3 force_n) noexcept override {
    last_n = force_n;
    return hand_.write(force_n);
  }
  void halt() noexcept override { ++halts; }
  void rearm() noexcept override { ++rearmed; }

  Vec3 last_n{1.0, 1.0, 1.0};
  int rearmed = 0;
  std::atomic<int> halts{0};
  std::atomic<bool> stands_still{false};  ///< reading comes back only once the device was halted

 private:
  static device::HandOptions options() { return {.explore_s = 3600.0}; }
  device::ExplorationPath path() {
    return {PlaneGeometry{0.2, 256, 256}, {.duration_s = 3600.0}, random_};
  }

  RandomStream random_;
  device::SimulatedHand hand_;
};

TEST_CASE("a monitored device feels the wall, stops on request with zero force, and resumes") {
  WatchedHand hand;
  app::MonitorHistory history(1000.0);
  {
    app::MonitorRun run(hand, 1000.0, {}, still_time());
    CHECK_FALSE(run.ended());
    run.wall().put(true);
    run.start();
    CHECK(comes([&] { return run.newest().force_n.z > 0.3; }));
    // The newest samples may still wait for their lateness.
    CHECK(comes([&] {
      run.collect(history);
      return history.values(app::Channel::force_z).back().greatest > 0.3 &&
             !history.lateness_us().back().is_empty();
    }));
    run.comfort_stop();
    CHECK(comes([&] { return run.ended().has_value(); }));
    CHECK(run.ended()->end == device::ServoEnd::comfort_stop);
    CHECK(hand.last_n == Vec3{});
    run.start();
    CHECK(run.running());
    CHECK(hand.rearmed == 2);
  }
  CHECK(hand.last_n == Vec3{});
}

TEST_CASE("a signal halts a monitored device under force, and it is not resumed") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  WatchedHand hand;
  app::MonitorRun run(hand, 1000.0, {}, still_time());
  run.wall().put(true);
  run.start();
  CHECK(comes([&] { return run.newest().force_n.z > 0.3; }));
  std::raise(signal);
  CHECK(comes([&] { return run.ended().has_value(); }));
  CHECK(run.ended()->fault == device::SafetyFault::emergency_stop);
  CHECK(hand.last_n == Vec3{});
  CHECK(hand.halts == 2);  // and by the servo at its end
  CHECK(device::StopOnSignals::exit_code() == 128 + signal);
  run.start();
  CHECK_FALSE(run.running());
  CHECK(hand.rearmed == 1);
}

TEST_CASE("the watchdog halts a monitored device whose driver stalls") {
  WatchedHand hand;
  app::MonitorRun run(hand, 1000.0, {});
  run.start();
  // A machine that stalls by itself may cause the fault first.
  CHECK(comes([&] { return run.newest().tick > 10 || run.ended(); }));
  hand.stands_still = true;
  CHECK(comes([&] { return run.ended().has_value(); }));
  CHECK(run.ended()->fault == device::SafetyFault::stalled);
  CHECK(hand.halts == 2);  // and by the servo at its end
  CHECK(hand.last_n == Vec3{});
}

}  // namespace
}  // namespace touchtrial
