// device accept: a person tries a device step by step, guided, and its certificate is written.
#include "app/acceptance_terminal.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/device_accept_page.hpp"
#include "app/device_words.hpp"
#include "app/sound/sound_accelerometer.hpp"
#include "app/study_inputs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "core/text.hpp"
#include "core/version.hpp"
#include "device/acceptance/accelerometer.hpp"
#include "device/acceptance/acceptance.hpp"
#include "device/acceptance/rehearsal.hpp"
#include "device/registry.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/session/stimulus_source.hpp"

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
  std::vector<std::string> records;  ///< LABEL=FILE of an accelerometer
  fs::path planes;                   ///< study file
  std::string sound_input;
  std::vector<double> full_scale_m_s2;
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

/// "falcon-model.json" beside "falcon-certificate.json", with this ending in place of
/// "-certificate.json".
fs::path file_beside(const fs::path& certificate, const std::string& ending) {
  std::string stem = certificate.stem().string();
  const std::string usual = "-certificate";
  if (ending != ".html" && stem.ends_with(usual)) stem.resize(stem.size() - usual.size());
  return certificate.parent_path() / (stem + ending);
}

/// The files that an acceptance writes.
struct AcceptanceFiles {
  fs::path certificate;
  fs::path page;
  fs::path model;

  [[nodiscard]] std::array<const fs::path*, 3> all() const { return {&certificate, &page, &model}; }
};

/// \return WHAT and FILE of --accelerometer
/// \throws UsageError
std::pair<std::string, std::string> record_words(const std::string& record) {
  const std::size_t equals = record.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == record.size()) {
    throw UsageError("--accelerometer " + in_quotes(record) +
                     ": give WHAT=FILE, for instance wall=wall.csv");
  }
  return {record.substr(0, equals), record.substr(equals + 1)};
}

