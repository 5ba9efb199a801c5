// stimuli: pictures for studies, which the program generates or imports from photographs.
#include "app/commands/commands.hpp"
#include "app/commands/input_pictures.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/text.hpp"
#include "stimuli/default_set.hpp"
#include "stimuli/generator.hpp"
#include "stimuli/import/import.hpp"
#include "study/protocol.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct GenerateArguments {
  fs::path folder = "stimuli";
  stimuli::StimuliChoice choice;
};

int generate(const GenerateArguments& arguments) {
  const stimuli::StimulusManifest manifest = stimuli::generate_default_stimuli(
      arguments.folder, arguments.choice, progress_bar("generating"));
  std::string paths;
  for (const stimuli::StimulusEntry& entry : manifest.entries) {
    paths += (arguments.folder / entry.file).string() + "\n";
  }
  print(paths + (arguments.folder / stimuli::kStimulusManifestFile).string() + "\n");
  return 0;
}

const std::map<std::string, stimuli::LevelEqualising> kEqualisings = {
    {"none", stimuli::LevelEqualising::none},
    {"mean", stimuli::LevelEqualising::mean},
    {"rms", stimuli::LevelEqualising::rms},
    {"both", stimuli::LevelEqualising::both}};

struct ImportArguments {
  stimuli::ImportOptions options;
  std::string pixels_per_mm;
  std::string equalise = "none";
  std::string protocol{study::protocols().front()->name};
  bool json = false;
};

/// Parses a number, or the word "file" for the resolution stated in the photographs.
void parse_resolution(const std::string& text, stimuli::ImportOptions& options) {
  if (text.empty()) return;
  if (text == "file") {
    options.pixels_per_mm_of_files = true;
    return;
  }
  const auto number = number_in<double>(text);
  if (!number) {
    throw UsageError("stimuli import: --pixels-per-mm must be a number above 0, or the word file");
  }
  options.pixels_per_mm = *number;
}

std::string summary_json(const stimuli::ImportReport& report) {
  nlohmann::ordered_json summary = {{"study", report.study.string()},
                                    {"pictures", report.pictures.string()},
                                    {"classes", nlohmann::ordered_json::array()},
                                    {"ignored", report.ignored},
                                    {"warnings", report.warnings}};
  for (const stimuli::ImportedClass& texture_class : report.classes) {
    summary["classes"].push_back({{"label", texture_class.label},
                                  {"photographs", texture_class.photographs},
                                  {"crops", texture_class.crops},
                                  {"overlapping", texture_class.overlapping},
                                  {"feature_mm", texture_class.feature_mm},
                                  {"mean_grey", texture_class.mean_grey},
                                  {"rms_grey", texture_class.rms_grey}});
  }
  return json_text(summary);
}

std::string summary_text(const stimuli::ImportReport& report,
                         const stimuli::ImportOptions& options) {
  std::string text = fmt::format("{:<20} {:>11} {:>6} {:>11} {:>10} {:>9}\n", "class",
                                 "photographs", "crops", "features mm", "mean grey", "rms grey");
  for (const stimuli::ImportedClass& texture_class : report.classes) {
    text += fmt::format("{:<20} {:>11} {:>6} {:>11.2f} {:>10.1f} {:>9.1f}\n", texture_class.label,
                        texture_class.photographs, texture_class.crops, texture_class.feature_mm,
                        texture_class.mean_grey, texture_class.rms_grey);
  }
  if (options.equalise != stimuli::LevelEqualising::none) text += "levels   before equalising\n";
  return text +
         fmt::format("plane    {:g} x {:g} mm, {:g} mm per pixel{}\nlicence  {}\n",
                     options.size_px * options.pitch_mm, options.size_px * options.pitch_mm,
                     options.pitch_mm,
                     options.pixels_per_mm || options.pixels_per_mm_of_files
                         ? ", in life size"
                         : ", photographs not resampled",
                     options.licence.empty() ? "not stated; give --licence" : options.licence) +
         fmt::format("pictures {}\nstudy    {}\n", report.pictures.string(), report.study.string());
}

