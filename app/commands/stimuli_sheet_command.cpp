// stimuli sheet: draws a contact sheet of a prepared study.
#include "analysis/planning/level_report.hpp"
#include "analysis/sheet/stimulus_sheet.hpp"
#include "app/commands/commands.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "study/prepare.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

struct SheetArguments {
  fs::path study;
  fs::path output;
  fs::path key;
  fs::path pack;
};

study::StudyKey load_sheet_key(const study::Study& study, const fs::path& path) {
  if (!path_exists(path)) {
    throw FileError(one_line(path.string()) +
                    ": the key does not exist, and a sheet needs it; run touchtrial prepare, or "
                    "name the key with --key");
  }
  const study::StudyKey stored_key = study::load_study_key(path);
  // Pictures are located from the study file, because the key may be elsewhere, for instance on a
  // USB stick.
  study::StudyKey key = study::rekeyed(stored_key, study);
  if (key.seal != stored_key.seal) {
    throw VerificationError(study::mismatch_of(study, stored_key, path, "--key"));
  }
  return key;
}

int draw_sheet(const SheetArguments& arguments) {
  const study::Study study = study::load_study(arguments.study);
  const study::PackPlace place = pack_place_for(arguments.study, arguments.pack);
  const fs::path key_path = arguments.key.empty() ? place.key : arguments.key;
  // Missing inputs are reported before the pictures take hours.
  if (ending_of(arguments.output) != ".html") {
    throw UsageError("stimuli sheet: " + one_line(arguments.output.string()) +
                     ": a sheet is HTML; give a name that ends in .html");
  }
  require_output_path(arguments.output);
  study::StudyKey key = load_sheet_key(study, key_path);
  study::check_images_exist(key.study);
  key.pack_folder = place.pack;
  analysis::Document sheet =
      analysis::make_stimulus_sheet(key, engine::Pack(place.pack), progress_bar("drawing"));
  sheet.sections.push_back(planning::levels_section(key.study, levels_of_pack(key)));
  sheet.colophon = "Made by the command touchtrial stimuli sheet.";
  write_output(arguments.output, analysis::page_html(sheet), FileMode::owner_only);
  print("sheet " + arguments.output.string() +
        " (it unblinds everyone who reads it; keep it with the key)\n");
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
