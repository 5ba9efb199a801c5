#include "protocols/threshold/simulation/comparing_participant.hpp"

#include "core/errors.hpp"
#include "protocols/procedures/psychometric_function.hpp"
#include "protocols/session/exploration.hpp"
#include "protocols/simulation/felt_exploration.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

namespace touchtrial::simulation::threshold {
namespace {

using study::threshold::Question;
using study::threshold::ThresholdOptions;

constexpr double kMinThoughtS = 0.8;
constexpr double kMaxThoughtS = 4.0;

engine::FeltFeatures perceived(engine::FeltFeatures felt, const Individual& person) {
  if (person.floor()) person.floor()->apply_to(felt);
  return felt;
}

/// The index of the strength whose nearest neighbour is farthest away.
int odd_index(const std::vector<double>& strengths) {
  int odd = 0;
  double largest_distance = -1.0;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < strengths.size(); ++j) {
      if (j != i) nearest = std::min(nearest, std::abs(strengths[i] - strengths[j]));
    }
    if (nearest <= largest_distance) continue;
    largest_distance = nearest;
    odd = static_cast<int>(i);
  }
  return odd;
}

/// Sets an exploration time longer than any interval.
SubjectModel with_long_exploration(SubjectModel subject, const study::Study& study) {
  constexpr double kMarginS = 1.0;
  subject.explore_s = study.trials.explore_limit_s + kMarginS;
  return subject;
}

class ComparingPopulation final : public Population {
 public:
  explicit ComparingPopulation(const PopulationSetting& setting)
      : study_(setting.key.study),
        subject_(with_long_exploration(setting.subject, study_)),
        seed_(setting.seed),
        expected_(expected_change_of(setting)) {}

  std::unique_ptr<SimulatedParticipant> participant(int number) const override {
    return std::make_unique<ComparingParticipant>(subject_, study_, expected_, seed_, number);
  }

 private:
  /// The mean over standards and training passes. Each pass strokes both planes along the same
  /// path.
  [[nodiscard]] static ExpectedChange expected_change_of(const PopulationSetting& setting);

  const study::Study& study_;
  SubjectModel subject_;
  std::uint64_t seed_;
  ExpectedChange expected_;
};

ExpectedChange ComparingPopulation::expected_change_of(const PopulationSetting& setting) {
  const study::Study& study = setting.key.study;
  const ThresholdOptions& options = study::threshold::options_of(study);
  SubjectModel learner = setting.subject;
  learner.explore_s = options.interval_s + device::SimulatedHand::kPushBuildUpS;
  const device::ServoOptions servo = session::trial_servo_options(study, device::kServoRateHz, {});
  const std::size_t standards = study::threshold::standards_of(study).size();
  const int passes = setting.subject.training_passes;
  const double share = 1.0 / (static_cast<double>(standards) * passes);
  ExpectedChange expected;
  for (std::size_t standard = 0; standard < standards; ++standard) {
    for (int pass = 0; pass < passes; ++pass) {
      const auto felt = [&](std::optional<std::size_t> level) {
        const study::Plane plane = study::threshold::plane_at(study, standard, level);
        return feel_exploration(setting.source.plane_of(plane, setting.key), setting.source.plane(),
                                learner, servo,
                                RandomStream(setting.seed, "subject: interval practice",
                                             (standard << 16U) + static_cast<std::uint64_t>(pass)));
      };
      const engine::FeltFeatures lower = felt(std::nullopt);
      const engine::FeltFeatures higher = felt(options.track.levels.size() - 1);
      for (std::size_t i = 0; i < lower.size(); ++i) {
        expected.lower[i] += share * lower[i];
        expected.higher[i] += share * higher[i];
      }
    }
  }
  return expected;
}

}  // namespace

ComparingParticipant::ComparingParticipant(const SubjectModel& subject, const study::Study& study,
                                           const ExpectedChange& expected, std::uint64_t seed,
                                           int number)
    : SimulatedParticipant(subject, seed, number),
      subject_(subject),
      options_(study::threshold::options_of(study)),
      seed_(seed),
      number_(number),
      individual_(subject, seed, number),
      condition_(subject, seed, number) {
  const engine::FeltFeatures lower = perceived(expected.lower, individual_);
  const engine::FeltFeatures higher = perceived(expected.higher, individual_);
  for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] = higher[i] - lower[i];
  const auto sum = [this] { return std::accumulate(weights_.begin(), weights_.end(), 0.0); };
  if (options_.rove_db > 0.0) {
    // With roved gains, the overall strength is uninformative.
    const double mean = sum() / static_cast<double>(weights_.size());
    for (double& weight : weights_) weight -= mean;
  }
  const double squares =
      std::inner_product(weights_.begin(), weights_.end(), weights_.begin(), 0.0);
  const engine::FeltNoise noise = individual_.noise();
  noise_ = std::sqrt(noise.independent * noise.independent * squares +
                     noise.common * noise.common * sum() * sum());
  // The criterion is the standard deviation of the difference of two strengths.
  criterion_ = std::sqrt(2.0) * noise_;
}

