/// \file Passphrases of protected files: from the files that --passphrase-file names, else asked
/// for on the terminal. They are never on the command line, which every user of the machine can
/// read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::app {

/// What --passphrase-file names; the parser fills it.
[[nodiscard]] std::vector<std::filesystem::path>& passphrase_files();

/// Answers whenever a protected file is opened: with the first line of each passphrase file in
/// turn, else from the terminal on standard input, without showing what is typed.
void answer_for_passphrases();

/// A passphrase for a file that is to be protected: the first line of the first of `sources`, or
/// without one what is typed twice on the terminal.
/// \throws UsageError if both are not the same, the question is broken off, or standard input is no
///   terminal
/// \throws FileError if the source cannot be read, is empty, or is a file that others may read
[[nodiscard]] std::string new_passphrase(const std::filesystem::path& file,
                                         const std::vector<std::filesystem::path>& sources);

}  // namespace touchtrial::app
