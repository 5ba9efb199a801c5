/// \file Whole files: read, replaced without a moment of half-written content, mapped read-only.
#pragma once

#include "core/bytes.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace touchtrial {

/// Who may read a file that the program writes.
enum class FileMode { everyone, owner_only };

/// \param limit_bytes  refuses a larger file before reading it
/// \throws FileError if the file is missing, a folder, unreadable or larger than the limit
[[nodiscard]] Bytes read_file(const std::filesystem::path& path,
                              std::uintmax_t limit_bytes = std::uintmax_t{1} << 32U);

/// Writes beside the target, syncs, and renames over it: after a crash the file is the old one or
/// the new one, never half of it. A link is followed; devices and pipes are refused. \throws
/// FileError with the system's reason
void replace_file(const std::filesystem::path& path, ByteView content,
                  FileMode mode = FileMode::everyone);
void replace_file(const std::filesystem::path& path, std::string_view content,
                  FileMode mode = FileMode::everyone);

/// Makes a folder, and those above it, where it is missing.
/// \throws FileError if there is no such folder afterwards
void make_folder(const std::filesystem::path& folder);

/// Gives a whole file its name, if nothing else has that name, and syncs the folder.
/// \return whether the name was free
/// \throws FileError with the system's reason
[[nodiscard]] bool move_to_free_name(const std::filesystem::path& file,
                                     const std::filesystem::path& name);

/// Whether something is there; false also where one cannot look.
[[nodiscard]] bool is_there(const std::filesystem::path& path) noexcept;

/// A file mapped read-only; only the pages that are touched are read from disk.
class MappedFile {
 public:
  MappedFile() = default;
  /// \throws FileError if the file is missing, empty or cannot be mapped
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;

  [[nodiscard]] ByteView bytes() const noexcept { return {data_, size_}; }

 private:
  const std::uint8_t* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace touchtrial
