// device fit: checks whether a study's plane and stiffness fit a device, even if not connected.
#include "app/commands/commands.hpp"
#include "app/commands/device_words.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/acceptance/certificate.hpp"
#include "device/drivers/registry.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "device/model/workspace_fit.hpp"
#include "device/servo/scaled_device.hpp"
#include "engine/image_file.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

/// The origin of a workspace.
enum class WorkspaceSource {
  maker,   ///< the manufacturer's data; no device was read
  model,   ///< a device model; no device was read
  device,  ///< the connected device
  none,    ///< the device reports positions on a plane of any size
};

struct StudyFit {
  std::string study;
  std::string device;                ///< as named by the user
  std::string driver;                ///< empty: a model without a driver
  std::optional<std::string> model;  ///< used in place of the device
  PlaneGeometry plane;
  std::optional<device::Workspace> workspace;
  WorkspaceSource source = WorkspaceSource::none;
  device::WorkspaceFit result;
  device::RenderedStiffness rendered;
  /// Limits of the device or its model; if neither is known, only the scale is set.
  device::DeviceInfo limits;
};

const char* word_for(device::PlaneOrientation orientation) {
  return orientation == device::PlaneOrientation::horizontal ? "horizontal" : "vertical";
}

const char* word_for(WorkspaceSource source) {
  switch (source) {
    case WorkspaceSource::maker:
      return "maker";
    case WorkspaceSource::model:
      return "model";
    case WorkspaceSource::device:
      return "device";
    case WorkspaceSource::none:
      break;
  }
  return "none";
}

std::string source_words(const StudyFit& fit) {
  if (fit.source == WorkspaceSource::device) return "as the device reports";
  if (fit.source == WorkspaceSource::maker) return "as stated by its maker; no device was read";
  return "of the device model " + fit.model.value_or("") + "; no device was read";
}

std::string workspace_text(const StudyFit& fit) {
  if (!fit.workspace && fit.model) {
    return "not compared with a frame: the device model " + *fit.model +
           " has no workspace; connect the device, or give a model file with a workspace\n";
  }
  if (!fit.workspace) return "accepts any plane: it has no frame of its own\n";
  const Vec3 size = fit.workspace->max_mm - fit.workspace->min_mm;
  return fmt::format("workspace {:.1f} x {:.1f} x {:.1f} mm{}, {}\n", size.x, size.y, size.z,
                     fit.workspace->shape == device::WorkspaceShape::ellipsoid ? " (rounded)" : "",
                     source_words(fit));
}

ordered_json vec_json(Vec3 v) {
  return ordered_json::array({v.x, v.y, v.z});
}

ordered_json plane_json(const PlaneGeometry& plane) {
  return {{"width_px", plane.width_px},
          {"height_px", plane.height_px},
          {"width_mm", plane.width_mm()},
          {"height_mm", plane.height_mm()},
          {"pitch_mm", plane.pitch_mm}};
}

ordered_json workspace_json(const StudyFit& fit) {
  if (!fit.workspace) return nullptr;
  const bool is_rounded = fit.workspace->shape == device::WorkspaceShape::ellipsoid;
  return {{"from", word_for(fit.source)},
          {"shape", is_rounded ? "ellipsoid" : "box"},
          {"least_mm", vec_json(fit.workspace->min_mm)},
          {"greatest_mm", vec_json(fit.workspace->max_mm)}};
}

/// The part of the plane covered by all pictures of a study, as in a session.
/// \throws FileError if a picture cannot be read
PlaneGeometry common_plane_of(const study::Study& study) {
  PlaneGeometry plane{study.rendering.pitch_mm, 0, 0};
  for (const study::StudyClass& texture_class : study.classes) {
    for (const auto& image : texture_class.images) {
      const GreyImage picture = engine::read_grey_image(study.folder / image);
      const bool is_first = plane.height_px == 0;
      plane.height_px = is_first ? picture.height() : std::min(plane.height_px, picture.height());
      plane.width_px = is_first ? picture.width() : std::min(plane.width_px, picture.width());
    }
  }
  return plane;
}

/// The device that the user or the study names.
struct NamedDevice {
  std::string name;
  const device::DeviceDriver* driver = nullptr;  ///< null: it has no driver
  std::optional<device::DeviceModel> model;      ///< used if no device is read
  bool may_open = true;  ///< whether the device may be opened to read its values
};

/// \throws UsageError as device::model_of_device
NamedDevice device_named(const std::string& name) {
  NamedDevice named_device{.name = name, .driver = nullptr, .model = {}};
  for (const device::DeviceDriver& driver : device::device_drivers()) {
    if (driver.name == name) named_device.driver = &driver;
    for (const device::DeviceProduct& product : driver.products) {
      if (product.name != name) continue;
      named_device.driver = &driver;
      if (!product.model.empty()) named_device.model = device::device_model(product.model);
    }
  }
  if (named_device.driver == nullptr) named_device.model = device::model_of_device(name);
  return named_device;
}

