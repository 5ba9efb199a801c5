/// \file A simulated participant who has learnt how the classes feel and identifies the presented
/// class.
#pragma once

#include "protocols/simulation/condition.hpp"
#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/simulated_participant.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial::simulation::identification {

/// Perceives the felt intensities with noise and chooses the picture of the most likely class,
/// subject to bias and condition; in a lapse, chooses a random picture. The subject must outlive
/// it.
class IdentifyingParticipant final : public SimulatedParticipant {
 public:
  /// \param number  from 1
  IdentifyingParticipant(const SubjectModel& subject,
                         std::shared_ptr<const FeltKnowledge> knowledge, std::uint64_t seed,
                         int number);
  /// \param knowledge  must outlive the participant
  IdentifyingParticipant(const SubjectModel& subject, const FeltKnowledge& knowledge,
                         std::uint64_t seed, int number);

  /// \throws std::invalid_argument if a learnt class has no picture
  void see_pictures(const std::vector<std::string>& labels) override;

  void rest() override;

 protected:
  [[nodiscard]] ParticipantAnswer choose(const engine::FeltFeatures& felt,
                                         RandomStream& random) override;
  void begin_visit(int visit, TrialCourse course) override;

 private:
  const SubjectModel& subject_;
  std::uint64_t seed_;
  int number_;
  std::shared_ptr<const FeltKnowledge> knowledge_;
  Individual individual_;
  FeltDecision decision_;
  Condition condition_;
  TrialCourse course_;
  MatchedPictures pictures_;
};

/// Trains participants on the study's labelled fields, all with the same or each with different
/// training passes, as the subject model specifies.
/// \throws StudyError if the subject names a class that the study does not have
/// \throws FileError if the pack lacks a stimulus
[[nodiscard]] std::unique_ptr<const Population> make_population(const PopulationSetting& setting);

}  // namespace touchtrial::simulation::identification
