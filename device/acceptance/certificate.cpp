#include "device/acceptance/certificate.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "core/utc.hpp"
#include "device/acceptance/measurement.hpp"
#include "device/servo/scaled_device.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace touchtrial::device {
namespace {

/// A number that prints like its limit (three digits, whole percents) does not exceed it.
constexpr double kEqualShare = 0.004;
constexpr double kEqualPercent = 0.5;

std::string axis_words(const AxisResult& axis) {
  return "axis " + std::string(name_of(axis.axis));
}

void check_push(const AxisResult& axis, const std::optional<PushResult>& push,
                const char* direction, std::vector<std::string>& failures) {
  const std::string where = axis_words(axis) + ": ";
  if (!push) {
    failures.push_back(where + "the push " + direction + " was not measured");
  } else if (!push->moved) {
    failures.push_back(
        fmt::format("{}the handle did not move at {:.1f} N {}", where, push->force_n, direction));
  } else if (push->along_mm <= 0.0) {
    failures.push_back(
        fmt::format("{}the handle moved against a force of {:.1f} N {}: the sign is "
                    "wrong",
                    where, push->force_n, direction));
  } else if (push->across_mm > push->along_mm) {
    failures.push_back(
        fmt::format("{}the handle moved across a force of {:.1f} N {}: axes are exchanged", where,
                    push->force_n, direction));
  }
}

void check_max(const std::string& where, const char* quantity, double value, double limit,
               const char* unit, std::vector<std::string>& failures) {
  if (value <= limit * (1.0 + kEqualShare)) return;
  failures.push_back(fmt::format("{}{} is {:.3g} {}, more than {:g} {}", where, quantity, value,
                                 unit, limit, unit));
}

/// \return ": " and the reason, if one is recorded for this axis
std::string reason_for_no_delay(DeviceAxis axis, const std::vector<NotMeasured>& not_measured) {
  const std::string measurement = "delay on axis " + std::string(name_of(axis));
  const auto found = std::ranges::find_if(not_measured, [&](const NotMeasured& entry) {
    return entry.measurement.ends_with(measurement);
  });
  return found == not_measured.end() ? "" : ": " + found->reason;
}

void check_delay(const AxisResult& axis, const std::vector<NotMeasured>& not_measured,
                 std::vector<std::string>& failures) {
  const std::string where = axis_words(axis) + ": ";
  if (!axis.delay_ms) {
    if (axis.delay_left_out) return;
    failures.push_back(where + "the delay was not measured" +
                       reason_for_no_delay(axis.axis, not_measured));
    return;
  }
  const Measured& delay = *axis.delay_ms;
  const auto add_failure = [&](const char* reason) {
    failures.push_back(fmt::format("{}the delay is {:.3g} +- {:.2g} ms, {} {:g} ms", where,
                                   delay.value, delay.error, reason, kMaxDelayMs));
  };
  switch (verdict_on_delay(delay)) {
    case DelayVerdict::below:
      break;
    case DelayVerdict::above:
      add_failure("more than");
      break;
    case DelayVerdict::not_shown:
      add_failure("not proven to be at most");
      break;
    case DelayVerdict::unclear:
      add_failure("too uncertain to be at most");
      break;
  }
}

/// \param force_scale  of the device settings, on this axis
void check_axis(const AxisResult& axis, double force_scale,
                const std::vector<NotMeasured>& not_measured, std::vector<std::string>& failures) {
  const std::string where = axis_words(axis) + ": ";
  check_push(axis, axis.plus, "along it", failures);
  if (axis.plus && axis.plus->moved && axis.plus->along_mm > 0.0) {
    check_push(axis, axis.minus, "against it", failures);
  }
  if (const auto scale = axis.scale()) {
    if (std::abs(scale->value - 1.0) > kForceTolerance + 0.01 * kEqualPercent) {
      failures.push_back(fmt::format(
          "{}delivers {:.0f} % of the commanded force, more than {:.0f} % off; if the "
          "weight was right, set force_scale on this axis to {:.2f} in the device "
          "settings",
          where, 100.0 * scale->value, 100.0 * kForceTolerance, force_scale * scale->value));
    }
  } else {
    failures.push_back(where + "the size of the force was not measured");
  }
  if (axis.friction_n) {
    check_max(where, "friction", axis.friction_n->value, kMaxFrictionN, "N", failures);
  }
  check_delay(axis, not_measured, failures);
}

std::string identity_words(const std::string& driver, const std::string& model,
                           const std::string& serial) {
  return in_quotes(driver) + (model.empty() ? "" : ", model " + in_quotes(model)) +
         (serial.empty() ? "" : ", serial number " + in_quotes(serial));
}

}  // namespace

