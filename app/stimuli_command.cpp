#include "app/commands.hpp"
#include "app/console.hpp"
#include "stimuli/default_set.hpp"
#include "stimuli/generator.hpp"

#include <filesystem>
#include <memory>
#include <string>

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
  std::string written;
  for (const stimuli::StimulusEntry& entry : manifest.entries) {
    written += (arguments.folder / entry.file).string() + "\n";
  }
  print(written + (arguments.folder / stimuli::kStimulusManifestFile).string() + "\n");
  return 0;
}

}  // namespace

void add_stimuli_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* stimuli = program.add_subcommand("stimuli", "Pictures to make studies of");
  stimuli->require_subcommand(1);
  add_stimuli_import_command(*stimuli, action);
  add_stimuli_sheet_command(*stimuli, action);
  add_stimuli_measure_command(*stimuli, action);
  CLI::App* command = stimuli->add_subcommand(
      "generate", "Make the default pictures: textures, objects, their materials, practice, flat");
  command->add_option("-o,--out", arguments->folder, "Folder to write into")->capture_default_str();
  command->add_option("--seed", arguments->choice.seed, "Another seed, other pictures")
      ->check(seed_validator())
      ->capture_default_str();
  command->add_option("--size", arguments->choice.size_px, "Side of a picture, pixels")
      ->check(CLI::Range(stimuli::kMinStimulusSizePx, stimuli::kMaxStimulusSizePx))
      ->capture_default_str();
  command
      ->add_option("--exemplars", arguments->choice.exemplars,
                   "Different pictures of each label (default: five of the textures, one of the "
                   "others)")
      ->check(CLI::Range(1, stimuli::kMaxStimulusExemplars));
  command->callback([=, &action] { action = [=] { return generate(*arguments); }; });
}

}  // namespace touchtrial::app
