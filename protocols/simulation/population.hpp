/// \file The simulated participants of a study. Its protocol defines how they answer.
#pragma once

#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/simulated_participant.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/study_key.hpp"

#include <cstdint>
#include <memory>
#include <string_view>

namespace touchtrial::simulation {

/// The input of a population; everything must outlive the population.
struct PopulationSetting {
  const study::StudyCodes& key;
  const session::StimulusSource& source;
  const SubjectModel& subject;
  std::uint64_t seed = 1;  ///< of all participants' random numbers
  int jobs = 1;            ///< threads for the training before the first trial, >= 1
};

/// Trained participants. Immutable and thread-safe.
class Population {
 public:
  virtual ~Population() = default;
  /// \param number  the participant's number, from 1
  /// \return a participant, which must not outlive the population
  [[nodiscard]] virtual std::unique_ptr<SimulatedParticipant> participant(int number) const = 0;
};

using MakePopulation = std::unique_ptr<const Population> (*)(const PopulationSetting&);

/// Registers the constructor of a protocol's simulated participants. Call before the first
/// simulation; not thread-safe.
/// \param protocol  the protocol's name, a string with static lifetime
void add_population(std::string_view protocol, MakePopulation make);

/// Creates and trains the participants of a study.
/// \throws StudyError if its protocol has no simulated participants
[[nodiscard]] std::unique_ptr<const Population> population_of(const PopulationSetting& setting);

}  // namespace touchtrial::simulation
