// reference: what packages, documentation and shells take from the parser; not in the help. help:
// as --help.
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/force_flag.hpp"
#include "app/reference/completion.hpp"
#include "app/reference/pages.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"

#include <filesystem>
#include <memory>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

int write_reference(const CLI::App& program, const fs::path& folder) {
  for (const char* part : {"man", "commands"}) make_folder(folder / part);
  for (const CLI::App* command : every_command(program)) {
    const std::string words = words_of(*command, "-");
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

}  // namespace

void add_reference_command(CLI::App& program, Action& action) {
  auto folder = std::make_shared<fs::path>();
  auto is_table = std::make_shared<bool>(false);
  CLI::App* reference = program.add_subcommand(
      "reference",
      "Write manual pages and pages in Markdown, or the table that shells complete from");
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
  CLI::App* help = program.add_subcommand("help", "Show the help of a command, as --help does");
  help->add_option("COMMAND", *words, "Words of the command, for instance device accept");
  help->callback(
      [=, &program, &action] { action = [=, &program] { return show_help(program, *words); }; });
}

}  // namespace touchtrial::app
