// reference (hidden): writes manual pages, documentation and shell completion from the parser.
// help: prints the same as --help.
#include "app/commands/commands.hpp"
#include "app/commands/shipped_files.hpp"
#include "app/reference/pages.hpp"
#include "app/terminal/console.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "device/drivers/registry.hpp"
#include "engine/extraction_options.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

int write_reference(const CLI::App& program, const fs::path& folder) {
  for (const char* part : {"man", "commands"}) make_folder(folder / part);
  for (const CLI::App* command : every_command(program)) {
    const std::string words = full_name_of(*command, "-");
    const std::string name = command == &program ? "index" : words.substr(words.find('-') + 1);
    write_output(folder / "man" / (words + ".1"), page_of(*command, PageFormat::man));
    write_output(folder / "commands" / (name + ".md"), page_of(*command, PageFormat::markdown));
  }
  return 0;
}

int show_help(const CLI::App& program, const std::vector<std::string>& words) {
  const CLI::App* command = &program;
  for (const std::string& word : words) command = &command_named(*command, word);
  print(page_of(*command, PageFormat::help));
  return 0;
}

/// The subject files of the installation.
std::vector<std::string> shipped_subjects() {
  std::vector<std::string> files;
  try {
    for (const auto& file : fs::directory_iterator(shipped_folder() / "config/subjects")) {
      files.push_back(file.path().string());
    }
  } catch (const std::exception&) {
    return {};  // the program was copied without its files
  }
  std::ranges::sort(files);
  return files;
}

/// Values to complete for an option, which may also accept others.
std::vector<std::string> completed_values(const CLI::Option& option) {
  if (std::vector<std::string> choices = choices_of(option); !choices.empty()) return choices;
  const std::string name = option.get_name();
  if (name == "--on") return device::modelled_names();
  if (name == "--methods") return engine::method_names();
  if (name == "--subject") return shipped_subjects();
  return {};
}

/// The full name without the program's name.
std::string command_path(const CLI::App& command) {
  const std::string words = full_name_of(command);
  const std::size_t space = words.find(' ');
  return space == std::string::npos ? "" : words.substr(space + 1);
}

/// The table for the scripts of config/completion, with columns separated by bars: the command so
/// far, a possible next word, its values, and its meaning. A word without a value has "-"; a row
/// without a word has the values of an argument. If a row's values are empty, shells complete file
/// names.
std::string completion_table(const CLI::App& program) {
  std::string table;
  for (const CLI::App* command : every_command(program)) {
    const std::string path = command_path(*command);
    for (const CLI::App* subcommand : command->get_subcommands({})) {
      if (subcommand->get_group().empty()) continue;
      table +=
          fmt::format("{}|{}|-|{}\n", path, subcommand->get_name(), subcommand->get_description());
    }
    for (const CLI::Option* option : options_of(*command)) {
      const std::string values = option->get_items_expected_max() == 0
                                     ? "-"
                                     : fmt::format("{}", fmt::join(completed_values(*option), " "));
      for (const std::string& name : names_of(*option)) {
        table += fmt::format("{}|{}|{}|{}\n", path, option->nonpositional() ? name : "", values,
                             option->get_description());
      }
    }
  }
  return table;
}

}  // namespace

void add_reference_command(CLI::App& program, Action& action) {
  auto folder = std::make_shared<fs::path>();
  auto is_table = std::make_shared<bool>(false);
  CLI::App* reference = program.add_subcommand(
      "reference", "Write manual pages and Markdown pages, or the table for shell completion");
  reference->group("");
  CLI::Option* out = reference->add_option("--out", *folder, "Folder");
  reference->add_flag("--table", *is_table, "Print the table instead")->excludes(out);
  add_force_flag(*reference);
  reference->callback([=, &program, &action] {
    if (out->count() == 0 && !*is_table) throw CLI::RequiredError("--out or --table");
    action = [=, &program] {
      if (!*is_table) return write_reference(program, *folder);
      print(completion_table(program));
      return 0;
    };
  });
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* help = program.add_subcommand("help", "Show the help of a command, like --help");
  help->add_option("COMMAND", *words, "Words of the command, for instance device accept");
  help->callback(
      [=, &program, &action] { action = [=, &program] { return show_help(program, *words); }; });
}

}  // namespace touchtrial::app
