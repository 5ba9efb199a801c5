#include "app/reference/pages.hpp"

#include "analysis/report/text_table.hpp"
#include "core/errors.hpp"
#include "core/nearest_name.hpp"
#include "core/text.hpp"
#include "core/version.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::app {
namespace {

constexpr std::size_t kHelpColumns = 80;
constexpr std::size_t kNameColumns = 24;
/// A longer list of choices is shown in the option's description, not beside its name.
constexpr std::size_t kMaxChoicesBesideName = 40;

/// An option, an argument or a command.
struct Item {
  std::string name;
  std::string value;  ///< shown after the name; may be empty
  std::string meaning;
  std::string page{};  ///< the page of a command: "device-accept"
};

struct Section {
  std::string title;
  std::vector<Item> items;
};

struct Page {
  std::string name;  ///< "touchtrial device accept"
  std::string summary;
  std::string synopsis;  ///< "touchtrial device accept [OPTIONS] [NAME]"
  std::string start;     ///< first steps; may be empty
  std::vector<Section> sections;
};

/// The parser's description of a value: its type and its limits. For instance "TEXT:{a,b}",
/// "INT:INT in [1 - 9]", "TEXT:FOLDER", "a|b".
struct ValueType {
  explicit ValueType(const CLI::Option& option) {
    if (option.get_items_expected_max() == 0) return;
    const std::string type = option.get_type_name();
    const std::size_t colon = type.find(':');
    kind = type.substr(0, colon);
    if (colon != std::string::npos) limit = type.substr(colon + 1);
  }
  [[nodiscard]] bool is_number() const {
    return kind == "INT" || kind == "UINT" || kind == "FLOAT";
  }

  std::string kind;
  std::string limit;
};

std::string value_of(const CLI::Option& option) {
  const ValueType type(option);
  if (type.is_number()) return "NUMBER";
  if (const std::vector<std::string> choices = choices_of(option); !choices.empty()) {
    const std::string joined = fmt::format("{}", fmt::join(choices, "|"));
    return joined.size() <= kMaxChoicesBesideName ? joined : "NAME";
  }
  return type.kind == "TEXT" && !type.limit.empty() ? type.limit : type.kind;
}

/// The limits of a number, for instance "From 16 to 4096"; empty if it has none.
std::string range_of(const CLI::Option& option) {
  const std::string limit = ValueType(option).limit;
  const std::size_t begin = limit.find(" in [");
  const std::size_t dash = limit.find(" - ", begin);
  if (begin == std::string::npos || dash == std::string::npos) return "";
  return "From " + limit.substr(begin + 5, dash - begin - 5) + " to " +
         limit.substr(dash + 3, limit.size() - dash - 4);
}

/// The names of the options in `set`, in the order in which the command defines them.
std::string names_among(const CLI::App& command, const std::set<CLI::Option*>& set) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(command)) {
    const bool is_member =
        std::ranges::any_of(set, [&](const auto* member) { return member == option; });
    if (is_member) names.push_back(names_of(*option).back());
  }
  return listed(names);
}

/// The description of an option with its limits, its default, and the options it requires or
/// excludes.
std::string meaning_of(const CLI::App& command, const CLI::Option& option) {
  std::string text = option.get_description();
  const auto add = [&text](const std::string& label, const std::string& sentence) {
    if (!sentence.empty()) text += (text.ends_with('.') ? " " : ". ") + label + sentence;
  };
  const bool may_repeat =
      option.get_items_expected_max() > 1 && text.find("repeated") == std::string::npos;
  if (value_of(option) == "NAME") add("One of ", listed(choices_of(option)));
  add("", range_of(option));
  add("Default: ", option.get_default_str());
  add("", may_repeat ? "May be repeated" : "");
  add("", option.get_required() && option.nonpositional() ? "Required" : "");
  add("Requires ", names_among(command, option.get_needs()));
  add("Cannot be used with ", names_among(command, option.get_excludes()));
  return text.ends_with('.') ? text : text + ".";
}

