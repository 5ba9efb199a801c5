/// \file The driver "inverse3": Haply's Inverse3 and Minverse, through Haply's Inverse service.
/// Tested against an emulated service; not verified on hardware.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/device_link.hpp"
#include "device/drivers/inverse3/service_link.hpp"
#include "device/drivers/inverse3/service_messages.hpp"

#include <atomic>
#include <chrono>
#include <latch>
#include <memory>
#include <string>
#include <thread>

namespace touchtrial::device::inverse3 {

struct Inverse3Options {
  std::unique_ptr<LinkPace> pace = std::make_unique<RealLinkPace>();
  /// Of the driver's thread: its priority is a little above that of the servo, which needs its
  /// samples.
  SchedulingRequest scheduling{SchedulingPolicy::fifo, 81, true};
  /// Timeout of each step of opening.
  std::chrono::nanoseconds timeout = std::chrono::seconds(2);
  /// Timeout of the answer to a force, after which the link counts as lost. The safety chain's
  /// limit on the age of a reading (10 ms) ends a run long before.
  std::chrono::nanoseconds silence = std::chrono::milliseconds(100);
};

/// A service that answered over HTTP.
struct KnownService {
  ServiceVersion version;
  ServiceAddress http;  ///< may differ from the port of its simulation channel
};

/// Exchanges forces and states at up to 2 kHz on a separate thread. Sends no force before the arm
/// is calibrated and powered. A fault latches: reopen the device.
class Inverse3Device final : public LinkedDevice {
 public:
  /// The shortest time from one exchange to the next.
  static constexpr std::chrono::nanoseconds kPeriod = std::chrono::microseconds(500);
  /// Messages without force before the connection is closed.
  static constexpr int kFinalPackets = 5;

  /// Connects, sets the frame, switches the service's filters off and reads them back.
  /// \throws DeviceError with the remedy: no service or one of an unknown version, no such device,
  ///   no power, another session, or a filter that cannot be switched off
  explicit Inverse3Device(const Inverse3Settings& settings, Inverse3Options options = {});
  ~Inverse3Device() override;

  [[nodiscard]] DeviceInfo info() const override { return info_; }
  [[nodiscard]] DeviceReadiness readiness() const noexcept override {
    return readiness_.load(std::memory_order_acquire);
  }

 private:
  [[nodiscard]] DeviceLink& link() const noexcept override { return link_; }
  [[nodiscard]] DeviceLink::Time link_time() const noexcept override {
    return options_.pace->now();
  }
  void choose_device(const ServiceReport& inventory);
  void expect_no_other_session(const ServiceReport& inventory) const;
  void configure();
  void listen_to_events();
  void describe(const DeviceConfig& config);
  [[nodiscard]] DeviceReport ask_for_inventory(const std::string& message);
  void refuse_home_return(DeviceConfig& config) const;
  void exchange_until_stopped() noexcept;
  void exchange();
  void take(const DeviceReport& report, std::uint32_t buttons) noexcept;
  void note_status(const ArmStatus& status) noexcept;
  void handle_event(const ServiceEvent& event) noexcept;
  void send_final_zeros() noexcept;
  [[nodiscard]] Vec3 within_reach(Vec3 force_n) const noexcept;

  Inverse3Settings settings_;
  Inverse3Options options_;
  KnownService known_;
  std::unique_ptr<ServiceLink> service_;
  std::string id_;
  std::optional<std::int64_t> session_id_;
  Vec3 centre_m_;  ///< of the workspace, in the service's frame
  DeviceInfo info_;
  mutable DeviceLink link_;
  ArmStatus status_;  ///< driver's thread, once that runs
  std::atomic<DeviceReadiness> readiness_{DeviceReadiness::needs_calibration};
  std::atomic<bool> stopping_{false};
  std::latch started_{1};
  std::thread thread_;
};

}  // namespace touchtrial::device::inverse3
