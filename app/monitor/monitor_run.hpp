/// \file The servo behind the monitor, which a person starts and stops, the wall that it feels, and
/// its last seconds, in bins narrow enough to plot.
#pragma once

#include "device/platform/stop_signals.hpp"
#include "device/safety/watchdog.hpp"
#include "device/servo/sample_ring.hpp"
#include "device/servo/servo.hpp"
#include "device/servo/servo_thread.hpp"
#include "device/workspace_fit.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace touchtrial::app {

/// The least and the greatest value of an interval; empty if least > greatest.
struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  void add(double value) noexcept;
  [[nodiscard]] bool is_empty() const noexcept { return least > greatest; }
};

/// The plotted channels: position in mm, force in N.
enum class Channel : std::size_t { x, y, z, force_x, force_y, force_z };

/// Not thread-safe.
class MonitorHistory {
 public:
  static constexpr double kBinsPerS = 50.0;
  static constexpr double kBinS = 1.0 / kBinsPerS;
  static constexpr std::size_t kBins = 250;

  /// \param rate_hz  the servo's rate, > 0
  explicit MonitorHistory(double rate_hz);

  /// Adds samples in the order of their ticks. A tick that is not greater than the last begins a
  /// new run.
  void add(const device::ServoSample& sample);
  /// Adds the worst lateness of a tick since the last call, in µs, to the bins since then.
  void add_lateness(double late_us);

  /// \name kBins values each, from the oldest to the newest
  ///@{
  [[nodiscard]] std::vector<Extent> values(Channel channel) const;
  /// Ticks per second, each over the preceding tenth of a second.
  [[nodiscard]] std::vector<Extent> rates_hz() const;
  [[nodiscard]] std::vector<Extent> lateness_us() const;
  ///@}

 private:
  struct Bin {
    std::array<Extent, 6> channels;
    Extent lateness_us;
    int samples = 0;
  };
  [[nodiscard]] Bin& bin_at(std::int64_t number) noexcept;
  [[nodiscard]] const Bin& from_oldest(std::size_t index) const noexcept;

  double rate_hz_;
  std::vector<Bin> bins_;     ///< a ring
  std::int64_t newest_ = -1;  ///< number of the newest bin since the run began
  std::int64_t last_tick_ = -1;
  std::int64_t told_until_ = -1;  ///< the newest bin when lateness was last added
};

/// A gentle wall at z = 0, which acts from the front (z > 0) only: if the stylus is behind it when
/// it is switched on, it waits until the stylus has come to the front. Its force rises and falls
/// within 100 ms.
class TestWall final : public device::ForceSource {
 public:
  static constexpr double kStiffnessNPerMm = 0.4;  ///< or less, as the device's limit wants
  static constexpr double kMaxForceN = 1.0;

  /// \param rate_hz  the servo's rate, > 0
  /// \param max_stiffness_n_per_mm  of the device, which the wall stays below; 0: not known
  explicit TestWall(double rate_hz, double max_stiffness_n_per_mm = 0.0) noexcept
      : share_of_tick_(10.0 / rate_hz),
        stiffness_n_per_mm_(device::within_share(kStiffnessNPerMm, max_stiffness_n_per_mm)) {}
  [[nodiscard]] double stiffness_n_per_mm() const noexcept { return stiffness_n_per_mm_; }

  /// \name Any thread
  ///@{
  void put(bool on) noexcept { on_.store(on, std::memory_order_release); }
  [[nodiscard]] bool is_on() const noexcept { return on_.load(std::memory_order_acquire); }
  /// Whether the wall is on but waits for the stylus.
  [[nodiscard]] bool waits() const noexcept {
    return is_on() && !met_.load(std::memory_order_acquire);
  }
  ///@}

  [[nodiscard]] Vec3 force_n(const device::DeviceSample& sample) noexcept override {
    const bool on = is_on();
    const double depth_mm = -sample.position_mm.z;
    const bool met = on && (met_.load(std::memory_order_relaxed) || depth_mm <= 0.0);
    // A wall that is switched off still acts while its force falls.
    if (met != met_.load(std::memory_order_relaxed)) met_.store(met, std::memory_order_release);
    share_ = std::clamp(share_ + (met ? share_of_tick_ : -share_of_tick_), 0.0, 1.0);
    const double force_n = std::clamp(stiffness_n_per_mm_ * depth_mm, 0.0, kMaxForceN);
    return {0.0, 0.0, share_ * force_n};
  }

 private:
  double share_of_tick_;
  double stiffness_n_per_mm_;
  double share_ = 0.0;
  std::atomic<bool> on_{false};
  std::atomic<bool> met_{false};
};

/// Runs a device against the test wall on a thread of its own, under a watchdog. Signals halt the
/// device while this object lives. Belongs to one thread; only its destructor waits for the servo.
class MonitorRun {
 public:
  /// \param device  must outlive this
  /// \param rate_hz  1,000 to 10,000
  /// \throws std::logic_error if there is another StopOnSignals
  MonitorRun(device::HapticDevice& device, double rate_hz, const device::SafetyLimits& limits,
             device::WatchdogTime& time = device::system_watchdog_time());
  /// The force fades to zero and the servo ends.
  ~MonitorRun();
  MonitorRun(const MonitorRun&) = delete;
  MonitorRun& operator=(const MonitorRun&) = delete;

  /// Re-arms the device and runs the servo; only a person may decide to do so. Does nothing while
  /// it runs, or after a signal has asked the program to end.
  void start();
  void comfort_stop() noexcept { control_.comfort_stop(); }
  [[nodiscard]] bool running();
  /// The report of the last run; nothing while one runs, or before the first.
  [[nodiscard]] std::optional<device::ServoReport> ended();

  [[nodiscard]] TestWall& wall() noexcept { return wall_; }
  [[nodiscard]] const device::ServoState& newest() noexcept { return states_.get(); }
  [[nodiscard]] const device::SchedulingObtained& scheduling() const noexcept {
    return thread_.scheduling();
  }
  /// Moves the samples since the last call into the history.
  void collect(MonitorHistory& history);

 private:
  void run() noexcept;

  device::HapticDevice& device_;
  device::ServoOptions options_;
  TestWall wall_;
  device::SampleRing ring_;
  device::RingSink sink_;
  device::ServoControl control_;
  std::atomic<std::int64_t> heartbeat_{0};
  device::Watchdog watchdog_;
  device::StopOnSignals signals_;
  device::LatestValue<device::ServoState> states_;
  std::atomic<std::int64_t> worst_late_ns_{-1};  ///< since the last `collect`
  device::ServoReport report_;
  bool waited_for_ = true;
  bool has_run_ = false;
  device::ServoThread thread_;  ///< last: it must end before the members that it uses
};

}  // namespace touchtrial::app