/// \throws UsageError if neither the command nor the study names a device; as device_named
/// \throws StudyError as simulation::device_of
NamedDevice device_to_fit(const std::string& requested_name, const study::Study& study) {
  if (!requested_name.empty()) return device_named(requested_name);
  if (study.device.empty()) {
    throw UsageError(
        one_line(study.source + ": names no device; give --device, or set /rendering/device"));
  }
  const device::DeviceModel model = simulation::device_of(study);
  return {study.device, device::driver_of_model(model.name), model, false};
}

/// Fills in the workspace and the limits from the model.
void fill_from_model(const device::DeviceModel& model, StudyFit& fit) {
  fit.model = model.name;
  fit.limits.max_stiffness_n_per_mm = model.max_stiffness_n_per_mm;
  if (!model.workspace) return;
  fit.workspace = device::scaled(*model.workspace, fit.limits.scale.length);
  fit.source = WorkspaceSource::model;
}

/// Fills in the workspace and the limits of the device.
/// \throws DeviceError if the values can only be read from the device and it cannot be opened
void fill_device(const NamedDevice& named_device, const device::DeviceSettings& settings,
                 StudyFit& fit) {
  if (named_device.driver == nullptr || !named_device.may_open)
    return fill_from_model(*named_device.model, fit);
  if (named_device.driver->workspace_is_known) {
    if (!named_device.driver->nominal_workspace) return;
    fit.workspace =
        device::scaled(*named_device.driver->nominal_workspace, fit.limits.scale.length);
    fit.source = WorkspaceSource::maker;
    return;
  }
  try {
    fit.limits = device::open_device(fit.driver, settings)->info();
    fit.workspace = fit.limits.workspace;
    fit.source = WorkspaceSource::device;
  } catch (const DeviceError&) {
    if (!named_device.model) throw;
    fill_from_model(*named_device.model, fit);
  }
}

/// \param orientation  empty: as in the settings
/// \throws DeviceError as fill_device
/// \throws FileError as common_plane_of
StudyFit fit_of(const study::Study& study, const NamedDevice& named_device,
                const device::DeviceSettings& settings,
                std::optional<device::PlaneOrientation> orientation) {
  StudyFit fit;
  fit.study = study.name;
  fit.device = named_device.name;
  fit.driver = named_device.driver != nullptr ? named_device.driver->name : "";
  const device::DeviceUse use = settings.use_of(fit.driver);
  fit.limits.name = named_device.name;
  fit.limits.scale = use.scale;
  fill_device(named_device, settings, fit);
  fit.rendered = rendered_stiffness(study.rendering);
  fit.plane = common_plane_of(study);
  fit.result = device::fit_plane(fit.plane, fit.workspace, use, orientation);
  return fit;
}

/// Empty unless the device states its stiffness limit.
std::string stiffness_text(const StudyFit& fit) {
  const std::string limits = device::rendering_limits_text(fit.limits);
  if (limits.empty()) return "";
  return fmt::format("stiffness {:g} N/mm of the wall, {:g} N/mm of the texture: {} {}, {}\n",
                     fit.rendered.wall_n_per_mm, fit.rendered.texture_n_per_mm, fit.device, limits,
                     fit.model ? "by its device model" : "as it reports");
}

std::string fit_text(const StudyFit& fit) {
  std::string text =
      fmt::format("{}: plane {:.1f} x {:.1f} mm ({} x {} px of {} mm)\n{}: ", fit.study,
                  fit.plane.width_mm(), fit.plane.height_mm(), fit.plane.width_px,
                  fit.plane.height_px, fit.plane.pitch_mm, fit.device);
  text += workspace_text(fit) + stiffness_text(fit);
  if (!fit.result.fits) return text;
  if (!fit.workspace && fit.model) return text;
  if (!fit.result.placement) return text + "fits\n";
  const Vec3 origin = fit.result.placement->origin_mm;
  return text + fmt::format(
                    "fits: {}, top-left corner at {:.1f}, {:.1f}, {:.1f} mm (right, up, "
                    "towards the person), {:.0f} mm around it\n",
                    word_for(fit.result.placement->orientation), origin.x, origin.y, origin.z,
                    device::kWorkspaceMarginMm);
}

/// \param limit  0: unknown
ordered_json limit_json(double limit) {
  return limit > 0.0 ? ordered_json(limit) : ordered_json(nullptr);
}

