/// \file From what was felt to an answer: all of a simulated participant that is no hand and no
/// skin. Used by whoever has felt features, from a servo or from a FeltBank.
#pragma once

#include "core/random.hpp"
#include "engine/perception/felt_classifier.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/session/felt_knowledge.hpp"
#include "protocols/session/individual.hpp"
#include "protocols/session/prompt_participant.hpp"
#include "protocols/session/subject_model.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace touchtrial::session {

/// Draws of one presentation: a stream for a seed, a purpose, a participant and the presentation
/// that is the nth to begin, lead-ins, catch trials and repetitions counted.
/// \param number,nth  from 1; nth < 2^24
[[nodiscard]] RandomStream stream_of_trial(std::uint64_t seed, const char* purpose, int number,
                                           std::uint64_t nth);
/// Purposes of a simulated participant's streams: the path of a trial's exploration, and its
/// decision.
inline constexpr const char* kExplorationPurpose = "subject: exploration";
inline constexpr const char* kAnswerPurpose = "subject: answer";

/// The pictures on the screen as a subject takes them.
struct SeenPictures {
  std::vector<double> bias;  ///< log odds, by position
  /// Position of the picture that each prototype of the knowledge is matched to, swaps included.
  std::vector<std::size_t> picture_of_prototype;
};

/// \param labels  of the pictures, by position  \param individual  whose biases they are
/// \throws std::invalid_argument if a class that was learnt has no picture
[[nodiscard]] SeenPictures see(const std::vector<std::string>& labels, const SubjectModel& subject,
                               const Individual& individual, const FeltKnowledge& knowledge);

/// How likely each picture is for someone who perceives these features: the largest, among the
/// prototypes matched to it, of log density plus bias; minus infinity if there is none. Cost: some
/// microseconds.
/// \param perceived  noise included
[[nodiscard]] std::vector<double> support_of_pictures(const engine::FeltClassifier& classifier,
                                                      const SeenPictures& pictures,
                                                      const engine::FeltFeatures& perceived);

/// Somebody before pictures. Refers to nothing; immutable, thread-safe.
class FeltDecision {
 public:
  /// Cost: some 20 us for 40 examples.
  /// \throws std::invalid_argument as FeltClassifier
  FeltDecision(const Individual& individual, const FeltKnowledge& knowledge);

  /// Names a picture: perceives the features with a noise of the Weber fraction on each, and takes
  /// the picture of most support, one of several equal ones at random; or lapses, and takes any.
  /// Draws lapse, lapse's picture, time to think, noise, tie, in this order, and all of them each
  /// time, so that none shifts another. Cost: some microseconds.
  /// \param felt  before noise, natural logarithms of newtons
  /// \param random  stream_of_trial for kAnswerPurpose
  [[nodiscard]] ParticipantAnswer answer(const engine::FeltFeatures& felt,
                                         const SeenPictures& pictures, RandomStream& random) const;

 private:
  double weber_;
  double lapse_;
  engine::FeltClassifier classifier_;
};

}  // namespace touchtrial::session
