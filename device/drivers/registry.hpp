/// \file The drivers by name: which devices are plugged in, what they lack, and how to open them.
#pragma once

#include "device/device_settings.hpp"
#include "device/drivers/unverified_fact.hpp"
#include "device/haptic_device.hpp"
#include "device/model/device_model.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::device {

/// One device that is plugged in, or a driver that found none.
struct DeviceListing {
  std::string driver;  ///< the name that opens it
  std::string model;   ///< "Novint Falcon"; empty if there is no device
  std::string serial;
  std::string where;  ///< bus and address, or the library's path
  bool present = false;
  /// What keeps it from use (permission, firmware, library), a line each with its remedy; empty:
  /// `open_device` will open it.
  std::vector<std::string> missing;
  /// What a study has to know of the device, a line each.
  std::vector<std::string> notes{};
};

/// A product, or a line of products, that a driver serves.
struct DeviceProduct {
  std::string name;   ///< that opens its driver too, for instance "omega"
  std::string title;  ///< for people, "Force Dimension omega"
  /// Name of the shipped model that stands for it where no device is at hand; empty: none does.
  std::string model{};
};

/// What one driver offers the registry.
struct DeviceDriver {
  std::string name;
  std::string what;  ///< a line for help
  std::function<std::vector<DeviceListing>(const DeviceSettings&)> list;
  std::function<std::unique_ptr<HapticDevice>(const DeviceSettings&)> open;
  /// The workspace as the maker states it, for planning without a device. Nothing: any plane, as
  /// for a DeviceInfo without one, unless `workspace_is_known` is false.
  std::optional<Workspace> nominal_workspace = std::nullopt;
  /// False if models differ and only the device itself knows its workspace.
  bool workspace_is_known = true;
  /// Lets the device find its axes by moving itself, which only a person may ask for who keeps
  /// clear of it; returns what it did, for instance "is initialised". Throws DeviceError with the
  /// remedy. Null: a person moves the device, see HapticDevice::readiness.
  std::function<std::string(const DeviceSettings&)> initialise = nullptr;
  /// Under whose names it opens as well; one may have the driver's own name.
  std::vector<DeviceProduct> products{};
  /// What nobody has checked on a real device; empty for what has no hardware.
  std::vector<UnverifiedFact> unverified{};

  /// Its name, then those of its products: each opens it, in commands and in settings.
  [[nodiscard]] std::vector<std::string_view> names() const;
};

/// \return all drivers, in the order in which the program lists them
[[nodiscard]] const std::vector<DeviceDriver>& device_drivers();

/// \return what is plugged in, and what each driver lacks; a driver's DeviceError or other Error
///   becomes a line of its listing
[[nodiscard]] std::vector<DeviceListing> list_devices(const DeviceSettings& settings);

/// \return every name that model_of_device knows: those of models, then of products with a model
[[nodiscard]] std::vector<std::string> modelled_names();

/// \return the model of a device that is not at hand: for simulations, levels and planning
/// \param name  of a shipped model, of a product with a model, or a model's file: a path that has a
///   slash or ends in ".json"
/// \throws UsageError naming the nearest and listing what is known if there is none of this name; as
///   read_device_model
[[nodiscard]] DeviceModel model_of_device(const std::string& name);

/// \return the driver of the device that a model stands for; null: of none that a driver serves
/// \param model  name of a model
[[nodiscard]] const DeviceDriver* driver_of_model(std::string_view model);

/// \return every name that device_driver knows, driver by driver
[[nodiscard]] std::vector<std::string_view> device_names();

/// \param name  of a driver or of a product
/// \throws UsageError naming the nearest if there is none of this name
[[nodiscard]] const DeviceDriver& device_driver(const std::string& name);

/// Opens the driver's device, and corrects it by the DeviceUse::scale of the settings.
/// \throws UsageError as device_driver; DeviceError, or
///   FileError for a file that it needs, with the remedy if it cannot be opened
[[nodiscard]] std::unique_ptr<HapticDevice> open_device(const std::string& driver,
                                                        const DeviceSettings& settings);

}  // namespace touchtrial::device
