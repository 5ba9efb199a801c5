#include "device/drivers/registry.hpp"

#include "core/errors.hpp"
#include "core/nearest_name.hpp"
#include "device/drivers/drivers.hpp"
#include "device/servo/scaled_device.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::device {
namespace {

/// \return the driver's devices, or one entry with the reason why it cannot list them
std::vector<DeviceListing> listings_of(const DeviceDriver& driver, const DeviceSettings& settings) {
  try {
    return driver.list(settings);
  } catch (const Error& error) {
    return {{driver.name, "", "", "", false, {error.what()}}};
  }
}

/// \return settings with force limits converted to the driver's newtons, for drivers that pass them
///   on to the device. In no direction is the converted limit below the lab's.
DeviceSettings convert_force_limits(DeviceSettings settings, const std::string& driver) {
  DeviceUse& use = settings.uses[driver];
  const Vec3 force = use.scale.force;
  const double min_force_scale = std::min({force.x, force.y, force.z});
  if (use.limits.max_force_n) *use.limits.max_force_n /= min_force_scale;
  if (use.limits.continuous_force_n) *use.limits.continuous_force_n /= min_force_scale;
  return settings;
}

/// \return the products with a model, driver by driver
std::vector<DeviceProduct> modelled_products() {
  std::vector<DeviceProduct> all;
  for (const DeviceDriver& driver : device_drivers()) {
    std::ranges::copy_if(driver.products, std::back_inserter(all),
                         [](const DeviceProduct& product) { return !product.model.empty(); });
  }
  return all;
}

}  // namespace

std::vector<std::string_view> DeviceDriver::names() const {
  std::vector<std::string_view> all = {name};
  for (const DeviceProduct& product : products) {
    if (product.name != name) all.push_back(product.name);
  }
  return all;
}

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

std::vector<std::string_view> device_names() {
  std::vector<std::string_view> all;
  for (const DeviceDriver& driver : device_drivers()) {
    for (const std::string_view name : driver.names()) all.push_back(name);
  }
  return all;
}

const DeviceDriver& device_driver(const std::string& name) {
  for (const DeviceDriver& driver : device_drivers()) {
    const std::vector<std::string_view> names = driver.names();
    if (std::ranges::find(names, name) != names.end()) return driver;
  }
  const auto nearest = nearest_product(name, device_names());
  throw UsageError(one_line(
      name + ": there is no such device or driver; " +
      (nearest ? "did you mean " + std::string(*nearest) + "?" : "see touchtrial device list")));
}

std::vector<std::string> modelled_names() {
  std::vector<std::string> names;
  for (const DeviceModel& model : shipped_device_models()) names.push_back(model.name);
  for (const DeviceProduct& product : modelled_products()) {
    if (product.name != product.model) names.push_back(product.name);
  }
  return names;
}

DeviceModel model_of_device(const std::string& name) {
  for (const DeviceProduct& product : modelled_products()) {
    if (product.name == name) return device_model(product.model);
  }
  const bool is_file = name.find('/') != std::string::npos || name.ends_with(".json");
  const std::vector<std::string> names = modelled_names();
  if (is_file || std::ranges::find(names, name) != names.end()) return device_model(name);
  const std::vector<std::string_view> views(names.begin(), names.end());
  const auto nearest = nearest_product(name, views);
  throw UsageError(one_line(fmt::format(
      "{}: there is no model of such a device; {}give {}, or a file that ends in .json", name,
      nearest ? "did you mean " + std::string(*nearest) + "? " : "", fmt::join(names, ", "))));
}

const DeviceDriver* driver_of_model(std::string_view model) {
  for (const DeviceDriver& driver : device_drivers()) {
    const bool is_served = std::ranges::any_of(
        driver.products, [&](const DeviceProduct& product) { return product.model == model; });
    if (is_served && !model.empty()) return &driver;
  }
  return nullptr;
}

std::unique_ptr<HapticDevice> open_device(const std::string& driver,
                                          const DeviceSettings& settings) {
  const DeviceDriver& entry = device_driver(driver);
  const DeviceScale scale = settings.use_of(entry.name).scale;
  if (scale == DeviceScale{}) return entry.open(settings);
  return std::make_unique<ScaledDevice>(entry.open(convert_force_limits(settings, entry.name)),
                                        scale);
}

}  // namespace touchtrial::device
