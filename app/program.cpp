#include "app/program.hpp"

#include "app/commands.hpp"
#include "core/errors.hpp"
#include "core/version.hpp"

#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace touchtrial {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;
constexpr int kNotVerified = 3;

void add_commands(CLI::App& program, Action& action) {
  add_extract_command(program, action);
  add_stimuli_command(program, action);
  add_prepare_command(program, action);
  add_simulate_command(program, action);
  add_close_command(program, action);
  add_unblind_command(program, action);
  add_verify_command(program, action);
  add_report_command(program, action);
  add_export_command(program, action);
}

int complain(int code, const std::string& message) noexcept {
  std::fprintf(stderr, "touchtrial: %s\n", one_line(message).c_str());
  return code;
}

/// Warnings go to standard error, so that results on standard output stay clean.
void set_up_log() {
  auto logger = spdlog::stderr_color_mt("touchtrial");
  logger->set_pattern("touchtrial: %^%l%$: %v");
  spdlog::set_default_logger(logger);
}

int parse_and_run(int argc, char** argv) {
  set_up_log();
  CLI::App program("A psychophysics runner for textures that are felt.", "touchtrial");
  program.set_version_flag("--version", std::string(program_version()));
  program.require_subcommand(1);
  program.fallthrough(false);
  Action action;
  add_commands(program, action);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    return complain(kBadInput, std::string(error.what()) + "; see touchtrial --help");
  }
  return action();
}

}  // namespace

int run_program(int argc, char** argv) noexcept {
  try {
    return parse_and_run(argc, argv);
  } catch (const UsageError& error) {
    return complain(kBadInput, error.what());
  } catch (const StudyError& error) {
    return complain(kBadInput, error.what());
  } catch (const VerificationError& error) {
    return complain(kNotVerified, error.what());
  } catch (const std::bad_alloc&) {
    return complain(kFailed,
                    "there is not enough memory; close other programs or use smaller images");
  } catch (const std::exception& error) {
    return complain(kFailed, error.what());
  }
}

}  // namespace touchtrial