void ComparingParticipant::begin_visit(int visit, TrialCourse course) {
  condition_ = Condition(subject_, seed_, number_, visit, static_cast<int>(course.size()));
  started_count_ = 0;
  started_trials_.clear();
}

void ComparingParticipant::interval(const session::IntervalStep& next) {
  if (next.interval == 1) {
    felt_.clear();
    ++started_count_;
  } else {
    felt_.push_back(last_features());
  }
  is_control_ = next.hand_off;
  if (next.interval == 1 && !started_trials_.insert(next.trial).second && order_) {
    order_->interrupted({.place = {.trial = next.trial}});
  }
  trial_ = next.trial;
}

double ComparingParticipant::strength(engine::FeltFeatures felt, double noise_factor,
                                      RandomStream& random) const {
  felt = perceived(felt, individual_);
  const engine::FeltNoise noise = individual_.noise();
  const double common_noise = noise_factor * noise.common * random.normal();
  double sum = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    sum +=
        weights_[i] * (felt[i] + common_noise + noise_factor * noise.independent * random.normal());
  }
  return sum;
}

int ComparingParticipant::choose_from_strengths(const std::vector<double>& strengths) const {
  switch (options_.question) {
    case Question::odd_one_out:
      return odd_index(strengths);
    case Question::same_different:
      return std::abs(strengths[0] - strengths[1]) > criterion_ ? 1 : 0;
    case Question::which_interval:
      break;
  }
  return static_cast<int>(std::ranges::max_element(strengths) - strengths.begin());
}

int ComparingParticipant::answer_by_function(RandomStream& random) {
  if (!order_) {
    throw UsageError(
        "given_function: only `touchtrial simulate` provides the level of a trial; use it, or "
        "remove "
        "given_function from the subject file");
  }
  const study::Trial trial = order_->at({.place = {.trial = trial_}});
  const int target = trial.right.value();
  const GivenFunction& function = *subject_.given_function;
  const procedures::ParameterGrid& grid = options_.track.grid;
  const auto person = static_cast<std::uint64_t>(number_);
  const int standard = std::max(0, trial.level.value().track - 1) / options_.tracks_each;
  const double person_offset = RandomStream(seed_, "subject: given threshold", person).normal();
  const double standard_offset =
      RandomStream(seed_, "subject: given threshold at a standard",
                   person * procedures::kMaxTracks + static_cast<std::uint64_t>(standard))
          .normal();
  const double threshold = function.threshold + function.spread * person_offset +
                           function.standard_step * standard +
                           function.standard_spread * standard_offset;
  const procedures::Observer observer{grid.shape, threshold, function.slope, grid.guess,
                                      function.lapse};
  const double level = options_.track.levels[static_cast<std::size_t>(trial.level.value().level)];
  const bool right = random.uniform() < procedures::shares_at(observer, level).correct;
  const auto wrong = static_cast<int>(random.below(labels_.size() - 1));
  const int position = right ? target : wrong + (wrong >= target ? 1 : 0);
  order_->answered(trial, ChoiceAnswer{position});
  return position;
}

ParticipantAnswer ComparingParticipant::choose(const engine::FeltFeatures& felt,
                                               RandomStream& random) {
  felt_.push_back(felt);
  const ConditionEffects moment = condition_.effects_on(started_count_, 0);
  const bool is_lapse =
      random.uniform() < with_log_odds(individual_.lapse(), moment.lapse_log_odds);
  const auto random_position = static_cast<int>(random.below(labels_.size()));
  const double thought_s = random.uniform(kMinThoughtS, kMaxThoughtS);
  std::vector<double> strengths;
  for (const engine::FeltFeatures& one : felt_) {
    strengths.push_back(strength(one, moment.noise_factor, random));
  }
  if (options_.question == Question::which_interval) {
    // Position bias, in standard deviations of the noise.
    const std::vector<double> bias = individual_.bias(labels_);
    for (std::size_t i = 0; i < strengths.size(); ++i) strengths[i] += noise_ * bias[i];
  }
  int position = is_lapse || is_control_ ? random_position : choose_from_strengths(strengths);
  if (subject_.given_function && !is_control_) position = answer_by_function(random);
  condition_.record_trial(static_cast<std::size_t>(position), std::nullopt);
  return {position, std::chrono::milliseconds(std::llround(thought_s * 1000.0))};
}

std::unique_ptr<const Population> make_population(const PopulationSetting& setting) {
  return std::make_unique<ComparingPopulation>(setting);
}

}  // namespace touchtrial::simulation::threshold
