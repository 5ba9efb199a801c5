#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/device_fit/study_fit.hpp"
#include "core/errors.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct DeviceFitArguments {
  fs::path study;
  std::string driver;
  std::optional<device::PlaneOrientation> orientation;
  fs::path settings;
  bool json = false;
};

int fit(const DeviceFitArguments& arguments) {
  const device::DeviceSettings settings = device::device_settings_for(arguments.settings);
  const design::Study study = design::load_study(arguments.study);
  const StudyFit fit = fit_study(study, arguments.driver, settings, arguments.orientation);
  print(arguments.json ? fit_json(fit) : fit_text(fit));
  if (!fit.fit.fits) {
    throw DeviceError(device::misfit_text(arguments.driver, fit.plane, *fit.workspace, fit.fit));
  }
  return 0;
}

}  // namespace

void add_device_fit_command(CLI::App& device, Action& action) {
  const std::map<std::string, device::PlaneOrientation> orientations = {
      {"horizontal", device::PlaneOrientation::horizontal},
      {"vertical", device::PlaneOrientation::vertical}};
  auto arguments = std::make_shared<DeviceFitArguments>();
  CLI::App* command = device.add_subcommand(
      "fit", "Whether a study's plane fits a device's workspace; if not, the crop that would");
  command->add_option("STUDY", arguments->study, "Study file")->required();
  command->add_option("--device", arguments->driver, "Driver, as touchtrial device list names it")
      ->required();
  command
      ->add_option_function<std::string>(
          "--orientation",
          [=](const std::string& word) { arguments->orientation = orientations.at(word); },
          "horizontal (a table) or vertical (a wall); default: as the device settings say, else "
          "horizontal")
      ->check(CLI::IsMember({"horizontal", "vertical"}));
  add_settings_option(*command, arguments->settings);
  command->add_flag("--json", arguments->json, "One JSON object in place of lines");
  command->callback([=, &action] { action = [=] { return fit(*arguments); }; });
}

}  // namespace touchtrial::app
