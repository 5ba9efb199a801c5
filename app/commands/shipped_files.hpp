/// \file Locates and copies the example studies with their pictures and subject files.
#pragma once

#include <filesystem>

namespace touchtrial::app {

/// The folder that contains `config` and `stimuli`: ../share/touchtrial beside an installed
/// program's folder, or the source tree of a program that runs where it was built.
/// \throws FileError, with the searched paths, if neither has them
[[nodiscard]] std::filesystem::path shipped_folder();

/// Copies the example studies and the files that they name, in the same layout, into a new or empty
/// folder.
/// \throws as require_free of app/commands/new_folder.hpp
/// \throws FileError with the system's reason; the folder is then removed
void copy_examples(const std::filesystem::path& folder);

/// Refuses a study file of an installation, because a pack would be created beside it.
/// \throws UsageError with the remedy
void refuse_installed_study(const std::filesystem::path& study);

}  // namespace touchtrial::app
