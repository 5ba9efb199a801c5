#include "analysis/report/page/frame_sections.hpp"

#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "core/text.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

struct ServoNumbers {
  std::vector<double> p99_us;
  double worst_us = 0.0;
  double lowest_rate_hz = 0.0;
  std::int64_t overruns = 0;
  std::int64_t lost = 0;
};

ServoNumbers servo_numbers(const std::vector<ServoTrial>& trials) {
  ServoNumbers numbers;
  numbers.lowest_rate_hz = trials.front().health.rate_hz;
  for (const ServoTrial& trial : trials) {
    numbers.p99_us.push_back(trial.health.lateness_p99_us);
    numbers.worst_us = std::max(numbers.worst_us, trial.health.lateness_worst_us);
    numbers.lowest_rate_hz = std::min(numbers.lowest_rate_hz, trial.health.rate_hz);
    numbers.overruns += trial.overruns;
    numbers.lost += trial.health.lost;
  }
  return numbers;
}

}  // namespace

std::vector<Block> registration_blocks(const study::Registration& registration) {
  const auto stated = [](const std::string& text) { return text.empty() ? "not stated" : text; };
  Definitions definitions{
      {{"hypothesis", stated(registration.hypothesis)},
       {"primary test", stated(registration.primary_test)},
       {"participants planned",
        registration.participants > 0 ? std::to_string(registration.participants) : "not stated"},
       {"stopping rule", stated(registration.stopping_rule)},
       {"exclusions", stated(registration.exclusions)}}};
  for (const auto& field : study::fields_of(registration)) definitions.entries.push_back(field);
  return {Subheading{"registration", "Registration"}, std::move(definitions)};
}

std::optional<Table> servo_table(const Collection& collection) {
  if (collection.servo_trials.empty()) return {};
  ServoNumbers numbers = servo_numbers(collection.servo_trials);
  const Quartiles p99 = quartiles(std::move(numbers.p99_us));
  Table table{"servo", "Servo timing in real-time trials", {{"quantity", Align::left}, {"value"}}};
  table.rows = {{"trials", std::to_string(collection.servo_trials.size())},
                {"lowest mean rate of a trial (Hz)", plain_figure(numbers.lowest_rate_hz, 1)},
                {"trials' 99th percentile of lateness, median (µs)", plain_figure(p99.median, 1)},
                {"trials' 99th percentile of lateness, quartiles (µs)",
                 plain_figure(p99.lower, 1) + " and " + plain_figure(p99.upper, 1)},
                {"maximum lateness (µs)", plain_figure(numbers.worst_us, 1)},
                {"late ticks", std::to_string(numbers.overruns)},
                {"samples missing from traces", std::to_string(numbers.lost)}};
  return table;
}

}  // namespace touchtrial::analysis
