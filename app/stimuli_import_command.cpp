#include "app/commands.hpp"
#include "app/console.hpp"
#include "core/errors.hpp"
#include "stimuli/import/import.hpp"

#include <charconv>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

const std::map<std::string, stimuli::LevelEqualising> kEqualisings = {
    {"none", stimuli::LevelEqualising::none},
    {"mean", stimuli::LevelEqualising::mean},
    {"rms", stimuli::LevelEqualising::rms},
    {"both", stimuli::LevelEqualising::both}};
const std::map<std::string, stimuli::ImportProtocol> kProtocols = {
    {"classification", stimuli::ImportProtocol::classification},
    {"comparison", stimuli::ImportProtocol::comparison}};

struct ImportArguments {
  stimuli::ImportOptions options;
  std::string pixels_per_mm;
  std::string equalise = "none";
  std::string protocol = "classification";
  bool json = false;
};

/// A number, or the word that leaves it to the photographs.
void take_resolution(const std::string& text, stimuli::ImportOptions& options) {
  if (text.empty()) return;
  if (text == "file") {
    options.pixels_per_mm_of_files = true;
    return;
  }
  double number = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || stop != text.data() + text.size()) {
    throw UsageError("stimuli import: --pixels-per-mm must be a number above 0, or the word file");
  }
  options.pixels_per_mm = number;
}

std::string summary_json(const stimuli::ImportReport& report) {
  nlohmann::ordered_json summary = {{"study", report.study.string()},
                                    {"pictures", report.pictures.string()},
                                    {"classes", nlohmann::ordered_json::array()},
                                    {"ignored", report.ignored},
                                    {"warnings", report.warnings}};
  for (const stimuli::ImportedClass& one : report.classes) {
    summary["classes"].push_back({{"label", one.label},
                                  {"photographs", one.photographs},
                                  {"crops", one.crops},
                                  {"overlapping", one.overlapping},
                                  {"feature_mm", one.feature_mm},
                                  {"mean_grey", one.mean_grey},
                                  {"rms_grey", one.rms_grey}});
  }
  return summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string summary_text(const stimuli::ImportReport& report,
                         const stimuli::ImportOptions& options) {
  std::string text = fmt::format("{:<20} {:>11} {:>6} {:>11} {:>10} {:>9}\n", "class",
                                 "photographs", "crops", "features mm", "mean grey", "rms grey");
  for (const stimuli::ImportedClass& one : report.classes) {
    text += fmt::format("{:<20} {:>11} {:>6} {:>11.2f} {:>10.1f} {:>9.1f}\n", one.label,
                        one.photographs, one.crops, one.feature_mm, one.mean_grey, one.rms_grey);
  }
  if (options.equalise != stimuli::LevelEqualising::none)
    text += "levels   as they were before equalising\n";
  if (!report.ignored.empty()) {
    text += fmt::format(
        "ignored  {}{}\n", one_line(report.ignored.front()),
        report.ignored.size() > 1 ? fmt::format(" and {} more", report.ignored.size() - 1) : "");
  }
  return text +
         fmt::format("plane    {:g} x {:g} mm, {:g} mm a pixel{}\nlicence  {}\n",
                     options.size_px * options.pitch_mm, options.size_px * options.pitch_mm,
                     options.pitch_mm,
                     options.pixels_per_mm || options.pixels_per_mm_of_files
                         ? ", as large as life"
                         : ", photographs not resampled",
                     options.licence.empty() ? "not stated; give --licence" : options.licence) +
         fmt::format("pictures {}\nstudy    {}\n", report.pictures.string(), report.study.string());
}

int import_with(ImportArguments arguments) {
  take_resolution(arguments.pixels_per_mm, arguments.options);
  arguments.options.equalise = kEqualisings.at(arguments.equalise);
  arguments.options.protocol = kProtocols.at(arguments.protocol);
  const stimuli::ImportReport report =
      stimuli::import_photographs(arguments.options, progress_bar("importing"));
  if (!arguments.json) {
    for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
  }
  print(arguments.json ? summary_json(report) : summary_text(report, arguments.options));
  return 0;
}

void add_picture_options(CLI::App& command, stimuli::ImportOptions& options) {
  command
      .add_option("FOLDER", options.photographs,
                  "Photographs: a folder of class folders, or a folder of files, each a class")
      ->required();
  command.add_option("--study", options.study, "Study file to write, ending in .json")->required();
  command.add_option("--out", options.pictures,
                     "Folder of the pictures to write (default: <study>.pictures)");
  command.add_option("--size", options.size_px, "Side of a crop, pixels")
      ->check(CLI::Range(stimuli::kMinCropSizePx, stimuli::kMaxCropSizePx))
      ->capture_default_str();
  command.add_option("--crops", options.crops, "Crops of each class, its exemplars")
      ->check(CLI::Range(1, stimuli::kMaxCropsOfClass))
      ->capture_default_str();
  command.add_option("--pitch-mm", options.pitch_mm, "Size of a crop's pixel on the plane, mm")
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Another seed, other crops and schedules")
      ->check(seed_validator())
      ->capture_default_str();
  command.add_option("--licence", options.licence, "Of the photographs, for the manifest");
  command.add_option("--source", options.source, "Where they come from, for the manifest");
  command.add_flag("--force", options.replace, "Replace what an earlier import wrote");
}

}  // namespace

void add_stimuli_import_command(CLI::App& stimuli, Action& action) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = stimuli.add_subcommand(
      "import", "Make a study of one's own photographs: crops, manifest and study file");
  add_picture_options(*command, arguments->options);
  command->add_option("--pixels-per-mm", arguments->pixels_per_mm,
                      "Pixels of a photograph on a millimetre of what it shows, or the word file "
                      "where the files say it: resamples them to be felt as large as life");
  command
      ->add_option("--equalise", arguments->equalise,
                   "Differences between pictures to take away: brightness, contrast")
      ->check(CLI::IsMember({"none", "mean", "rms", "both"}))
      ->capture_default_str();
  command->add_option("--protocol", arguments->protocol, "What the study asks")
      ->check(CLI::IsMember({"classification", "comparison"}))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Summary as one JSON object");
  command->callback([=, &action] { action = [=] { return import_with(*arguments); }; });
}

}  // namespace touchtrial::app
