// Manual pages: man(7).
#include "app/reference/reference_pages.hpp"
#include "core/version.hpp"

#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::app {
namespace {

/// Text that the formatter takes as it is: hyphens that can be copied, no requests.
std::string in_roff(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    const bool begins_line = safe.empty() || safe.back() == '\n';
    if (begins_line && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '-') {
      safe += "\\-";
    } else if (c == '\\') {
      safe += "\\e";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string page_name(const CommandDefinition& command) {
  return fmt::format("{}", fmt::join(command.words, "-"));
}

std::string names_of(const OptionDefinition& option) {
  std::string names;
  for (const std::string& name : option.names) {
    names += (names.empty() ? "\\fB" : ", \\fB") + in_roff(name) + "\\fR";
  }
  if (!option.value.empty() && !option.is_argument)
    names += " \\fI" + in_roff(option.value) + "\\fR";
  return names;
}

std::string items(const CommandDefinition& command, bool are_arguments) {
  std::string text;
  for (const OptionDefinition& option : command.options) {
    if (option.is_argument != are_arguments) continue;
    text += fmt::format(".TP\n{}\n{}\n", names_of(option), in_roff(whole_meaning(option)));
  }
  return text;
}

constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n.TP\n0\nDone.\n.TP\n1\nFailed; the message says where, and what to "
    "do.\n.TP\n2\n"
    "The arguments or the study file are wrong.\n.TP\n3\nThe data failed verification.\n";

}  // namespace

std::string man_page(const CommandDefinition& program, const CommandDefinition& command) {
  const std::string name = page_name(command);
  std::string upper = name;
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  std::string page = fmt::format(
      ".TH \"{}\" 1 \"\" \"touchtrial {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n.SH "
      "SYNOPSIS\n\\fB{}\\fR\n",
      in_roff(upper), program_version(), in_roff(name), in_roff(command.summary),
      in_roff(command.synopsis()));
  if (const std::string arguments = items(command, true); !arguments.empty()) {
    page += ".SH ARGUMENTS\n" + arguments;
  }
  if (!command.commands.empty()) {
    page += ".SH COMMANDS\n";
    for (const CommandDefinition& below : command.commands) {
      page += fmt::format(".TP\n\\fB{}\\fR\n{}. See \\fB{}\\fR(1).\n", in_roff(below.words.back()),
                          in_roff(below.summary), in_roff(page_name(below)));
    }
  }
  page += ".SH OPTIONS\n" + items(command, false) + kExitStatus + ".SH SEE ALSO\n";
  std::string others;
  for (const CommandDefinition* one : every_command(program)) {
    const bool is_parent = one->words.size() + 1 == command.words.size() &&
                           std::equal(one->words.begin(), one->words.end(), command.words.begin());
    const bool is_below =
        one->words.size() == command.words.size() + 1 &&
        std::equal(command.words.begin(), command.words.end(), one->words.begin());
    if (is_parent || is_below)
      others += (others.empty() ? "\\fB" : ",\n\\fB") + in_roff(page_name(*one)) + "\\fR(1)";
  }
  return page + others + "\n";
}

}  // namespace touchtrial::app
