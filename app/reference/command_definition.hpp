/// \file The program's commands as data, read off the parser: what manual pages, pages of the
/// documentation and completions are made of. Private to app.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace touchtrial::app {

/// An option or an argument of a command.
struct OptionDefinition {
  std::vector<std::string> names;    ///< "-o", "--out"; of an argument its name alone
  std::string value;                 ///< what follows, "FILE" or "float|double"; of a flag empty
  std::vector<std::string> choices;  ///< all values that it takes, if they are few; else empty
  std::string range;                 ///< "16 to 4096", or empty
  std::string usual;                 ///< the default, or empty
  std::string meaning;
  std::vector<std::string> needs, excludes;  ///< names of other options
  bool is_argument = false;
  bool is_required = false;
  bool is_repeated = false;  ///< takes several values
};

/// A command; the first is the program itself.
struct CommandDefinition {
  std::vector<std::string> words;  ///< "touchtrial", "device", "accept"
  std::string summary;
  std::vector<OptionDefinition> options;  ///< arguments too, in the order of the help
  std::vector<CommandDefinition> commands;

  /// The words with something between them: "device accept" without the program's name.
  [[nodiscard]] std::string path(const std::string& between = " ") const;
  /// How it is called: "touchtrial device accept [OPTIONS] [NAME]".
  [[nodiscard]] std::string synopsis() const;
};

/// What the parser offers, without what is hidden.
[[nodiscard]] CommandDefinition definition_of(const CLI::App& program);

/// The command, and all below it, each before its own.
[[nodiscard]] std::vector<const CommandDefinition*> every_command(const CommandDefinition& command);

/// All of an option's text but its names: meaning, range, default, what it needs and excludes.
[[nodiscard]] std::string whole_meaning(const OptionDefinition& option);

}  // namespace touchtrial::app
