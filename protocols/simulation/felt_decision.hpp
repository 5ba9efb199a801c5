/// \file From felt features to an answer: everything of a simulated participant except the hand and
/// the skin. Works on features from the servo and from a FeltBank.
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

/// The random stream of one presentation: a function of the seed, a purpose, the participant, and
/// the presentation's place among those that the participant begins. Lead-ins, catch trials and
/// repetitions count.
/// \param number  of the participant, from 1
/// \param nth  from 1, < 2^24
[[nodiscard]] RandomStream stream_of_trial(std::uint64_t seed, const char* purpose, int number,
                                           std::uint64_t nth);
/// Purpose of the stream for an exploration's path.
inline constexpr const char* kExplorationPurpose = "subject: exploration";
/// Purpose of the stream for a decision.
inline constexpr const char* kAnswerPurpose = "subject: answer";

/// Moves a probability by log odds. 0 and 1 have none, and stay.
[[nodiscard]] double moved(double probability, double log_odds);

/// One participant of a population. A function of subject model, seed and number: the same in every
/// study and thread. Source of the distributions: docs/planning.md, "Differences between
/// participants".
class Individual {
 public:
  /// \param subject  must outlive this
  /// \param number  of the participant, from 1
  Individual(const SubjectModel& subject, std::uint64_t seed, int number);

  /// Noise on the logarithms of felt intensities.
  [[nodiscard]] engine::FeltNoise noise() const noexcept { return noise_; }
  /// The threshold; nothing with a flat sense.
  [[nodiscard]] const std::optional<FeltFloor>& floor() const noexcept { return floor_; }
  /// Probability of a random answer, 0 .. 1.
  [[nodiscard]] double lapse() const noexcept { return lapse_; }
  /// Log odds of each picture, whatever is felt.
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

/// The pictures on the screen, for one individual.
struct SeenPictures {
  std::vector<double> bias;  ///< log odds, by position
  /// Position of the picture that each prototype of the knowledge is matched to, after label swaps.
  std::vector<std::size_t> picture_of_prototype;
};

/// \param labels  of the pictures, by position
/// \param individual  gives the biases
/// \throws std::invalid_argument if a class that was learnt has no picture
[[nodiscard]] SeenPictures see(const std::vector<std::string>& labels, const SubjectModel& subject,
                               const Individual& individual, const FeltKnowledge& knowledge);

/// The position of the picture that a class is matched to; empty if the class was not learnt.
[[nodiscard]] std::optional<std::size_t> picture_of(const std::string& label,
                                                    const SeenPictures& pictures,
                                                    const FeltKnowledge& knowledge);

/// Ends a trial: keeps what of it the next answer leans on.
/// \param place  of the trial
/// \param answered  position of the picture
void end_trial(Condition& condition, const TrialPlace& place, int answered,
               const SeenPictures& pictures, const FeltKnowledge& knowledge);

/// The support of each picture: the largest sum of log density and bias among the prototypes that
/// are matched to it; minus infinity if there are none. Cost: a few microseconds.
/// \param perceived  features with noise
[[nodiscard]] std::vector<double> support_of_pictures(const engine::FeltClassifier& classifier,
                                                      const SeenPictures& pictures,
                                                      const engine::FeltFeatures& perceived);

/// How one individual chooses a picture. Refers to nothing; immutable, thread-safe.
class FeltDecision {
 public:
  /// Cost: about 20 us for 40 examples.
  /// \throws std::invalid_argument as FeltClassifier
  FeltDecision(const Individual& individual, const FeltKnowledge& knowledge);

  /// Names a picture. Perceives each feature with noise of its own and takes the
  /// picture with the most support, one of several equal ones at random; or lapses, and takes any
  /// picture. Every call draws lapse, lapse's picture, time to think, noise and tie, in this order,
  /// and at last a time to think that depends on the margin, so that no draw shifts another. Cost:
  /// a few microseconds.
  /// \param felt  features without noise, natural logarithms of newtons
  /// \param random  stream_of_trial for kAnswerPurpose
  /// \param moment  the participant's condition; its positions are those of `pictures`
  [[nodiscard]] ParticipantAnswer answer(const engine::FeltFeatures& felt,
                                         const SeenPictures& pictures, RandomStream& random,
                                         const Moment& moment = {}) const;

 private:
  engine::FeltNoise noise_;
  std::optional<FeltFloor> floor_;
  double lapse_;
  engine::FeltClassifier classifier_;
};

}  // namespace touchtrial::simulation
