#include "protocols/simulation/condition.hpp"

#include "core/random.hpp"

#include <cmath>
#include <string_view>

namespace touchtrial::simulation {
namespace {

/// Draws a participant's value: the population's value plus spread times a standard normal number.
/// Each purpose has its own stream, so that no spread changes another draw.
double individual_value(double value, double spread, std::string_view purpose, std::uint64_t seed,
                        std::uint64_t number) {
  if (spread == 0.0) return value;
  return value + spread * RandomStream(seed, purpose, number).normal();
}

/// The number of presentations at earlier visits, less those forgotten.
double earlier_presentations(const Learning& learning, int visit, int presentations) {
  double count = 0.0;
  for (int earlier = 1; earlier < visit; ++earlier) {
    count = (count + presentations) * (1.0 - learning.forgotten);
  }
  return count;
}

}  // namespace

Condition::Condition(const SubjectModel& subject, std::uint64_t seed, int number, int visit,
                     int presentations)
    : subject_(&subject),
      seed_(seed),
      number_(static_cast<std::uint64_t>(number)),
      visit_(visit),
      first_log_(std::log(subject.learning.factor) *
                 std::exp(individual_value(0.0, subject.learning.spread, "subject: learning", seed,
                                           number_))),
      earlier_presentations_(earlier_presentations(subject.learning, visit, presentations)),
      answer_leaning_(individual_value(subject.serial.answer, subject.serial.answer_spread,
                                       "subject: leaning to the last answer", seed, number_)),
      stimulus_leaning_(individual_value(subject.serial.stimulus, subject.serial.stimulus_spread,
                                         "subject: leaning to the last stimulus", seed, number_)) {}

ConditionEffects Condition::effects_on(int nth, int block) {
  tire(nth - 1);
  const double presentations = earlier_presentations_ + (nth - 1);
  const double learning_log = first_log_ * std::exp(-presentations / subject_->learning.trials);
  const double tired_log = subject_->fatigue.noise_per_min * tired_min_;
  ConditionEffects moment;
  moment.noise_factor = std::exp(learning_log + tired_log + period_log(block));
  moment.lapse_log_odds = subject_->fatigue.lapse_per_min * tired_min_;
  if (answered_ && answer_leaning_ != 0.0) moment.answer_leaning = {*answered_, answer_leaning_};
  if (presented_ && stimulus_leaning_ != 0.0)
    moment.stimulus_leaning = {*presented_, stimulus_leaning_};
  if (subject_->thought) moment.thought = &*subject_->thought;
  return moment;
}

void Condition::rest(int presentations) {
  tire(presentations);
  tired_min_ *= 1.0 - subject_->fatigue.recovered;
}

void Condition::record_trial(std::size_t answered, std::optional<std::size_t> presented) {
  answered_ = answered;
  presented_ = presented;
}

void Condition::forget() noexcept {
  answered_.reset();
  presented_.reset();
}

void Condition::tire(int presentations) {
  constexpr double kSecondsPerMinute = 60.0;
  tired_min_ += (presentations - tired_presentations_) * subject_->explore_s / kSecondsPerMinute;
  tired_presentations_ = presentations;
}

double Condition::period_log(int block) {
  if (subject_->period_noise_spread == 0.0) return 0.0;
  const auto [found, is_new] = period_logs_.try_emplace(block, 0.0);
  if (is_new) {
    constexpr unsigned kPeriodBits = 16;
    constexpr unsigned kBlockBits = 8;
    const std::uint64_t period =
        (static_cast<std::uint64_t>(visit_) << kBlockBits) + static_cast<std::uint64_t>(block);
    found->second = individual_value(0.0, subject_->period_noise_spread, "subject: period", seed_,
                                     (number_ << kPeriodBits) + period);
  }
  return found->second;
}

}  // namespace touchtrial::simulation
