#include "analysis/explorations.hpp"

#include <chrono>
#include <utility>

namespace touchtrial::analysis {
namespace {

struct Samples {
  std::vector<double> answer_s;
  std::vector<double> contact_s;
  std::vector<double> path_mm;
  std::vector<double> speed_mm_s;
  std::vector<double> force_n;
  std::vector<double> saturated;
};

void add(const TrialOutcome& trial, Samples& samples) {
  if (trial.row.answered_at) {
    const std::chrono::duration<double> taken = *trial.row.answered_at - trial.row.presented_at;
    samples.answer_s.push_back(taken.count());
  }
  if (!trial.measures || !(trial.measures->contact_s > 0.0)) return;
  const store::TrialMeasures& felt = *trial.measures;
  samples.contact_s.push_back(felt.contact_s);
  samples.path_mm.push_back(felt.path_mm);
  samples.speed_mm_s.push_back(felt.path_mm / felt.contact_s);
  samples.force_n.push_back(felt.force_rms_n);
  samples.saturated.push_back(felt.saturated_share);
}

}  // namespace

std::vector<Explorations> explorations_of(const Outcomes& outcomes) {
  std::vector<Explorations> all(outcomes.methods.size());
  std::vector<Samples> samples(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i].method = outcomes.methods[i];
  for (const TrialOutcome& trial : outcomes.trials) {
    const auto method = static_cast<std::size_t>(trial.stimulus.method);
    if (!trial.counted || method >= all.size()) continue;
    ++all[method].trials;
    if (!trial.response) ++all[method].without_response;
    add(trial, samples[method]);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].answer_s = quartiles(std::move(samples[i].answer_s));
    all[i].contact_s = quartiles(std::move(samples[i].contact_s));
    all[i].path_mm = quartiles(std::move(samples[i].path_mm));
    all[i].speed_mm_s = quartiles(std::move(samples[i].speed_mm_s));
    all[i].force_n = quartiles(std::move(samples[i].force_n));
    all[i].saturated = quartiles(std::move(samples[i].saturated));
  }
  return all;
}

}  // namespace touchtrial::analysis
