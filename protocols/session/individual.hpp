/// \file One participant of a population: what differs between people, drawn for one of them.
/// Source of the distributions: docs/subject-file.md, "Differences between participants".
#pragma once

#include "protocols/session/subject_model.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace touchtrial::session {

/// A function of subject model, seed and number: the same at every study, in every thread.
class Individual {
 public:
  /// \param number  the participant's, from 1
  Individual(const SubjectModel& subject, std::uint64_t seed, int number);

  /// Standard deviation of the noise on the logarithm of every felt intensity.
  [[nodiscard]] double weber() const noexcept { return weber_; }
  /// Probability of an answer at random, 0 .. 1.
  [[nodiscard]] double lapse() const noexcept { return lapse_; }
  /// Log odds of each picture, whatever is felt. \param labels  of the pictures, by position
  [[nodiscard]] std::vector<double> bias(const std::vector<std::string>& labels) const;

 private:
  const SubjectModel* subject_;  ///< outlives the individual
  std::uint64_t seed_;
  std::uint64_t number_;
  double weber_;
  double lapse_;
  double position_bias_;
};

}  // namespace touchtrial::session
