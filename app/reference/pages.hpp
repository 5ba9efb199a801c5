/// \file The page of a command, generated from the parser: for `--help`, as manual page, and for
///   the documentation.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

enum class PageFormat { help, man, markdown };

/// The page of a command, without hidden parts.
[[nodiscard]] std::string page_of(const CLI::App& command, PageFormat format);

/// Shows page_of in place of the parser's own help.
class PageFormatter final : public CLI::FormatterBase {
 public:
  [[nodiscard]] std::string make_help(const CLI::App* command, std::string /*name*/,
                                      CLI::AppFormatMode /*mode*/) const override {
    return page_of(*command, PageFormat::help);
  }
};

/// The words of a command, "touchtrial device accept".
/// \param between  them
[[nodiscard]] std::string words_of(const CLI::App& command, const std::string& between = " ");

/// The subcommand of this name.
/// \throws UsageError that names the nearest if there is none
[[nodiscard]] const CLI::App& command_named(const CLI::App& above, const std::string& name);

/// The program and all commands below it that are not hidden, each before its own.
[[nodiscard]] std::vector<const CLI::App*> every_command(const CLI::App& command);

/// The options and arguments of a command that are not hidden; arguments first.
[[nodiscard]] std::vector<const CLI::Option*> options_of(const CLI::App& command);

/// "-o", "--out"; for an argument only its name.
[[nodiscard]] std::vector<std::string> names_of(const CLI::Option& option);

/// All values that an option takes, if they are few; else empty.
[[nodiscard]] std::vector<std::string> choices_of(const CLI::Option& option);

}  // namespace touchtrial::app
