/// \file How a simulated participant turns felt features into an answer. The features come from the
/// servo or from a FeltBank.
#pragma once

#include "core/random.hpp"
#include "engine/perception/felt_classifier.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/simulation/condition.hpp"
#include "protocols/simulation/felt_floor.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "protocols/simulation/subject_model.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::simulation {

/// The random stream of one presentation, for a purpose. Presentations are numbered in the order in
/// which the participant begins them, including lead-ins, catch trials and repetitions.
/// \param number  the participant's number, from 1
/// \param nth  number of the presentation, from 1, < 2^24
[[nodiscard]] RandomStream stream_of_trial(std::uint64_t seed, const char* purpose, int number,
                                           std::uint64_t nth);
/// Purpose of the stream for an exploration's path.
inline constexpr const char* kExplorationPurpose = "subject: exploration";
/// Purpose of the stream for a decision.
inline constexpr const char* kAnswerPurpose = "subject: answer";

/// Adds log odds to a probability; 0 and 1 stay unchanged.
[[nodiscard]] double with_log_odds(double probability, double log_odds);

/// One participant of a population, determined by subject model, seed and number, and therefore the
/// same in every study and thread. Source of the distributions: docs/planning.md, "Differences
/// between participants".
class Individual {
 public:
  /// \param subject  must outlive this
  /// \param number  the participant's number, from 1
  Individual(const SubjectModel& subject, std::uint64_t seed, int number);

  /// Noise on the logarithms of felt intensities.
  [[nodiscard]] engine::FeltNoise noise() const noexcept { return noise_; }
  /// The threshold; empty if the sense has no threshold curve.
  [[nodiscard]] const std::optional<FeltFloor>& floor() const noexcept { return floor_; }
  /// Probability of a random answer, 0 .. 1.
  [[nodiscard]] double lapse() const noexcept { return lapse_; }
  /// Bias towards each picture, log odds, independent of felt features.
  /// \param labels  of the pictures, by position
  [[nodiscard]] std::vector<double> bias(const std::vector<std::string>& labels) const;

 private:
  const SubjectModel* subject_;
  std::uint64_t seed_;
  std::uint64_t number_;
  engine::FeltNoise noise_;
  std::optional<FeltFloor> floor_;
  double lapse_;
  double position_bias_;
};

/// The pictures on the screen, with one individual's biases.
struct MatchedPictures {
  std::vector<double> bias;  ///< log odds, by position
  /// For each prototype of the knowledge, the position of its picture, after label swaps.
  std::vector<std::size_t> picture_of_prototype;
};

/// Matches prototypes and biases to the pictures on the screen.
/// \param labels  of the pictures, by position
/// \throws std::invalid_argument if a learnt class has no picture
[[nodiscard]] MatchedPictures match_pictures(const std::vector<std::string>& labels,
                                             const SubjectModel& subject,
                                             const Individual& individual,
                                             const FeltKnowledge& knowledge);

/// The position of the picture that a class is matched to; empty if the class was not learnt.
[[nodiscard]] std::optional<std::size_t> picture_of(const std::string& label,
                                                    const MatchedPictures& pictures,
                                                    const FeltKnowledge& knowledge);

/// Ends a trial, and records what affects the next answer.
/// \param place  of the trial
/// \param answered  position of the picture
void end_trial(Condition& condition, const TrialPlace& place, int answered,
               const MatchedPictures& pictures, const FeltKnowledge& knowledge);

/// The support of each picture: the maximum of log density plus bias over its prototypes; minus
/// infinity if it has none. Takes a few microseconds.
/// \param perceived  features with noise
[[nodiscard]] std::vector<double> support_of_pictures(const engine::FeltClassifier& classifier,
                                                      const MatchedPictures& pictures,
                                                      const engine::FeltFeatures& perceived);

/// An individual's rule for choosing a picture. Contains no references; immutable and thread-safe.
class FeltDecision {
 public:
  /// Takes about 20 us for 40 examples.
  /// \throws std::invalid_argument as FeltClassifier
  FeltDecision(const Individual& individual, const FeltKnowledge& knowledge);

  /// Chooses the picture with the maximum support after adding noise to each feature, and breaks
  /// ties at random. In a lapse, chooses any picture. Every call draws lapse, the lapse's picture,
  /// thinking time, noise and tie, in this order, then a thinking time that depends on the margin,
  /// so that no draw changes another. Takes a few microseconds.
  /// \param felt  features without noise, natural logarithms of newtons
  /// \param random  stream_of_trial for kAnswerPurpose
  /// \param moment  the participant's condition; its positions are those of `pictures`
  [[nodiscard]] ParticipantAnswer answer(const engine::FeltFeatures& felt,
                                         const MatchedPictures& pictures, RandomStream& random,
                                         const ConditionEffects& moment = {}) const;

 private:
  engine::FeltNoise noise_;
  std::optional<FeltFloor> floor_;
  double lapse_;
  engine::FeltClassifier classifier_;
};

}  // namespace touchtrial::simulation
