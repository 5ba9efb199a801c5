/// \file What commands share to talk to people and programs: output, progress, the time, and the
/// endings of file names.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace touchtrial::app {

/// Prints to standard output, as core/printable.hpp shows it.
/// \throws FileError if that fails (a full disk, a closed pipe)
void print(const std::string& text);

/// A JSON object as commands print it: indented, ending with a line feed. Bytes that are not UTF-8
/// become replacement characters.
template <typename Json>
[[nodiscard]] std::string json_text(const Json& object) {
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// A progress bar on standard error. It appears only on a terminal and after one second, and
/// disappears when the work ends. Call it from one thread.
[[nodiscard]] std::function<void(int done, int of)> progress_bar(const std::string& what);

/// Nanoseconds since 1970, UTC.
[[nodiscard]] std::chrono::nanoseconds utc_now();

/// A time as utc_now gives it, for people: "2026-03-02 09:00 UTC".
[[nodiscard]] std::string utc_words(std::chrono::nanoseconds at);

/// The extension of a file name in lower case, with its dot: ".png" of "A.PNG".
[[nodiscard]] std::string ending_of(const std::filesystem::path& file);

}  // namespace touchtrial::app
