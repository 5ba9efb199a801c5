/// \file A connected device and the person at the terminal, for acceptance and bring-up.
#pragma once

#include "app/run/attended_run.hpp"
#include "device/acceptance/acceptance.hpp"
#include "device/device_settings.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial::app {

/// Thrown when the person or a signal ends the acceptance.
struct AcceptanceStopped {};

/// Prompts go to standard error: standard output holds the result only. Belongs to the main thread.
class AcceptanceTerminal final : public device::AcceptanceBench, public device::AcceptancePerson {
 public:
  /// Opens the device and waits until it is ready.
  /// \throws AcceptanceStopped; DeviceError if it has no motors; as device::open_device and
  ///   AttendedRun::wait_until_ready
  AcceptanceTerminal(const std::string& driver, const device::DeviceSettings& settings);

  [[nodiscard]] const device::SchedulingObtained& scheduling() const noexcept {
    return run_.scheduling();
  }

  [[nodiscard]] device::DeviceInfo info() const override { return info_; }
  [[nodiscard]] device::SafetyLimits limits() const override;
  void limit_force(double max_n) override;
  [[nodiscard]] device::ServoReport run(const std::string& name,
                                        device::Measurement& measurement) override;
  [[nodiscard]] std::optional<device::ServoReport> run_suspended(
      device::Measurement& measurement) override;

  [[nodiscard]] device::Consent ready(const device::Prompt& prompt) override;
  [[nodiscard]] std::optional<double> weight_n(device::DeviceAxis axis, double min_n,
                                               double max_n) override;
  [[nodiscard]] std::optional<double> temperature_c(const std::string& question) override;
  [[nodiscard]] std::string ask_observation(const std::string& question) override;
  void show(const std::string& text) override;

 private:
  void require_not_aborted() const;

  std::unique_ptr<device::HapticDevice> device_;
  device::SafetyLimits limits_;
  double max_n_ = std::numeric_limits<double>::infinity();  ///< set by limit_force
  AttendedRun run_;
  device::DeviceInfo info_;
};

/// Does the work in a child process, so that suspending it does not return the terminal to the
/// shell. Call it before threads exist.
/// \return the exit code, in both processes
int run_in_child_process(const std::function<int()>& work);

}  // namespace touchtrial::app
