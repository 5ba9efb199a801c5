/// \file Collection status: which participants are done or open, and what is left to do. Uses what a database
/// stores in clear, and says nothing about outcomes.
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

/// A visit of a participant who has completed the one before and may come again.
struct UpcomingVisit {
  std::string participant;
  int visit = 2;
  /// By the study's least and most days between visits; nothing in virtual time. `until` also if
  /// the study has no most.
  std::optional<std::chrono::nanoseconds> from{};
  std::optional<std::chrono::nanoseconds> until{};

  /// \param now  UTC since 1970
  [[nodiscard]] bool is_due(std::chrono::nanoseconds now) const noexcept {
    return !from || *from <= now;
  }
};

/// The next visits of all participants, the earliest first; empty if the study has one visit, or
/// takes no sessions any more.
/// \throws StoreError as prescription_from_json
[[nodiscard]] std::vector<UpcomingVisit> upcoming_visits(const record::StudyStore& store);

/// What is known of a study beside its database.
struct StatusSources {
  std::vector<record::PersonalRecord> consents{};  ///< as PersonalData::all
  bool knows_consents = false;                     ///< there is a file of personal data
  int planned = 0;                                 ///< participants; 0: not stated
  std::string consent_version{};                   ///< that participants sign; empty: not stated
  std::optional<study::Station> station{};         ///< whose file the database is
};

/// One participant, by one session, or without any yet.
struct PersonStatus {
  std::string participant;  ///< empty if the data are erased
  int session = 0;          ///< 0: none yet
  int enrolment = 0;        ///< 0: not known yet
  int visit = 1;            ///< of the participant, from 1
  int station = 0;  ///< from which the session was collected; 0: the file is a station's own
  /// "complete", "open", "stopped", "excluded", "replaced", "withdrawn", "erased" or "to come".
  std::string state;
  bool counts = false;     ///< a complete session that will be analysed
  bool may_go_on = false;  ///< an open session that can be resumed
  int answered = 0;        ///< trials, those without a response included
  std::string opened_utc;  ///< ISO 8601; empty in virtual time
  std::string ended_utc;   ///< likewise; empty if it has not ended
  std::string consent;     ///< the last version; empty: none is recorded
  std::string device;
  bool was_felt = false;  ///< in real time on a device, not seen on a screen
  /// SHA-256 of the device's certificate, "UNVERIFIED DEVICE", or empty: none.
  std::string certificate;
  std::string in_place_of;  ///< of one to come: whose place is kept for the participant
  std::string group;        ///< only where groups are open
};

/// How the orders of methods are filled. They are dealt in blocks of consecutive enrolment numbers,
/// each with every order once; which number has which order is sealed.
struct OrderBlocks {
  int orders = 1;           ///< size of a block
  int complete = 0;         ///< blocks in which every number has a session that counts
  std::vector<int> open{};  ///< of the others that were begun: how many numbers have one
};

struct StudyStatus {
  std::string study;
  std::string protocol;
  record::StudyState state{};
  bool simulated = false;
  bool pilot = false;
  int stations = 0;  ///< 0: the file is a station's own
  int planned = 0;   ///< 0: not stated, or a pilot, to which no plan applies
  int visits = 1;    ///< of each participant
  /// Participants with a session that counts, of each visit that the study needs.
  int complete = 0;
  std::vector<PersonStatus> people{};  ///< sessions by number, then participants to come
  std::vector<UpcomingVisit> upcoming_visits{};
  std::optional<OrderBlocks>
      orders{};  ///< if orders differ and the numbers of one station are known
  std::vector<std::string>
      balance{};  ///< sentences on stations and enrolment numbers, filled in by the caller
  std::vector<std::string> left{};  ///< sentences on what is left to do
  /// What the database lacks and its head files know, or which of them are gone, filled in by the
  /// caller; empty: nothing.
  std::string head_fault{};
};

[[nodiscard]] StudyStatus status_of(const record::StudyStore& store, const StatusSources& sources);

/// The same before the first session, when there is no database: who has consented.
/// \param study,protocol  names; empty if they are not known
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
