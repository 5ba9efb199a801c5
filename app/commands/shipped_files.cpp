#include "app/commands/shipped_files.hpp"

#include "app/commands/new_folder.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <system_error>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

bool has_examples(const fs::path& folder) {
  return path_exists(folder / "config" / "classification.json") &&
         path_exists(folder / "stimuli" / "manifest.json");
}

/// Copies studies, subject and device files, schemas, texts and pictures, but neither source code
/// nor packs.
void copy_shipped_files(const fs::path& source, const fs::path& destination) {
  for (const fs::directory_entry& entry : fs::directory_iterator(source)) {
    const fs::path ending = entry.path().extension();
    const fs::path target = destination / entry.path().filename();
    if (entry.is_directory() && ending != ".pack") {
      copy_shipped_files(entry.path(), target);
    } else if (ending == ".json" || ending == ".png") {
      make_folder(destination);
      replace_file(target, read_file(entry.path()));
    }
  }
}

/// Possible locations: beside an installed program's folder, and in the source tree.
std::array<fs::path, 2> possible_folders() {
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);
  const fs::path folder = program.parent_path();
  return {folder.parent_path() / "share" / "touchtrial", folder.parent_path().parent_path()};
}

}  // namespace

fs::path shipped_folder() {
  for (const fs::path& place : possible_folders()) {
    if (has_examples(place)) return place;
  }
  throw FileError(one_line(possible_folders().front().string()) +
                  ": does not contain the example studies; reinstall Touchtrial");
}

void copy_examples(const fs::path& folder) {
  const fs::path source_folder = shipped_folder();
  NewFolder new_folder(folder);
  try {
    for (const char* part : {"config", "stimuli"})
      copy_shipped_files(source_folder / part, folder / part);
  } catch (const fs::filesystem_error& error) {
    throw FileError(one_line(error.path1().string()) + ": " + error.code().message());
  }
  new_folder.keep();
}

void refuse_installed_study(const fs::path& study) {
  std::error_code failure;
  const fs::path installation = fs::canonical(possible_folders().front(), failure);
  if (failure) return;
  const fs::path place = fs::canonical(study, failure);
  if (failure) return;
  const auto [end, ignored] =
      std::mismatch(installation.begin(), installation.end(), place.begin(), place.end());
  if (end != installation.end()) return;
  throw UsageError(
      one_line(study.string()) +
      ": is part of the installation, where no pack can be created; copy the example studies with "
      "`touchtrial examples FOLDER`, and use that copy");
}

}  // namespace touchtrial::app