ordered_json stiffness_json(const StudyFit& fit) {
  return {{"wall_n_per_mm", fit.rendered.wall_n_per_mm},
          {"texture_n_per_mm", fit.rendered.texture_n_per_mm},
          {"damping_n_s_per_mm", fit.rendered.damping_n_s_per_mm},
          {"limit_n_per_mm", limit_json(fit.limits.max_stiffness_n_per_mm)},
          {"damping_limit_n_s_per_mm", limit_json(fit.limits.max_damping_n_s_per_mm)}};
}

/// The format is documented in docs/devices/README.md.
std::string fit_json(const StudyFit& fit) {
  ordered_json object = {{"study", fit.study},
                         {"device", fit.device},
                         {"driver", fit.driver},
                         {"model", fit.model ? ordered_json(*fit.model) : ordered_json(nullptr)},
                         {"fits", fit.result.fits},
                         {"margin_mm", device::kWorkspaceMarginMm},
                         {"plane", plane_json(fit.plane)},
                         {"workspace", workspace_json(fit)},
                         {"stiffness", stiffness_json(fit)},
                         {"orientation", nullptr},
                         {"origin_mm", nullptr},
                         {"crop", nullptr}};
  if (fit.result.placement) {
    object["orientation"] = word_for(fit.result.placement->orientation);
    object["origin_mm"] = vec_json(fit.result.placement->origin_mm);
  }
  if (!fit.result.fits && fit.result.largest.width_px > 0)
    object["crop"] = plane_json(fit.result.largest);
  return json_text(object);
}

struct DeviceFitArguments {
  fs::path study;
  std::string device;  ///< empty: the study's
  std::optional<device::PlaneOrientation> orientation;
  fs::path settings;
  fs::path certificate;  ///< empty: NAME-certificate.json, if it exists
  bool json = false;
};

/// \throws DeviceError if sessions would reject the certificate, as far as is known without the
///   device, or the study's wall is as stiff as one that oscillated
void check_with_certificate(const fs::path& file, const study::Study& study, const StudyFit& fit) {
  const device::Certificate certificate = device::read_certificate(file).certificate;
  device::DeviceInfo info = fit.limits;
  if (fit.source != WorkspaceSource::device) {
    // No device was read, so any device of this driver is possible.
    info.name = fit.driver;
    info.model = certificate.model;
    info.serial = certificate.serial;
    info.firmware = certificate.firmware;
  }
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const std::string warning = device::check_certificate(certificate, info, now);
  if (!warning.empty()) spdlog::warn("{}", warning);
  device::require_stable(certificate, study.rendering.stiffness_n_per_mm);
}

int check_fit(const DeviceFitArguments& arguments) {
  const device::DeviceSettings settings = device::load_device_settings(arguments.settings);
  const study::Study study = study::load_study(arguments.study);
  const NamedDevice named_device = device_to_fit(arguments.device, study);
  const StudyFit fit = fit_of(study, named_device, settings, arguments.orientation);
  print(arguments.json ? fit_json(fit) : fit_text(fit));
  if (!fit.result.fits) {
    throw DeviceError(device::misfit_text(fit.device, fit.plane, *fit.workspace, fit.result));
  }
  const fs::path default_file = fit.driver + "-certificate.json";
  const bool has_default = !fit.driver.empty() && path_exists(default_file);
  if (!arguments.certificate.empty() || has_default) {
    check_with_certificate(arguments.certificate.empty() ? default_file : arguments.certificate,
                           study, fit);
  }
  const std::string warning = device::check_stiffness(fit.rendered, fit.limits);
  if (!warning.empty()) spdlog::warn("{}", warning);
  return 0;
}

}  // namespace

void add_device_fit_command(CLI::App& device, Action& action) {
  const std::map<std::string, device::PlaneOrientation> orientations = {
      {"horizontal", device::PlaneOrientation::horizontal},
      {"vertical", device::PlaneOrientation::vertical}};
  auto arguments = std::make_shared<DeviceFitArguments>();
  CLI::App* command =
      device.add_subcommand("fit",
                            "Check whether a study's plane and stiffness fit a device's workspace "
                            "and limits; if the plane is too large, print the crop that fits");
  add_study_argument(*command, arguments->study);
  command
      ->add_option("--device", arguments->device,
                   "Driver, product or device model from touchtrial device list and device models, "
                   "or a model's file (default: the study's). The model stands in for a product "
                   "that cannot be opened")
      ->type_name("NAME");
  command
      ->add_option_function<std::string>(
          "--orientation",
          [=](const std::string& word) { arguments->orientation = orientations.at(word); },
          "horizontal (a table) or vertical (a wall); default: the device settings', or "
          "horizontal")
      ->check(CLI::IsMember({"horizontal", "vertical"}));
  add_settings_option(*command, arguments->settings);
  command->add_option("--certificate", arguments->certificate,
                      "Certificate whose stiffest wall limits the study (default: "
                      "NAME-certificate.json, if it exists)");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return check_fit(*arguments); }; });
}

}  // namespace touchtrial::app
