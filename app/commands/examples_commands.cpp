// examples: copies the example studies into a folder; demo: runs two of them with simulated
// participants.
#include "app/commands/commands.hpp"
#include "app/commands/shipped_files.hpp"
#include "app/terminal/console.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

/// The studies name no device, so without this they would be simulated on an ideal one.
constexpr const char* kDemoDevice = "touch";

struct ExamplesArguments {
  fs::path folder = "touchtrial-examples";
};

struct DemoArguments {
  fs::path folder = "touchtrial-demo";
  int participants = 20;
};

int write_examples(const ExamplesArguments& arguments) {
  // A shell command would parse "-x" as an option.
  const bool looks_like_option = arguments.folder.string().starts_with('-');
  const fs::path folder = looks_like_option ? "." / arguments.folder : arguments.folder;
  copy_examples(folder);
  print(fmt::format(
      "studies  {}\npictures {}\n\nChange to the new folder, and try a study:\n\n  cd {}\n  "
      "touchtrial preview "
      "config/classification.json\n  touchtrial prepare config/classification.json\n  touchtrial "
      "simulate config/classification.json --participants 20 --db rehearsal.db\n",
      (folder / "config").string(), (folder / "stimuli").string(), shell_word(folder.string())));
  return 0;
}

/// Prints a command line and runs it.
/// \throws as run_command
int show_and_run(const std::vector<std::string>& words) {
  std::string line = "\n$ touchtrial";
  for (const std::string& word : words) line += " " + shell_word(word);
  print(line + "\n");
  return run_command(words);
}

int run_demo(const DemoArguments& arguments) {
  copy_examples(arguments.folder);
  for (const std::string name : {"classification", "comparison"}) {
    const std::string study = (arguments.folder / "config" / (name + ".json")).string();
    const std::string db = (arguments.folder / (name + ".db")).string();
    const std::string report = (arguments.folder / (name + "-report")).string();
    const std::vector<std::vector<std::string>> steps = {
        {"simulate", study, "--on", kDemoDevice, "--participants",
         std::to_string(arguments.participants), "--seed", "1", "--db", db},
        {"verify", db},
        {"report", db},
        {"report", db, "--out", report}};
    for (const std::vector<std::string>& step : steps) {
      if (const int code = show_and_run(step); code != 0) return code;
    }
  }
  print(fmt::format(
      "\nDatabases and reports (report.html) are in {}; continue with\n\n  touchtrial export {} "
      "--format csv --out {}\n",
      arguments.folder.string(), shell_word((arguments.folder / "classification.db").string()),
      shell_word((arguments.folder / "csv").string())));
  return 0;
}

}  // namespace

void add_examples_commands(CLI::App& program, Action& action) {
  const auto [examples, example_arguments] = add_command(
      program, action, "examples",
      "Copy the example studies, with their pictures and subject files, into a new folder",
      write_examples);
  examples.add_option("FOLDER", example_arguments.folder, "New folder")->capture_default_str();

  const auto [demo, arguments] = add_command(
      program, action, "demo",
      "Run both experiments with simulated people on a modelled Touch, and write reports",
      run_demo);
  demo.add_option("FOLDER", arguments.folder, "New folder for studies, databases and reports")
      ->capture_default_str();
  add_count_option(demo, "--participants", arguments.participants,
                   "Simulated participants of each experiment", 1, 1000);
}

}  // namespace touchtrial::app
