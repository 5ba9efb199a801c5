/// \file A rehearsal of an acceptance: a device model in virtual time, and a simulated person who
///   follows the prompts. It tests the program, not a device.
#pragma once

#include "device/acceptance/acceptance.hpp"
#include "device/model/device_model.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace touchtrial::device {

/// Bench and person in one. Not thread-safe.
class Rehearsal final : public AcceptanceBench, public AcceptancePerson {
 public:
  /// \throws std::invalid_argument as ModelledDevice
  explicit Rehearsal(const DeviceModel& model);

  [[nodiscard]] DeviceInfo info() const override { return device_.info(); }
  [[nodiscard]] SafetyLimits limits() const override { return limits_; }
  void limit_force(double max_n) override {
    limits_.max_force_n = std::min(SafetyLimits{}.max_force_n, max_n);
  }
  [[nodiscard]] ServoReport run(const std::string& name, Measurement& measurement) override;

  [[nodiscard]] Consent ready(const Prompt& prompt) override;
  [[nodiscard]] std::optional<double> weight_n(DeviceAxis axis, double min_n,
                                               double max_n) override;
  [[nodiscard]] std::optional<double> temperature_c(const std::string& question) override;
  [[nodiscard]] std::string ask_observation(const std::string& question) override;
  void show(const std::string& result) override { results_.push_back(result); }

  /// Every result, one line each.
  [[nodiscard]] const std::vector<std::string>& results() const noexcept { return results_; }

 private:
  [[nodiscard]] DeviceDynamics::TipLoad hand_load(double time_s, Vec3 position_mm) const;

  /// The load of a hand that gradually lets go.
  [[nodiscard]] DeviceDynamics::TipLoad release_load(double time_s, Vec3 to_middle_mm) const;

  ModelledDevice device_;
  SafetyLimits limits_;
  Vec3 middle_mm_;
  Grip grip_ = Grip::lying;
  DeviceAxis axis_ = DeviceAxis::y;
  double weight_n_ = 0.0;
  double run_start_s_ = 0.0;
  std::vector<std::string> results_;
};

/// Rehearses an acceptance with a device model.
/// \return the acceptance, with Certificate::emulated set
[[nodiscard]] Acceptance rehearse_acceptance(const DeviceModel& model,
                                             const AcceptanceOptions& options);

}  // namespace touchtrial::device
