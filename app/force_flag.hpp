/// \file The one flag that lets outputs take places that are not free.
#pragma once

#include <CLI/CLI.hpp>

namespace touchtrial::app {

/// --force, for every command that writes where it is told to: see core/outputs.hpp.
CLI::Option* add_force_flag(CLI::App& command);

}  // namespace touchtrial::app
