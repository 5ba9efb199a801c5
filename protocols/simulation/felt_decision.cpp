#include "protocols/simulation/felt_decision.hpp"

#include "protocols/simulation/thought_time.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace touchtrial::simulation {

double with_log_odds(double probability, double log_odds) {
  if (probability <= 0.0 || probability >= 1.0) return probability;
  return 1.0 / (1.0 + std::exp(-(std::log(probability / (1.0 - probability)) + log_odds)));
}

namespace {

/// Draws a standard normal number. Each purpose has its own stream, so that no spread changes
/// another draw.
double draw_standard_normal(std::string_view purpose, std::uint64_t seed, std::uint64_t number) {
  return RandomStream(seed, purpose, number).normal();
}

/// Varies the log odds, so that the result stays a probability. With a median of 0 or 1 all
/// participants are equal.
double individual_lapse(const SubjectModel& subject, std::uint64_t seed, std::uint64_t number) {
  if (subject.lapse_spread == 0.0) return subject.lapse;
  return with_log_odds(subject.lapse,
                       subject.lapse_spread * draw_standard_normal("subject: lapse", seed, number));
}

double individual_position_bias(const SubjectModel& subject, std::uint64_t seed,
                                std::uint64_t number) {
  if (subject.position_bias_spread == 0.0) return subject.position_bias;
  return subject.position_bias + subject.position_bias_spread *
                                     draw_standard_normal("subject: position bias", seed, number);
}

/// Preference for the class with this label, regardless of its picture's position.
double class_preference(const SubjectModel& subject, const std::string& label, std::uint64_t seed,
                        std::uint64_t number) {
  if (subject.class_bias_spread == 0.0) return 0.0;
  return subject.class_bias_spread *
         draw_standard_normal("subject: bias for " + label, seed, number);
}

engine::FeltNoise individual_noise(const SubjectModel& subject, std::uint64_t seed,
                                   std::uint64_t number) {
  const double factor = std::exp(subject.feature_noise_spread *
                                 draw_standard_normal("subject: acuity", seed, number));
  return {subject.feature_noise * factor, subject.common_noise * factor};
}

std::optional<FeltFloor> individual_floor(const SubjectModel& subject, engine::FeltNoise noise,
                                          std::uint64_t seed, std::uint64_t number) {
  if (!subject.sense) return std::nullopt;
  return floor_of(noise, subject.threshold_spread_db *
                             draw_standard_normal("subject: threshold", seed, number));
}

constexpr double kMinThoughtS = 0.8;
constexpr double kMaxThoughtS = 4.0;

/// The label of the picture that a class is matched to, given the class's own label.
const std::string& matched_label(const SubjectModel& subject, const std::string& label) {
  for (const auto& [first, second] : subject.label_swap) {
    if (label == first) return second;
    if (label == second) return first;
  }
  return label;
}

void add_leaning(const std::optional<ConditionEffects::Leaning>& leaning,
                 std::vector<double>& support) {
  if (leaning && leaning->position < support.size()) {
    support[leaning->position] += leaning->log_odds;
  }
}

/// Index of the maximum; ties are broken at random.
int index_of_max(const std::vector<double>& support, RandomStream& random) {
  const double max = *std::ranges::max_element(support);
  std::vector<int> ties;
  for (std::size_t i = 0; i < support.size(); ++i) {
    if (support[i] == max) ties.push_back(static_cast<int>(i));
  }
  return ties[random.below(ties.size())];
}

}  // namespace

RandomStream stream_of_trial(std::uint64_t seed, const char* purpose, int number,
                             std::uint64_t nth) {
  constexpr unsigned kTrialBits = 24;
  return {seed, purpose, (static_cast<std::uint64_t>(number) << kTrialBits) + nth};
}

Individual::Individual(const SubjectModel& subject, std::uint64_t seed, int number)
    : subject_(&subject),
      seed_(seed),
      number_(static_cast<std::uint64_t>(number)),
      noise_(individual_noise(subject, seed, number_)),
      floor_(individual_floor(subject, noise_, seed, number_)),
      lapse_(individual_lapse(subject, seed, number_)),
      position_bias_(individual_position_bias(subject, seed, number_)) {}