std::vector<Item> items_of(const CLI::App& command, bool are_arguments) {
  std::vector<Item> items;
  for (const CLI::Option* option : options_of(command)) {
    if (option->nonpositional() == are_arguments) continue;
    items.push_back({listed(names_of(*option)), are_arguments ? "" : value_of(*option),
                     meaning_of(command, *option)});
  }
  return items;
}

/// "device-accept" for touchtrial device accept.
std::string page_name(const CLI::App& command) {
  const std::string words = full_name_of(command, "-");
  return words.substr(words.find('-') + 1);
}

/// The subcommands by group.
std::vector<Section> command_sections(const CLI::App& command) {
  std::vector<Section> sections;
  for (const CLI::App* subcommand : command.get_subcommands({})) {
    if (subcommand->get_group().empty()) continue;
    // The parser's default group.
    const std::string group =
        subcommand->get_group() == "Subcommands" ? "Commands" : subcommand->get_group();
    auto section = std::ranges::find(sections, group, &Section::title);
    if (section == sections.end()) section = sections.insert(sections.end(), Section{group, {}});
    section->items.push_back(
        {subcommand->get_name(), "", subcommand->get_description(), page_name(*subcommand)});
  }
  return sections;
}

Page read_page(const CLI::App& command) {
  Page page{full_name_of(command), command.get_description(), full_name_of(command) + " [OPTIONS]",
            // Subcommands inherit the footer.
            command.get_parent() == nullptr ? command.get_footer() : "", command_sections(command)};
  for (const CLI::Option* option : options_of(command)) {
    if (option->nonpositional()) continue;
    const std::string name =
        option->get_name(true) + (option->get_items_expected_max() > 1 ? "..." : "");
    page.synopsis += option->get_required() ? " " + name : " [" + name + "]";
  }
  if (!page.sections.empty()) page.synopsis += " COMMAND";
  page.sections.push_back({"Arguments", items_of(command, true)});
  page.sections.push_back({"Options", items_of(command, false)});
  std::erase_if(page.sections, [](const Section& section) { return section.items.empty(); });
  return page;
}

/// \name The text of --help
///@{

std::string help_item(const Item& item) {
  std::string name = "  " + item.name + (item.value.empty() ? "" : " " + item.value);
  std::string own_line;
  if (name.size() + 2 > kNameColumns) own_line = std::exchange(name, "") + "\n";
  name.resize(kNameColumns, ' ');
  return own_line + analysis::wrapped(name, item.meaning, kHelpColumns);
}

std::string help(const Page& page) {
  std::string text = analysis::wrapped("", page.summary, kHelpColumns) + "\n" +
                     analysis::wrapped("Usage: ", page.synopsis, kHelpColumns);
  if (!page.start.empty()) text += "\n" + page.start + "\n";
  for (const Section& section : page.sections) {
    text += "\n" + section.title + ":\n";
    for (const Item& item : section.items) text += help_item(item);
  }
  return text;
}

///@}
/// \name man(7)
///@{

/// Escapes text for roff: hyphens that can be copied, no requests.
std::string roff_text(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const bool begins_line = safe.empty() || safe.back() == '\n';
    if (begins_line && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '-' || c == '\\') safe += '\\';
    safe += c == '\\' ? 'e' : c;
  }
  return safe;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n.TP\n0\nDone.\n.TP\n1\nFailed; the message gives the place and the remedy.\n"
    ".TP\n2\nThe arguments or the study file are wrong.\n.TP\n3\nThe data failed verification.\n";

