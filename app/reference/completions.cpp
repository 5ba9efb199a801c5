// Completions for bash, zsh and fish. Where a value is expected that is none of a few, the shell
// completes names of files.
#include "app/reference/reference_pages.hpp"

#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::app {
namespace {

/// In single quotes, for any of the shells.
std::string in_single_quotes(std::string_view text) {
  std::string safe = "'";
  for (const char c : text) safe += c == '\'' ? "'\\''" : std::string(1, c);
  return safe + "'";
}

std::string names_of_commands(const CommandDefinition& command) {
  std::string names;
  for (const CommandDefinition& below : command.commands) names += " " + below.words.back();
  return names;
}

/// What may stand where a word of the command is expected: commands, values of its first argument,
/// options.
std::string words_of(const CommandDefinition& command) {
  std::string words = names_of_commands(command);
  for (const OptionDefinition& option : command.options) {
    words += fmt::format(" {}", fmt::join(option.is_argument ? option.choices : option.names, " "));
  }
  return words;
}

/// Text of a zsh specification, in which brackets and colons separate.
std::string in_specification(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') safe += '\\';
    safe += c;
  }
  return safe;
}

std::string zsh_value(const OptionDefinition& option) {
  const std::string action =
      option.choices.empty() ? "_files" : fmt::format("({})", fmt::join(option.choices, " "));
  return fmt::format(
      ":{}:{}", in_specification(option.is_argument ? option.names.front() : option.value), action);
}

std::string zsh_specifications(const CommandDefinition& command) {
  std::string text;
  for (const OptionDefinition& option : command.options) {
    if (option.is_argument) {
      text += " \\\n    " + in_single_quotes((option.is_repeated ? "*" : "") + zsh_value(option));
      continue;
    }
    for (const std::string& name : option.names) {
      std::string one =
          (option.is_repeated ? "*" : "") + name + "[" + in_specification(option.meaning) + "]";
      if (!option.value.empty()) one += zsh_value(option);
      text += " \\\n    " + in_single_quotes(one);
    }
  }
  return text;
}

std::string zsh_function(const CommandDefinition& command) {
  return fmt::format("_{}", fmt::join(command.words, "_"));
}

}  // namespace

std::string bash_completion(const CommandDefinition& program) {
  std::string paths;
  std::string words;
  std::string choices;
  for (const CommandDefinition* command : every_command(program)) {
    const std::string path = command->path();
    if (!path.empty()) paths += (paths.empty() ? "" : "|") + in_single_quotes(path);
    words += fmt::format("    {}) words={} ;;\n", in_single_quotes(path),
                         in_single_quotes(words_of(*command)));
    for (const OptionDefinition& option : command->options) {
      if (option.value.empty() || option.is_argument) continue;
      for (const std::string& name : option.names) {
        choices += fmt::format("    {}) words={}; wants_value=yes ;;\n",
                               in_single_quotes(path + ":" + name),
                               in_single_quotes(fmt::format("{}", fmt::join(option.choices, " "))));
      }
    }
  }
  return fmt::format(R"bash(# Completion of touchtrial for bash.
_touchtrial() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} path='' words='' wants_value='' word longer
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    longer=${{path:+$path }}$word
    case $longer in
    {}) path=$longer ;;
    esac
  done
  case $path in
{}  esac
  case $path:${{COMP_WORDS[COMP_CWORD-1]}} in
{}  esac
  COMPREPLY=()
  if [ -z "$wants_value" ] && [ "${{current#-}}" = "$current" ]; then
    for word in $words; do
      case $word in -*) ;; "$current"*) COMPREPLY+=("$word") ;; esac
    done
  else
    for word in $words; do
      case $word in "$current"*) COMPREPLY+=("$word") ;; esac
    done
  fi
}}
complete -o default -F _touchtrial touchtrial
)bash",
                     paths, words, choices);
}

std::string zsh_completion(const CommandDefinition& program) {
  std::string text = "#compdef touchtrial\n# Completion of touchtrial for zsh.\n";
  for (const CommandDefinition* command : every_command(program)) {
    text += fmt::format("\n{}() {{\n", zsh_function(*command));
    if (command->commands.empty()) {
      text += "  _arguments -s" + zsh_specifications(*command) + "\n}\n";
      continue;
    }
    text += "  local line state\n  _arguments -C" + zsh_specifications(*command) +
            " \\\n    '1: :->command' \\\n    '*:: :->arguments'\n  case $state in\n  command)\n   "
            " local -a "
            "commands=(\n";
    for (const CommandDefinition& below : command->commands) {
      text += "      " +
              in_single_quotes(below.words.back() + ":" + in_specification(below.summary)) + "\n";
    }
    text += "    )\n    _describe command commands ;;\n  arguments)\n    case $line[1] in\n";
    for (const CommandDefinition& below : command->commands) {
      text += fmt::format("    {}) {} ;;\n", below.words.back(), zsh_function(below));
    }
    text += "    esac ;;\n  esac\n}\n";
  }
  return text + "\n_touchtrial \"$@\"\n";
}

std::string fish_completion(const CommandDefinition& program) {
  std::string paths;
  std::string lines;
  for (const CommandDefinition* command : every_command(program)) {
    const std::string path = command->path();
    if (!path.empty()) paths += " " + in_single_quotes(path);
    const std::string at = "complete -c touchtrial -n " +
                           in_single_quotes("__touchtrial_at " + in_single_quotes(path));
    for (const CommandDefinition& below : command->commands) {
      lines += fmt::format("{} -f -a {} -d {}\n", at, in_single_quotes(below.words.back()),
                           in_single_quotes(below.summary));
    }
    for (const OptionDefinition& option : command->options) {
      const std::string choices = fmt::format("{}", fmt::join(option.choices, " "));
      if (option.is_argument) {
        if (!choices.empty()) lines += fmt::format("{} -a {}\n", at, in_single_quotes(choices));
        continue;
      }
      std::string one = at;
      for (const std::string& name : option.names) {
        one += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (!option.value.empty())
        one += choices.empty() ? " -r" : " -x -a " + in_single_quotes(choices);
      lines += one + " -d " + in_single_quotes(option.meaning) + "\n";
    }
  }
  return fmt::format(R"fish(# Completion of touchtrial for fish.
function __touchtrial_at --description 'Whether the command so far is this one'
    set -l path
    for word in (commandline -opc)[2..-1]
        set -l longer (string join ' ' -- $path $word)
        contains -- $longer{} && set path $longer
    end
    test "$path" = "$argv[1]"
end
{})fish",
                     paths, lines);
}

}  // namespace touchtrial::app