int run_import(ImportArguments arguments) {
  parse_resolution(arguments.pixels_per_mm, arguments.options);
  arguments.options.equalise = kEqualisings.at(arguments.equalise);
  arguments.options.protocol = arguments.protocol;
  arguments.options.methods = study::find_protocol(arguments.protocol)->min_methods;
  const stimuli::ImportReport report = with_faults_printed(
      [&] { return stimuli::import_photographs(arguments.options, progress_bar("importing")); });
  if (!arguments.json) {
    for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
  }
  print(arguments.json ? summary_json(report) : summary_text(report, arguments.options));
  return 0;
}

void add_picture_options(CLI::App& command, stimuli::ImportOptions& options) {
  command
      .add_option("FOLDER", options.photographs,
                  "Folder of photographs: one folder for each class, or one file for each class")
      ->required();
  command.add_option("--study", options.study, "Study file to write, ending in .json")->required();
  command.add_option("--out", options.pictures,
                     "Folder of the pictures to write (default: <study>.pictures)");
  add_count_option(command, "--size", options.size_px, "Side of a crop, pixels",
                   stimuli::kMinCropSizePx, stimuli::kMaxCropSizePx);
  add_count_option(command, "--crops", options.crops,
                   "Number of crops of each class, which are its exemplars", 1,
                   stimuli::kMaxCropsOfClass);
  command.add_option("--pitch-mm", options.pitch_mm, "Size of a crop's pixel on the plane, mm")
      ->capture_default_str();
  command.add_option(
      "--names", options.names,
      "How the files of a folder are named: {class}_# for T01_01.jpg and T01_02.jpg, "
      "where # is a number and * any text (default: each file is a class)");
  add_sample_options(command, options.scale);
  add_seed_option(command, options.seed, "Seed of the crops and the study's schedules");
  command.add_option("--licence", options.licence, "Licence of the photographs, for the manifest");
  command.add_option("--source", options.source, "Source of the photographs, for the manifest");
  add_force_flag(command)->each([&options](const std::string&) { options.replace = true; });
}

void add_import_command(CLI::App& stimuli, Action& action) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = stimuli.add_subcommand(
      "import", "Make a study from your own photographs: crops, manifest and study file");
  add_picture_options(*command, arguments->options);
  command->add_option("--pixels-per-mm", arguments->pixels_per_mm,
                      "Resample the photographs to life size: their pixels per millimetre of the "
                      "subject, or the word file if the files state it");
  command
      ->add_option(
          "--equalise", arguments->equalise,
          "Differences between pictures to remove: of brightness (mean), contrast (rms) or both")
      ->check(CLI::IsMember({"none", "mean", "rms", "both"}))
      ->capture_default_str();
  command->add_option("--protocol", arguments->protocol, "Protocol of the study")
      ->check(CLI::IsMember(protocols_of_new_studies()))
      ->capture_default_str();
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return run_import(*arguments); }; });
}

void add_generate_command(CLI::App& stimuli, Action& action) {
  auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* command = stimuli.add_subcommand(
      "generate",
      "Make the default pictures: textures, objects, their materials, practice pictures, flat");
  command->add_option("-o,--out", arguments->folder, "Folder to write into")->capture_default_str();
  add_force_flag(*command);
  add_seed_option(*command, arguments->choice.seed, "Seed of the pictures");
  add_count_option(*command, "--size", arguments->choice.size_px, "Side of a picture, pixels",
                   stimuli::kMinStimulusSizePx, stimuli::kMaxStimulusSizePx);
  command
      ->add_option("--exemplars", arguments->choice.exemplars,
                   "Number of different pictures of each label (default: five of each texture, one "
                   "of the others)")
      ->check(CLI::Range(1, stimuli::kMaxStimulusExemplars));
  command->callback([=, &action] { action = [=] { return generate(*arguments); }; });
}

}  // namespace

void add_stimuli_command(CLI::App& program, Action& action) {
  CLI::App* stimuli = program.add_subcommand("stimuli", "Pictures for studies");
  stimuli->require_subcommand(1);
  add_import_command(*stimuli, action);
  add_stimuli_sheet_command(*stimuli, action);
  add_stimuli_measure_command(*stimuli, action);
  add_generate_command(*stimuli, action);
}

}  // namespace touchtrial::app
