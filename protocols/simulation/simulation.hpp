/// \file A complete study with simulated participants, in virtual time.
#pragma once

#include "engine/pack/pack.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "record/study_store.hpp"
#include "study/prepare.hpp"
#include "study/study_key.hpp"

#include <cstdint>
#include <string>

namespace touchtrial::simulation {

struct SimulationOptions {
  int participants = 20;      ///< >= 1
  std::uint64_t seed = 1;     ///< of all participants' random numbers
  int jobs = 1;               ///< threads, >= 1; results do not depend on it
  int first_participant = 1;  ///< >= 1; 1 is P001 with enrolment number 1
};

/// Counts of a simulation, without outcomes.
struct SimulationReport {
  int sessions = 0;
  int presentations = 0;
  int invalid_trials = 0;
  std::int64_t ticks = 0;  ///< of the servo, without training
  std::string device{};    ///< recorded_device of the subject
};

/// Trains the participants on the study's labelled fields as the subject model specifies. Then runs
/// one session for each participant and visit through the session state machine and stores it: the
/// first visits of all participants in their order, then the second visits, and so on. Groups have
/// no effect. The stored data depend only on key, pack, subject, seed and first participant. Only a
/// few sessions are in memory at a time.
/// \param progress  called after each session, from one thread at a time
/// \throws StudyError if the subject names a class that the study does not have
/// \throws FileError if the pack lacks a stimulus
/// \throws StoreError if a participant is already in the database or a write fails; sessions that
///   are already stored remain
/// \throws std::invalid_argument if an option is out of range
SimulationReport simulate_study(const study::StudyKey& key, const engine::Pack& pack,
                                const SubjectModel& subject, const SimulationOptions& options,
                                record::StudyStore& store, const study::Progress& progress = {});

}  // namespace touchtrial::simulation
