/// \file A simulated participant who knows the classes by touch and names the one that was felt.
#pragma once

#include "protocols/simulation/felt_decision.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/population.hpp"
#include "protocols/simulation/simulated_participant.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial::simulation::identification {

/// Perceives the felt intensities with Weber noise and names the picture whose class makes them
/// likeliest, bias included; or lapses, and names any picture. Refers to subject and knowledge,
/// which must outlive it.
class IdentifyingParticipant final : public SimulatedParticipant {
 public:
  /// \param number  from 1
  IdentifyingParticipant(const SubjectModel& subject, const FeltKnowledge& knowledge,
                         std::uint64_t seed, int number);

  /// \throws std::invalid_argument if a class that was learnt has no picture
  void see_pictures(const std::vector<std::string>& labels) override;

 protected:
  [[nodiscard]] ParticipantAnswer choose(const engine::FeltFeatures& felt,
                                         RandomStream& random) override;

 private:
  const SubjectModel& subject_;
  const FeltKnowledge& knowledge_;
  Individual individual_;
  FeltDecision decision_;
  SeenPictures pictures_;
};

/// Trains the subject model on the study's labelled fields, once: all participants know the classes
/// alike, and differ in acuity, paths and noise.
/// \throws StudyError if the subject names a class that the study does not have
/// \throws FileError if the pack lacks a stimulus
[[nodiscard]] std::unique_ptr<const Population> make_population(const PopulationSetting& setting);

}  // namespace touchtrial::simulation::identification
