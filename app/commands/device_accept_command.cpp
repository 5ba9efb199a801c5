// device accept: guides a person through the test of a device, and writes its certificate.
#include "app/commands/acceptance_terminal.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/device_accept_page.hpp"
#include "app/commands/device_words.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "core/text.hpp"
#include "core/version.hpp"
#include "device/acceptance/acceptance.hpp"
#include "device/acceptance/rehearsal.hpp"
#include "device/drivers/registry.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

constexpr int kRefused = 1;

struct AcceptArguments {
  std::string driver;
  fs::path settings;
  fs::path certificate;
  std::string emulated;  ///< name or file of a device model
  std::vector<std::string> skip;
  bool thermal = false;
  bool json = false;
};

/// A model's name as part of a file name.
std::string file_name_part(std::string name) {
  for (char& letter : name) {
    const bool is_plain = (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
                          (letter >= 'A' && letter <= 'Z') || letter == '-' || letter == '_';
    if (!is_plain) letter = '_';
  }
  return name;
}

/// The name of a rehearsal on this model.
std::string emulated_name(const std::string& model) {
  return "emulated-" + file_name_part(model);
}

/// A path beside the certificate: "falcon-model.json" for "falcon-certificate.json" and the ending
/// "-model.json".
fs::path file_beside(const fs::path& certificate, const std::string& ending) {
  std::string stem = certificate.stem().string();
  const std::string suffix = "-certificate";
  if (ending != ".html" && stem.ends_with(suffix)) stem.resize(stem.size() - suffix.size());
  return certificate.parent_path() / (stem + ending);
}

/// The files that an acceptance writes.
struct AcceptanceFiles {
  fs::path certificate;
  fs::path page;
  fs::path model;

  [[nodiscard]] std::array<const fs::path*, 3> all() const { return {&certificate, &page, &model}; }
};

/// Checks the output paths before the device is opened, so that no run ends without a path for its
/// results.
/// \param name  the default name of the certificate, without its ending
/// \throws UsageError if the certificate would not be a .json file, or an input of this
///   acceptance would be replaced
/// \throws FileError if they cannot be written
AcceptanceFiles files_to_write(const AcceptArguments& arguments, const std::string& name) {
  const fs::path path =
      arguments.certificate.empty() ? fs::path(name + "-certificate.json") : arguments.certificate;
  if (ending_of(path) != ".json") {
    throw UsageError("--certificate " + in_quotes(path.filename().string()) +
                     ": the page with the plots is written beside it; give a name that ends in "
                     ".json");
  }
  AcceptanceFiles files{path, file_beside(path, ".html"), file_beside(path, "-model.json")};
  const std::array<fs::path, 2> inputs = {arguments.emulated, arguments.settings};
  for (const fs::path* const file : files.all()) {
    std::error_code ignored;
    const auto is_input = [&](const fs::path& input) {
      return !input.empty() && fs::equivalent(*file, input, ignored);
    };
    if (std::ranges::any_of(inputs, is_input)) {
      throw UsageError(
          one_line(file->string()) +
          ": is an input of this acceptance and would be replaced; choose another path "
          "with --certificate");
    }
    require_output_path(*file);
    // Only a trial write shows that the file can be written.
    const Draft draft(*file, Draft::Kind::file);
  }
  return files;
}

/// Whether a file is a certificate that no session accepts, because it failed or is a rehearsal's.
bool is_replaceable(const fs::path& certificate) {
  try {
    const device::Certificate old = device::read_certificate(certificate).certificate;
    return !old.emulated.empty() || !old.passed();
  } catch (const Error&) {
    return false;
  }
}

/// Backs up a certificate that sessions may depend on, with the files beside it.
void back_up_certificate(const AcceptanceFiles& files) {
  if (path_exists(files.certificate) && is_replaceable(files.certificate)) return;
  for (const fs::path* const file : files.all()) {
    if (!path_exists(*file)) continue;
    spdlog::warn("{}: was renamed to {}", file->string(), move_aside(*file).string());
  }
}

int write_results(const AcceptArguments& arguments, const AcceptanceFiles& files,
                  device::Acceptance acceptance, const device::DeviceInfo& info) {
  device::Certificate& certificate = acceptance.certificate;
  certificate.program = std::string(program_version());
  certificate.made = std::chrono::floor<std::chrono::seconds>(
      std::chrono::sys_time<std::chrono::nanoseconds>(utc_now()));
  device::DeviceModel model = device::model_of(certificate, info);
  if (!certificate.emulated.empty()) model.name = emulated_name(certificate.emulated);
  const std::string json = device::certificate_json(certificate);
  back_up_certificate(files);
  write_output(files.certificate, json);
  write_output(files.page, acceptance_page(acceptance));
  write_output(files.model, device::device_model_json(model));
  if (arguments.json) {
    print(json);
  } else {
    print(acceptance_text(certificate, columns_of_output()) +
          fmt::format("{}: SHA-256 {}\n", files.certificate.string(),
                      to_hex(sha256_of_file(files.certificate))));
  }
  return certificate.passed() ? 0 : kRefused;
}

device::AcceptanceOptions options_of(const AcceptArguments& arguments) {
  return {{arguments.skip.begin(), arguments.skip.end()}, arguments.thermal};
}

int rehearse_on_model(const AcceptArguments& arguments) {
  const device::DeviceModel model = device::model_of_device(arguments.emulated);
  const AcceptanceFiles files = files_to_write(arguments, emulated_name(model.name));
  return write_results(arguments, files, device::rehearse_acceptance(model, options_of(arguments)),
                       device::ModelledDevice(model).info());
}

int accept_connected_device(const AcceptArguments& arguments) {
  const AcceptanceFiles files =
      files_to_write(arguments, device::device_driver(arguments.driver).name);
  try {
    AcceptanceTerminal terminal(arguments.driver, device::load_device_settings(arguments.settings));
    return write_results(arguments, files,
                         device::accept_device(terminal, terminal, options_of(arguments)),
                         terminal.info());
  } catch (const AcceptanceStopped&) {
    if (device::StopOnSignals::stop_requested()) {
      std::cerr << "touchtrial: " << device::StopOnSignals::message() << "; nothing was written\n";
      return device::StopOnSignals::exit_code();
    }
    throw DeviceError("the acceptance was stopped; nothing was written");
  }
}

int run_acceptance(const AcceptArguments& arguments) {
  if (arguments.driver.empty() == arguments.emulated.empty()) {
    throw UsageError(
        "device accept: name a driver from `touchtrial device list`, or a model with --emulate");
  }
  return arguments.emulated.empty() ? accept_connected_device(arguments)
                                    : rehearse_on_model(arguments);
}

}  // namespace

void add_device_accept_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<AcceptArguments>();
  CLI::App* command =
      device.add_subcommand("accept",
                            "Test a device step by step: signs, forces, friction, mass, delay, "
                            "walls; writes the certificate that sessions require");
  add_driver_argument(*command, "NAME", arguments->driver);
  command->add_option("--emulate", arguments->emulated,
                      "Rehearse on a device model (its name, a product or a file) in virtual time, "
                      "without testing a device");
  add_settings_option(*command, arguments->settings);
  command->add_option("--certificate", arguments->certificate,
                      "Certificate to write (default: NAME-certificate.json)");
  add_force_flag(*command);
  command->add_option("--skip", arguments->skip, "Step to skip; may be repeated")
      ->allow_extra_args(false)
      ->check(CLI::IsMember(std::vector<std::string>(device::kAcceptanceSteps.begin(),
                                                     device::kAcceptanceSteps.end())));
  command->add_flag("--thermal", arguments->thermal, "Also hold a weight for twenty minutes");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return run_acceptance(*arguments); }; });
}

}  // namespace touchtrial::app
