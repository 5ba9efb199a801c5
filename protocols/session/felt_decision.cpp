#include "protocols/session/felt_decision.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace touchtrial::session {
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

RandomStream stream_of_trial(std::uint64_t seed, const char* purpose, int number,
                             std::uint64_t nth) {
  constexpr unsigned kTrialBits = 24;
  return {seed, purpose, (static_cast<std::uint64_t>(number) << kTrialBits) + nth};
}

SeenPictures see(const std::vector<std::string>& labels, const SubjectModel& subject,
                 const Individual& individual, const FeltKnowledge& knowledge) {
  SeenPictures seen{individual.bias(labels), {}};
  for (const std::string& felt : knowledge.label_of_prototype) {
    const auto picture = std::ranges::find(labels, matched_label(subject, felt));
    if (picture == labels.end()) {
      throw std::invalid_argument("SimulatedParticipant: a class that was learnt has no picture");
    }
    seen.picture_of_prototype.push_back(static_cast<std::size_t>(picture - labels.begin()));
  }
  return seen;
}

std::vector<double> support_of_pictures(const engine::FeltClassifier& classifier,
                                        const SeenPictures& pictures,
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
    : weber_(individual.weber()),
      lapse_(individual.lapse()),
      classifier_(knowledge.examples, individual.weber()) {}

ParticipantAnswer FeltDecision::answer(const engine::FeltFeatures& felt,
                                       const SeenPictures& pictures, RandomStream& random) const {
  const bool lapses = random.uniform() < lapse_;
  const int anything = static_cast<int>(random.below(pictures.bias.size()));
  const double thought_s = random.uniform(kQuickestThoughtS, kSlowestThoughtS);
  engine::FeltFeatures perceived = felt;
  for (double& feature : perceived) feature += weber_ * random.normal();
  const int named = strongest(support_of_pictures(classifier_, pictures, perceived), random);
  return {lapses ? anything : named, std::chrono::milliseconds(std::llround(thought_s * 1000.0))};
}

}  // namespace touchtrial::session
