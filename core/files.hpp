/// \file Reads whole files, replaces them atomically, and maps them read-only.
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

/// \param limit_bytes  a larger file is refused before it is read
/// \throws FileError if the file is missing, a folder, unreadable or larger than the limit
[[nodiscard]] Bytes read_file(const std::filesystem::path& path,
                              std::uintmax_t limit_bytes = std::uintmax_t{1} << 32U);

/// Writes a draft, syncs it, and renames it over the target: after a crash the file has its old or
/// its new content, never a part of it. Refuses links, devices and pipes. Use it for files whose
/// names the program chooses, such as keys, and core/outputs.hpp for files that the user names.
/// \throws FileError with the system's reason
void replace_file(const std::filesystem::path& path, ByteView content,
                  FileMode mode = FileMode::everyone);
void replace_file(const std::filesystem::path& path, std::string_view content,
                  FileMode mode = FileMode::everyone);

/// Checks that only its owner can access a file of secrets.
/// \throws FileError with the remedy if group or others have any permission, or it is missing
void require_owner_only(const std::filesystem::path& path);

/// Creates a folder and its missing parents.
/// \throws FileError if the folder does not exist afterwards
void make_folder(const std::filesystem::path& folder);

/// Renames a complete file, replacing any file of the new name, and syncs the folder.
/// \throws FileError with the system's reason
void rename_file(const std::filesystem::path& file, const std::filesystem::path& name);

/// Renames a complete file unless the new name is taken, and syncs the folder.
/// \return whether the name was free
/// \throws FileError with the system's reason
[[nodiscard]] bool move_to_free_name(const std::filesystem::path& file,
                                     const std::filesystem::path& name);

/// Whether the path exists; also false if access is denied.
[[nodiscard]] bool path_exists(const std::filesystem::path& path) noexcept;

/// A file mapped read-only: only pages that are accessed are read from disk.
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

/// The path of a database, with links resolved, plus `suffix`.
[[nodiscard]] std::filesystem::path database_companion(const std::filesystem::path& database,
                                                       const char* suffix);

}  // namespace touchtrial
