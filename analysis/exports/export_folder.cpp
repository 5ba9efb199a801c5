#include "analysis/exports/export_folder.hpp"

#include "core/errors.hpp"

#include <system_error>

namespace touchtrial {

void make_export_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (std::filesystem::is_directory(folder)) return;
  const std::string reason = error ? error.message() : "a file of that name exists";
  throw FileError(one_line(folder.string()) + ": cannot be made a folder (" + reason +
                  "); give another folder or change its permissions");
}

}  // namespace touchtrial