std::vector<double> Individual::bias(const std::vector<std::string>& labels) const {
  std::vector<double> bias(labels.size(), 0.0);
  const double last_index = std::max(1.0, static_cast<double>(labels.size()) - 1.0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    bias[i] = position_bias_ * (1.0 - static_cast<double>(i) / last_index);
    for (const ClassBias& preferred : subject_->class_bias) {
      if (preferred.label == labels[i]) bias[i] += preferred.log_odds;
    }
    bias[i] += class_preference(*subject_, labels[i], seed_, number_);
  }
  return bias;
}

MatchedPictures match_pictures(const std::vector<std::string>& labels, const SubjectModel& subject,
                               const Individual& individual, const FeltKnowledge& knowledge) {
  MatchedPictures matches{individual.bias(labels), {}};
  for (const std::string& label : knowledge.label_of_prototype) {
    const auto picture = std::ranges::find(labels, matched_label(subject, label));
    if (picture == labels.end()) {
      throw std::invalid_argument("SimulatedParticipant: a learnt class has no picture");
    }
    matches.picture_of_prototype.push_back(static_cast<std::size_t>(picture - labels.begin()));
  }
  return matches;
}

std::optional<std::size_t> picture_of(const std::string& label, const MatchedPictures& pictures,
                                      const FeltKnowledge& knowledge) {
  const auto& labels = knowledge.label_of_prototype;
  const auto found = std::ranges::find(labels, label);
  if (found == labels.end()) return std::nullopt;
  return pictures.picture_of_prototype[static_cast<std::size_t>(found - labels.begin())];
}

void end_trial(Condition& condition, const TrialPlace& place, int answered,
               const MatchedPictures& pictures, const FeltKnowledge& knowledge) {
  if (!place.carries_over) return condition.forget();
  condition.record_trial(static_cast<std::size_t>(answered),
                         picture_of(place.label, pictures, knowledge));
}

std::vector<double> support_of_pictures(const engine::FeltClassifier& classifier,
                                        const MatchedPictures& pictures,
                                        const engine::FeltFeatures& perceived) {
  const std::vector<double> logs = classifier.log_likelihoods(perceived);
  std::vector<double> support(pictures.bias.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const std::size_t picture = pictures.picture_of_prototype[i];
    support[picture] = std::max(support[picture], logs[i] + pictures.bias[picture]);
  }
  return support;
}

FeltDecision::FeltDecision(const Individual& individual, const FeltKnowledge& knowledge)
    : noise_(individual.noise()),
      floor_(individual.floor()),
      lapse_(individual.lapse()),
      classifier_(perceived_examples(knowledge, floor_), noise_) {}

ParticipantAnswer FeltDecision::answer(const engine::FeltFeatures& felt,
                                       const MatchedPictures& pictures, RandomStream& random,
                                       const ConditionEffects& moment) const {
  const double lapse =
      moment.lapse_log_odds == 0.0 ? lapse_ : with_log_odds(lapse_, moment.lapse_log_odds);
  const bool is_lapse = random.uniform() < lapse;
  const int random_position = static_cast<int>(random.below(pictures.bias.size()));
  double thought_s = random.uniform(kMinThoughtS, kMaxThoughtS);
  const engine::FeltNoise noise{noise_.independent * moment.noise_factor,
                                noise_.common * moment.noise_factor};
  engine::FeltFeatures perceived = felt;
  if (floor_) floor_->apply_to(perceived);
  for (double& feature : perceived) feature += noise.independent * random.normal();
  if (noise.common > 0.0) {
    const double common_error = noise.common * random.normal();
    for (double& feature : perceived) feature += common_error;
  }
  std::vector<double> support = support_of_pictures(classifier_, pictures, perceived);
  add_leaning(moment.answer_leaning, support);
  add_leaning(moment.stimulus_leaning, support);
  const int best_position = index_of_max(support, random);
  if (moment.thought != nullptr) {
    thought_s = thought_time_s(*moment.thought, margin_of(support), random);
  }
  return {is_lapse ? random_position : best_position,
          std::chrono::milliseconds(std::llround(thought_s * 1000.0))};
}

}  // namespace touchtrial::simulation
