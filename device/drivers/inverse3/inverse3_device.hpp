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
  /// The driver's thread has a slightly higher priority than the servo, which needs its samples.
  SchedulingRequest scheduling{SchedulingPolicy::fifo, 81, true};
  /// Timeout of each step of opening.
  std::chrono::nanoseconds timeout = std::chrono::seconds(2);
  /// Timeout of the answer to a force, after which the link counts as lost. The safety chain ends a
  /// run much earlier, after 10 ms without a reading.
  std::chrono::nanoseconds answer_timeout = std::chrono::milliseconds(100);
};

/// The service that answered over HTTP.
struct ServiceInfo {
  ServiceVersion version;
  ServiceAddress http;  ///< its port may differ from the simulation channel's
};

/// Exchanges forces and states at up to 2 kHz on a separate thread. Sends no force before the arm
/// is calibrated and powered. A fault latches until the device is reopened.
class Inverse3Device final : public LinkedDevice {
 public:
  /// The minimum time from one exchange to the next.
  static constexpr std::chrono::nanoseconds kPeriod = std::chrono::microseconds(500);
  /// Zero-force messages sent before the connection is closed.
  static constexpr int kFinalPackets = 5;

  /// Connects, sets the frame, switches the service's filters off and verifies the configuration.
  /// \throws DeviceError with the remedy for: no service or an unsupported version, no such device,
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
  [[nodiscard]] DeviceReport exchange_configuration(const std::string& message);
  void refuse_home_return(DeviceConfig& config) const;
  void exchange_until_stopped() noexcept;
  void exchange();
  void publish_sample(const DeviceReport& report, std::uint32_t buttons) noexcept;
  void update_status(const ArmStatus& status) noexcept;
  void handle_event(const ServiceEvent& event) noexcept;
  void send_final_zeros() noexcept;
  [[nodiscard]] Vec3 limit_to_max_force(Vec3 force_n) const noexcept;

  Inverse3Settings settings_;
  Inverse3Options options_;
  ServiceInfo service_info_;
  std::unique_ptr<ServiceLink> service_;
  std::string id_;
  std::optional<std::int64_t> session_id_;
  Vec3 centre_m_;  ///< of the workspace, in the service's frame
  DeviceInfo info_;
  mutable DeviceLink link_;
  ArmStatus status_;  ///< belongs to the driver's thread once it runs
  std::atomic<DeviceReadiness> readiness_{DeviceReadiness::needs_calibration};
  std::atomic<bool> stopping_{false};
  std::latch started_{1};
  std::thread thread_;
};

}  // namespace touchtrial::device::inverse3
