/// \file The ready studies, with their pictures and subject files, wherever the program is installed.
#pragma once

#include <filesystem>

namespace touchtrial::app {

/// The folder that holds `config` and `stimuli`: ../share/touchtrial beside an installed program's
/// folder, or the source tree of one that runs where it was built.
/// \throws FileError, with the places that were looked at, if neither has them
[[nodiscard]] std::filesystem::path shipped_folder();

/// Copies the ready studies and what they name, in the same layout, into a new or empty folder.
/// \throws UsageError if the folder has something in it
/// \throws FileError with the system's reason; what was copied before stays
void copy_examples(const std::filesystem::path& folder);

}  // namespace touchtrial::app
