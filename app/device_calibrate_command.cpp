// device calibrate: a person weighs a device's force with hanging weights.
#include "app/attended_run.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/device_words.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "core/version.hpp"
#include "device/calibration/certificate.hpp"

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

constexpr double kLightestG = 10.0;
/// The share of the force limit that may hold a weight; the rest holds the handle itself.
constexpr double kWeightShare = 0.6;
/// 2 s longer than the measurement, so that a run never ends before its last sample.
constexpr double kRunS = device::HoldMeasurement::kRunS + 2.0;
constexpr int kNotPassed = 1;

struct CalibrateArguments {
  std::string driver;
  fs::path settings;
  fs::path certificate;
};

/// Writes a prompt to standard error: standard output holds the result only.
void tell(const std::string& text) {
  std::cerr << text << std::flush;
}

std::string answer_to(const std::string& question) {
  tell(question);
  std::string line;
  if (!std::getline(std::cin, line)) {
    throw UsageError("standard input ended during the calibration; answer every prompt");
  }
  return line;
}

double mass_asked_for(device::CalibrationAxis axis, double heaviest_g) {
  while (true) {
    const std::string line =
        answer_to(fmt::format("mass for axis {} in g ({:.0f} to {:.0f}): ", device::name_of(axis),
                              kLightestG, heaviest_g));
    const auto mass_g = number_in<double>(line);
    if (mass_g && *mass_g >= kLightestG && *mass_g <= heaviest_g) return *mass_g;
    tell("that is not a mass in this range\n");
  }
}

const char* hanging_on(device::CalibrationAxis axis) {
  switch (axis) {
    case device::CalibrationAxis::x:
      return "Lead the string horizontally to the right, over a pulley at the handle's height, and "
             "hang "
             "the weight on its end.";
    case device::CalibrationAxis::y:
      return "Hang the weight straight down from the handle.";
    case device::CalibrationAxis::z:
      break;
  }
  return "Lead the string horizontally towards you, over a pulley at the handle's height, and hang "
         "the "
         "weight on its end.";
}

/// "passed", or why not.
const char* verdict_on(const device::AxisResult& result) {
  if (result.passed) return "passed";
  return device::is_within_tolerance(result) ? "FAILED, the handle did not come to rest"
                                             : "FAILED, more than 10 % off";
}

class Calibration {
 public:
  explicit Calibration(const CalibrateArguments& arguments)
      : settings_(device::device_settings_for(arguments.settings)),
        opened_(arguments.driver, settings_, {100.0, 100.0}),
        limits_(
            device::limits_on(opened_.device().info(),
                              device::stricter_of({}, settings_.use_of(arguments.driver).limits))),
        run_(opened_, checked(opened_.device()), limits_, device::kServoRateHz, false) {}

  device::Certificate measure() {
    run_.wait_until_ready(kReadyLimitS);
    const device::DeviceInfo info = opened_.device().info();
    device::Certificate certificate{
        info.name, info.model, info.serial, info.firmware, std::string(program_version()),
        {},        {},         {}};
    answer_to("Let the handle lie or hang still, without a weight, hands off. Then press Enter.\n");
    const device::HoldFigures rest = held("rest", device::HoldMeasurement::Mode::rest);
    answer_to("Hold the handle in the middle of its range. Press Enter, then let go slowly.\n");
    const device::HoldFigures empty = held("empty", device::HoldMeasurement::Mode::hold);
    certificate.free_air = device::judge_free_air(rest, empty);
    for (const device::CalibrationAxis axis : device::kCalibrationAxes) {
      certificate.axes.push_back(measure_axis(axis, empty));
    }
    certificate.made = std::chrono::floor<std::chrono::seconds>(
        std::chrono::sys_time<std::chrono::nanoseconds>(utc_now()));
    return certificate;
  }

 private:
  static device::HapticDevice& checked(device::HapticDevice& device) {
    const device::DeviceInfo info = device.info();
    if (info.simulated || info.visual || !info.workspace) {
      throw DeviceError(info.name +
                        ": has no motors whose force could be weighed; calibrate a "
                        "device that touchtrial device list finds on a cable");
    }
    return device;
  }

  device::AxisResult measure_axis(device::CalibrationAxis axis, const device::HoldFigures& empty) {
    const double heaviest_g =
        kWeightShare * limits_.max_force_n / device::kStandardGravityMS2 * 1000.0;
    tell(fmt::format("\nAxis {}. {}\n", device::name_of(axis), hanging_on(axis)));
    const double mass_g = mass_asked_for(axis, heaviest_g);
    answer_to(
        "Hold the handle in the middle of its range with the weight on it. Press Enter, "
        "then let go slowly.\n");
    const device::HoldFigures loaded =
        held(std::string(device::name_of(axis)), device::HoldMeasurement::Mode::hold);
    const device::AxisResult result = device::judge_axis(axis, mass_g, empty, loaded);
    tell(fmt::format("axis {}: {:.3f} N commanded for {:.3f} N: {}\n", device::name_of(axis),
                     result.measured_n, result.expected_n, verdict_on(result)));
    return result;
  }

  device::HoldFigures held(const std::string& phase, device::HoldMeasurement::Mode mode) {
    device::HoldMeasurement hold(mode);
    const auto report = run_.run([&](std::int64_t) { return phase; }, hold, kRunS, {}, &hold);
    if (!report || run_.stop() != AttendedStop::none) {
      throw DeviceError("calibration was stopped; nothing was written");
    }
    if (report->end == device::ServoEnd::fault) {
      throw DeviceError("fault while calibrating: " + fault_names(*report) +
                        "; nothing was written; try again");
    }
    return hold.figures();
  }

  device::DeviceSettings settings_;
  OpenedDevice opened_;
  device::SafetyLimits limits_;
  AttendedRun run_;
};

std::string result_text(const device::Certificate& certificate, const fs::path& path) {
  std::string text;
  for (const device::AxisResult& r : certificate.axes) {
    text += fmt::format("axis {}: {:.3f} N for {:.3f} N ({:+.1f} %), {:.3f} N across: {}\n",
                        device::name_of(r.axis), r.measured_n, r.expected_n,
                        100.0 * (r.measured_n / r.expected_n - 1.0), r.cross_n, verdict_on(r));
  }
  const device::FreeAirResult& air = certificate.free_air;
  text += fmt::format("free air: noise {:.3f} mm, drift {:.3f} mm, holding takes {:.3f} N: {}\n",
                      air.noise_mm, air.drift_mm, air.residual_n, air.passed ? "passed" : "FAILED");
  return text + fmt::format("{}\n{}: SHA-256 {}\n", certificate.passed() ? "passed" : "FAILED",
                            path.string(), to_hex(sha256_of_file(path)));
}

int calibrate(const CalibrateArguments& arguments) {
  const device::Certificate certificate = Calibration(arguments).measure();
  const fs::path path = arguments.certificate.empty()
                            ? fs::path(arguments.driver + "-certificate.json")
                            : arguments.certificate;
  replace_file(path, device::certificate_json(certificate));
  print(result_text(certificate, path));
  return certificate.passed() ? 0 : kNotPassed;
}

}  // namespace

void add_device_calibrate_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command = device.add_subcommand(
      "calibrate",
      "Weigh a device's force with hanging weights, axis by axis, and write a certificate");
  add_driver_argument(*command, "NAME", arguments->driver);
  add_settings_option(*command, arguments->settings);
  command->add_option("--certificate", arguments->certificate,
                      "Certificate to write (default: NAME-certificate.json)");
  command->callback([=, &action] { action = [=] { return calibrate(*arguments); }; });
}

}  // namespace touchtrial::app
