#include "analysis/report/figures/gnuplot.hpp"

#include "core/errors.hpp"
#include "core/outputs.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace touchtrial::analysis {
namespace {

/// An unnamed temporary file. Unlike a pipe it never blocks, and writing to it raises no signal
/// when the reading program exits early.
class ScratchFile {
 public:
  // Not std::tmpfile, which ignores TMPDIR.
  ScratchFile() {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    std::string name = (folder / "touchtrial-figure-XXXXXX").string();
    const int descriptor = error ? -1 : ::mkstemp(name.data());
    if (descriptor >= 0) {
      ::unlink(name.c_str());
      file_.reset(::fdopen(descriptor, "w+b"));
    }
    if (!file_) {
      throw FileError("temporary folder: cannot be written (" +
                      (error ? error.message() : std::generic_category().message(errno)) +
                      "); make room or set TMPDIR");
    }
  }
  explicit ScratchFile(std::string_view content) : ScratchFile() {
    const bool written =
        std::fwrite(content.data(), 1, content.size(), file_.get()) == content.size();
    if (!written || std::fflush(file_.get()) != 0) {
      throw FileError("temporary folder: cannot be written (no space); make room or set TMPDIR");
    }
    std::rewind(file_.get());
  }

  [[nodiscard]] int descriptor() const { return fileno(file_.get()); }
  [[nodiscard]] std::string content() const {
    std::rewind(file_.get());
    std::string text;
    std::array<char, 1U << 14U> part{};
    while (const std::size_t n = std::fread(part.data(), 1, part.size(), file_.get())) {
      text.append(part.data(), n);
    }
    return text;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
};

/// Redirects standard input, output and error of a program.
class Streams {
 public:
  Streams(const ScratchFile& in, const ScratchFile& out, const ScratchFile& err) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, in.descriptor(), 0);
    posix_spawn_file_actions_adddup2(&actions_, out.descriptor(), 1);
    posix_spawn_file_actions_adddup2(&actions_, err.descriptor(), 2);
  }
  ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return status;
}

constexpr std::array<int, 2> kMinVersion = {5, 2};

/// "5.0" of "gnuplot 5.0 patchlevel 5" if that is too old_version; empty otherwise.
std::string outdated_version(const std::string& output) {
  const std::size_t begin = output.find_first_of("0123456789");
  if (begin == std::string::npos) return "";
  const std::string version = output.substr(begin, output.find(' ', begin) - begin);
  const std::size_t dot = std::min(version.find('.'), version.size() - 1);
  const auto major = number_in<int>(version.substr(0, dot));
  const auto minor = number_in<int>(version.substr(dot + 1));
  if (!major || !minor) return "";
  return std::array<int, 2>{*major, *minor} < kMinVersion ? version : "";
}

/// The last line of an error message; the other lines echo the script.
std::string last_line(const std::string& message) {
  const std::size_t last = message.find_last_not_of(" \n");
  if (last == std::string::npos) return "without a message";
  const std::size_t line = message.rfind('\n', last);
  return one_line(message.substr(line == std::string::npos ? 0 : line + 1, last - line));
}

}  // namespace

struct GnuplotProcess::Run {
  explicit Run(std::string_view script) : in(script) {}

  ScratchFile in;
  ScratchFile out;
  ScratchFile err;
  pid_t child = 0;  ///< 0 once it has ended
};

GnuplotProcess::GnuplotProcess(std::string argument, std::string_view script)
    : run_(std::make_unique<Run>(script)), is_version_query_(argument == "--version") {
  std::string name = "gnuplot";
  std::string defaults = "-d";
  std::array<char*, 4> arguments = {name.data(), defaults.data(), argument.data(), nullptr};
  if (argument.empty()) arguments[2] = nullptr;
  const Streams streams(run_->in, run_->out, run_->err);
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, name.c_str(), streams.actions(), nullptr, arguments.data(), environ);
  if (failed != 0) {
    throw Error(failed == ENOENT
                    ? "gnuplot: is not installed; install gnuplot-nox"
                    : "gnuplot: cannot be started (" + std::generic_category().message(failed) +
                          "); check that `gnuplot --version` works");
  }
  run_->child = child;
}

GnuplotProcess::~GnuplotProcess() {
  if (run_ && run_->child != 0) wait_for(run_->child);
}

GnuplotProcess::GnuplotProcess(GnuplotProcess&&) noexcept = default;

std::string GnuplotProcess::result() {
  const int status = run_->child == 0 ? 0 : wait_for(std::exchange(run_->child, 0));
  if (status != 0 && WIFSIGNALED(status)) {
    throw Error(std::string("gnuplot: was killed (") + ::strsignal(WTERMSIG(status)) +
                "); free memory and try again");
  }
  if (status != 0) {
    throw Error("gnuplot: failed (" + last_line(run_->err.content()) + ")" +
                (is_version_query_ ? "; reinstall gnuplot-nox" : gnuplot_remedy()));
  }
  return run_->out.content();
}

void require_gnuplot() {
  static_cast<void>(GnuplotProcess("--version", "").result());
}

std::string gnuplot_remedy() {
  const std::string old_version = outdated_version(GnuplotProcess("--version", "").result());
  if (!old_version.empty())
    return "; it is version " + old_version + ", and 5.2 or later is needed";
  return "; check that the temporary folder has room (TMPDIR selects another), and that gnuplot "
         "can draw SVG, PDF and PNG, as that of gnuplot-nox can";
}

std::string gnuplot_string(const std::string& text) {
  std::string quoted = "'";
  for (const char c : one_line(text)) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace touchtrial::analysis
