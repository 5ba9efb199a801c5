/// \file How a session begins: as a new one, or where it broke off.
#pragma once

#include "app/run/run_options.hpp"
#include "app/run/run_study.hpp"
#include "protocols/session/session.hpp"
#include "protocols/store/study_store.hpp"

#include <chrono>
#include <functional>
#include <memory>

namespace touchtrial::app {

/// A session that may be run, and what it stands on. Must not outlive the store.
struct EnteredSession {
  int number = 0;
  int enrolment = 0;
  bool resumed = false;
  std::chrono::nanoseconds clock{};  ///< what the session's clock is to show now
  std::unique_ptr<store::EventSink> sink;
  std::unique_ptr<session::Session> session;
};

/// Fills in what a new session's first event says of device and station.
using DescribeOpening = std::function<void(store::SessionOpening&)>;

/// Opens a new session for the participant, or takes up the one that they have, as
/// `options.on_existing` says. Its first or next event is stored by then.
/// \throws StoreError if the participant has a session that may not be taken up (which, how far it
///   is, and what to do), or the database refuses
[[nodiscard]] EnteredSession enter_session(const RunOptions& options, const RunStudy& study,
                                           store::StudyStore& store,
                                           const DescribeOpening& describe);

}  // namespace touchtrial::app
