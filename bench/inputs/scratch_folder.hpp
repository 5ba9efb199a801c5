/// \file Where a benchmark writes.
#pragma once

#include "core/errors.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace touchtrial::bench {

/// A folder of its own, gone afterwards.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name =
        (std::filesystem::temp_directory_path() / "touchtrial-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw FileError(name + ": cannot be made; make room or set TMPDIR");
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace touchtrial::bench
