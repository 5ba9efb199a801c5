#include "app/commands/made_folder.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"

#include <string>
#include <system_error>

namespace touchtrial::app {

namespace fs = std::filesystem;

MadeFolder::MadeFolder(const fs::path& folder) : folder_(folder), had_(is_there(folder)) {
  require_free(folder);
  for (first_ = folder; !had_ && first_.has_parent_path() && !is_there(first_.parent_path());) {
    first_ = first_.parent_path();
  }
  make_folder(folder);
}

MadeFolder::~MadeFolder() {
  if (is_kept_) return;
  std::error_code ignored;
  if (!had_) {
    fs::remove_all(first_, ignored);
    return;
  }
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
    fs::remove_all(entry.path(), ignored);
  }
}

void require_free(const fs::path& folder) {
  if (folder.empty()) throw UsageError("the folder's name is empty; name a new folder");
  // "new/.." is an existing folder even if "new" does not exist.
  const fs::path place = fs::absolute(folder).lexically_normal();
  if (!is_there(place)) return;
  std::error_code unreadable;
  const std::string name = one_line(folder.string());
  if (!fs::is_directory(place, unreadable))
    throw UsageError(name + ": is a file; name a new folder");
  if (!fs::is_empty(place, unreadable))
    throw UsageError(name + ": exists already; name a new folder");
}

}  // namespace touchtrial::app
