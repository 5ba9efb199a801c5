#include "app/commands/new_folder.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"

#include <string>
#include <system_error>

namespace touchtrial::app {

namespace fs = std::filesystem;

NewFolder::NewFolder(const fs::path& folder) : folder_(folder), existed_(path_exists(folder)) {
  require_free(folder);
  for (topmost_ = folder;
       !existed_ && topmost_.has_parent_path() && !path_exists(topmost_.parent_path());) {
    topmost_ = topmost_.parent_path();
  }
  make_folder(folder);
}

NewFolder::~NewFolder() {
  if (is_kept_) return;
  std::error_code ignored;
  if (!existed_) {
    fs::remove_all(topmost_, ignored);
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
  if (!path_exists(place)) return;
  std::error_code unreadable;
  const std::string name = one_line(folder.string());
  if (!fs::is_directory(place, unreadable))
    throw UsageError(name + ": is a file; name a new folder");
  if (!fs::is_empty(place, unreadable))
    throw UsageError(name + ": exists already; name a new folder");
}

}  // namespace touchtrial::app
