// servo_jitter: how late the servo's ticks begin on a machine.
#include "analysis/figures/gnuplot.hpp"
#include "app/console.hpp"
#include "bench/jitter/measurement.hpp"
#include "bench/jitter/results.hpp"
#include "core/errors.hpp"
#include "stimuli/generator.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace touchtrial::bench::jitter {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

struct Arguments {
  std::vector<double> rates_hz = {device::kServoRateHz};
  std::vector<device::SchedulingPolicy> policies = {device::SchedulingPolicy::fifo};
  std::vector<int> loads = {0};
  double seconds = 10.0;
  std::int64_t unpaced_ticks = 0;
  bool json = false;
  std::filesystem::path picture;
};

void set_up(CLI::App& program, Arguments& a) {
  const std::map<std::string, device::SchedulingPolicy> policies = {
      {"other", device::SchedulingPolicy::other}, {"fifo", device::SchedulingPolicy::fifo}};
  program.add_option("--rate", a.rates_hz, "Ticks per second, 1000 to 10000; several as 1000,4000")
      ->check(CLI::Range(1000.0, 10'000.0))
      ->delimiter(',');
  program
      .add_option("--policy", a.policies,
                  "Scheduling to request: other or fifo; both as other,fifo")
      ->transform(CLI::CheckedTransformer(policies))
      ->delimiter(',');
  program.add_option("--load", a.loads, "Busy threads beside the servo; several as 0,4")
      ->check(CLI::Range(0, 1000))
      ->delimiter(',');
  CLI::Option* const seconds =
      program.add_option("--seconds", a.seconds, "Duration of each measurement, s")
          ->check(CLI::Range(0.01, 86'400.0));
  program
      .add_option("--unpaced", a.unpaced_ticks,
                  "Measure the time of this many ticks that follow one another without a pause")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}))
      ->excludes(seconds);
  program.add_flag("--json", a.json, "Print JSON");
  program.add_option("--picture", a.picture, "Draw the histograms into this file, .svg or .png");
}

std::vector<Conditions> conditions_of(const Arguments& a) {
  std::vector<Conditions> all;
  for (const double rate_hz : a.rates_hz) {
    for (const device::SchedulingPolicy policy : a.policies) {
      for (const int load : a.loads) all.push_back({rate_hz, policy, load});
    }
  }
  return all;
}

std::vector<Measurement> measure(const Arguments& a, const std::vector<Conditions>& all) {
  const app::TestTexture texture(stimuli::kDefaultStimulusSizePx);
  const auto progress = app::progress_bar("servo_jitter");
  std::vector<Measurement> measurements;
  for (const Conditions& conditions : all) {
    progress(static_cast<int>(measurements.size()), static_cast<int>(all.size()));
    measurements.push_back(a.unpaced_ticks > 0
                               ? measure_service(texture, conditions, a.unpaced_ticks)
                               : measure_lateness(texture, conditions, a.seconds));
  }
  progress(static_cast<int>(all.size()), static_cast<int>(all.size()));
  return measurements;
}

void run(const Arguments& a) {
  const Measured what = a.unpaced_ticks > 0 ? Measured::service : Measured::lateness;
  if (!a.picture.empty()) {
    static_cast<void>(histogram_script(what, {}, a.picture));  // refuses a wrong ending early
    analysis::require_gnuplot();
  }
  const std::vector<Measurement> measurements = measure(a, conditions_of(a));
  app::print(a.json ? results_json(what, measurements) : results_text(what, measurements));
  if (!a.picture.empty()) {
    analysis::draw_with_gnuplot(histogram_script(what, measurements, a.picture), a.picture);
  }
}

int complain(int code, const std::string& message) noexcept {
  std::fprintf(stderr, "servo_jitter: %s\n", one_line(message).c_str());
  return code;
}

int parse_and_run(int argc, char** argv) {
  CLI::App program("Measures how late the servo's ticks begin on this machine.", "servo_jitter");
  Arguments arguments;
  set_up(program, arguments);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    return complain(kBadInput, std::string(error.what()) + "; see servo_jitter --help");
  }
  run(arguments);
  return 0;
}

/// \return 0 done, 1 failed, 2 bad arguments
int run_program(int argc, char** argv) noexcept {
  try {
    return parse_and_run(argc, argv);
  } catch (const UsageError& error) {
    return complain(kBadInput, error.what());
  } catch (const std::exception& error) {
    return complain(kFailed, error.what());
  }
}

}  // namespace
}  // namespace touchtrial::bench::jitter

int main(int argc, char** argv) {
  return touchtrial::bench::jitter::run_program(argc, argv);
}
