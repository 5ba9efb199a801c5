#include "app/run/session_device.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/drivers/mouse/mouse_device.hpp"
#include "device/drivers/registry.hpp"
#include "device/model/workspace_fit.hpp"
#include "device/servo/servo_thread.hpp"
#include "study/deviation_codes.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <pwd.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

/// Whether a driver may be chosen automatically: those without a physical device may not.
bool has_hardware(const device::DeviceListing& listing) {
  return listing.present && listing.driver != device::kMouseDriver &&
         listing.driver != "simulated" && listing.driver != "replay";
}

std::string chosen_driver(const std::string& named, const device::DeviceSettings& settings) {
  if (!named.empty()) return device::device_driver(named).name;
  std::vector<std::string> found;
  for (const device::DeviceListing& listing : device::list_devices(settings)) {
    if (has_hardware(listing)) found.push_back(listing.driver);
  }
  if (found.size() == 1) return found.front();
  throw UsageError(found.empty()
                       ? "run: no haptic device is plugged in; see `touchtrial device list`, or "
                         "try the study with --device mouse --pilot"
                       : "run: several haptic devices are plugged in; choose one with --device");
}

/// The user name, as in the system's limits.
std::string name_of_user() {
  const passwd* const user = ::getpwuid(::geteuid());
  return user == nullptr ? "USER" : user->pw_name;
}

}  // namespace

std::optional<session::ExperimenterRequest> lateness_to_record(
    const device::DeviceInfo& device, const device::SchedulingObtained& scheduling,
    bool is_late_allowed) {
  const bool is_punctual = scheduling.policy == device::SchedulingPolicy::fifo;
  if (is_punctual || device.visual || device.simulated) return std::nullopt;
  const std::string why = device.name +
                          ": the servo has no real-time scheduling and is late, by up "
                          "to 54 ms beside other work";
  if (is_late_allowed) {
    return session::ExperimenterRequest{session::ExperimenterRequest::Kind::deviation,
                                        one_line(why + " (" + scheduling.reason + ")"),
                                        "no-real-time"};
  }
  const std::string user = name_of_user();
  throw DeviceError(one_line(
      why + "; put the two lines \"" + user + " - rtprio 99\" and \"" + user +
      " - memlock unlimited\" into /etc/security/limits.d/touchtrial.conf and log in again, "
      "or give --allow-late, which is recorded"));
}

session::Attendant::Reply SessionDevice::Consent::attend(const std::string& need) {
  if (need.empty()) return Reply::arm;
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return Reply::wait;
}

SessionDevice::SessionDevice(const RunOptions& options, const PlaneGeometry& plane,
                             session::Attendant& attendant)
    : settings_(device::device_settings_for(options.settings)),
      driver_(chosen_driver(options.device, settings_)) {
  settings_.simulated_on = options.on;
  first_ = open();
  first_->halt();
  info_ = first_->info();
  const auto placement = device::placement_of(plane, info_, settings_.use_of(driver_));
  check_certificate(options);
  if (info_.simulated) {
    const std::string what = "device 'simulated' is not a device: nothing is felt";
    spdlog::warn("{}, and the session does not count", what);
    to_record_.push_back({session::ExperimenterRequest::Kind::deviation, what, "simulated-device"});
  }
  if (const auto late =
          lateness_to_record(info_, device::ServoThread().scheduling(), options.allow_late)) {
    spdlog::warn("{}; the record says so", late->text);
    to_record_.push_back(*late);
  }
  station_.emplace([this] { return first_ ? std::move(first_) : open(); }, placement,
                   info_.visual ? static_cast<session::Attendant&>(consent_) : attendant);
}

std::unique_ptr<device::HapticDevice> SessionDevice::open() {
  if (driver_ == device::kMouseDriver)
    return std::make_unique<device::MouseDevice>(pointer_, pointer_clock_);
  return device::open_device(driver_, settings_);
}

device::LabLimits SessionDevice::limits() const {
  device::LabLimits limits = settings_.use_of(driver_).limits;
  const double scale = accepted_ ? accepted_->largest_scale() : 1.0;
  if (scale <= 1.0) return limits;
  const auto lower = [&](std::optional<double>& limit, double of_device) {
    const double max_n = std::min(limit.value_or(of_device), of_device);
    if (max_n > 0.0) limit = max_n / scale;
  };
  lower(limits.max_force_n, info_.max_force_n);
  if (info_.continuous_force_n > 0.0) lower(limits.continuous_force_n, info_.continuous_force_n);
  return limits;
}

void SessionDevice::require_stable_wall(double stiffness_n_per_mm) const {
  if (accepted_) device::require_stable(*accepted_, stiffness_n_per_mm);
}

std::string SessionDevice::shown_name() const {
  if (info_.simulated) return driver_ + ", does not count";
  return certificate_ == study::kUnverifiedDevice ? driver_ + " " + certificate_ : driver_;
}

/// \return the warning of a valid certificate, if any
/// \throws Error if there is none
std::string SessionDevice::read_accepted(const RunOptions& options) {
  const fs::path path =
      options.certificate.empty() ? fs::path(driver_ + "-certificate.json") : options.certificate;
  if (!is_there(path)) {
    throw DeviceError(one_line(fmt::format(
        "{}: has no certificate ({} is not there), and no session runs without; run touchtrial "
        "device accept {}, or name its certificate with --certificate, or stamp everything {} with "
        "--allow-unverified",
        driver_, path.string(), driver_, study::kUnverifiedDevice)));
  }
  const device::ReadCertificate read = device::read_certificate(path);
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  std::string warning = device::check_certificate(read.certificate, info_, now);
  accepted_ = read.certificate;
  certificate_ = to_hex(read.hash);
  return warning;
}

void SessionDevice::check_certificate(const RunOptions& options) {
  if (info_.visual || info_.simulated) return;
  using Kind = session::ExperimenterRequest::Kind;
  try {
    const std::string warning = read_accepted(options);
    if (warning.empty()) return;
    spdlog::warn("{}", warning);
    to_record_.push_back({Kind::deviation, warning, "no-certificate"});
  } catch (const Error& error) {
    if (!options.allow_unverified) throw;
    certificate_ = study::kUnverifiedDevice;
    spdlog::warn("{}: {}", certificate_, error.what());
    to_record_.push_back({Kind::deviation, error.what(), study::kUnverifiedDeviceCode});
  }
}

}  // namespace touchtrial::app
