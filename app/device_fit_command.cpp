// device fit: whether a study's plane and its stiffness fit the devices of a driver, even if none
// is at hand.
#include "analysis/planning/level_report.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/device_words.hpp"
#include "app/study_inputs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "device/acceptance/certificate.hpp"
#include "device/registry.hpp"
#include "device/scaled_device.hpp"
#include "device/workspace_fit.hpp"
#include "engine/image_file.hpp"
#include "protocols/design/study.hpp"

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
  maker,   ///< the maker's statement about all these devices; none was read
  device,  ///< the device that is plugged in
  none,    ///< the device reports positions on the plane, whatever its size
};

struct StudyFit {
  std::string study;
  std::string driver;
  PlaneGeometry plane;
  std::optional<device::Workspace> workspace;
  WorkspaceSource source = WorkspaceSource::none;
  device::WorkspaceFit fit;
  device::RenderedStiffness rendered;
  device::DeviceInfo limits;  ///< of the device that was read; if none was, the scale alone
};

const char* word_for(device::PlaneOrientation orientation) {
  return orientation == device::PlaneOrientation::horizontal ? "horizontal" : "vertical";
}

const char* word_for(WorkspaceSource source) {
  switch (source) {
    case WorkspaceSource::maker:
      return "maker";
    case WorkspaceSource::device:
      return "device";
    case WorkspaceSource::none:
      break;
  }
  return "none";
}

std::string workspace_text(const StudyFit& fit) {
  if (!fit.workspace) return "accepts any plane: it has no frame of its own\n";
  const Vec3 size = fit.workspace->greatest_mm - fit.workspace->least_mm;
  return fmt::format("workspace {:.1f} x {:.1f} x {:.1f} mm{}, {}\n", size.x, size.y, size.z,
                     fit.workspace->shape == device::WorkspaceShape::ellipsoid ? " (rounded)" : "",
                     fit.source == WorkspaceSource::device
                         ? "as the device reports"
                         : "as its maker states; no device was read");
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
  const bool rounded = fit.workspace->shape == device::WorkspaceShape::ellipsoid;
  return {{"from", word_for(fit.source)},
          {"shape", rounded ? "ellipsoid" : "box"},
          {"least_mm", vec_json(fit.workspace->least_mm)},
          {"greatest_mm", vec_json(fit.workspace->greatest_mm)}};
}

/// The part of the plane that all pictures of a study cover, as a session presents it.
/// \throws FileError if a picture cannot be read
PlaneGeometry common_plane_of(const design::Study& study) {
  PlaneGeometry plane{study.rendering.pitch_mm, 0, 0};
  for (const design::StudyClass& shown : study.classes) {
    for (const auto& image : shown.images) {
      const GreyImage picture = engine::read_grey_image(study.folder / image);
      const bool first = plane.height_px == 0;
      plane.height_px = first ? picture.height() : std::min(plane.height_px, picture.height());
      plane.width_px = first ? picture.width() : std::min(plane.width_px, picture.width());
    }
  }
  return plane;
}

/// \param orientation  nothing: as the settings say
/// \throws UsageError if there is no such driver
/// \throws DeviceError if only a device could tell its workspace and none can be opened
/// \throws FileError as common_plane_of
StudyFit fit_of(const design::Study& study, const std::string& driver,
                const device::DeviceSettings& settings,
                std::optional<device::PlaneOrientation> orientation) {
  const device::DeviceDriver& known = device::device_driver(driver);
  StudyFit fit;
  fit.study = study.name;
  fit.driver = driver;
  fit.limits.scale = settings.use_of(driver).scale;
  fit.workspace = known.nominal_workspace;
  if (fit.workspace) {
    fit.workspace = device::scaled(*fit.workspace, fit.limits.scale.length);
    fit.source = WorkspaceSource::maker;
  }
  if (!known.workspace_is_known) {
    fit.limits = device::open_device(driver, settings)->info();
    fit.workspace = fit.limits.workspace;
    fit.source = WorkspaceSource::device;
  }
  fit.rendered = rendered_stiffness(study.rendering);
  fit.plane = common_plane_of(study);
  fit.fit = device::fit_plane(fit.plane, fit.workspace, settings.use_of(driver), orientation);
  return fit;
}

/// Empty unless the device says what it renders.
std::string stiffness_text(const StudyFit& fit) {
  const std::string limits = device::rendering_limits_text(fit.limits);
  if (limits.empty()) return "";
  return fmt::format("stiffness {:g} N/mm of the wall, {:g} N/mm of the texture: {} {}\n",
                     fit.rendered.wall_n_per_mm, fit.rendered.texture_n_per_mm, fit.driver, limits);
}

