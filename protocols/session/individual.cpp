#include "protocols/session/individual.hpp"

#include "core/random.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::session {
namespace {

/// Each difference has a stream of its own, so that adding one leaves the others as they were.
double deviation(const char* purpose, std::uint64_t seed, std::uint64_t number) {
  return RandomStream(seed, purpose, number).normal();
}

/// By log odds, so that it stays a probability; who never lapses, or always, is like all others.
double individual_lapse(const SubjectModel& subject, std::uint64_t seed, std::uint64_t number) {
  const double median = subject.lapse;
  if (subject.lapse_spread == 0.0 || median <= 0.0 || median >= 1.0) return median;
  const double log_odds = std::log(median / (1.0 - median)) +
                          subject.lapse_spread * deviation("subject: lapse", seed, number);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

double individual_position_bias(const SubjectModel& subject, std::uint64_t seed,
                                std::uint64_t number) {
  if (subject.position_bias_spread == 0.0) return subject.position_bias;
  return subject.position_bias +
         subject.position_bias_spread * deviation("subject: position bias", seed, number);
}

/// What somebody feels about a class of this name, wherever its picture lies.
double liking(const SubjectModel& subject, const std::string& label, std::uint64_t seed,
              std::uint64_t number) {
  if (subject.class_bias_spread == 0.0) return 0.0;
  const std::string purpose = "subject: bias for " + label;
  return subject.class_bias_spread * RandomStream(seed, purpose, number).normal();
}

}  // namespace

Individual::Individual(const SubjectModel& subject, std::uint64_t seed, int number)
    : subject_(&subject),
      seed_(seed),
      number_(static_cast<std::uint64_t>(number)),
      weber_(subject.weber *
             std::exp(subject.weber_spread * deviation("subject: acuity", seed, number_))),
      lapse_(individual_lapse(subject, seed, number_)),
      position_bias_(individual_position_bias(subject, seed, number_)) {}

std::vector<double> Individual::bias(const std::vector<std::string>& labels) const {
  std::vector<double> bias(labels.size(), 0.0);
  const double last = std::max(1.0, static_cast<double>(labels.size()) - 1.0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    bias[i] = position_bias_ * (1.0 - static_cast<double>(i) / last);
    for (const ClassBias& preferred : subject_->class_bias) {
      if (preferred.label == labels[i]) bias[i] += preferred.log_odds;
    }
    bias[i] += liking(*subject_, labels[i], seed_, number_);
  }
  return bias;
}

}  // namespace touchtrial::session
