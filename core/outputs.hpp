/// \file Writes outputs, the files that a user asks a command to write, without overwriting foreign
/// files (docs/evidence.md, "What is replaced").
#pragma once

#include "core/draft.hpp"

#include <filesystem>
#include <functional>
#include <string_view>

namespace touchtrial {

/// Receives the old and the new path of a file that was moved aside.
using MovedAsideNotice =
    std::function<void(const std::filesystem::path&, const std::filesystem::path&)>;

/// Sets the policy of the whole program: foreign files at the path of an output are renamed to
/// NAME.1, NAME.2 and so on. With an empty notice, the default, they are refused.
/// \param notice  called on the thread that writes
void move_foreign_files_aside(MovedAsideNotice notice);

enum class Origin {
  nothing,  ///< there is no file
  ours,     ///< an output of this program, unchanged since
  foreign,  ///< another program's file, a changed output, or a folder
  unknown   ///< the file system has no extended attributes
};

/// Determines who wrote a file. Outputs have the SHA-256 of their content as extended attribute
/// "user.touchtrial".
/// \throws FileError if it is a link, a device or a pipe, or cannot be read
[[nodiscard]] Origin origin_of(const std::filesystem::path& file);

/// Refuses a path with a foreign file unless such files are moved aside. Call it before long work.
/// \throws FileError naming --force
void require_output_path(const std::filesystem::path& path);

/// Refuses a foreign file or folder, or moves it to a free name and calls the notice.
/// \throws FileError naming --force
void clear_output_path(const std::filesystem::path& path);

/// Moves a file or folder to the first free name of NAME.1, NAME.2 and so on.
/// \return its new name
/// \throws FileError with the system's reason
std::filesystem::path move_aside(const std::filesystem::path& path);

/// Writes and marks an output atomically: after a crash it has the old or the new content.
/// Thread-safe for different paths.
/// \throws FileError naming --force if a foreign file exists, or with the system's reason
void write_output(const std::filesystem::path& path, ByteView content,
                  FileMode mode = FileMode::everyone);
void write_output(const std::filesystem::path& path, std::string_view content,
                  FileMode mode = FileMode::everyone);

/// Moves a complete file on the same disk to the path of an output and marks it.
void move_to_output(const std::filesystem::path& file, const std::filesystem::path& path);

}  // namespace touchtrial
