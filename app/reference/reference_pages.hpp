/// \file Manual pages, pages of the documentation, and completions for shells, from the definitions of
/// the commands. Private to app.
#pragma once

#include "app/reference/command_definition.hpp"

#include <string>

namespace touchtrial::app {

/// A page of section 1, in the man macros.
/// \param program  which `command` is part of
[[nodiscard]] std::string man_page(const CommandDefinition& program,
                                   const CommandDefinition& command);

/// A page of the documentation, in Markdown; those of the commands below are named after their
/// words, "device-accept.md".
[[nodiscard]] std::string markdown_page(const CommandDefinition& command);

[[nodiscard]] std::string bash_completion(const CommandDefinition& program);
[[nodiscard]] std::string zsh_completion(const CommandDefinition& program);
[[nodiscard]] std::string fish_completion(const CommandDefinition& program);

}  // namespace touchtrial::app
