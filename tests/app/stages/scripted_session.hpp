/// \file A session whose participant and experimenter follow a script, through the program's own
/// parts but its device, window and time. The script writes down what both did and felt, and knows
/// nothing of what the program records.
#pragma once

#include "app/run/run_session.hpp"

#include <filesystem>
#include <string>

namespace touchtrial {

/// What the experimenter, or a power cut, does to the session, once.
struct Deed {
  std::string what;   ///< "pause", "stop", "own-stop", "abort", "note" (and half of a deviation),
                      ///< "leave", "kill"; "": nothing
  std::string stage;  ///< as the experimenter's status has it, and finer while a plane is on
  int time = 1;       ///< that the stage comes, from 1
  bool at_console = false;  ///< the experimenter uses the window instead of the terminal
};

/// Runs the session that the options name to its end, or to that of the deed.
/// \param log  a JSON object a line is appended to it: "is" says what happened
void run_scripted(const app::RunOptions& options, const Deed& deed,
                  const std::filesystem::path& log);

}  // namespace touchtrial