std::optional<Measured> AxisResult::scale() const {
  if (!weight || !(weight->measured_n > 0.0)) return std::nullopt;
  const double scale = weight->expected_n / weight->measured_n;
  // An error of 2 % for the weight, the string and the pulley.
  return Measured{scale, scale * (weight->error_n / weight->measured_n + 0.02)};
}

DelayVerdict verdict_on_delay(const Measured& delay_ms) noexcept {
  if (delay_ms.value - delay_ms.error > kMaxDelayMs) return DelayVerdict::above;
  if (!(delay_ms.error <= kMaxDelayErrorMs)) return DelayVerdict::unclear;
  return delay_ms.value + delay_ms.error <= kMaxDelayMs ? DelayVerdict::below
                                                        : DelayVerdict::not_shown;
}

std::vector<std::string> Certificate::failures() const {
  std::vector<std::string> failures;
  if (!fault.empty()) failures.push_back("the device failed: " + fault);
  if (rest) {
    check_max("at rest: ", "noise", rest->noise_mm, kMaxNoiseMm, "mm", failures);
    check_max("at rest: ", "drift", rest->drift_mm, kMaxDriftMm, "mm", failures);
  } else {
    failures.emplace_back("noise at rest was not measured");
  }
  if (step_mm) {
    check_max("", "the encoder step", step_mm->value, kMaxStepMm, "mm", failures);
  }
  for (const DeviceAxis axis : kDeviceAxes) {
    const auto found = std::ranges::find(axes, axis, &AxisResult::axis);
    if (found == axes.end()) {
      failures.push_back("axis " + std::string(name_of(axis)) + ": was not measured");
    } else {
      const double force_scale = dot(scale.force, direction_of(axis));
      check_axis(*found, force_scale, not_measured, failures);
    }
  }
  if (wall && wall->oscillates_n_per_mm > 0.0 && wall->stable_n_per_mm <= 0.0) {
    failures.push_back(fmt::format("the softest wall that was tested, {:.2g} N/mm, oscillates",
                                   wall->oscillates_n_per_mm));
  }
  if (warm && std::abs(warm->before_n) > 0.0) {
    check_max("", "the change of the load's force over twenty minutes",
              std::abs(warm->after_n / warm->before_n - 1.0), kMaxWarmDrift, "of it", failures);
  }
  return failures;
}

double Certificate::largest_scale() const {
  double largest = 0.0;
  for (const AxisResult& axis : axes) {
    if (const auto delivered = axis.scale()) largest = std::max(largest, delivered->value);
  }
  return largest > 0.0 ? largest : 1.0;
}

std::optional<Measured> Certificate::mean_of(std::optional<Measured> AxisResult::*part) const {
  Measured sum;
  int n = 0;
  for (const AxisResult& axis : axes) {
    const std::optional<Measured>& measured = axis.*part;
    if (!measured) continue;
    sum.value += measured->value;
    sum.error += measured->error;
    ++n;
  }
  if (n == 0) return std::nullopt;
  return Measured{sum.value / n, sum.error / n};
}

std::string check_certificate(const Certificate& certificate, const DeviceInfo& device,
                              std::chrono::sys_seconds now) {
  const std::string remedy = "; run touchtrial device accept " + device.name;
  if (!certificate.emulated.empty()) {
    throw DeviceError(
        one_line(device.name + ": its certificate is from a rehearsal on an emulated " +
                 in_quotes(certificate.emulated) + ", which does not test a device" + remedy));
  }
  if (certificate.driver != device.name || certificate.serial != device.serial ||
      certificate.model != device.model) {
    throw DeviceError(one_line(
        "the certificate is for " +
        identity_words(certificate.driver, certificate.model, certificate.serial) +
        "; the device is " + identity_words(device.name, device.model, device.serial) + remedy));
  }
  if (certificate.scale != device.scale) {
    throw DeviceError(device.name + ": its certificate was made with " +
                      scale_text(certificate.scale) + ", but the device settings have " +
                      scale_text(device.scale) + remedy);
  }
  if (const auto failures = certificate.failures(); !failures.empty()) {
    throw DeviceError(one_line(device.name + ": its certificate states that it failed (" +
                               failures.front() + ")" + remedy));
  }
  if (certificate.made > now + kCertificateLead) {
    throw DeviceError(device.name + ": its certificate was made at " +
                      utc_text(certificate.made.time_since_epoch()) +
                      ", which is in the future; set the clock of this machine" + remedy);
  }
  if (now - certificate.made > kCertificateAge) {
    const auto days = std::chrono::duration_cast<std::chrono::days>(now - certificate.made).count();
    return device.name + ": its certificate is " + std::to_string(days) + " days old" + remedy;
  }
  if (certificate.firmware != device.firmware) {
    return one_line(device.name + ": its certificate is for firmware " +
                    in_quotes(certificate.firmware) + ", the device has " +
                    in_quotes(device.firmware) + remedy);
  }
  return "";
}

