#include "app/commands/shipped_files.hpp"

#include "app/commands/made_folder.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <system_error>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

bool holds_examples(const fs::path& folder) {
  return is_there(folder / "config" / "classification.json") &&
         is_there(folder / "stimuli" / "manifest.json");
}

/// Studies, subject and device files, schemas, texts and pictures; neither sources nor packs.
void copy_below(const fs::path& from, const fs::path& to) {
  for (const fs::directory_entry& entry : fs::directory_iterator(from)) {
    const fs::path ending = entry.path().extension();
    const fs::path target = to / entry.path().filename();
    if (entry.is_directory() && ending != ".pack") {
      copy_below(entry.path(), target);
    } else if (ending == ".json" || ending == ".png") {
      make_folder(to);
      replace_file(target, read_file(entry.path()));
    }
  }
}

/// Possible locations: beside an installed program's folder, and in the source tree.
std::array<fs::path, 2> places() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  const fs::path folder = program.parent_path();
  return {folder.parent_path() / "share" / "touchtrial", folder.parent_path().parent_path()};
}

}  // namespace

fs::path shipped_folder() {
  for (const fs::path& place : places()) {
    if (holds_examples(place)) return place;
  }
  throw FileError(
      one_line(places().front().string()) +
      ": has none of the ready studies, which are installed there; install Touchtrial again");
}

void copy_examples(const fs::path& folder) {
  const fs::path shipped = shipped_folder();
  MadeFolder made(folder);
  try {
    for (const char* part : {"config", "stimuli"}) copy_below(shipped / part, folder / part);
  } catch (const fs::filesystem_error& error) {
    throw FileError(one_line(error.path1().string()) + ": " + error.code().message());
  }
  made.keep();
}

void refuse_installed_study(const fs::path& study) {
  std::error_code unknown;
  const fs::path installed = fs::canonical(places().front(), unknown);
  if (unknown) return;
  const fs::path place = fs::canonical(study, unknown);
  if (unknown) return;
  const auto [end, ignored] =
      std::mismatch(installed.begin(), installed.end(), place.begin(), place.end());
  if (end != installed.end()) return;
  throw UsageError(
      one_line(study.string()) +
      ": is part of the installation, where no pack can be created; copy the ready studies with "
      "`touchtrial examples FOLDER`, and use that copy");
}

}  // namespace touchtrial::app
