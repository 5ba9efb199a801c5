/// \file What shells complete, for the scripts of config/completion.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

/// What may stand where, a row each: the command so far, a word that may follow, the values after
/// it, and its meaning, with bars between them. A word that takes no value has the value "-"; a row
/// without a word has the values of an argument. Where a value is expected and the row has none,
/// shells complete names of files.
[[nodiscard]] std::string completion_table(const CLI::App& program);

}  // namespace touchtrial::app
