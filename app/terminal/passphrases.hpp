/// \file Passphrases of protected files: from the files of --passphrase-file, otherwise from the
/// terminal. Never from the command line, which every user of the machine can read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::app {

/// The files of --passphrase-file, filled by the parser.
[[nodiscard]] std::vector<std::filesystem::path>& passphrase_files();

/// Provides passphrases when protected files are opened: the first line of each passphrase file in
/// turn, otherwise from the terminal, without echo.
void provide_passphrases();

/// A passphrase for a file to protect: the first line of the first of `sources`, or else typed
/// twice at the terminal.
/// \throws UsageError if the two differ, the prompt is cancelled, or standard input is not a
///   terminal
/// \throws FileError if the source cannot be read, is empty, or is a file that others may read
[[nodiscard]] std::string new_passphrase(const std::filesystem::path& file,
                                         const std::vector<std::filesystem::path>& sources);

}  // namespace touchtrial::app
