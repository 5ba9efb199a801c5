/// \file Collection status: the participants' sessions and the remaining tasks. Uses only
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
  /// The window given by the study's minimum and maximum days between visits; empty in virtual
  /// time. `until` is also empty without a maximum.
  std::optional<std::chrono::nanoseconds> from{};
  std::optional<std::chrono::nanoseconds> until{};

  /// \param now  UTC since 1970
  [[nodiscard]] bool is_due(std::chrono::nanoseconds now) const noexcept {
    return !from || *from <= now;
  }
};

/// The next visits of all participants, the earliest first; empty if the study has one visit or is
/// closed.
/// \throws StoreError as prescription_from_json does
[[nodiscard]] std::vector<UpcomingVisit> upcoming_visits(const record::StudyStore& store);

/// Information about a study from outside its database.
struct StatusSources {
  std::vector<record::PersonalRecord> consents{};  ///< as PersonalData::all
  bool has_consents = false;                       ///< whether a personal data file exists
  int planned = 0;                                 ///< number of participants; 0: not stated
  std::string consent_version{};            ///< version that participants sign; empty: not stated
  std::optional<study::Station> station{};  ///< the station that recorded the database
};

/// A participant's session, or a participant without a session.
struct PersonStatus {
  std::string participant;  ///< empty if the data are erased
  int session = 0;          ///< 0: none yet
  int enrolment = 0;        ///< 0: not assigned yet
  int visit = 1;            ///< from 1
  int station = 0;          ///< in a collected study, the recording station; otherwise 0
  /// "complete", "open", "stopped", "excluded", "replaced", "withdrawn", "erased" or "to come".
  std::string state;
  bool counts = false;      ///< the session is complete and will be analysed
  bool can_resume = false;  ///< the session is open and can be resumed
  int answered = 0;         ///< ended trials, including those without a response
  std::string opened_utc;   ///< ISO 8601; empty in virtual time
  std::string ended_utc;    ///< ISO 8601; empty in virtual time or while the session is open
  std::string consent;      ///< last signed version; empty: none recorded
  std::string device;
  bool was_felt = false;  ///< felt in real time on a device, not seen on a screen
  /// SHA-256 of the device's certificate, "UNVERIFIED DEVICE", or empty: none.
  std::string certificate;
  std::string in_place_of;  ///< the participant whom an upcoming participant replaces
  std::string group;        ///< only if groups are not blinded
};

/// Progress of counterbalancing. Orders of methods are assigned in blocks of consecutive enrolment
/// numbers, each block with every order once. The order of each number is sealed.
struct OrderBlocks {
  int orders = 1;           ///< size of a block
  int complete = 0;         ///< blocks in which every number has a counting session
  std::vector<int> open{};  ///< for each incomplete block, the number of its counting sessions
};

struct StudyStatus {
  std::string study;
  std::string protocol;
  record::StudyState state{};
  bool simulated = false;
  bool pilot = false;
  int stations = 0;  ///< number of collected stations; 0: not a collected study
  int planned = 0;   ///< planned participants; 0: not stated, or a pilot study
  int visits = 1;    ///< per participant
  int complete = 0;  ///< participants with a counting session for each needed visit
  std::vector<PersonStatus> people{};  ///< sessions by number, then upcoming participants
  std::vector<UpcomingVisit> upcoming_visits{};
  /// Empty if all participants have the same order or the file's enrolment numbers are unknown.
  std::optional<OrderBlocks> orders{};
  /// Sentences about stations and enrolment numbers, set by the caller.
  std::vector<std::string> balance{};
  std::vector<std::string> tasks{};  ///< sentences about the remaining tasks
  /// Events missing according to head files, or missing head files; set by the caller; empty: no
  /// fault.
  std::string head_fault{};
};

[[nodiscard]] StudyStatus status_of(const record::StudyStore& store, const StatusSources& sources);

/// The status before the first session creates the database.
/// \param study,protocol  names; empty if unknown
[[nodiscard]] StudyStatus status_before(const std::string& study, const std::string& protocol,
                                        const StatusSources& sources);

/// A command to copy.
struct NextCommand {
  std::string what;  ///< purpose of the command
  std::string command;
};

/// Text for a terminal, ending with a line feed.
[[nodiscard]] std::string status_text(const StudyStatus& status,
                                      const std::vector<NextCommand>& next);
/// One JSON object, indented, ending with a line feed.
[[nodiscard]] std::string status_json(const StudyStatus& status,
                                      const std::vector<NextCommand>& next);

}  // namespace touchtrial::analysis
