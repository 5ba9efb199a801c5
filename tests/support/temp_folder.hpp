/// \file A folder that lives as long as a test.
#pragma once

#include <filesystem>

namespace touchtrial {

/// Makes an empty folder of its own and removes it with everything in it.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace touchtrial
