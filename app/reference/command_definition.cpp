#include "app/reference/command_definition.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::app {
namespace {

std::vector<std::string> parts_of(std::string_view text, char between) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(between, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// Splits what the parser calls a type: "TEXT:{a,b}", "INT:INT in [1 - 9]", "TEXT:FOLDER", "a|b".
void read_type(const std::string& type, OptionDefinition& option) {
  const std::size_t colon = type.find(':');
  const std::string kind = type.substr(0, colon);
  const std::string check = colon == std::string::npos ? "" : type.substr(colon + 1);
  const bool is_number = kind == "INT" || kind == "UINT" || kind == "FLOAT";
  option.value = is_number ? "NUMBER" : kind;
  if (check.starts_with('{') && check.ends_with('}')) {
    option.choices = parts_of(std::string_view(check).substr(1, check.size() - 2), ',');
  } else if (const std::size_t range = check.find(" in ["); range != std::string::npos) {
    const std::string limits = check.substr(range + 5, check.size() - range - 6);
    const std::size_t dash = limits.find(" - ");
    option.range = limits.substr(0, dash) + " to " + limits.substr(dash + 3);
  } else if (!check.empty() && !is_number) {
    option.value = kind == "TEXT" ? check : type;
  } else if (kind.find('|') != std::string::npos) {
    option.choices = parts_of(kind, '|');
  }
  if (!option.choices.empty()) option.value = fmt::format("{}", fmt::join(option.choices, "|"));
}

/// In the order in which the command defines them, not that of their addresses.
std::vector<std::string> names_of(const std::set<CLI::Option*>& some, const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    const bool is_one = std::any_of(some.begin(), some.end(),
                                    [&](const CLI::Option* other) { return other == option; });
    if (is_one && !option->get_group().empty())
      names.push_back(option->get_name(!option->nonpositional()));
  }
  return names;
}

OptionDefinition option_of(const CLI::Option& option, const CLI::App& command) {
  OptionDefinition one;
  one.is_argument = !option.nonpositional();
  if (one.is_argument) {
    one.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) one.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) one.names.push_back("--" + name);
  }
  if (option.get_items_expected_max() > 0) read_type(option.get_type_name(), one);
  one.usual = option.get_default_str();
  one.meaning = option.get_description();
  one.needs = names_of(option.get_needs(), command);
  one.excludes = names_of(option.get_excludes(), command);
  one.is_required = option.get_required();
  one.is_repeated = option.get_items_expected_max() > 1;
  return one;
}

CommandDefinition command_of(const CLI::App& command, std::vector<std::string> words) {
  CommandDefinition one;
  words.push_back(command.get_name());
  one.words = std::move(words);
  one.summary = command.get_description();
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_group().empty()) one.options.push_back(option_of(*option, command));
  }
  std::stable_partition(one.options.begin(), one.options.end(),
                        [](const OptionDefinition& option) { return option.is_argument; });
  for (const CLI::App* below : command.get_subcommands({})) {
    if (!below->get_group().empty()) one.commands.push_back(command_of(*below, one.words));
  }
  return one;
}

}  // namespace

std::string CommandDefinition::path(const std::string& between) const {
  return fmt::format("{}", fmt::join(words.begin() + 1, words.end(), between));
}

std::string CommandDefinition::synopsis() const {
  std::string text = fmt::format("{} [OPTIONS]", fmt::join(words, " "));
  for (const OptionDefinition& option : options) {
    if (!option.is_argument) continue;
    const std::string name = option.names.front() + (option.is_repeated ? "..." : "");
    text += option.is_required ? " " + name : " [" + name + "]";
  }
  return commands.empty() ? text : text + " COMMAND";
}

CommandDefinition definition_of(const CLI::App& program) {
  return command_of(program, {});
}

std::vector<const CommandDefinition*> every_command(const CommandDefinition& command) {
  std::vector<const CommandDefinition*> all{&command};
  for (const CommandDefinition& below : command.commands) {
    for (const CommandDefinition* one : every_command(below)) all.push_back(one);
  }
  return all;
}

std::string whole_meaning(const OptionDefinition& option) {
  std::string text = option.meaning;
  const auto add = [&text](const std::string& sentence) {
    text += (text.ends_with('.') ? " " : ". ") + sentence;
  };
  if (!option.range.empty()) add("From " + option.range);
  if (!option.usual.empty()) add("Default: " + option.usual);
  if (option.is_repeated && text.find("repeated") == std::string::npos) add("May be repeated");
  if (option.is_required && !option.is_argument) add("Required");
  if (!option.needs.empty()) add(fmt::format("Needs {}", fmt::join(option.needs, ", ")));
  if (!option.excludes.empty()) add(fmt::format("Not with {}", fmt::join(option.excludes, ", ")));
  return text.ends_with('.') ? text : text + ".";
}

}  // namespace touchtrial::app