std::string fit_text(const StudyFit& fit) {
  std::string text =
      fmt::format("{}: plane {:.1f} x {:.1f} mm ({} x {} px of {} mm)\n{}: ", fit.study,
                  fit.plane.width_mm(), fit.plane.height_mm(), fit.plane.width_px,
                  fit.plane.height_px, fit.plane.pitch_mm, fit.driver);
  text += workspace_text(fit) + stiffness_text(fit);
  if (!fit.fit.fits) return text;
  if (!fit.fit.placement) return text + "fits\n";
  const Vec3 origin = fit.fit.placement->origin_mm;
  return text + fmt::format(
                    "fits: {}, top-left corner at {:.1f}, {:.1f}, {:.1f} mm (right, up, "
                    "towards the person), {:.0f} mm around it\n",
                    word_for(fit.fit.placement->orientation), origin.x, origin.y, origin.z,
                    device::kWorkspaceMarginMm);
}

/// \param limit  0: not known
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
std::string fit_json(const design::Study& study, const StudyFit& fit,
                     const std::optional<simulation::StimulusLevels>& levels) {
  ordered_json object = {{"study", fit.study},
                         {"driver", fit.driver},
                         {"fits", fit.fit.fits},
                         {"margin_mm", device::kWorkspaceMarginMm},
                         {"plane", plane_json(fit.plane)},
                         {"workspace", workspace_json(fit)},
                         {"stiffness", stiffness_json(fit)},
                         {"orientation", nullptr},
                         {"origin_mm", nullptr},
                         {"crop", nullptr}};
  if (fit.fit.placement) {
    object["orientation"] = word_for(fit.fit.placement->orientation);
    object["origin_mm"] = vec_json(fit.fit.placement->origin_mm);
  }
  if (!fit.fit.fits && fit.fit.largest.width_px > 0) object["crop"] = plane_json(fit.fit.largest);
  object["levels"] = nullptr;
  if (levels) object["levels"] = ordered_json::parse(planning::all_levels_json(study, *levels));
  return json_text(object);
}

struct DeviceFitArguments {
  fs::path study;
  std::string driver;
  std::optional<device::PlaneOrientation> orientation;
  fs::path settings;
  fs::path certificate;  ///< empty: NAME-certificate.json, if it is there
  bool json = false;
};

/// \throws DeviceError if no session would take the certificate, as far as can be said without the
///   device, or the study's wall is as stiff as one that oscillated
void check_with_certificate(const fs::path& file, const design::Study& study, const StudyFit& fit) {
  const device::Certificate certificate = device::read_certificate(file).certificate;
  device::DeviceInfo info = fit.limits;
  if (fit.source != WorkspaceSource::device) {
    // No device was read, so that it can be any of this driver's.
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

/// How strong the stimuli are, if the study is prepared here with a key that anybody may read.
std::optional<simulation::StimulusLevels> levels_here(const design::Study& study,
                                                      const fs::path& file) {
  const std::optional<design::StudyKey> key = open_key_of(study, file);
  if (!key) return std::nullopt;
  return levels_of_pack(*key);
}

void print_levels(const design::Study& study,
                  const std::optional<simulation::StimulusLevels>& levels) {
  if (!levels) {
    print("levels of the stimuli: run touchtrial prepare, whose key and pack they need\n");
    return;
  }
  analysis::Document document;
  document.sections.push_back(planning::levels_section(study, *levels));
  print(analysis::document_text(document, columns_of_output()));
}

int fit(const DeviceFitArguments& arguments) {
  const device::DeviceSettings settings = device::device_settings_for(arguments.settings);
  const design::Study study = design::load_study(arguments.study);
  const StudyFit fit = fit_of(study, arguments.driver, settings, arguments.orientation);
  const auto levels = levels_here(study, arguments.study);
  print(arguments.json ? fit_json(study, fit, levels) : fit_text(fit));
  if (!fit.fit.fits) {
    throw DeviceError(device::misfit_text(arguments.driver, fit.plane, *fit.workspace, fit.fit));
  }
  const fs::path usual = arguments.driver + "-certificate.json";
  if (!arguments.certificate.empty() || is_there(usual)) {
    check_with_certificate(arguments.certificate.empty() ? usual : arguments.certificate, study,
                           fit);
  }
  if (!arguments.json) print_levels(study, levels);
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
  CLI::App* command = device.add_subcommand(
      "fit",
      "Check whether a study's plane fits a device's workspace, and its stiffness the device's "
      "limits; if the plane does not, give the crop that does");
  add_study_argument(*command, arguments->study);
  add_driver_argument(*command, "--device", arguments->driver)->required();
  command
      ->add_option_function<std::string>(
          "--orientation",
          [=](const std::string& word) { arguments->orientation = orientations.at(word); },
          "horizontal (a table) or vertical (a wall); default: that of the device settings, else "
          "horizontal")
      ->check(CLI::IsMember({"horizontal", "vertical"}));
  add_settings_option(*command, arguments->settings);
  command->add_option("--certificate", arguments->certificate,
                      "Certificate whose stiffest wall the study must keep to (default: "
                      "NAME-certificate.json, if it is there)");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return fit(*arguments); }; });
}

}  // namespace touchtrial::app
