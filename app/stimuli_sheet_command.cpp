// stimuli sheet: a contact sheet of a prepared study.
#include "analysis/planning/level_report.hpp"
#include "analysis/sheet/stimulus_sheet.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/study_inputs.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "protocols/design/prepare.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

/// Side of the pictures; smaller for many pictures, so that the document opens.
constexpr int kSidePx = 480;
constexpr int kSideOfManyPx = 240;
constexpr std::size_t kMany = 100;

struct SheetArguments {
  fs::path study;
  fs::path output;
  fs::path key;
  fs::path pack;
};

void refuse_input(const fs::path& output, const fs::path& input) {
  std::error_code ignored;
  if (!fs::equivalent(output, input, ignored)) return;
  throw UsageError("stimuli sheet: " + one_line(output.string()) +
                   " is an input of the sheet; give another -o");
}

design::StudyKey key_of(const design::Study& study, const fs::path& path) {
  if (!is_there(path)) {
    throw FileError(one_line(path.string()) +
                    ": there is no key, which a sheet needs; run touchtrial prepare, or name the "
                    "key with --key");
  }
  const design::StudyKey stored = design::load_study_key(path);
  // The key may be elsewhere, for instance on a USB stick: pictures are found from the study file.
  design::StudyKey key = design::rekeyed(stored, study);
  if (key.seal != stored.seal) {
    throw VerificationError(design::misfit_of(study, stored, path, "--key"));
  }
  return key;
}

/// Checks everything that may be missing before the pictures take hours.
void check_output(const SheetArguments& arguments, const design::Study& study,
                  const fs::path& key) {
  if (ending_of(arguments.output) != ".html") {
    throw UsageError("stimuli sheet: " + one_line(arguments.output.string()) +
                     ": a sheet is HTML; give a name that ends in .html");
  }
  refuse_input(arguments.output, arguments.study);
  refuse_input(arguments.output, key);
  for (const design::StudyClass& one : study.classes) {
    for (const fs::path& image : one.images) refuse_input(arguments.output, study.folder / image);
  }
  require_output_place(arguments.output);
}

/// How strong each stimulus is on the study's device, and the blank plane beside it.
void add_levels(design::StudyKey key, const fs::path& pack, analysis::StimulusSheet& sheet) {
  key.pack_folder = pack;
  const simulation::StimulusLevels levels = levels_of_pack(key);
  const std::string blank = planning::range_words(levels.blank);
  sheet.level_of =
      key.study.device.empty() ? "all shipped devices" : simulation::device_of(key.study).name;
  for (std::vector<analysis::SheetCard>& line : sheet.lines) {
    for (analysis::SheetCard& card : line) {
      const auto keyed = std::ranges::find(key.stimuli, card.code, &design::KeyedStimulus::code);
      const auto place = std::ranges::find(levels.stimuli, keyed->stimulus);
      const auto at = static_cast<std::size_t>(place - levels.stimuli.begin());
      card.level = planning::range_words(levels.levels[at]) + " dB" +
                   (levels.provisional ? ", provisional" : "") + " (blank " + blank + ")";
    }
  }
}

int draw_sheet(const SheetArguments& arguments) {
  const design::Study study = design::load_study(arguments.study);
  const design::PackPlace place = pack_place_for(arguments.study, arguments.pack);
  const fs::path key_path = arguments.key.empty() ? place.key : arguments.key;
  check_output(arguments, study, key_path);
  const design::StudyKey key = key_of(study, key_path);
  design::check_images_exist(key.study);
  const int side_px = key.stimuli.size() > kMany ? kSideOfManyPx : kSidePx;
  analysis::StimulusSheet sheet = analysis::make_stimulus_sheet(key, engine::Pack(place.pack),
                                                                side_px, progress_bar("drawing"));
  add_levels(key, place.pack, sheet);
  write_output(arguments.output, analysis::sheet_html(sheet), FileMode::owner_only);
  print("sheet " + arguments.output.string() +
        " (it unblinds everybody who reads it; keep it with the key)\n");
  return 0;
}

}  // namespace

void add_stimuli_sheet_command(CLI::App& stimuli, Action& action) {
  auto arguments = std::make_shared<SheetArguments>();
  CLI::App* command = stimuli.add_subcommand(
      "sheet", "Draw a contact sheet of a prepared study for the lab book; it unblinds");
  add_study_argument(*command, arguments->study);
  command->add_option("-o,--output", arguments->output, "HTML file to write")->required();
  add_key_option(*command, arguments->key, "Key of the study (default: beside the pack)");
  add_pack_option(*command, arguments->pack);
  add_force_flag(*command);
  command->callback([=, &action] { action = [=] { return draw_sheet(*arguments); }; });
}

}  // namespace touchtrial::app
