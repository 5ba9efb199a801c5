#include "app/run/session_device.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/calibration/certificate.hpp"
#include "device/mouse/mouse_device.hpp"
#include "device/registry.hpp"
#include "device/workspace_fit.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

/// Whether a driver may be chosen automatically: those without a physical device may not.
bool is_a_rig(const device::DeviceListing& listing) {
  return listing.present && listing.driver != device::kMouseDriver &&
         listing.driver != "simulated" && listing.driver != "replay";
}

std::string chosen_driver(const std::string& named, const device::DeviceSettings& settings) {
  if (!named.empty()) return device::device_driver(named).name;
  std::vector<std::string> found;
  for (const device::DeviceListing& listing : device::list_devices(settings)) {
    if (is_a_rig(listing)) found.push_back(listing.driver);
  }
  if (found.size() == 1) return found.front();
  throw UsageError(found.empty()
                       ? "run: no haptic device is plugged in; see `touchtrial device list`, or "
                         "try the study with --device mouse --pilot"
                       : "run: several haptic devices are plugged in; choose one with --device");
}

}  // namespace

session::Attendant::Says SessionDevice::Consent::attend(const std::string& need) {
  if (need.empty()) return Says::arm;
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return Says::wait;
}

SessionDevice::SessionDevice(const RunOptions& options, const PlaneGeometry& plane,
                             session::Attendant& attendant)
    : settings_(device::device_settings_for(options.settings)),
      driver_(chosen_driver(options.device, settings_)) {
  first_ = open();
  first_->halt();
  info_ = first_->info();
  const auto placement = device::placement_of(plane, info_, settings_.use_of(driver_));
  check_certificate(options);
  station_.emplace([this] { return first_ ? std::move(first_) : open(); }, placement,
                   info_.visual ? static_cast<session::Attendant&>(consent_) : attendant);
}

std::unique_ptr<device::HapticDevice> SessionDevice::open() {
  if (driver_ == device::kMouseDriver)
    return std::make_unique<device::MouseDevice>(pointer_, pointer_clock_);
  return device::open_device(driver_, settings_);
}

void SessionDevice::check_certificate(const RunOptions& options) {
  if (info_.visual || info_.simulated) return;
  using Kind = session::ExperimenterRequest::Kind;
  const fs::path usual = driver_ + "-certificate.json";
  const fs::path path = options.certificate.empty() ? usual : options.certificate;
  if (options.certificate.empty() && !is_there(usual)) {
    spdlog::warn(
        "{}: no calibration certificate; run `touchtrial device calibrate {}`, or name one with "
        "--certificate",
        driver_, driver_);
    to_record_.push_back({Kind::deviation, "none was given", "no-certificate"});
    return;
  }
  const device::ReadCertificate read = device::read_certificate(path);
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const std::string warning = device::check_certificate(read.certificate, info_, now);
  certificate_ = to_hex(read.hash);
  if (warning.empty()) return;
  spdlog::warn("{}", warning);
  to_record_.push_back({Kind::deviation, warning, "no-certificate"});
}

}  // namespace touchtrial::app
