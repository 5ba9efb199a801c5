#include "analysis/report/servo_quality.hpp"

#include <algorithm>
#include <set>

namespace touchtrial::analysis {
namespace {

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void add_trial(const store::ServoHealth& trial, ServoQuality& all) {
  all.lowest_rate_hz =
      all.trials == 0 ? trial.rate_hz : std::min(all.lowest_rate_hz, trial.rate_hz);
  all.highest_p99_us = std::max(all.highest_p99_us, trial.lateness_p99_us);
  all.worst_us = std::max(all.worst_us, trial.lateness_worst_us);
  all.lost += trial.lost;
  ++all.trials;
}

}  // namespace

std::optional<ServoQuality> servo_quality(const Collection& collection) {
  if (collection.servo_trials.empty()) return std::nullopt;
  ServoQuality all;
  std::vector<double> p99_us;
  for (const ServoTrial& trial : collection.servo_trials) {
    add_trial(trial.health, all);
    p99_us.push_back(trial.health.lateness_p99_us);
  }
  all.median_p99_us = median_of(std::move(p99_us));
  std::set<std::string> scheduling;
  for (const SessionRecord& session : collection.sessions) {
    if (session.station) scheduling.insert(session.station->scheduling);
  }
  all.scheduling.assign(scheduling.begin(), scheduling.end());
  return all;
}

}  // namespace touchtrial::analysis
