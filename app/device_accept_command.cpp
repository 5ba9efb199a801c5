// device accept: a person tries a device step by step, guided, and its certificate is written.
#include "analysis/page/document.hpp"
#include "app/acceptance_terminal.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/force_flag.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"
#include "core/version.hpp"
#include "device/acceptance/acceptance.hpp"
#include "device/acceptance/rehearsal.hpp"
#include "device/registry.hpp"

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

/// A model's name as a part of a file's.
std::string file_word(std::string name) {
  for (char& letter : name) {
    const bool is_plain = (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
                          (letter >= 'A' && letter <= 'Z') || letter == '-' || letter == '_';
    if (!is_plain) letter = '_';
  }
  return name;
}

/// What a rehearsal on this model is called.
std::string emulated_word(const std::string& model) {
  return "emulated-" + file_word(model);
}

/// "falcon-model.json" beside "falcon-certificate.json".
fs::path model_beside(const fs::path& certificate) {
  std::string stem = certificate.stem().string();
  const std::string usual = "-certificate";
  if (stem.ends_with(usual)) stem.resize(stem.size() - usual.size());
  return certificate.parent_path() / (stem + "-model.json");
}

/// The files that an acceptance writes.
struct AcceptanceFiles {
  fs::path certificate;
  fs::path model;

  [[nodiscard]] std::array<const fs::path*, 2> all() const { return {&certificate, &model}; }
};

/// Called before the device is opened, so that no work is lost at the end.
/// \param name  of the certificate, without its ending, unless the arguments name one
/// \throws UsageError if a file that this very acceptance reads would be replaced
/// \throws FileError if they cannot be written
AcceptanceFiles files_to_write(const AcceptArguments& arguments, const std::string& name) {
  const fs::path path =
      arguments.certificate.empty() ? fs::path(name + "-certificate.json") : arguments.certificate;
  const AcceptanceFiles files{path, model_beside(path)};
  const std::array<fs::path, 2> inputs = {arguments.emulated, arguments.settings};
  for (const fs::path* const file : files.all()) {
    std::error_code ignored;
    const auto is_input = [&](const fs::path& input) {
      return !input.empty() && fs::equivalent(*file, input, ignored);
    };
    if (std::ranges::any_of(inputs, is_input)) {
      throw UsageError(one_line(file->string()) +
                       ": is read by this acceptance, which would replace it; name another place "
                       "with --certificate");
    }
    require_output_place(*file);
    // Writing is the only proof that it can be written.
    const Draft trial(*file, Draft::Kind::file);
  }
  return files;
}

/// Whether a file is a certificate that no session would take: it failed, or is of a rehearsal.
bool is_no_loss(const fs::path& certificate) {
  try {
    const device::Certificate old = device::read_certificate(certificate).certificate;
    return !old.emulated.empty() || !old.passed();
  } catch (const Error&) {
    return false;
  }
}

/// Keeps a certificate that sessions may rest on, and what lies beside it.
void keep_earlier(const AcceptanceFiles& files) {
  if (is_there(files.certificate) && is_no_loss(files.certificate)) return;
  for (const fs::path* const file : files.all()) {
    if (!is_there(*file)) continue;
    spdlog::warn("{}: is kept as {}", file->string(), keep_aside(*file).string());
  }
}

using analysis::Cell;

std::string number_cell(const std::optional<device::Measured>& measured, int digits,
                        double factor = 1.0) {
  if (!measured) return "-";
  return fmt::format("{:.{}f} ± {:.{}f}", factor * measured->value, digits,
                     factor * measured->error, digits);
}

std::string push_cell(const std::optional<device::PushResult>& push) {
  if (!push) return "-";
  if (!push->moved) return fmt::format("no motion at {:.1f} N", push->force_n);
  return fmt::format("{:+.1f} mm at {:.1f} N", push->along_mm, push->force_n);
}

analysis::Table table_of_axes(const device::Certificate& certificate) {
  analysis::Table table{"axes",
                        "Each axis of the device frame (x right, y up, z towards the person). "
                        "Numbers have the half-width of their interval of about 95 %.",
                        {{"axis", analysis::Align::left},
                         {"push along it", analysis::Align::right},
                         {"push against it", analysis::Align::right},
                         {"delivered, %", analysis::Align::right},
                         {"friction, N", analysis::Align::right},
                         {"mass, kg", analysis::Align::right},
                         {"damping, N s/m", analysis::Align::right},
                         {"delay, ms", analysis::Align::right}}};
  for (const device::AxisResult& axis : certificate.axes) {
    table.rows.push_back({Cell(std::string(device::name_of(axis.axis))), Cell(push_cell(axis.plus)),
                          Cell(push_cell(axis.minus)), Cell(number_cell(axis.scale(), 1, 100.0)),
                          Cell(number_cell(axis.friction_n, 3)), Cell(number_cell(axis.mass_kg, 3)),
                          Cell(number_cell(axis.viscous_n_s_per_m, 1)),
                          Cell(number_cell(axis.delay_ms, 1))});
  }
  return table;
}

analysis::Definitions device_figures(const device::Certificate& certificate) {
  analysis::Definitions figures;
  auto& entries = figures.entries;
  if (certificate.rest) {
    entries.emplace_back("noise and drift at rest",
                         fmt::format("{:.4f} mm and {:.3f} mm", certificate.rest->noise_mm,
                                     certificate.rest->drift_mm));
  }
  if (certificate.step_mm) {
    entries.emplace_back("encoder step", number_cell(certificate.step_mm, 4) + " mm");
  }
  if (certificate.wall) {
    const device::WallResult& wall = *certificate.wall;
    entries.emplace_back("stiffest stable wall", fmt::format("{:.2f} N/mm; the trials ended by {}",
                                                             wall.stable_n_per_mm, wall.ended));
    if (wall.oscillates_n_per_mm > 0.0) {
      // b = K (T/2 + delay) at the edge; T is one tick.
      const auto delay = certificate.mean_of(&device::AxisResult::delay_ms);
      const double damping = wall.oscillates_n_per_mm * (0.5 + (delay ? delay->value : 0.0));
      entries.emplace_back("first wall that swings",
                           fmt::format("{:.2f} N/mm, where {}K (T/2 + delay) is {:.2f} N s/m",
                                       wall.oscillates_n_per_mm,
                                       delay ? "" : "(delay unknown, taken as 0) ", damping));
    }
  }
  if (certificate.warm) {
    entries.emplace_back("load's force at first, and after twenty minutes",
                         fmt::format("{:.3f} N and {:.3f} N", certificate.warm->before_n,
                                     certificate.warm->after_n));
  }
  return figures;
}

analysis::Section results_of(const device::Certificate& certificate) {
  analysis::Section section{"results", "Results", {}};
  section.blocks.emplace_back(table_of_axes(certificate));
  section.blocks.emplace_back(device_figures(certificate));
  return section;
}

analysis::Section verdict_of(const device::Certificate& certificate) {
  analysis::Section section{"verdict", "Verdict", {}};
  const std::vector<std::string> failures = certificate.failures();
  section.blocks.emplace_back(analysis::Cited{
      failures.empty() ? "Every requirement of a session with people was measured and is met."
                       : "No session with people runs on this device.",
      {},
      failures.empty() ? "Passed." : "Failed."});
  if (!failures.empty()) section.blocks.emplace_back(analysis::Warnings{failures, "Why"});
  if (!certificate.not_measured.empty()) {
    analysis::Warnings missing{{}, "Not measured"};
    for (const device::NotMeasured& one : certificate.not_measured) {
      missing.sentences.push_back(one.what + ": " + one.why);
    }
    section.blocks.emplace_back(std::move(missing));
  }
  return section;
}

/// Verdict and numbers, for the terminal.
analysis::Document document_of(const device::Certificate& certificate) {
  analysis::Document document;
  document.title = "Acceptance of " + certificate.driver +
                   (certificate.model.empty() ? "" : ", " + certificate.model);
  if (!certificate.emulated.empty()) {
    document.stamp = "REHEARSAL";
    document.banners.push_back("REHEARSAL on an emulated device (" + certificate.emulated +
                               "): proves the program, not a device.");
  }
  document.header.entries = {{"driver", certificate.driver},
                             {"model", certificate.model},
                             {"serial number", certificate.serial},
                             {"firmware", certificate.firmware},
                             {"made", utc_text(certificate.made.time_since_epoch())},
                             {"program", certificate.program}};
  document.about = "This certificate";
  document.sections = {verdict_of(certificate), results_of(certificate)};
  return document;
}

int write_results(const AcceptArguments& arguments, const AcceptanceFiles& files,
                  device::Certificate certificate, const device::DeviceInfo& info) {
  certificate.program = std::string(program_version());
  certificate.made = std::chrono::floor<std::chrono::seconds>(
      std::chrono::sys_time<std::chrono::nanoseconds>(utc_now()));
  device::DeviceModel model = device::model_of(certificate, info);
  if (!certificate.emulated.empty()) model.name = emulated_word(certificate.emulated);
  const std::string json = device::certificate_json(certificate);
  keep_earlier(files);
  write_output(files.certificate, json);
  write_output(files.model, device::device_model_json(model));
  if (arguments.json) {
    print(json);
  } else {
    print(analysis::document_text(document_of(certificate), columns_of_output()) +
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
  const AcceptanceFiles files = files_to_write(arguments, emulated_word(model.name));
  return write_results(arguments, files, device::rehearse_acceptance(model, options_of(arguments)),
                       device::ModelledDevice(model).info());
}

int accept_on_cable(const AcceptArguments& arguments) {
  const AcceptanceFiles files =
      files_to_write(arguments, device::device_driver(arguments.driver).name);
  try {
    AcceptanceTerminal terminal(arguments.driver, device::device_settings_for(arguments.settings));
    return write_results(arguments, files,
                         device::accept_device(terminal, terminal, options_of(arguments)),
                         terminal.info());
  } catch (const AcceptanceStopped&) {
    if (device::StopOnSignals::asked()) {
      std::cerr << "touchtrial: " << device::StopOnSignals::message() << "; nothing was written\n";
      return device::StopOnSignals::exit_code();
    }
    throw DeviceError("the acceptance was stopped; nothing was written");
  }
}

int accept_one(const AcceptArguments& arguments) {
  if (arguments.driver.empty() == arguments.emulated.empty()) {
    throw UsageError(
        "device accept: name a driver, as touchtrial device list does, or a model with --emulate");
  }
  return arguments.emulated.empty() ? accept_on_cable(arguments) : rehearse_on_model(arguments);
}

}  // namespace

void add_device_accept_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<AcceptArguments>();
  CLI::App* command = device.add_subcommand(
      "accept",
      "Try a device step by step: signs, forces, friction, mass, delay, walls; writes its "
      "certificate, without which no session runs");
  add_driver_argument(*command, "NAME", arguments->driver);
  command->add_option("--emulate", arguments->emulated,
                      "Rehearse on a device model (its name, a product or a file) in virtual time; "
                      "proves no device");
  add_settings_option(*command, arguments->settings);
  command->add_option("--certificate", arguments->certificate,
                      "Certificate to write (default: NAME-certificate.json)");
  add_force_flag(*command);
  command->add_option("--skip", arguments->skip, "Step to leave out; may be repeated")
      ->allow_extra_args(false)
      ->check(CLI::IsMember(std::vector<std::string>(device::kAcceptanceSteps.begin(),
                                                     device::kAcceptanceSteps.end())));
  command->add_flag("--thermal", arguments->thermal, "Also hold a weight for twenty minutes");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return accept_one(*arguments); }; });
}

}  // namespace touchtrial::app
