/// \file The registry of drivers: lists connected devices and their problems, and opens devices.
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

/// One connected device, or a driver that found none.
struct DeviceListing {
  std::string driver;  ///< name that opens it
  std::string model;   ///< "Novint Falcon"; empty if there is no device
  std::string serial;
  std::string where;  ///< bus and address, or the library's path
  bool present = false;
  /// Problems that prevent its use (permission, firmware, library), one line each with the remedy;
  /// empty: `open_device` will open it.
  std::vector<std::string> missing;
  /// Properties of the device that matter to a study, one line each.
  std::vector<std::string> notes{};
};

/// A product, or a line of products, that a driver serves.
struct DeviceProduct {
  std::string name;   ///< also opens its driver, for instance "omega"
  std::string title;  ///< full name, for instance "Force Dimension omega"
  /// Name of the built-in model to use without the device; empty: none.
  std::string model{};
};

/// One driver's entry in the registry.
struct DeviceDriver {
  std::string name;
  std::string what;  ///< one line that describes the driver in help texts
  std::function<std::vector<DeviceListing>(const DeviceSettings&)> list;
  std::function<std::unique_ptr<HapticDevice>(const DeviceSettings&)> open;
  /// The maker's nominal workspace, for planning without a device. Nothing: any plane fits, as for
  /// a DeviceInfo without workspace, unless `workspace_is_known` is false.
  std::optional<Workspace> nominal_workspace = std::nullopt;
  /// False if models differ and the workspace can only be read from the device.
  bool workspace_is_known = true;
  /// Homes the device, which moves by itself; call it only at the request of a person who keeps
  /// clear of it. Returns the result, for instance "is initialised". Throws DeviceError with the
  /// remedy. Null: a person homes the device, see HapticDevice::readiness.
  std::function<std::string(const DeviceSettings&)> initialise = nullptr;
  /// Their names also open the driver; one may equal the driver's name.
  std::vector<DeviceProduct> products{};
  /// Facts not verified on a real device; empty for drivers without hardware.
  std::vector<UnverifiedFact> unverified{};

  /// \return the names for commands and settings: the driver's, then its products'
  [[nodiscard]] std::vector<std::string_view> names() const;
};

/// \return all drivers, in the order in which the program lists them
[[nodiscard]] const std::vector<DeviceDriver>& device_drivers();

/// \return connected devices, and the problems of each driver; an Error of a driver becomes a line
///   of its listing
[[nodiscard]] std::vector<DeviceListing> list_devices(const DeviceSettings& settings);

/// \return every name that model_of_device accepts: models, then products with a model
[[nodiscard]] std::vector<std::string> modelled_names();

/// \return the model of a device, for simulations, levels and planning
/// \param name  of a shipped model, of a product with a model, or a model's file: a path that has a
///   slash or ends in ".json"
/// \throws UsageError with the nearest and all known names if the name is unknown; as
///   read_device_model
[[nodiscard]] DeviceModel model_of_device(const std::string& name);

/// \return the driver of the modelled device; null: no driver serves it
/// \param model  name of a model
[[nodiscard]] const DeviceDriver* driver_of_model(std::string_view model);

/// \return every name that device_driver accepts, driver by driver
[[nodiscard]] std::vector<std::string_view> device_names();

/// \param name  of a driver or of a product
/// \throws UsageError with the nearest name if the name is unknown
[[nodiscard]] const DeviceDriver& device_driver(const std::string& name);

/// Opens the driver's device, corrected by DeviceUse::scale of the settings.
/// \throws UsageError as device_driver; DeviceError with the remedy if the device cannot be opened,
///   or FileError if a file that it needs cannot
[[nodiscard]] std::unique_ptr<HapticDevice> open_device(const std::string& driver,
                                                        const DeviceSettings& settings);

}  // namespace touchtrial::device
