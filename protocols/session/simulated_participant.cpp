#include "protocols/session/simulated_participant.hpp"

#include "protocols/session/simulated_exploration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace touchtrial {
namespace {

constexpr double kQuickestThoughtS = 0.8;
constexpr double kSlowestThoughtS = 4.0;

/// The label whose picture a feeling is matched to.
const std::string& matched_label(const SubjectModel& subject, const std::string& label) {
  for (const auto& [one, other] : subject.label_swap) {
    if (label == one) return other;
    if (label == other) return one;
  }
  return label;
}

/// The strongest, one of the strongest at random if several are equal.
int strongest(const std::vector<double>& support, RandomStream& random) {
  const double most = *std::ranges::max_element(support);
  std::vector<int> equals;
  for (std::size_t i = 0; i < support.size(); ++i) {
    if (support[i] == most) equals.push_back(static_cast<int>(i));
  }
  return equals[random.below(equals.size())];
}

}  // namespace

SimulatedParticipant::SimulatedParticipant(const SubjectModel& subject,
                                           const FeltKnowledge& knowledge, std::uint64_t seed,
                                           int number)
    : subject_(subject),
      knowledge_(knowledge),
      seed_(seed),
      number_(number),
      individual_(subject, seed, number),
      classifier_(knowledge.examples, individual_.weber()) {}

RandomStream SimulatedParticipant::stream(const char* purpose) const {
  constexpr unsigned kTrialBits = 24;
  return {seed_, purpose, (static_cast<std::uint64_t>(number_) << kTrialBits) + trials_begun_};
}

void SimulatedParticipant::see_pictures(const std::vector<std::string>& labels) {
  bias_ = individual_.bias(labels);
  picture_of_prototype_.clear();
  for (const std::string& felt : knowledge_.label_of_prototype) {
    const auto picture = std::ranges::find(labels, matched_label(subject_, felt));
    if (picture == labels.end()) {
      throw std::invalid_argument("SimulatedParticipant: a class that was learnt has no picture");
    }
    picture_of_prototype_.push_back(static_cast<std::size_t>(picture - labels.begin()));
  }
}

HapticDevice& SimulatedParticipant::begin_exploring(const PlaneGeometry& plane) {
  ++trials_begun_;
  sense_.reset(plane);
  RandomStream random = stream("subject: exploration");
  return hand_.emplace(make_exploring_hand(subject_, plane, random));
}

void SimulatedParticipant::feel(const ServoSample& sample) noexcept {
  sense_.feel(sample.position_mm, sample.force_n);
}

std::vector<double> SimulatedParticipant::support_of_pictures(RandomStream& random) const {
  FeltFeatures perceived = sense_.features();
  for (double& feature : perceived) feature += individual_.weber() * random.normal();
  const std::vector<double> logs = classifier_.log_likelihoods(perceived);
  std::vector<double> support(bias_.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const std::size_t picture = picture_of_prototype_[i];
    support[picture] = std::max(support[picture], logs[i] + bias_[picture]);
  }
  return support;
}

ParticipantAnswer SimulatedParticipant::answer() {
  // Every draw is made whether it is needed or not, so that none shifts another.
  RandomStream random = stream("subject: answer");
  const bool lapses = random.uniform() < individual_.lapse();
  const int anything = static_cast<int>(random.below(bias_.size()));
  const double thought_s = random.uniform(kQuickestThoughtS, kSlowestThoughtS);
  const int felt = strongest(support_of_pictures(random), random);
  return {lapses ? anything : felt, std::chrono::milliseconds(std::llround(thought_s * 1000.0))};
}

}  // namespace touchtrial
