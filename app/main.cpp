// touchtrial: parses the command line and runs one command.
#include "app/commands/commands.hpp"
#include "app/commit.hpp"
#include "app/reference/pages.hpp"
#include "app/terminal/console.hpp"
#include "app/terminal/passphrases.hpp"
#include "core/errors.hpp"
#include "core/nearest_name.hpp"
#include "core/version.hpp"
#include "protocols/registration/registration.hpp"
#include "record/damage.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <malloc.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;
constexpr int kClosedPipe = 128 + SIGPIPE;  // the exit code that shells report for this signal

int report_error(int code, const std::string& message) noexcept {
  std::fprintf(stderr, "touchtrial: %s\n", one_line(message).c_str());
  return code;
}

/// Formats the message of a warning on one line, without control characters.
class CleanMessage final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm& /*time*/,
              spdlog::memory_buf_t& line) override {
    const std::string text = one_line(std::string(message.payload.data(), message.payload.size()));
    line.append(text.data(), text.data() + text.size());
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<CleanMessage>();
  }
};

/// Sends warnings to standard error: standard output holds results only.
void set_up_log() {
  auto logger = spdlog::stderr_color_mt("touchtrial");
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<CleanMessage>('*').set_pattern("touchtrial: %^%l%$: %*");
  logger->set_formatter(std::move(formatter));
  spdlog::set_default_logger(logger);
}

/// The command parsed so far.
const CLI::App& command_so_far(const CLI::App& program) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return *command;
}

/// The message about the first unknown option if it resembles a known one; otherwise empty. An
/// option that seems to be missing is often misspelt.
std::string misspelt_option(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(command)) {
    if (option->nonpositional()) std::ranges::move(names_of(*option), std::back_inserter(names));
  }
  const std::vector<std::string_view> option_names(names.begin(), names.end());
  for (const std::string& word : command.remaining()) {
    const std::string option_name = word.substr(0, word.find('='));
    if (!option_name.starts_with("--")) continue;
    if (const auto nearest = nearest_name(option_name, option_names)) {
      return option_name + ": is not an option; did you mean " + std::string(*nearest) + "?";
    }
  }
  return "";
}

/// Makes a write past the file size limit, or to a closed pipe, fail with an error instead of a
/// signal, so that the program cleans up.
void ignore_write_signals() {
  static_cast<void>(std::signal(SIGXFSZ, SIG_IGN));
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
}

/// Keeps freed memory for the next allocation. The system would zero every page that it hands out
/// again, which costs as much as extraction and rendering. Blocks of more than 32 MiB are returned.
void keep_freed_memory() {
  constexpr int kMmapThreshold = 32 << 20;
  constexpr int kTrimThreshold = 1 << 30;
  static_cast<void>(::mallopt(M_MMAP_THRESHOLD, kMmapThreshold));
  static_cast<void>(::mallopt(M_TRIM_THRESHOLD, kTrimThreshold));
}

/// The version and commit, for instance "touchtrial 1.2.3 (f697f373)".
std::string version_line() {
  std::string line = "touchtrial " + std::string(program_version());
  if (!program_commit().empty()) line += " (" + std::string(program_commit()) + ")";
  return line;
}

int parse_and_run(int argc, char** argv) {
  keep_freed_memory();
  ignore_write_signals();
  set_up_log();
  registration::register_protocols();
  provide_passphrases();
  CLI::App program("A psychophysics runner for textures that are felt.", "touchtrial");
  program.set_version_flag("--version", version_line());
  program.require_subcommand(1);
  program.fallthrough(false);
  Action action;
  add_commands(program, action);
  const bool has_command = argc > 1 && argv[1][0] != '-' && argv[1][0] != '\0';
  if (has_command) static_cast<void>(command_named(program, argv[1]));
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    std::ostringstream text;
    const int code = program.exit(help, text, text);
    print(text.str());
    return code;
  } catch (const CLI::ParseError& error) {
    const CLI::App& command = command_so_far(program);
    const std::string misspelt = misspelt_option(command);
    return report_error(kBadInput, (misspelt.empty() ? error.what() : misspelt) + "; see " +
                                       full_name_of(command) + " --help");
  }
  return action();
}

/// Whether a thread could not be started, which needs memory for its stack. oneTBB reports this
/// only in the message.
bool is_thread_shortage(const std::exception& error) {
  const auto* const system_error = dynamic_cast<const std::system_error*>(&error);
  return (system_error != nullptr &&
          system_error->code() == std::errc::resource_unavailable_try_again) ||
         std::string_view(error.what()).starts_with("pthread_create has failed");
}

/// The terminate handler: when memory or threads run out, an exception escapes from oneTBB's own
/// threads. Prints one line; the next run removes leftover drafts.
[[noreturn]] void exit_out_of_memory() noexcept {
  bool is_shortage = false;
  try {
    if (const std::exception_ptr failure = std::current_exception()) {
      std::rethrow_exception(failure);
    }
  } catch (const std::bad_alloc&) {
    is_shortage = true;
  } catch (const std::exception& error) {
    is_shortage = is_thread_shortage(error);
  } catch (...) {
  }
  if (!is_shortage) std::abort();
  static constexpr std::string_view kLine =
      "touchtrial: out of memory; close other programs, or give fewer --jobs\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kLine.data(), kLine.size());
  ::_exit(kFailed);
}

/// Runs one command, and reports any error as one line on standard error.
/// \return 0 done, 1 failed, 2 bad arguments or bad study file, 3 verification failed, kClosedPipe
///   (without a line) if the output's reader has exited
int run_program(int argc, char** argv) noexcept {
  std::set_terminate(exit_out_of_memory);
  try {
    return parse_and_run(argc, argv);
  } catch (const ClosedPipe&) {
    return kClosedPipe;
  } catch (const UsageError& error) {
    return report_error(kBadInput, error.what());
  } catch (const StudyError& error) {
    return report_error(kBadInput, error.what());
  } catch (const record::DamagedStore& error) {
    return report_error(kNotVerified, error.what());
  } catch (const VerificationError& error) {
    return report_error(kNotVerified, error.what());
  } catch (const std::bad_alloc&) {
    return report_error(kFailed, "out of memory; close other programs or use smaller images");
  } catch (const std::exception& error) {
    return report_error(
        kFailed,
        is_thread_shortage(error)
            ? "the system cannot start another thread; close other programs, or give fewer --jobs"
            : error.what());
  }
}

}  // namespace
}  // namespace touchtrial::app

int main(int argc, char** argv) {
  return touchtrial::app::run_program(argc, argv);
}
