/// \file docs/monday-morning.md, and a desk at which its commands are typed.
#pragma once

#include "app/study_folder.hpp"
#include "app/touchtrial_process.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace touchtrial {

/// One case of the page.
struct MondayCase {
  int lines = 0;                                 ///< of text and commands
  std::vector<std::vector<std::string>> blocks;  ///< of commands
};

/// The cases by their headings, and what stands before the first under "".
[[nodiscard]] std::map<std::string, MondayCase> monday_cases();

/// A case's block of commands, from 0. The test fails if the page has none.
[[nodiscard]] std::vector<std::string> monday_block(const std::string& heading, std::size_t block);

/// A station and what belongs to it: folders `home/study` (where one is), `home/investigator`,
/// which alone has the key, and `media/stick` and `media/backup`, which commands call /media/stick
/// and /media/backup. `run` presents simulated participants.
class MondayDesk {
 public:
  /// Prepares a study of 18 trials.
  MondayDesk();

  [[nodiscard]] const fs::path& root() const { return folder_.path(); }
  [[nodiscard]] fs::path study() const { return root() / "home" / "study"; }
  [[nodiscard]] fs::path investigator() const { return root() / "home" / "investigator"; }

  /// Types one command.
  ProgramResult type(const std::string& command, const std::string& input = "");
  /// Types a block's commands, of which all must succeed.
  /// \return what the last one printed
  ProgramResult type_all(const std::vector<std::string>& commands);
  void go_to(const fs::path& folder) { here_ = folder; }

  /// A session from its beginning to its end.
  void complete(const std::string& participant);
  /// A session that a signal ends after a trial.
  /// \return what was printed
  std::string break_off(const std::string& participant, int trial, int signal);

  /// What is wrong with the machine while programs run; 0: nothing. `sudo date` mends the clock.
  void set_clock_ahead(long seconds);
  void fill_disk_after(long bytes);

 private:
  [[nodiscard]] std::string script(const std::string& command) const;

  TempFolder folder_;
  fs::path here_;
};

}  // namespace touchtrial
