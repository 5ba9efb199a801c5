#include "app/terminal/passphrases.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "study/key_protection.hpp"

#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>

#include <termios.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxPrompts = 3;
constexpr std::size_t kMaxPassphraseBytes = 4096;

/// Switches the terminal to raw input without echo; Ctrl-C is read as a key, so that the terminal
/// is always restored.
class NoEcho {
 public:
  NoEcho() {
    if (::tcgetattr(STDIN_FILENO, &original_) != 0) {
      throw UsageError("the terminal cannot hide what is typed; give --passphrase-file");
    }
    termios raw_mode = original_;
    raw_mode.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | ISIG);
    raw_mode.c_cc[VMIN] = 1;
    raw_mode.c_cc[VTIME] = 0;
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &raw_mode);
  }
  ~NoEcho() { ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &original_); }
  NoEcho(const NoEcho&) = delete;
  NoEcho& operator=(const NoEcho&) = delete;

 private:
  termios original_{};
};

/// Reads one typed line while a NoEcho exists; backspace and Ctrl-U edit it.
/// \throws UsageError after Ctrl-C, Ctrl-D, or the end of the input
std::string read_hidden_line() {
  constexpr char kBackspace = '\x08';
  constexpr char kDelete = '\x7f';
  constexpr char kErase = '\x15';
  constexpr char kInterrupt = '\x03';
  constexpr char kEnd = '\x04';
  std::string line;
  for (char key = 0; ::read(STDIN_FILENO, &key, 1) == 1;) {
    if (key == '\n' || key == '\r') return line;
    if (key == kInterrupt || key == kEnd) break;
    if (key == kErase) line.clear();
    if (key == kBackspace || key == kDelete) {
      while (!line.empty() && (static_cast<unsigned char>(line.back()) & 0xc0U) == 0x80U) {
        line.pop_back();  // remaining bytes of a multi-byte character
      }
      if (!line.empty()) line.pop_back();
    } else if (static_cast<unsigned char>(key) >= ' ' && line.size() < kMaxPassphraseBytes) {
      line += key;
    }
  }
  throw UsageError("no passphrase was given; nothing was changed");
}

std::string ask_hidden(const std::string& question) {
  const NoEcho no_echo;  // before the question, because the answer may follow at once
  std::fputs(question.c_str(), stderr);
  std::fflush(stderr);
  const auto end_line = [] { std::fputs("\n", stderr); };
  try {
    std::string line = read_hidden_line();
    end_line();
    return line;
  } catch (const UsageError&) {
    end_line();
    throw;
  }
}

std::string read_first_line(const fs::path& source) {
  std::error_code error;
  if (fs::is_regular_file(source, error)) require_owner_only(source);
  std::ifstream file(source);
  std::string line;
  char letter = 0;
  while (line.size() < kMaxPassphraseBytes && file.get(letter) && letter != '\n') line += letter;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  if (line.empty()) {
    throw FileError(one_line(source.string()) +
                    ": has no passphrase in its first line, or cannot be read");
  }
  return line;
}

/// Caches passphrases, because a descriptor can be read only once.
const std::string& passphrase_in(const fs::path& source) {
  static std::map<fs::path, std::string> cache;
  const auto entry = cache.find(source);
  return entry != cache.end() ? entry->second
                              : cache.emplace(source, read_first_line(source)).first->second;
}

std::optional<std::string> passphrase_for(const fs::path& file, int attempt) {
  const auto& sources = passphrase_files();
  if (!sources.empty()) {
    const auto index = static_cast<std::size_t>(attempt - 1);
    if (index >= sources.size()) return std::nullopt;
    return passphrase_in(sources[index]);
  }
  if (::isatty(STDIN_FILENO) == 0 || attempt > kMaxPrompts) return std::nullopt;
  return ask_hidden((attempt > 1 ? "wrong passphrase; " : "") + std::string("passphrase of ") +
                    one_line(file.string()) + ": ");
}

}  // namespace

std::vector<fs::path>& passphrase_files() {
  static std::vector<fs::path> files;
  return files;
}

void provide_passphrases() {
  study::set_passphrase_prompt(passphrase_for);
}

std::string new_passphrase(const fs::path& file, const std::vector<fs::path>& sources) {
  if (!sources.empty()) return passphrase_in(sources.front());
  const std::string name = one_line(file.string());
  if (::isatty(STDIN_FILENO) == 0) {
    throw UsageError(
        name +
        ": a new passphrase is read from a terminal, and standard input is not one; name a "
        "file with the passphrase in its first line");
  }
  std::string passphrase = ask_hidden("new passphrase of " + name + ": ");
  if (ask_hidden("repeat the new passphrase: ") != passphrase) {
    throw UsageError(name + ": the two passphrases differ; nothing was changed");
  }
  return passphrase;
}

}  // namespace touchtrial::app
