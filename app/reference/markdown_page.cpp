// Pages of the documentation, in Markdown.
#include "app/reference/reference_pages.hpp"

#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::app {
namespace {

/// Text of a table's cell.
std::string in_cell(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const bool is_special = c == '|' || c == '<' || c == '*' || c == '_' || c == '[';
    if (is_special) safe += '\\';
    safe += c;
  }
  return safe;
}

std::string in_code(std::string_view text) {
  std::string safe;
  for (const char c : text) safe += c == '|' ? "\\|" : std::string(1, c);
  return "`" + safe + "`";
}

std::string table(const CommandDefinition& command, bool are_arguments) {
  std::string rows;
  for (const OptionDefinition& option : command.options) {
    if (option.is_argument != are_arguments) continue;
    std::string name = fmt::format("{}", fmt::join(option.names, ", "));
    if (!option.value.empty() && !are_arguments) name += " " + option.value;
    rows += fmt::format("| {} | {} |\n", in_code(name), in_cell(whole_meaning(option)));
  }
  if (rows.empty()) return "";
  return fmt::format("\n## {}\n\n| {} | meaning |\n| --- | --- |\n{}",
                     are_arguments ? "Arguments" : "Options", are_arguments ? "argument" : "option",
                     rows);
}

}  // namespace

std::string markdown_page(const CommandDefinition& command) {
  std::string page =
      fmt::format("# {}\n\n{}{}\n\n```text\n{}\n```\n", fmt::join(command.words, " "),
                  command.summary, command.summary.ends_with('.') ? "" : ".", command.synopsis());
  if (!command.commands.empty()) {
    page += "\n## Commands\n\n| command | does |\n| --- | --- |\n";
    for (const CommandDefinition& below : command.commands) {
      page += fmt::format("| [{}]({}.md) | {} |\n", below.path(), below.path("-"),
                          in_cell(below.summary));
    }
  }
  return page + table(command, true) + table(command, false);
}

}  // namespace touchtrial::app
