#include "device/registry.hpp"

#include "core/errors.hpp"
#include "core/nearest_name.hpp"
#include "device/drivers.hpp"

#include <string_view>

namespace touchtrial::device {
namespace {

std::vector<std::string_view> driver_names() {
  std::vector<std::string_view> names;
  for (const DeviceDriver& driver : device_drivers()) names.push_back(driver.name);
  return names;
}

/// \return the driver's devices, or one entry that says why it cannot list them
std::vector<DeviceListing> listings_of(const DeviceDriver& driver, const DeviceSettings& settings) {
  try {
    return driver.list(settings);
  } catch (const Error& error) {
    return {{driver.name, "", "", "", false, {error.what()}}};
  }
}

}  // namespace

const std::vector<DeviceDriver>& device_drivers() {
  static const std::vector<DeviceDriver> kDrivers = all_drivers();
  return kDrivers;
}

std::vector<DeviceListing> list_devices(const DeviceSettings& settings) {
  std::vector<DeviceListing> all;
  for (const DeviceDriver& driver : device_drivers()) {
    for (DeviceListing& listing : listings_of(driver, settings)) all.push_back(std::move(listing));
  }
  return all;
}

const DeviceDriver& device_driver(const std::string& name) {
  for (const DeviceDriver& known : device_drivers()) {
    if (known.name == name) return known;
  }
  const auto nearest = nearest_name(name, driver_names());
  throw UsageError(one_line(
      name + ": there is no such device driver; " +
      (nearest ? "did you mean " + std::string(*nearest) + "?" : "see touchtrial device list")));
}

std::unique_ptr<HapticDevice> open_device(const std::string& driver,
                                          const DeviceSettings& settings) {
  return device_driver(driver).open(settings);
}

}  // namespace touchtrial::device
