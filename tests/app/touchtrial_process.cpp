#include "app/touchtrial_process.hpp"

#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cstdlib>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace touchtrial {
namespace {

constexpr std::chrono::minutes kMaxWait{2};  // for a prompt, or the end, of a program

}  // namespace

ProgramResult run_program(const std::filesystem::path& program, const std::filesystem::path& folder,
                          const std::vector<std::string>& arguments, const std::string& input) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const std::string out = (folder / "stdout.txt").string();
  const std::string err = (folder / "stderr.txt").string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  const std::string in = input.empty() ? "/dev/null" : (folder / "stdin.txt").string();
  if (!input.empty()) replace_file(in, input);
  posix_spawn_file_actions_addopen(&actions, 0, in.c_str(), O_RDONLY, 0);
  const int flags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), flags, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), flags, 0600);
  pid_t child = 0;
  // What the program remembers for its user must not be the tester's.
  std::string home = "XDG_CONFIG_HOME=" + (folder / ".config").string();
  std::string cache = "XDG_CACHE_HOME=" + (folder / ".cache").string();
  std::vector<char*> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) environment.push_back(*entry);
  if (std::getenv("XDG_CONFIG_HOME") == nullptr) environment.push_back(home.data());
  if (std::getenv("XDG_CACHE_HOME") == nullptr) environment.push_back(cache.data());
  environment.push_back(nullptr);
  const int failed =
      posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  REQUIRE(failed == 0);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(read_file(out)),
          text_of(read_file(err))};
}

ProgramResult run_touchtrial(const std::filesystem::path& folder,
                             const std::vector<std::string>& arguments, const std::string& input) {
  return run_program(TOUCHTRIAL_PROGRAM, folder, arguments, input);
}

std::vector<std::string> typed_words(const std::string& line, const std::filesystem::path& folder) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line[at] == ' ') continue;
    const bool is_quoted = line[at] == '\'';
    const std::size_t begin = at + (is_quoted ? 1 : 0);
    at = std::min(line.find(is_quoted ? '\'' : ' ', begin), line.size());
    words.push_back(line.substr(begin, at - begin));
    if (!is_quoted && words.back().starts_with('@')) {
      words.back() = (folder / words.back().substr(1)).string();
    }
    if (is_quoted) ++at;
  }
  return words;
}

ProgramResult succeeded(const ProgramResult& result) {
  INFO(result.output << result.errors);
  REQUIRE(result.exit_code == 0);
  return result;
}

void check_refused(const ProgramResult& result, int exit_code,
                   const std::vector<std::string>& parts) {
  INFO(result.output << result.errors);
  CHECK(result.exit_code == exit_code);
  CHECK(result.output.empty());
  CHECK(line_count(result.errors) == 1);
  for (const std::string& part : parts) {
    INFO(part);
    CHECK(names_in_order(result.errors, part));
  }
}

ProgramResult run_touchtrial_limited(const std::filesystem::path& folder, const std::string& limit,
                                     const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"-c", "ulimit " + limit + " && exec \"$0\" \"$@\"",
                                    TOUCHTRIAL_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_program("/bin/sh", folder, words);
}

TerminalRun::TerminalRun(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TOUCHTRIAL_PROGRAM);
  std::vector<char*> argv;
  for (std::string& word : arguments) argv.push_back(word.data());
  argv.push_back(nullptr);
  child_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
  if (child_ == 0) {
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  REQUIRE(child_ > 0);
}

TerminalRun::~TerminalRun() {
  ::close(terminal_);
}

void TerminalRun::answer(const std::string& prompt, const std::string& line) {
  const bool is_asked = read_until(prompt, read_, kMaxWait);
  INFO("waited for \"" << prompt << "\" in: " << shown_);
  REQUIRE(is_asked);
  read_ = shown_.size();
  const std::string typed = line + "\r";
  REQUIRE(::write(terminal_, typed.data(), typed.size()) == static_cast<ssize_t>(typed.size()));
}

void TerminalRun::hold_enter(const std::string& prompt, std::chrono::milliseconds held) {
  answer(prompt, "");
  std::chrono::milliseconds next{660};
  for (std::chrono::milliseconds passed{0}; passed + next <= held;) {
    std::this_thread::sleep_for(next);
    passed += next;
    next = std::chrono::milliseconds(40);
    press("\r");
  }
}

void TerminalRun::press(const std::string& keys) {
  // Nobody reads them at the end, which is no error of the test.
  [[maybe_unused]] const ssize_t written = ::write(terminal_, keys.data(), keys.size());
}

bool TerminalRun::shows(const std::string& text, std::chrono::milliseconds longest) {
  return read_until(text, 0, longest);
}

int TerminalRun::finish() {
  read_until("", read_, kMaxWait);
  INFO(shown_);
  REQUIRE(ended_);
  int status = 0;
  REQUIRE(::waitpid(child_, &status, 0) == child_);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool TerminalRun::read_until(const std::string& text, std::size_t from,
                             std::chrono::milliseconds longest) {
  const auto until = std::chrono::steady_clock::now() + longest;
  const auto is_shown = [&] {
    return !text.empty() && shown_.find(text, from) != std::string::npos;
  };
  while (!ended_ && !is_shown()) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    pollfd waiting{terminal_, POLLIN, 0};
    if (::poll(&waiting, 1, static_cast<int>(std::max(left.count(), 0L))) <= 0) return false;
    char letter = 0;
    ended_ = ::read(terminal_, &letter, 1) != 1;
    if (!ended_) shown_ += letter;
  }
  return is_shown();
}

int line_count(const std::string& text) {
  const auto ends = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  return ends + (!text.empty() && text.back() != '\n' ? 1 : 0);
}

}  // namespace touchtrial
