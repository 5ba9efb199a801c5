// reference: what packages and documentation are made of; not in the help.
#include "app/commands.hpp"
#include "app/console.hpp"
#include "app/reference/reference_pages.hpp"
#include "core/files.hpp"

#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

int write_reference(const CommandDefinition& program, const fs::path& folder) {
  for (const char* part : {"man", "commands", "completion"}) make_folder(folder / part);
  for (const CommandDefinition* command : every_command(program)) {
    replace_file(folder / "man" / fmt::format("{}.1", fmt::join(command->words, "-")),
                 man_page(program, *command));
    const std::string name = command->path().empty() ? "index" : command->path("-");
    replace_file(folder / "commands" / (name + ".md"), markdown_page(*command));
  }
  replace_file(folder / "completion" / "touchtrial", bash_completion(program));
  replace_file(folder / "completion" / "_touchtrial", zsh_completion(program));
  replace_file(folder / "completion" / "touchtrial.fish", fish_completion(program));
  return 0;
}

}  // namespace

void add_reference_command(CLI::App& program, Action& action) {
  auto folder = std::make_shared<fs::path>();
  CLI::App* command = program.add_subcommand(
      "reference", "Write manual pages, pages in Markdown, and completions for bash, zsh and fish");
  command->group("");
  command->add_option("--out", *folder, "Folder")->required();
  command->callback([=, &program, &action] {
    action = [=, definition = definition_of(program)] {
      return write_reference(definition, *folder);
    };
  });
}

}  // namespace touchtrial::app
