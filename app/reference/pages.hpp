/// \file The page of a command, generated from the parser: for `--help`, as manual page, and for
///   the documentation.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

enum class PageFormat { help, man, markdown };

/// The page of a command, without hidden options and subcommands.
[[nodiscard]] std::string page_of(const CLI::App& command, PageFormat format);

/// Shows page_of in place of the parser's own help.
class PageFormatter final : public CLI::FormatterBase {
 public:
  [[nodiscard]] std::string make_help(const CLI::App* command, std::string /*name*/,
                                      CLI::AppFormatMode /*mode*/) const override {
    return page_of(*command, PageFormat::help);
  }
};

/// The full name of a command, for instance "touchtrial device accept".
/// \param separator  text between the words
[[nodiscard]] std::string full_name_of(const CLI::App& command, const std::string& separator = " ");

/// The subcommand of this name.
/// \throws UsageError that names the nearest command if there is none
[[nodiscard]] const CLI::App& command_named(const CLI::App& parent, const std::string& name);

/// The command and everything below it that is not hidden, each before its subcommands.
[[nodiscard]] std::vector<const CLI::App*> every_command(const CLI::App& command);

/// The options and arguments of a command that are not hidden; arguments first.
[[nodiscard]] std::vector<const CLI::Option*> options_of(const CLI::App& command);

/// The names of an option, for instance "-o" and "--out", or the name of an argument.
[[nodiscard]] std::vector<std::string> names_of(const CLI::Option& option);

/// The allowed values of an option with a fixed list; otherwise empty.
[[nodiscard]] std::vector<std::string> choices_of(const CLI::Option& option);

}  // namespace touchtrial::app