void require_stable(const Certificate& certificate, double stiffness_n_per_mm) {
  if (!certificate.wall || certificate.wall->oscillates_n_per_mm <= 0.0) return;
  if (stiffness_n_per_mm < certificate.wall->oscillates_n_per_mm) return;
  if (certificate.wall->stable_n_per_mm <= 0.0) {
    throw DeviceError(
        fmt::format("{}: even the softest wall of its acceptance, {:.2g} N/mm, oscillated, and no "
                    "wall was stable; find the cause (delay, gains, a loose joint), and run "
                    "touchtrial device accept {} again",
                    certificate.driver, certificate.wall->oscillates_n_per_mm, certificate.driver));
  }
  throw DeviceError(fmt::format(
      "{}: a wall of {:.2g} N/mm oscillated in its acceptance, and the study's wall has {:.2g} "
      "N/mm; set the stiffness in the study's rendering to at most {:.2g} N/mm",
      certificate.driver, certificate.wall->oscillates_n_per_mm, stiffness_n_per_mm,
      certificate.wall->stable_n_per_mm));
}

DeviceModel model_of(const Certificate& certificate, const DeviceInfo& device) {
  DeviceModel model;
  model.name = certificate.driver + (certificate.serial.empty() ? "" : "-" + certificate.serial);
  model.title = certificate.model;
  const std::string source =
      (certificate.emulated.empty() ? std::string("device accept")
                                    : "a rehearsal on the model " + certificate.emulated) +
      ", " + utc_text(certificate.made.time_since_epoch());
  const auto set_parameter = [&](const char* key, double value, double limit, double& parameter) {
    parameter = std::clamp(value, 0.0, limit);
    if (parameter == 0.0) return;
    model.provenance[key] = {
        source, certificate.emulated.empty() ? Confidence::measured : Confidence::derived};
  };
  if (const auto mass = certificate.mean_of(&AxisResult::mass_kg)) {
    set_parameter("mass_kg", mass->value, 5.0, model.mass_kg);
  }
  if (const auto viscous = certificate.mean_of(&AxisResult::viscous_n_s_per_m)) {
    set_parameter("viscous_n_s_per_m", viscous->value, 100.0, model.viscous_n_s_per_m);
  }
  if (const auto friction = certificate.mean_of(&AxisResult::friction_n)) {
    set_parameter("coulomb_n", friction->value, 10.0, model.coulomb_n);
  }
  if (certificate.step_mm) {
    set_parameter("position_step_mm", certificate.step_mm->value, 1.0, model.position_step_mm);
  }
  if (const auto delay = certificate.mean_of(&AxisResult::delay_ms)) {
    double ticks = 0.0;
    set_parameter("delay_ticks", std::round(delay->value), 100.0, ticks);
    model.delay_ticks = static_cast<int>(ticks);
  }
  // This is not measured, but without it the model's walls would be more stable than any device's.
  model.zero_order_hold = true;
  model.provenance["zero_order_hold"] = {"every device holds a force until the next tick",
                                         Confidence::guess};
  model.max_force_n = std::clamp(device.max_force_n, 0.0, 100.0);
  model.continuous_force_n = std::clamp(device.continuous_force_n, 0.0, 100.0);
  model.workspace = device.workspace;
  model.max_stiffness_n_per_mm = std::clamp(device.max_stiffness_n_per_mm, 0.0, 100.0);
  return model;
}

}  // namespace touchtrial::device
