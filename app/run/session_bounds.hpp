/// \file Start and end of a session: new or resumed sessions, requests to end, and the summary and
///   exit code.
#pragma once

#include "app/run/database_watch.hpp"
#include "app/run/run_session.hpp"
#include "app/run/run_study.hpp"
#include "protocols/session/experimenter.hpp"
#include "protocols/session/session.hpp"
#include "protocols/session/session_runner.hpp"
#include "record/study_store.hpp"
#include "study/schedule.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// A session that is ready to run, and its sink of events. Must not outlive the store.
struct EnteredSession {
  int number = 0;
  int enrolment = 0;
  study::ScheduleDraw draw;          ///< the inputs of its schedule
  std::chrono::nanoseconds clock{};  ///< the session's current time
  std::unique_ptr<PatientSink> sink;
  std::unique_ptr<session::Session> session;
};

/// Describes device and station in a new session's first event.
using DescribeOpening = std::function<void(record::SessionOpening&)>;

/// \throws UsageError if the study does not have that visit
void require_planned_visit(const RunOptions& options, const study::Study& study);

/// Asks for confirmation of an --enrolment number above the planned number of participants, or,
/// without a plan, above the next number. The ranges of a divided study's stations are checked
/// separately.
/// \throws as confirm, and as StudyStore::open
void confirm_enrolment(const RunOptions& options, const study::StationKey& key);

/// Opens a new session for the participant, or handles the existing one according to
/// `options.on_existing`. On return, the session's first or next event is stored. The database is
/// created last.
/// \throws StoreError if the participant's session may not be resumed (with its number, its progress
///   and the remedy), or if the database refuses
/// \throws UsageError if the participant's id is invalid, they cannot get an enrolment number, or
///   the study has no such visit
[[nodiscard]] EnteredSession enter_session(const RunOptions& options, const RunStudy& study,
                                           RunDatabase& database, const DescribeOpening& describe);

/// While an object of this class exists, SIGINT, SIGTERM and SIGHUP are stored and do not end the
/// program; a second signal of the same kind does. During explorations, StopOnSignals handles them
/// first. At most one object may exist.
class EndingSignals {
 public:
  EndingSignals();
  /// Restores the earlier handlers.
  ~EndingSignals();
  EndingSignals(const EndingSignals&) = delete;
  EndingSignals& operator=(const EndingSignals&) = delete;

  /// May be called from any thread.
  /// \return the number of the received signal, also during explorations; 0: none
  [[nodiscard]] static int signal_number() noexcept;
  /// \return for instance "stopped by SIGTERM"; empty: none was received
  [[nodiscard]] static std::string message();
};

/// Forwards everything to the experimenter's terminal or window, prints a line to standard output
/// for each durable response, and leaves the session when the program must end.
class RunExperimenter final : public session::Experimenter {
 public:
  /// \param inner  must outlive this object
  /// \param end_reason  reason to end the program other than signals; "": none
  /// \param extra_request  the next request from another source, such as the sound; empty: none
  /// \param alert  SessionStatus::alert; empty: none
  RunExperimenter(session::Experimenter& inner, std::function<std::string()> end_reason,
                  std::function<std::optional<session::ExperimenterRequest>()> extra_request = {},
                  std::function<std::string()> alert = {});

  void show(const session::SessionStatus& status) override;
  [[nodiscard]] std::optional<session::ExperimenterRequest> request() override;
  [[nodiscard]] std::optional<std::vector<session::Tick>> day_sheet(
      const std::vector<session::DaySheetItem>& items) override {
    return inner_.day_sheet(items);
  }
  void acknowledged(int trial) override;

 private:
  session::Experimenter& inner_;
  std::function<std::string()> end_reason_;
  std::function<std::optional<session::ExperimenterRequest>()> extra_request_;
  std::function<std::string()> alert_;
};

/// Prints the session's summary, without outcomes, and how to resume the session if it was left
/// open.
/// \param problem  DatabaseWatch::problem; if not empty, the store's content is saved beside the
///   database
/// \return the exit code, as run_study_session
[[nodiscard]] int conclude_session(const RunOptions& options, int session,
                                   const session::SessionTally& tally, record::StudyStore& store,
                                   std::string problem);

}  // namespace touchtrial::app
