/// \file What an output may replace: docs/evidence.md, "What is replaced". The one rule for every
/// file that a command writes because somebody asked for it.
#pragma once

#include "core/draft.hpp"

#include <filesystem>
#include <functional>
#include <string_view>

namespace touchtrial {

/// Called with a file that is kept, and its new name.
using KeptNotice = std::function<void(const std::filesystem::path&, const std::filesystem::path&)>;

/// From now on, in the whole program, files in the way of outputs are kept under other names,
/// NAME.1, NAME.2 and so on. With an empty notice they are refused, as they are at first.
/// \param notice  called on the thread that writes
void keep_files_in_the_way(KeptNotice notice);

enum class Origin {
  nothing,  ///< there is no file
  ours,     ///< an output of this program that nobody changed since
  others,   ///< somebody else's, or changed since, or a folder
  unknown   ///< its file system keeps no marks
};

/// Whose a file is. An output carries the SHA-256 of its bytes as the extended attribute
/// "user.touchtrial".
/// \throws FileError if it is a link, which no output follows, a device or a pipe, or cannot be read
[[nodiscard]] Origin origin_of(const std::filesystem::path& file);

/// Before long work: refuses a place that has another's file, unless such files are kept.
/// \throws FileError naming --force
void require_output_place(const std::filesystem::path& place);

/// Refuses another's file or folder, or moves it to a free name and calls the notice.
/// \throws FileError naming --force
void make_way(const std::filesystem::path& place);

/// Moves what is in a place to the first free one of NAME.1, NAME.2 and so on.
/// \return its new name
/// \throws FileError with the system's reason
std::filesystem::path keep_aside(const std::filesystem::path& place);

/// Writes an output as a whole and marks it: what is in its place afterwards has the old or the new
/// content, also after a crash. Thread-safe for different places.
/// \throws FileError naming --force if another's file is in the way; with the system's reason
void write_output(const std::filesystem::path& place, ByteView content,
                  FileMode mode = FileMode::everyone);
void write_output(const std::filesystem::path& place, std::string_view content,
                  FileMode mode = FileMode::everyone);

/// The same with a complete file on the same disk, which is moved.
void move_to_output(const std::filesystem::path& made, const std::filesystem::path& place);

}  // namespace touchtrial
