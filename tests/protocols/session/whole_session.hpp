/// \file A whole classification session of the tiny study, up to its report, for any device that is
/// lost once: study, pack, database, a mind that knows the textures, and an instrument on a pseudo
/// terminal that is told of events.
#pragma once

#include "core/hash.hpp"
#include "device/instruments/instrument_side.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "protocols/identification/simulation/identifying_participant.hpp"
#include "protocols/session/device_station.hpp"
#include "protocols/session/real_time_explorer.hpp"
#include "protocols/session/session_runner.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "record/study_store.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace touchtrial {

struct WholeSession {
  /// \param repeats  of each of the five textures
  /// \param explore_s  of the participant
  WholeSession(int repeats, double explore_s);

  /// Runs the session until it is closed.
  session::SessionTally run(session::DeviceStation& station, session::Participant& person,
                            session::RealTimeExplorer& explorer,
                            session::Experimenter& experimenter = session::no_experimenter());

  [[nodiscard]] std::vector<record::Event> all(record::EventKind kind) const;

  /// Checks that the answers are stored as they were given, that the device was lost once, in this
  /// trial, which was repeated at the end, and that the instrument was told of all that.
  /// \param named  every choice, in order
  /// \return what is sealed of the loss
  record::InterruptionDetail check(const std::vector<int>& named, int unlucky);

  /// Closes the study and opens its results.
  [[nodiscard]] analysis::identification::StudyReport report();

  TinyStudy study;
  session::StimulusSource source{study.pack(), study.key().study.rendering};
  record::StudyStore store;
  SecretKey participant_key = sha256(bytes_of("somebody"));
  simulation::SubjectModel subject;
  simulation::FeltKnowledge knowledge;
  simulation::identification::IdentifyingParticipant mind{subject, knowledge, 5, 1};
  Instrument instrument;

 private:
  void check_codes(int unlucky);
  [[nodiscard]] std::string codes_recorded() const;
};

}  // namespace touchtrial