std::string man(const Page& page, const CLI::App& command) {
  const std::string name = full_name_of(command, "-");
  std::string text = fmt::format(
      ".TH \"{}\" 1 \"\" \"touchtrial {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH "
      "SYNOPSIS\n\\fB{}\\fR\n",
      roff_text(upper_case(name)), program_version(), roff_text(name), roff_text(page.summary),
      roff_text(page.synopsis));
  if (!page.start.empty()) text += ".PP\n.nf\n" + roff_text(page.start) + "\n.fi\n";
  for (const Section& section : page.sections) {
    text += ".SH " + upper_case(section.title) + "\n";
    for (const Item& item : section.items) {
      text += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff_text(item.name),
                          item.value.empty() ? "" : " \\fI" + roff_text(item.value) + "\\fR",
                          roff_text(item.meaning));
    }
  }
  text += std::string(kExitStatus) + ".SH SEE ALSO\n";
  std::vector<const CLI::App*> related = command.get_subcommands({});
  std::erase_if(related,
                [](const CLI::App* subcommand) { return subcommand->get_group().empty(); });
  if (command.get_parent() != nullptr) related.insert(related.begin(), command.get_parent());
  return text +
         listed(related, ", ",
                [](const CLI::App* other) {
                  return "\\fB" + roff_text(full_name_of(*other, "-")) + "\\fR(1)";
                }) +
         "\n";
}

///@}
/// \name Markdown
///@{

std::string with_backslashes(std::string_view text, std::string_view special) {
  std::string safe;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) safe += '\\';
    safe += c;
  }
  return safe;
}

std::string markdown(const Page& page) {
  std::string text = fmt::format("# {}\n\n{}{}\n\n```text\n{}\n```\n", page.name, page.summary,
                                 page.summary.ends_with('.') ? "" : ".", page.synopsis);
  if (!page.start.empty()) text += "\n```text\n" + page.start + "\n```\n";
  for (const Section& section : page.sections) {
    const bool are_commands = !section.items.front().page.empty();
    text += fmt::format("\n## {}\n\n| {} | meaning |\n| --- | --- |\n", section.title,
                        are_commands ? "command" : "name");
    for (const Item& item : section.items) {
      const std::string value = item.value.empty() ? "" : " " + item.value;
      const std::string name = are_commands ? fmt::format("[{}]({}.md)", item.name, item.page)
                                            : "`" + with_backslashes(item.name + value, "|") + "`";
      text += fmt::format("| {} | {} |\n", name, with_backslashes(item.meaning, "|<*_["));
    }
  }
  return text;
}

///@}

}  // namespace

std::string page_of(const CLI::App& command, PageFormat format) {
  const Page page = read_page(command);
  if (format == PageFormat::help) return help(page);
  return format == PageFormat::man ? man(page, command) : markdown(page);
}

std::string full_name_of(const CLI::App& command, const std::string& separator) {
  const CLI::App* const parent = command.get_parent();
  return (parent == nullptr ? "" : full_name_of(*parent, separator) + separator) +
         command.get_name();
}

const CLI::App& command_named(const CLI::App& parent, const std::string& name) {
  const std::vector<const CLI::App*> commands = parent.get_subcommands({});
  const auto match = std::ranges::find(commands, name, &CLI::App::get_name);
  if (match != commands.end()) return **match;
  std::vector<std::string_view> names;
  for (const CLI::App* command : commands) names.emplace_back(command->get_name());
  const auto nearest = nearest_name(name, names);
  throw UsageError(one_line(name) + ": is not a command; " +
                   (nearest ? "did you mean " + std::string(*nearest) + "?"
                            : "see " + full_name_of(parent) + " --help"));
}

std::vector<const CLI::App*> every_command(const CLI::App& command) {
  std::vector<const CLI::App*> all{&command};
  for (const CLI::App* subcommand : command.get_subcommands({})) {
    if (subcommand->get_group().empty()) continue;
    std::ranges::copy(every_command(*subcommand), std::back_inserter(all));
  }
  return all;
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> options =
      command.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
  std::stable_partition(options.begin(), options.end(),
                        [](const auto* option) { return !option->nonpositional(); });
  return options;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (!option.nonpositional()) return {option.get_name(true)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  const ValueType type(option);
  const bool is_set = type.limit.starts_with('{') && type.limit.ends_with('}');
  if (!is_set && type.kind.find('|') == std::string::npos) return {};
  std::istringstream all(is_set ? type.limit.substr(1, type.limit.size() - 2) : type.kind);
  std::vector<std::string> choices;
  for (std::string choice; std::getline(all, choice, is_set ? ',' : '|');) {
    choices.push_back(choice);
  }
  return choices;
}

}  // namespace touchtrial::app
