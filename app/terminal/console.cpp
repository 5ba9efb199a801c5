#include "app/terminal/console.hpp"

#include "analysis/report/text_table.hpp"
#include "core/printable.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <iostream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kBarWidth = 30;

void draw_bar(const std::string& label, int done, int total) {
  const int filled_width = total > 0 ? kBarWidth * done / total : kBarWidth;
  const std::string bar = std::string(static_cast<std::size_t>(filled_width), '#') +
                          std::string(static_cast<std::size_t>(kBarWidth - filled_width), '.');
  const std::string line = fmt::format("\r{} [{}] {}/{}", label, bar, done, total);
  std::fputs(line.c_str(), stderr);
  if (done >= total) std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
}

}  // namespace

void print(const std::string& text) {
  const std::string escaped = printable(text);
  const bool is_written = std::fwrite(escaped.data(), 1, escaped.size(), stdout) == escaped.size();
  if (is_written && std::fflush(stdout) == 0) return;
  const int error = errno;
  if (error == EPIPE) throw ClosedPipe("standard output: its reader has exited");
  throw FileError("standard output: cannot be written (" + std::generic_category().message(error) +
                  "); make room, or name another file");
}

void confirm(const std::string& description, bool yes) {
  if (yes) return;
  if (::isatty(STDIN_FILENO) == 0) {
    throw UsageError(one_line(description) +
                     "; nothing was done: standard input is not a terminal; confirm with --yes");
  }
  const std::string question = one_line(description) + "\ntype yes to continue: ";
  std::fputs(question.c_str(), stderr);
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != "yes") throw UsageError("not confirmed; nothing was done");
}

std::size_t columns_of_output() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return analysis::kTextWidth;
  return std::clamp<std::size_t>(size.ws_col, 80, analysis::kTextWidth);
}

std::string shell_word(const std::string& text) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./-+=:,@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::function<void(int, int)> progress_bar(const std::string& label) {
  if (::isatty(STDERR_FILENO) == 0) return [](int, int) {};
  const auto start_time = Clock::now() + std::chrono::seconds(1);
  return [label, start_time](int done, int total) {
    if (Clock::now() >= start_time) draw_bar(label, done, total);
  };
}

std::chrono::nanoseconds utc_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::system_clock::now().time_since_epoch());
}

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& letter : ending) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return ending;
}

}  // namespace touchtrial::app
