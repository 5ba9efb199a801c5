#include "app/shipped_files.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"

#include <string>
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

}  // namespace

fs::path shipped_folder() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  const fs::path installed = program.parent_path().parent_path() / "share" / "touchtrial";
  if (holds_examples(installed)) return installed;
  const fs::path source = program.parent_path().parent_path().parent_path();
  if (holds_examples(source)) return source;
  throw FileError(
      one_line(installed.string()) +
      ": has none of the ready studies, which are installed there; install Touchtrial again");
}

void copy_examples(const fs::path& folder) {
  const fs::path shipped = shipped_folder();
  std::error_code unreadable;
  if (is_there(folder) && !fs::is_empty(folder, unreadable)) {
    throw UsageError(one_line(folder.string()) + ": exists already; name a new folder");
  }
  try {
    for (const char* part : {"config", "stimuli"}) copy_below(shipped / part, folder / part);
  } catch (const fs::filesystem_error& error) {
    throw FileError(one_line(error.path1().string()) + ": " + error.code().message());
  }
}

}  // namespace touchtrial::app
