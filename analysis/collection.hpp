/// \file How a study was collected: everything about its sessions that is in clear and that a
/// results section has to state. Nothing here tells of outcomes, so it may be shown at any time.
#pragma once

#include "protocols/store/study_store.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A deviation from the protocol, by its code (docs/data-dictionary.md) and in words.
struct Deviation {
  std::string code;
  std::string text;
};

/// How practice went.
struct PracticeRecord {
  int rounds = 0;
  int presentations = 0;
  int correct = 0;
  bool passed = true;  ///< no deviation `practice-not-passed`
};

/// One session, withdrawn ones with nothing but their number and state.
struct SessionRecord {
  store::SessionRow row;
  std::string device_serial;                    ///< empty if none
  std::optional<store::StationRecord> station;  ///< real time only
  std::string opened_utc;                       ///< ISO 8601; empty for simulated sessions
  std::optional<PracticeRecord> practice;
  std::vector<Deviation> deviations;  ///< each code and text once, those noted later too
  std::string exclusion_reason;
  std::string replacement_reason;
  std::string stop_reason;
  int resumed = 0;  ///< times that it was taken up again
};

/// How the servo kept its time in one trial, in real time.
struct ServoTrial {
  int session = 0;
  int trial = 0;
  store::ServoHealth health;
  std::int64_t overruns = 0;
};

/// Participants on their way from enrolment to analysis; a participant is counted once, by the
/// session that stands.
struct ParticipantFlow {
  int enrolled = 0;
  int withdrawn = 0;
  int replaced = 0;  ///< of them: somebody else took their place
  int excluded = 0;
  std::vector<std::string> exclusion_reasons;  ///< one a participant, in the order of sessions
  int stopped = 0;
  int open = 0;
  int other_kind = 0;  ///< pilots or simulations among others
  int unseen = 0;      ///< completed after an interim look
  int analysed = 0;    ///< enrolled less all above
};

/// What the study prescribes of a session, from its configuration in clear.
struct Prescription {
  double explore_limit_s = 0.0;
  std::string on_timeout;
  std::string order;
  int repeats = 0;
  int method_orders = 1;  ///< that participants take in turn, by their enrolment numbers
  std::string sight;      ///< "curtain" or "blindfold"
  bool masking_wanted = true;
  double masking_dbfs = 0.0;
};

struct Collection {
  Prescription prescription;
  std::vector<SessionRecord> sessions;   ///< by number
  std::vector<ServoTrial> servo_trials;  ///< by session and trial; of withdrawn ones none
  ParticipantFlow flow;
  bool visual = false;  ///< sessions were seen on a screen, not felt; a database holds one kind
};

/// \param configuration  as the study's commitment has it, in clear
/// \throws StoreError if it is not what this program writes
[[nodiscard]] Prescription prescription_from_json(const std::string& configuration);

/// Reads the clear part of every session's events; traces and sealed parts are not looked at.
[[nodiscard]] Collection load_collection(const store::StudyStore& store);

}  // namespace touchtrial::analysis
