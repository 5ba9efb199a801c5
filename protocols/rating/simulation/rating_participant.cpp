#include "protocols/rating/simulation/rating_participant.hpp"

#include "protocols/simulation/own_knowledge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

namespace touchtrial::simulation::rating {
namespace {

constexpr double kMinThoughtS = 1.5;
constexpr double kMaxThoughtS = 6.0;
/// The distance in excess of the noise, in its standard deviations, at which a fit falls to 1/e.
constexpr double kFitDecay = 1.5;
// Standard deviations between participants in the use of a scale.
constexpr double kShiftSd = 0.08;
constexpr double kLogStretchSd = 0.25;

Expectations expectations_of(const PopulationSetting& setting) {
  const study::Study& study = setting.key.study;
  const LabelledFields fields(setting.key, setting.source);
  const auto learnt = learn(fields, study, setting.subject, setting.seed, setting.jobs);
  const auto is_control = [&](const LabelledField& field) {
    const auto method = static_cast<std::size_t>(field.stimulus.method);
    return study.methods[method].control != engine::Control::none;
  };
  const bool has_only_controls = std::ranges::all_of(fields.all(), is_control);
  Expectations expectations;
  std::map<std::string, double> counts;
  for (const engine::FeltExample& example : learnt->examples) {
    const LabelledField& field = fields.all()[static_cast<std::size_t>(example.label)];
    if (is_control(field) && !has_only_controls) continue;
    engine::FeltFeatures& sum = expectations[field.label];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += example.features[i];
    ++counts[field.label];
  }
  for (auto& [label, sum] : expectations) {
    for (double& feature : sum) feature /= counts[label];
  }
  return expectations;
}

class RatingPopulation final : public Population {
 public:
  explicit RatingPopulation(const PopulationSetting& setting)
      : study_(setting.key.study),
        subject_(setting.subject),
        seed_(setting.seed),
        expectations_(expectations_of(setting)) {}

  std::unique_ptr<SimulatedParticipant> participant(int number) const override {
    return std::make_unique<RatingParticipant>(subject_, study_, expectations_, seed_, number);
  }

 private:
  const study::Study& study_;
  const SubjectModel& subject_;
  std::uint64_t seed_;
  Expectations expectations_;
};

double person_deviation(const char* purpose, std::uint64_t seed, int number) {
  return RandomStream(seed, purpose, static_cast<std::uint64_t>(number)).normal();
}

double rating_at(const study::Scale& scale, double share) {
  const double value = scale.min() + share * (scale.max() - scale.min());
  if (scale.points > 0) return std::round(value);
  return std::round(value / study::kLineStep) * study::kLineStep;
}

}  // namespace

RatingParticipant::RatingParticipant(const SubjectModel& subject, const study::Study& study,
                                     const Expectations& expectations, std::uint64_t seed,
                                     int number)
    : SimulatedParticipant(subject, seed, number),
      subject_(subject),
      expectations_(expectations),
      scales_(study::rating::scales_of(study)),
      seed_(seed),
      number_(number),
      individual_(subject, seed, number),
      condition_(subject, seed, number),
      shift_(kShiftSd * person_deviation("subject: rating shift", seed, number)),
      stretch_(
          std::exp(kLogStretchSd * person_deviation("subject: rating stretch", seed, number))) {}

void RatingParticipant::begin_visit(int visit, TrialCourse course) {
  condition_ = Condition(subject_, seed_, number_, visit, static_cast<int>(course.size()));
}

double RatingParticipant::fit_of(engine::FeltFeatures felt, double noise_factor,
                                 RandomStream& random) const {
  const engine::FeltNoise noise = individual_.noise();
  const double common_noise = noise_factor * noise.common * random.normal();
  const double sd = std::max(1e-9, std::hypot(noise.independent, noise.common));
  if (individual_.floor()) individual_.floor()->apply_to(felt);
  for (double& feature : felt)
    feature += common_noise + noise_factor * noise.independent * random.normal();
  const auto expectation = expectations_.find(picture_);
  if (expectation == expectations_.end()) return 0.5;
  engine::FeltFeatures expected_features = expectation->second;
  if (individual_.floor()) individual_.floor()->apply_to(expected_features);
  double squares = 0.0;
  for (std::size_t i = 0; i < felt.size(); ++i) {
    squares += (felt[i] - expected_features[i]) * (felt[i] - expected_features[i]) / (sd * sd);
  }
  // Noise alone gives a mean square of 1.
  const double excess = std::max(0.0, squares / static_cast<double>(felt.size()) - 1.0);
  return std::exp(-std::sqrt(excess) / kFitDecay);
}

ParticipantAnswer RatingParticipant::choose(const engine::FeltFeatures& felt,
                                            RandomStream& random) {
  const ConditionEffects moment = condition_.effects_on(presentations_begun(), 0);
  const bool is_lapse =
      random.uniform() < with_log_odds(individual_.lapse(), moment.lapse_log_odds);
  const double thought_s = random.uniform(kMinThoughtS, kMaxThoughtS);
  const double fit = fit_of(felt, moment.noise_factor, random);
  ParticipantAnswer answer;
  answer.thought = std::chrono::milliseconds(std::llround(thought_s * 1000.0));
  for (const study::Scale& scale : scales_) {
    const double random_share = random.uniform();
    const double fit_share = std::clamp(0.5 + shift_ + stretch_ * (fit - 0.5), 0.0, 1.0);
    answer.ratings.push_back(rating_at(scale, is_lapse ? random_share : fit_share));
  }
  condition_.forget();
  return answer;
}

std::unique_ptr<const Population> make_population(const PopulationSetting& setting) {
  return std::make_unique<RatingPopulation>(setting);
}

}  // namespace touchtrial::simulation::rating
