/// \file Tells whether a file is still the one that was read, without reading it again.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace touchtrial {

/// What the system knows of a file without its content.
struct FileStamp {
  std::uint64_t bytes = 0;
  std::uint64_t inode = 0;
  std::int64_t modified_ns = 0;  ///< since 1970; any program may set it
  std::int64_t changed_ns = 0;   ///< of content, rights, name or times; no program can set it
  std::int64_t taken_ns = 0;     ///< when the stamp was taken

  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// Take it before the file is read. Thread-safe.
/// \return nothing if there is no such file
[[nodiscard]] std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// File systems keep times to no worse than this.
inline constexpr std::chrono::nanoseconds kSettledAfter = std::chrono::seconds(2);

/// Whether a file still has the content that it had when its first stamp was taken: size, inode and
/// both times are the same, and lie so far before the stamp that a change after it would have
/// another time.
/// \param settled_after  the coarsest step of a time
[[nodiscard]] bool is_unchanged(const FileStamp& before, const FileStamp& now,
                                std::chrono::nanoseconds settled_after = kSettledAfter) noexcept;

}  // namespace touchtrial