/// Called before the device is opened, so that no work is lost at the end.
/// \param name  of the certificate, without its ending, unless the arguments name one
/// \throws UsageError if the certificate would not be a .json file, or a file that this very
///   acceptance reads would be replaced
/// \throws FileError if they cannot be written
AcceptanceFiles files_to_write(const AcceptArguments& arguments, const std::string& name) {
  const fs::path path =
      arguments.certificate.empty() ? fs::path(name + "-certificate.json") : arguments.certificate;
  if (ending_of(path) != ".json") {
    throw UsageError("--certificate " + in_quotes(path.string()) +
                     ": the page with the plots is written beside it; give a name that ends in "
                     ".json");
  }
  AcceptanceFiles files{path, file_beside(path, ".html"), file_beside(path, "-model.json")};
  std::vector<fs::path> inputs = {arguments.emulated, arguments.settings};
  inputs.push_back(arguments.planes);
  for (const std::string& record : arguments.records) {
    inputs.emplace_back(record_words(record).second);
  }
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

/// The spectra of the records that the arguments name.
std::vector<device::SpectrumResult> spectra_of(const AcceptArguments& arguments) {
  std::vector<device::SpectrumResult> spectra;
  for (const std::string& record : arguments.records) {
    const auto [what, file] = record_words(record);
    spectra.push_back({what, device::acceleration_bands(device::read_accelerometer_csv(file))});
  }
  return spectra;
}

int write_results(const AcceptArguments& arguments, const AcceptanceFiles& files,
                  device::Acceptance acceptance, const device::DeviceInfo& info) {
  device::Certificate& certificate = acceptance.certificate;
  certificate.program = std::string(program_version());
  certificate.made = std::chrono::floor<std::chrono::seconds>(
      std::chrono::sys_time<std::chrono::nanoseconds>(utc_now()));
  device::DeviceModel model = device::model_of(certificate, info);
  if (!certificate.emulated.empty()) model.name = emulated_word(certificate.emulated);
  const std::string json = device::certificate_json(certificate);
  keep_earlier(files);
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

/// The planes of a prepared study, which the acceptance presents one by one.
class StudyPlanes {
 public:
  /// \throws FileError if the study is not prepared here, or its key is under a passphrase
  explicit StudyPlanes(const fs::path& file)
      : key_(key_of(file)), pack_(key_.pack_folder), source_(pack_, key_.study.rendering) {}

  /// Refers to this. The blank plane comes first.
  [[nodiscard]] std::vector<device::FeltPlane> planes() const {
    std::vector<device::FeltPlane> planes = {
        plane(std::string(device::kBlankPlane), source_.flat())};
    for (const design::KeyedStimulus& keyed : sorted()) {
      const design::StudyClass& own = key_.study.classes[keyed.stimulus.class_index];
      std::string felt = own.label + " " + key_.study.methods[keyed.stimulus.method].label;
      if (own.images.size() > 1) felt += fmt::format(" {}", keyed.stimulus.exemplar + 1);
      planes.push_back(plane(std::move(felt), source_.model(keyed.code)));
    }
    return planes;
  }

 private:
  static design::StudyKey key_of(const fs::path& file) {
    std::optional<design::StudyKey> key = open_key_of(design::load_study(file), file);
    if (key) return std::move(*key);
    throw FileError(one_line(file.string()) +
                    ": --planes: is not prepared here, or its key is under a passphrase; run "
                    "touchtrial prepare with a copy of the study in another folder");
  }
  /// Codes are random, and so is the key's order.
  [[nodiscard]] std::vector<design::KeyedStimulus> sorted() const {
    std::vector<design::KeyedStimulus> stimuli = key_.stimuli;
    std::ranges::sort(stimuli, {}, &design::KeyedStimulus::stimulus);
    return stimuli;
  }
  [[nodiscard]] device::FeltPlane plane(std::string felt,
                                        const engine::RenderingModel& model) const {
    return {std::move(felt), key_.study.rendering.stiffness_n_per_mm, source_.plane(),
            [&model, touch = engine::Bristle()](Vec3 position_mm, Vec3 velocity_mm_s) mutable {
              return model.force_n(position_mm, velocity_mm_s, touch);
            }};
  }

  design::StudyKey key_;
  engine::Pack pack_;
  session::StimulusSource source_;
};

device::AcceptanceOptions options_of(const AcceptArguments& arguments,
                                     const std::optional<StudyPlanes>& study) {
  device::AcceptanceOptions options;
  options.skip.insert(arguments.skip.begin(), arguments.skip.end());
  options.thermal = arguments.thermal;
  if (study) options.planes = study->planes();
  return options;
}

std::optional<StudyPlanes> planes_of(const AcceptArguments& arguments) {
  std::optional<StudyPlanes> study;
  if (!arguments.planes.empty()) study.emplace(arguments.planes);
  return study;
}

void add_spectra(const std::vector<device::SpectrumResult>& spectra,
                 device::Certificate& certificate) {
  certificate.spectra.insert(certificate.spectra.end(), spectra.begin(), spectra.end());
}

int rehearse_on_model(const AcceptArguments& arguments,
                      const std::vector<device::SpectrumResult>& spectra) {
  if (!arguments.sound_input.empty()) {
    throw UsageError("--sound-input: a rehearsal has an accelerometer of its own; leave it out");
  }
  const device::DeviceModel model = device::model_of_device(arguments.emulated);
  const AcceptanceFiles files = files_to_write(arguments, emulated_word(model.name));
  const std::optional<StudyPlanes> study = planes_of(arguments);
  device::Acceptance acceptance = device::rehearse_acceptance(model, options_of(arguments, study));
  add_spectra(spectra, acceptance.certificate);
  return write_results(arguments, files, std::move(acceptance),
                       device::ModelledDevice(model).info());
}

int accept_on_cable(const AcceptArguments& arguments, const AcceptanceFiles& files,
                    const std::vector<device::SpectrumResult>& spectra) {
  std::optional<device::Acceptance> acceptance;
  device::DeviceInfo info;
  try {
    const std::optional<StudyPlanes> study = planes_of(arguments);
    std::optional<SoundAccelerometer> accelerometer;
    if (study) accelerometer.emplace(arguments.sound_input, arguments.full_scale_m_s2);
    AcceptanceTerminal terminal(arguments.driver, device::device_settings_for(arguments.settings),
                                accelerometer ? &*accelerometer : nullptr);
    info = terminal.info();
    acceptance = device::accept_device(terminal, terminal, options_of(arguments, study));
  } catch (const AcceptanceStopped&) {
    if (device::StopOnSignals::asked()) {
      std::cerr << "touchtrial: " << device::StopOnSignals::message() << "; nothing was written\n";
      return device::StopOnSignals::exit_code();
    }
    throw DeviceError("the acceptance was stopped; nothing was written");
  }
  add_spectra(spectra, acceptance->certificate);
  return write_results(arguments, files, std::move(*acceptance), info);
}

int accept_one(const AcceptArguments& arguments) {
  if (arguments.driver.empty() == arguments.emulated.empty()) {
    throw UsageError(
        "device accept: name a driver, as touchtrial device list does, or a model with --emulate");
  }
  const std::vector<device::SpectrumResult> spectra = spectra_of(arguments);
  if (arguments.emulated.empty() && !arguments.planes.empty() && arguments.sound_input.empty()) {
    throw UsageError(
        "--planes: needs an accelerometer at the stylus; name its sound input with --sound-input");
  }
  if (!arguments.emulated.empty()) return rehearse_on_model(arguments, spectra);
  const AcceptanceFiles files =
      files_to_write(arguments, device::device_driver(arguments.driver).name);
  return accept_on_cable(arguments, files, spectra);
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
  command
      ->add_option("--accelerometer", arguments->records,
                   "WHAT=FILE, a CSV record at the stylus (time_s,x_m_s2,y_m_s2,z_m_s2) while it "
                   "felt WHAT; may be repeated")
      ->type_name("WHAT=FILE")
      ->allow_extra_args(false);
  CLI::Option* planes =
      command
          ->add_option("--planes", arguments->planes,
                       "Also stroke the blank plane and every texture of this prepared study, "
                       "under an accelerometer at the stylus")
          ->type_name("STUDY");
  CLI::Option* input =
      command
          ->add_option("--sound-input", arguments->sound_input,
                       "With --planes: the sound card's input that the accelerometer is plugged "
                       "into, by its name or a part of it")
          ->type_name("NAME")
          ->needs(planes);
  command
      ->add_option("--full-scale", arguments->full_scale_m_s2,
                   "With --sound-input: the acceleration in m/s2 at the end of the input's range; "
                   "one number for one axis, or X,Y,Z")
      ->type_name("A")
      ->delimiter(',')
      ->needs(input);
  command->add_flag("--thermal", arguments->thermal, "Also hold a weight for twenty minutes");
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return accept_one(*arguments); }; });
}

}  // namespace touchtrial::app
