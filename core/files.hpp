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

/// For files whose names belong to the program, such as keys; core/outputs.hpp writes the others.
/// Writes a draft, syncs it, and renames it over the target: after a crash the file has its old or
/// its new content, never half of it. Refuses links, devices and pipes.
/// \throws FileError with the system's reason
void replace_file(const std::filesystem::path& path, ByteView content,
                  FileMode mode = FileMode::everyone);
void replace_file(const std::filesystem::path& path, std::string_view content,
                  FileMode mode = FileMode::everyone);

/// Refuses a file of secrets that others may read.
/// \throws FileError with the remedy if the group or others have any right to it, or it is missing
void require_owner_only(const std::filesystem::path& path);

/// Creates a folder and its missing parents.
/// \throws FileError if the folder does not exist afterwards
void make_folder(const std::filesystem::path& folder);

/// Renames a complete file, over one that has the new name, and syncs the folder.
/// \throws FileError with the system's reason
void rename_file(const std::filesystem::path& file, const std::filesystem::path& name);

/// Renames a complete file, unless something already has the new name, and syncs the folder.
/// \return whether the name was free
/// \throws FileError with the system's reason
[[nodiscard]] bool move_to_free_name(const std::filesystem::path& file,
                                     const std::filesystem::path& name);

/// Whether the path exists; also false if access is denied.
[[nodiscard]] bool is_there(const std::filesystem::path& path) noexcept;

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

/// The file of this name beside a database; links to the database are followed first.
[[nodiscard]] std::filesystem::path beside_database(const std::filesystem::path& database,
                                                    const char* suffix);

}  // namespace touchtrial
