/// \file Utilities of commands: output, confirmation, progress, time, and file extensions.
#pragma once

#include "core/errors.hpp"
#include "core/strict_json.hpp"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace touchtrial::app {

/// The reader of standard output has exited, as in `touchtrial report DB | head -1`. The program
/// then exits silently.
class ClosedPipe : public FileError {
 public:
  using FileError::FileError;
};

/// Prints to standard output, escaped as in core/printable.hpp.
/// \throws ClosedPipe if the reader has exited
/// \throws FileError if it cannot be written, for instance to a full disk
void print(const std::string& text);

/// Asks for confirmation at the terminal, before anything is done; `--yes` answers in advance
/// (add_yes_flag).
/// \param description  one line: the participant concerned, and what will be lost or shown
/// \param yes  --yes: nothing is printed or asked
/// \throws UsageError if the answer is not "yes", or standard input is not a terminal
void confirm(const std::string& description, bool yes);

/// The width of the terminal on standard output, clamped to 80 to 100 columns; 100 for a file or
/// pipe (analysis::kTextWidth).
[[nodiscard]] std::size_t columns_of_output();

/// An argument quoted for a shell.
[[nodiscard]] std::string shell_word(const std::string& text);

/// A progress bar on standard error. It appears only on a terminal and after one second, and
/// disappears when the work ends. Call it from one thread.
[[nodiscard]] std::function<void(int done, int total)> progress_bar(const std::string& label);

/// Nanoseconds since 1970, UTC.
[[nodiscard]] std::chrono::nanoseconds utc_now();

/// The extension of a file name in lower case, with its dot: ".png" of "A.PNG".
[[nodiscard]] std::string ending_of(const std::filesystem::path& file);

}  // namespace touchtrial::app
