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

std::string choose_driver(const std::string& requested, const device::DeviceSettings& settings) {
  if (!requested.empty()) return device::device_driver(requested).name;
  std::vector<std::string> connected;
  for (const device::DeviceListing& listing : device::list_devices(settings)) {
    if (has_hardware(listing)) connected.push_back(listing.driver);
  }
  if (connected.size() == 1) return connected.front();
  throw UsageError(connected.empty()
                       ? "run: no haptic device is plugged in; see `touchtrial device list`, or "
                         "try the study with --device mouse --pilot"
                       : "run: several haptic devices are plugged in; choose one with --device");
}

/// The user name for the lines in the system's limits file.
std::string name_of_user() {
  const passwd* const user = ::getpwuid(::geteuid());
  return user == nullptr ? "USER" : user->pw_name;
}

}  // namespace

std::optional<session::ExperimenterRequest> lateness_entry(
    const device::DeviceInfo& device, const device::SchedulingObtained& scheduling,
    bool is_late_allowed) {
  const bool is_punctual = scheduling.policy == device::SchedulingPolicy::fifo;
  if (is_punctual || device.visual || device.simulated) return std::nullopt;
  const std::string warning = device.name +
                              ": the servo has no real-time scheduling and runs late, by up "
                              "to 54 ms under load";
  if (is_late_allowed) {
    return session::ExperimenterRequest{session::ExperimenterRequest::Kind::deviation,
                                        one_line(warning + " (" + scheduling.reason + ")"),
                                        "no-real-time"};
  }
  const std::string user = name_of_user();
  throw DeviceError(one_line(
      warning + "; put the two lines \"" + user + " - rtprio 99\" and \"" + user +
      " - memlock unlimited\" into /etc/security/limits.d/touchtrial.conf and log in again, "
      "or give --allow-late, which is recorded"));
}

session::Attendant::Reply SessionDevice::Consent::poll(const std::string& need) {
  if (need.empty()) return Reply::arm;
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return Reply::wait;
}

SessionDevice::SessionDevice(const RunOptions& options, const PlaneGeometry& plane,
                             session::Attendant& attendant)
    : settings_(device::load_device_settings(options.settings)),
      driver_(choose_driver(options.device, settings_)) {
  settings_.simulated_device = options.hand_device;
  opened_device_ = open();
  opened_device_->halt();
  info_ = opened_device_->info();
  const auto placement = device::placement_of(plane, info_, settings_.use_of(driver_));
  check_certificate(options);
  if (info_.simulated) {
    const std::string message = "device 'simulated' is not a device: nothing is felt";
    spdlog::warn("{}, and the session does not count", message);
    record_entries_.push_back(
        {session::ExperimenterRequest::Kind::deviation, message, "simulated-device"});
  }
  if (const auto entry =
          lateness_entry(info_, device::ServoThread().scheduling(), options.allow_late)) {
    spdlog::warn("{}; this is recorded", entry->text);
    record_entries_.push_back(*entry);
  }
  station_.emplace([this] { return opened_device_ ? std::move(opened_device_) : open(); },
                   placement,
                   info_.visual ? static_cast<session::Attendant&>(consent_) : attendant);
}

std::unique_ptr<device::HapticDevice> SessionDevice::open() {
  if (driver_ == device::kMouseDriver)
    return std::make_unique<device::MouseDevice>(pointer_, pointer_clock_);
  return device::open_device(driver_, settings_);
}

device::LabLimits SessionDevice::limits() const {
  device::LabLimits limits = settings_.use_of(driver_).limits;
  const double scale = acceptance_ ? acceptance_->largest_scale() : 1.0;
  if (scale <= 1.0) return limits;
  const auto lower_limit = [&](std::optional<double>& limit, double device_limit) {
    const double max_n = std::min(limit.value_or(device_limit), device_limit);
    if (max_n > 0.0) limit = max_n / scale;
  };
  lower_limit(limits.max_force_n, info_.max_force_n);
  if (info_.continuous_force_n > 0.0)
    lower_limit(limits.continuous_force_n, info_.continuous_force_n);
  return limits;
}

void SessionDevice::require_stable_wall(double stiffness_n_per_mm) const {
  if (acceptance_) device::require_stable(*acceptance_, stiffness_n_per_mm);
}

std::string SessionDevice::display_name() const {
  if (info_.simulated) return driver_ + ", does not count";
  return certificate_ == study::kUnverifiedDevice ? driver_ + " " + certificate_ : driver_;
}

/// \return the warning of a valid certificate, if any
/// \throws Error if there is no valid certificate
std::string SessionDevice::load_certificate(const RunOptions& options) {
  const fs::path path =
      options.certificate.empty() ? fs::path(driver_ + "-certificate.json") : options.certificate;
  if (!path_exists(path)) {
    throw DeviceError(one_line(fmt::format(
        "{}: sessions require a certificate, and {} does not exist; run touchtrial device accept "
        "{}, name the certificate with --certificate, or give --allow-unverified, which marks all "
        "data as {}",
        driver_, path.string(), driver_, study::kUnverifiedDevice)));
  }
  const device::HashedCertificate certificate_file = device::read_certificate(path);
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  std::string warning = device::check_certificate(certificate_file.certificate, info_, now);
  acceptance_ = certificate_file.certificate;
  certificate_ = to_hex(certificate_file.hash);
  return warning;
}

void SessionDevice::check_certificate(const RunOptions& options) {
  if (info_.visual || info_.simulated) return;
  using Kind = session::ExperimenterRequest::Kind;
  try {
    const std::string warning = load_certificate(options);
    if (warning.empty()) return;
    spdlog::warn("{}", warning);
    record_entries_.push_back({Kind::deviation, warning, "no-certificate"});
  } catch (const Error& error) {
    if (!options.allow_unverified) throw;
    certificate_ = study::kUnverifiedDevice;
    spdlog::warn("{}: {}", certificate_, error.what());
    record_entries_.push_back({Kind::deviation, error.what(), study::kUnverifiedDeviceCode});
  }
}

}  // namespace touchtrial::app
