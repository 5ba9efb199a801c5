/// \file Collection status: which participants are done or open, and what is left to do. Uses only
/// unencrypted data and reveals nothing about outcomes.
#pragma once

#include "analysis/outcomes/collection.hpp"
#include "record/personal_data.hpp"
#include "record/study_store.hpp"
#include "study/station.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The next visit of a participant who has completed the previous one.
struct UpcomingVisit {
  std::string participant;
  int visit = 2;
  /// The window from the study's minimum and maximum days between visits; empty in virtual time.
  /// `until` is also empty without a maximum.
  std::optional<std::chrono::nanoseconds> from{};
  std::optional<std::chrono::nanoseconds> until{};

  /// \param now  UTC since 1970
  [[nodiscard]] bool is_due(std::chrono::nanoseconds now) const noexcept {
    return !from || *from <= now;
  }
};

/// The next visits of all participants, the earliest first; empty if the study has one visit or
/// accepts no more sessions.
/// \throws StoreError as prescription_from_json
[[nodiscard]] std::vector<UpcomingVisit> upcoming_visits(const record::StudyStore& store);

/// Sources of information about a study other than its database.
struct StatusSources {
  std::vector<record::PersonalRecord> consents{};  ///< as PersonalData::all
  bool knows_consents = false;                     ///< a personal data file exists
  int planned = 0;                                 ///< participants; 0: not stated
  std::string consent_version{};            ///< version that participants sign; empty: not stated
  std::optional<study::Station> station{};  ///< the station whose file the database is
};

/// One participant with one session, or with none yet.
struct PersonStatus {
  std::string participant;  ///< empty if the data are erased
  int session = 0;          ///< 0: none yet
  int enrolment = 0;        ///< 0: not known yet
  int visit = 1;            ///< of the participant, from 1
  int station = 0;  ///< from which the session was collected; 0: the file is a station's own
  /// "complete", "open", "stopped", "excluded", "replaced", "withdrawn", "erased" or "to come".
  std::string state;
  bool counts = false;      ///< a complete session that will be analysed
  bool can_resume = false;  ///< an open session that can be resumed
  int answered = 0;         ///< trials, those without a response included
  std::string opened_utc;   ///< ISO 8601; empty in virtual time
  std::string ended_utc;    ///< likewise; empty if it has not ended
  std::string consent;      ///< the last version; empty: none is recorded
  std::string device;
  bool was_felt = false;  ///< felt in real time on a device, not seen on a screen
  /// SHA-256 of the device's certificate, "UNVERIFIED DEVICE", or empty: none.
  std::string certificate;
  std::string in_place_of;  ///< of a participant to come: who is replaced
  std::string group;        ///< only if groups are not blinded
};

/// How the orders of methods are filled. They are assigned in blocks of consecutive enrolment
/// numbers, each block with every order once. Which number has which order is sealed.
struct OrderBlocks {
  int orders = 1;           ///< size of a block
  int complete = 0;         ///< blocks in which every number has a session that counts
  std::vector<int> open{};  ///< for each block that was begun but is incomplete, how many numbers
                            ///< have such a session
};

struct StudyStatus {
  std::string study;
  std::string protocol;
  record::StudyState state{};
  bool simulated = false;
  bool pilot = false;
  int stations = 0;  ///< 0: the file is a station's own
  int planned = 0;   ///< 0: not stated, or a pilot study, which has no plan
  int visits = 1;    ///< of each participant
  /// Participants with a counting session for each visit that the study needs.
  int complete = 0;
  std::vector<PersonStatus> people{};  ///< sessions by number, then participants to come
  std::vector<UpcomingVisit> upcoming_visits{};
  std::optional<OrderBlocks>
      orders{};  ///< if orders differ and the file's enrolment numbers are known
  std::vector<std::string>
      balance{};  ///< sentences about stations and enrolment numbers, set by the caller
  std::vector<std::string> left{};  ///< sentences about the remaining work
  /// What the database is missing according to its head files, or which head files are missing. Set
  /// by the caller; empty: nothing.
  std::string head_fault{};
};

[[nodiscard]] StudyStatus status_of(const record::StudyStore& store, const StatusSources& sources);

/// The status before the first session, when there is no database yet: who has consented.
/// \param study,protocol  names; empty if unknown
[[nodiscard]] StudyStatus status_before(const std::string& study, const std::string& protocol,
                                        const StatusSources& sources);

/// A command to copy, and what it is for.
struct NextCommand {
  std::string what;
  std::string command;
};

/// A page for a terminal, ending with a line feed.
[[nodiscard]] std::string status_text(const StudyStatus& status,
                                      const std::vector<NextCommand>& next);
/// One JSON object, indented, ending with a line feed.
[[nodiscard]] std::string status_json(const StudyStatus& status,
                                      const std::vector<NextCommand>& next);

}  // namespace touchtrial::analysis
