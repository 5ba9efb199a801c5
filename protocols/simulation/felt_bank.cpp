#include "protocols/simulation/felt_bank.hpp"

#include "core/parallel.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/felt_exploration.hpp"

#include <algorithm>
#include <mutex>
#include <stdexcept>

namespace touchtrial::simulation {
namespace {

constexpr unsigned kExplorationBits = 24;

void check(const FeltBankOptions& options) {
  if (options.jobs < 1 || options.explorations < 1 ||
      options.explorations >= (1 << kExplorationBits)) {
    throw std::invalid_argument("FeltBank: explorations or jobs are out of range");
  }
}

/// Reports progress from several threads.
class ProgressCounter {
 public:
  ProgressCounter(const study::Progress& progress, int total)
      : progress_(progress), total_(total) {}
  void increment() {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    progress_(++done_, total_);
  }

 private:
  const study::Progress& progress_;
  int total_;
  int done_ = 0;
  std::mutex mutex_;
};

}  // namespace

FeltBank::FeltBank(const LabelledFields& fields, const study::Study& study,
                   const SubjectModel& subject, const FeltBankOptions& options,
                   const study::Progress& progress)
    : explorations_(options.explorations) {
  check(options);
  for (const LabelledField& field : fields.all()) stimuli_.push_back(field.stimulus);
  const auto per_stimulus = static_cast<std::size_t>(explorations_);
  felt_.resize(stimuli_.size() * per_stimulus);
  const device::ServoOptions servo = session::trial_servo_options(study, device::kServoRateHz, {});
  ProgressCounter counter(progress, static_cast<int>(felt_.size()));
  const auto feel = [&](std::size_t i) {
    const std::size_t place = i / per_stimulus;
    const std::uint64_t index = (std::uint64_t{place} << kExplorationBits) + i % per_stimulus;
    const double gain_db = fields.draw_gain_db({options.seed, "subject: felt bank gain", index});
    felt_[i] = feel_exploration(fields.all()[place].model(gain_db), fields.plane(), subject, servo,
                                RandomStream(options.seed, "subject: felt bank", index),
                                hand_of_participant(subject, options.seed, 1 + i % per_stimulus));
    counter.increment();
  };
  in_parallel(options.jobs, felt_.size(), feel);
}

int FeltBank::place_of(const study::StimulusIndex& stimulus) const {
  const auto found = std::ranges::lower_bound(stimuli_, stimulus);
  if (found == stimuli_.end() || *found != stimulus) {
    throw std::invalid_argument("FeltBank: the study does not present this stimulus");
  }
  return static_cast<int>(found - stimuli_.begin());
}

engine::FeltFeatures feel_trial(const LabelledField& field, double gain_db,
                                const PlaneGeometry& plane, const study::Study& study,
                                const SubjectModel& subject, std::uint64_t seed, int number,
                                std::uint64_t nth) {
  return feel_exploration(field.model(gain_db), plane, subject,
                          session::trial_servo_options(study, device::kServoRateHz, {}),
                          stream_of_trial(seed, kExplorationPurpose, number, nth),
                          hand_of_participant(subject, seed, static_cast<std::uint64_t>(number)));
}

}  // namespace touchtrial::simulation
