/// \file What commands share when they talk to a terminal.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace touchtrial::app {

/// Prints to standard output. \throws FileError if that fails (a full disk, a closed pipe)
void print(const std::string& text);

/// A progress bar on standard error: shown only if that is a terminal and the work takes more than
/// a second, removed when it ends. Call from one thread.
[[nodiscard]] std::function<void(int done, int of)> progress_bar(const std::string& what);

/// Nanoseconds since 1970, UTC.
[[nodiscard]] std::chrono::nanoseconds utc_now();

/// The key of a database: `--key`, else `<db>.key` beside it.
[[nodiscard]] std::filesystem::path key_path_for(const std::filesystem::path& database,
                                                 const std::filesystem::path& given);

}  // namespace touchtrial::app
