/// \file How a session begins: as a new one, or where it was interrupted.
#pragma once

#include "app/run/run_options.hpp"
#include "app/run/run_study.hpp"
#include "protocols/session/session.hpp"
#include "protocols/store/study_store.hpp"

#include <chrono>
#include <functional>
#include <memory>

namespace touchtrial::app {

/// A session that is ready to run, and its sink of events. Must not outlive the store.
struct EnteredSession {
  int number = 0;
  int enrolment = 0;
  std::chrono::nanoseconds clock{};  ///< present time of the session's clock
  std::unique_ptr<store::EventSink> sink;
  std::unique_ptr<session::Session> session;
};

/// Fills in what a new session's first event says about device and station.
using DescribeOpening = std::function<void(store::SessionOpening&)>;

/// Opens a new session for the participant, or handles the existing one as `options.on_existing`
/// says. On return, the session's first or next event is stored.
/// \throws StoreError if the participant has a session that may not be resumed (with its number,
/// its
///   progress and the remedy), or if the database refuses
/// \throws UsageError if the participant cannot get an enrolment number
[[nodiscard]] EnteredSession enter_session(const RunOptions& options, const RunStudy& study,
                                           store::StudyStore& store,
                                           const DescribeOpening& describe);

/// \return the number of answered trials of a session
[[nodiscard]] int answered_trials(const store::StudyStore& store, int session);

}  // namespace touchtrial::app
