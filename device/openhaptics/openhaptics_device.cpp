#include "device/openhaptics/openhaptics_device.hpp"

#include "device/openhaptics/hd_session.hpp"
#include "device/platform/realtime.hpp"

#include <chrono>
#include <thread>

namespace touchtrial::device {
namespace {

using std::chrono::milliseconds;

/// Frames of zero before the scheduler is stopped, and how long to wait for them.
constexpr int kZerosAtTheEnd = 5;
constexpr milliseconds kPatience{500};
/// For a callback that is still inside the library after the scheduler was stopped.
constexpr milliseconds kPatienceWithCallback{2000};

void wait_for_zeros(const hd::Loop& loop) noexcept {
  for (milliseconds waited(0); waited < kPatience; ++waited) {
    if (loop.zeros_sent() >= kZerosAtTheEnd) return;
    std::this_thread::sleep_for(milliseconds(1));
  }
}

}  // namespace

/// An open device whose scheduler runs. The order in which it ends is the vendor's: force to zero,
/// scheduler stopped, callback unscheduled, device disabled.
class OpenHapticsDevice::Running {
 public:
  explicit Running(const OpenHapticsSettings& settings)
      : session_(settings),
        info_(session_.info()),
        loop_(std::make_unique<hd::Loop>(session_.api(), session_.device(),
                                         session_.loop_options())) {
    info_.max_rate_hz = static_cast<double>(settings.rate_hz);
    try {
      start(settings.rate_hz);
    } catch (...) {
      stop();
      throw;
    }
  }
  ~Running() {
    loop_->link().halt();
    wait_for_zeros(*loop_);
    stop();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  [[nodiscard]] const DeviceInfo& info() const noexcept { return info_; }
  [[nodiscard]] hd::Loop& loop() noexcept { return *loop_; }

 private:
  void start(unsigned long rate_hz) {
    const hd::Api& api = session_.api();
    api.set_scheduler_rate(rate_hz);
    session_.expect_no_error("openhaptics.rate_hz = " + std::to_string(rate_hz));
    api.enable(hd::kForceOutput);
    api.enable(hd::kForceClamping);
    api.enable(hd::kForceRamping);
    session_.expect_no_error("switching force on");
    callback_ = api.schedule_asynchronous(&hd::Loop::callback, loop_.get(), hd::kHighestPriority);
    session_.expect_no_error("scheduling the servo");
    scheduled_ = true;
    api.start_scheduler();
    session_.expect_no_error("starting the scheduler");
  }

  void stop() noexcept {
    const hd::Api& api = session_.api();
    api.stop_scheduler();
    // A callback that never comes back still holds the loop: better lost than freed under it.
    if (!loop_->close(kPatienceWithCallback)) (void)loop_.release();
    if (scheduled_) api.unschedule(callback_);
    api.make_current_device(session_.device());
    api.disable(hd::kForceOutput);
    (void)hd::drain_errors(api);
  }

  hd::Session session_;
  DeviceInfo info_;
  std::unique_ptr<hd::Loop> loop_;
  hd::ScheduleHandle callback_ = 0;
  bool scheduled_ = false;
};

OpenHapticsDevice::OpenHapticsDevice(const OpenHapticsSettings& settings)
    : running_(std::make_unique<Running>(settings)) {
  info_ = running_->info();
}

OpenHapticsDevice::~OpenHapticsDevice() = default;

DeviceStatus OpenHapticsDevice::read(DeviceSample& sample) noexcept {
  return running_->loop().link().read(sample);
}

DeviceStatus OpenHapticsDevice::write(Vec3 force_n) noexcept {
  return running_->loop().link().write(force_n, monotonic_now());
}

void OpenHapticsDevice::halt() noexcept {
  running_->loop().link().halt();
}

void OpenHapticsDevice::rearm() noexcept {
  running_->loop().link().rearm();
}

DeviceFault OpenHapticsDevice::fault() const noexcept {
  return running_->loop().link().fault();
}

DeviceReadiness OpenHapticsDevice::readiness() const noexcept {
  return running_->loop().readiness();
}

}  // namespace touchtrial::device
