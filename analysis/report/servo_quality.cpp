#include "analysis/report/servo_quality.hpp"

#include "protocols/store/payload_json.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void add_trial(const ServoHealth& trial, ServoQuality& all) {
  all.lowest_rate_hz =
      all.trials == 0 ? trial.rate_hz : std::min(all.lowest_rate_hz, trial.rate_hz);
  all.highest_p99_us = std::max(all.highest_p99_us, trial.lateness_p99_us);
  all.worst_us = std::max(all.worst_us, trial.lateness_worst_us);
  all.lost += trial.lost;
  ++all.trials;
}

}  // namespace

std::optional<ServoQuality> servo_quality(const StudyStore& store, const std::set<int>& withdrawn) {
  ServoQuality all;
  std::vector<double> p99_us;
  store.for_each(EventKind::trace_stored, [&](const Event& event) {
    const TraceBody body = trace_body_from_json(event.body);
    if (!body.servo || withdrawn.contains(event.session)) return;
    add_trial(*body.servo, all);
    p99_us.push_back(body.servo->lateness_p99_us);
  });
  if (all.trials == 0) return std::nullopt;
  all.median_p99_us = median_of(std::move(p99_us));
  std::set<std::string> scheduling;
  store.for_each(EventKind::opened, [&](const Event& event) {
    const SessionOpening opening = opening_from_json(event.body);
    if (opening.station && !withdrawn.contains(event.session)) {
      scheduling.insert(opening.station->scheduling);
    }
  });
  all.scheduling.assign(scheduling.begin(), scheduling.end());
  return all;
}

bool is_visual(const StudyStore& store) {
  bool visual = false;
  store.for_each(EventKind::opened, [&](const Event& event) {
    const SessionOpening opening = opening_from_json(event.body);
    visual = visual || (opening.station && opening.station->visual);
  });
  return visual;
}

}  // namespace touchtrial
