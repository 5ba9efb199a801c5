/// \file Files and folders that are made beside their place, and get its name when they are whole.
#pragma once

#include "core/bytes.hpp"
#include "core/files.hpp"

#include <filesystem>

namespace touchtrial {

/// Refuses a link in a file's place, which may lead to any other file. Links to folders above it
/// are the user's own.
/// \throws FileError naming the link and where it leads
void refuse_link(const std::filesystem::path& path);

/// Makes the names in a folder survive a power cut.
void sync_folder(const std::filesystem::path& folder) noexcept;

/// Something new in the folder of its future place. It is locked as long as its maker lives, and
/// named ".touchtrial-PROCESS-NUMBER.tmp": the first draft that a program makes in a folder removes
/// those there whose makers were killed. One thread at a time may use an object.
class Draft {
 public:
  enum class Kind { file, folder };

  /// Makes it, empty.
  /// \throws FileError with the system's reason; nothing is left then
  Draft(std::filesystem::path place, Kind kind, FileMode mode = FileMode::everyone);
  /// Removes it, and what is in a folder, unless it took its place.
  ~Draft();
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// The open draft.
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

  /// Writes the whole file and syncs it.
  /// \throws FileError with the system's reason
  void write(ByteView content) const;
  /// Takes the place, also of a file that has it.
  /// \throws FileError with the system's reason
  void replace();
  /// \return whether the place was free, and is taken now
  /// \throws FileError with the system's reason
  [[nodiscard]] bool take_free_place();

 private:
  [[nodiscard]] bool make(Kind kind, FileMode mode);

  std::filesystem::path place_;
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace touchtrial
