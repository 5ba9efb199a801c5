/// \file Which files an output may replace: one rule for every file that a user asks a command to
///   write (docs/evidence.md, "What is replaced").
#pragma once

#include "core/draft.hpp"

#include <filesystem>
#include <functional>
#include <string_view>

namespace touchtrial {

/// Called with the old and the new name of a file that was moved aside.
using MovedAsideNotice =
    std::function<void(const std::filesystem::path&, const std::filesystem::path&)>;

/// From now on, in the whole program, foreign files in the way of outputs are renamed to NAME.1,
/// NAME.2 and so on. With an empty notice, the default, they are refused.
/// \param notice  called on the thread that writes
void move_foreign_files_aside(MovedAsideNotice notice);

enum class Origin {
  nothing,  ///< there is no file
  ours,     ///< an output of this program, unchanged since
  others,   ///< a foreign file, a changed output, or a folder
  unknown   ///< the file system has no extended attributes
};

/// Who wrote a file. An output carries the SHA-256 of its bytes as the extended attribute
/// "user.touchtrial".
/// \throws FileError if it is a link, a device or a pipe, or cannot be read
[[nodiscard]] Origin origin_of(const std::filesystem::path& file);

/// Called before long work: refuses a path with a foreign file, unless such files are moved aside.
/// \throws FileError naming --force
void require_output_place(const std::filesystem::path& place);

/// Refuses a foreign file or folder, or moves it to a free name and calls the notice.
/// \throws FileError naming --force
void clear_output_place(const std::filesystem::path& place);

/// Moves a file or folder to the first free one of NAME.1, NAME.2 and so on.
/// \return its new name
/// \throws FileError with the system's reason
std::filesystem::path move_aside(const std::filesystem::path& place);

/// Writes and marks an output atomically: after a crash it has the old or the new content.
/// Thread-safe for different paths.
/// \throws FileError naming --force if a foreign file is in the way; with the system's reason
void write_output(const std::filesystem::path& place, ByteView content,
                  FileMode mode = FileMode::everyone);
void write_output(const std::filesystem::path& place, std::string_view content,
                  FileMode mode = FileMode::everyone);

/// The same with a complete file on the same disk, which is moved.
void move_to_output(const std::filesystem::path& made, const std::filesystem::path& place);

}  // namespace touchtrial
