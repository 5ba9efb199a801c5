#include "stimuli/import/draft_folder.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"

#include <system_error>

#include <unistd.h>

namespace touchtrial::stimuli {
namespace {

namespace fs = std::filesystem;

/// A hidden name beside the target, so that the rename stays on one disk.
fs::path beside(const fs::path& target, const std::string& purpose) {
  const std::string name = target.filename().string();
  return target.parent_path() / ("." + name + "." + purpose + std::to_string(::getpid()));
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (!error) return;
  throw FileError(one_line(to.string()) + ": cannot be written (" + error.message() +
                  "); check the folder and its permissions");
}

}  // namespace

DraftFolder::DraftFolder(fs::path target)
    : target_(std::move(target)), draft_(beside(target_, "draft")) {
  std::error_code error;
  fs::remove_all(draft_, error);
  if (fs::create_directory(draft_, error)) return;
  throw FileError(one_line(target_.string()) + ": cannot be made (" + error.message() +
                  "); check the folder above it and its permissions");
}

DraftFolder::~DraftFolder() {
  std::error_code ignored;
  if (!kept_) {
    fs::remove_all(in_place_ ? target_ : draft_, ignored);
    if (!earlier_.empty()) fs::rename(earlier_, target_, ignored);
  }
}

void DraftFolder::put_in_place() {
  if (is_there(target_)) {
    const fs::path aside = beside(target_, "earlier");
    move(target_, aside);
    earlier_ = aside;
  }
  move(draft_, target_);
  in_place_ = true;
}

void DraftFolder::keep() noexcept {
  kept_ = true;
  std::error_code ignored;
  if (!earlier_.empty()) fs::remove_all(earlier_, ignored);
}

}  // namespace touchtrial::stimuli
