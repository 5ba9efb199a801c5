/// \file Runs the built program as a user would.
#pragma once

#include "support/names.hpp"

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace touchtrial {

struct ProgramResult {
  int exit_code = -1;  ///< -1 if it died by a signal
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

/// Runs `PROGRAM ARGUMENTS` to its end.
/// \param folder  a folder for its output while it runs
/// \param input  its standard input
[[nodiscard]] ProgramResult run_program(const std::filesystem::path& program,
                                        const std::filesystem::path& folder,
                                        const std::vector<std::string>& arguments,
                                        const std::string& input = "");

/// The same for `touchtrial`.
[[nodiscard]] ProgramResult run_touchtrial(const std::filesystem::path& folder,
                                           const std::vector<std::string>& arguments,
                                           const std::string& input = "");
/// The words of a line as a shell would have them: blanks separate, but for those between single
/// quotes. A word that begins with @ names a file of the folder.
[[nodiscard]] std::vector<std::string> typed_words(const std::string& line,
                                                   const std::filesystem::path& folder);

/// Fails the test unless the program ended with 0.
/// \return the same result
ProgramResult succeeded(const ProgramResult& result);

/// Checks for this exit code, no output, and one line of errors that names every part
/// (support/names.hpp).
void check_refused(const ProgramResult& result, int exit_code,
                   const std::vector<std::string>& parts);

/// run_touchtrial under the limits that a shell's `ulimit` sets, for instance "-f 8".
[[nodiscard]] ProgramResult run_touchtrial_limited(const std::filesystem::path& folder,
                                                   const std::string& limit,
                                                   const std::vector<std::string>& arguments);

/// `touchtrial` on a terminal of its own.
class TerminalRun {
 public:
  explicit TerminalRun(std::vector<std::string> arguments);
  ~TerminalRun();
  TerminalRun(const TerminalRun&) = delete;
  TerminalRun& operator=(const TerminalRun&) = delete;

  /// Reads until the text was shown, then types the line. Fails the test if the program ends
  /// before, or does not show it for two minutes.
  void answer(const std::string& prompt, const std::string& line);
  /// Like `answer` with an empty line, whose Enter is held down for so long, as a keyboard repeats
  /// it: for the second time after 660 ms, then every 40 ms.
  void hold_enter(const std::string& prompt, std::chrono::milliseconds held);
  /// Presses these keys now, if the program has not ended.
  void press(const std::string& keys);
  /// Whether the text is shown, or will be within that time.
  [[nodiscard]] bool shows(const std::string& text, std::chrono::milliseconds longest);
  /// Whether all that the program ever showed was read.
  [[nodiscard]] bool ended() const noexcept { return ended_; }
  /// The exit code. Fails the test if the program runs for two minutes more.
  [[nodiscard]] int finish();
  [[nodiscard]] const std::string& shown() const { return shown_; }

 private:
  /// Reads until the text is shown at or after `from`, or to the end if it is empty or missing.
  /// \return whether it was shown within that time
  bool read_until(const std::string& text, std::size_t from, std::chrono::milliseconds longest);

  int terminal_ = -1;
  pid_t child_ = -1;
  std::string shown_;
  std::size_t read_ = 0;
  bool ended_ = false;
};

/// The number of lines in a text, the last one finished or not.
[[nodiscard]] int line_count(const std::string& text);

}  // namespace touchtrial
