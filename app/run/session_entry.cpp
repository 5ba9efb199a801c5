#include "app/run/session_entry.hpp"

#include "app/console.hpp"
#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/version.hpp"
#include "protocols/design/enrolment_plan.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace touchtrial::app {
namespace {

using std::chrono::nanoseconds;

/// Includes numbers that are reserved for a replacement: their first session is still stored.
std::set<int> taken_numbers(const store::StudyStore& store) {
  std::set<int> taken;
  for (const store::SessionRow& row : store.sessions()) taken.insert(row.enrolment);
  return taken;
}

/// Two stations without a plan would take the same free numbers.
void require_station(const RunOptions& options, const std::filesystem::path& plan) {
  if (!options.station.empty() && !is_there(plan)) {
    throw UsageError(plan.string() +
                     ": does not exist, and --station takes numbers from it; copy it here, or "
                     "make it with `touchtrial plan`");
  }
  if (!options.station.empty() || options.pilot || !is_there(plan)) return;
  throw UsageError(plan.string() +
                   ": assigns enrolment numbers to stations; name this one with --station");
}

/// A database with another station's numbers belongs to that station, or the name is wrong.
void require_own_file(const RunOptions& options, const design::EnrolmentPlan& plan,
                      const std::set<int>& taken) {
  for (const int number : taken) {
    const std::string* const owner = design::station_of(plan, number);
    if (owner == nullptr || *owner == options.station) continue;
    throw UsageError(one_line(options.database.string()) + ": has number " +
                     std::to_string(number) + ", which is station " + *owner +
                     "'s; every station has a file of its own: give another --db, or the station's "
                     "right name");
  }
}

/// The enrolment number of a participant without a session: the one that the options name, or else
/// the number of the person whom the participant replaces, or else the station's next number of the
/// study's plan (the smallest free number without a plan).
/// \throws UsageError if there is a plan but no station is named, or the other way round (a pilot
///   needs no plan), or if the database has numbers of another station
/// \throws as load_plan and next_of_station
int enrolment_of(const RunOptions& options, const design::Study& study,
                 const store::StudyStore& store) {
  if (options.enrolment > 0) return options.enrolment;
  const int free_or_inherited = store.enrolment_for(options.participant);
  const std::set<int> taken = taken_numbers(store);
  if (taken.contains(free_or_inherited)) return free_or_inherited;
  const std::filesystem::path plan =
      options.plan.empty() ? design::plan_path_for(options.study) : options.plan;
  require_station(options, plan);
  if (options.station.empty()) return free_or_inherited;
  const design::EnrolmentPlan dealt = design::load_plan(plan, study);
  const int next = design::next_of_station(dealt, options.station, taken, plan.string());
  require_own_file(options, dealt, taken);
  return next;
}

/// How blocks of this participant's session are restarted.
session::BlockDrawing block_restart_of(const design::StudyKey& key, int enrolment) {
  return {[&key, enrolment](int block, int restarts_before, int first_trial) {
            return design::restarted_block(key.study, enrolment, block, restarts_before,
                                           first_trial);
          },
          [&key](const std::vector<design::Presentation>& presentations) {
            return block_to_json(presentations, key);
          }};
}

EnteredSession new_session(const RunOptions& options, const RunStudy& study,
                           store::StudyStore& store, int enrolment,
                           const DescribeOpening& describe) {
  EnteredSession entered;
  entered.number = store.next_session();
  entered.enrolment = enrolment;
  SystemEntropy entropy;
  const SecretKey key = entropy.secret("participant key");
  entered.sink = store.begin_session(
      entered.number, store::wrap_participant_key(study.key.master, entered.number, key));
  const design::Schedule schedule = design::make_schedule(study.key.study, enrolment);
  entered.session = std::make_unique<session::Session>(
      schedule, study.key.study.trials, store::SessionRecorder(entered.number, key, *entered.sink),
      block_restart_of(study.key, enrolment));
  store::SessionOpening opening;
  opening.participant = options.participant;
  opening.enrolment = enrolment;
  opening.study_id = study.key.study_id;
  opening.seal = design::study_seal(study.key);
  opening.pilot = options.pilot;
  describe(opening);
  entered.session->open({}, opening, design::schedule_to_json(schedule, study.key));
  return entered;
}

/// The time since the session's last event.
nanoseconds away(const store::StudyStore& store, const store::SessionRow& row,
                 const store::Event& last) {
  nanoseconds opened{};
  store.for_each(store::EventKind::session_opened, [&](const store::Event& event) {
    if (store::session_opened_from_json(event.body).session == row.session) opened = event.at;
  });
  return std::max(nanoseconds{}, utc_now() - opened - last.at);
}

std::string standing(const store::StudyStore& store, const store::SessionRow& row,
                     nanoseconds away) {
  const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(away).count();
  return fmt::format("participant {} has session {}, with {} trials answered, left {} h {} min ago",
                     row.participant, row.session, answered_trials(store, row.session),
                     minutes / 60, minutes % 60);
}

session::Session restored(const RunStudy& study, const store::StudyStore& store,
                          const store::SessionRow& row, store::EventSink& sink) {
  const std::vector<store::Event> events = store.events(row.session);
  const auto wrapped = store.wrapped_key(row.session);
  const auto key = wrapped
                       ? store::unwrap_participant_key(study.key.master, row.own_session, *wrapped)
                       : std::nullopt;
  const auto secret = key ? store::unsealed(events.front(), *key) : std::nullopt;
  if (!secret) {
    throw StoreError(fmt::format("session {}: its schedule cannot be read; run `touchtrial verify`",
                                 row.session));
  }
  session::Session session(design::schedule_from_json(*secret, study.key), study.key.study.trials,
                           store::SessionRecorder(row.session, *key, sink),
                           block_restart_of(study.key, row.enrolment));
  session.restore(events);
  return session;
}

/// In virtual time, no time passes between two runs of the program.
nanoseconds time_after(const RunOptions& options, nanoseconds last, nanoseconds away) {
  return options.is_simulated() && !options.real_time ? last : last + away;
}

EnteredSession resumed_session(const RunOptions& options, const RunStudy& study,
                               store::StudyStore& store, const store::SessionRow& row,
                               nanoseconds away) {
  EnteredSession entered;
  entered.number = row.session;
  entered.enrolment = row.enrolment;
  entered.sink = store.continue_session(row.session);
  entered.session = std::make_unique<session::Session>(restored(study, store, row, *entered.sink));
  session::Session& session = *entered.session;
  entered.clock = time_after(options, session.last(), away);
  session.take_up(entered.clock, {.after = "program-ended",
                                  .away_s = std::chrono::duration<double>(away).count(),
                                  .program_version = std::string(program_version())});
  return entered;
}

void require_young(const RunOptions& options, const RunStudy& study, const std::string& standing,
                   nanoseconds away) {
  const double limit_h = study.key.study.trials.resume_within_h;
  if (std::chrono::duration<double, std::ratio<3600>>(away).count() <= limit_h) return;
  throw StoreError(
      fmt::format("{}: {}; the study lets sessions be resumed within {} h; begin anew with "
                  "--on-existing restart",
                  options.database.string(), standing, limit_h));
}

bool is_visual(const store::SessionOpening& opening) {
  return opening.station && opening.station->visual;
}

/// Refuses to resume a session on another kind of device: a session that is seen is not blind.
void require_same_kind(const RunOptions& options, const store::SessionRow& row,
                       const store::SessionOpening& then, const store::SessionOpening& now) {
  if (is_visual(now) == is_visual(then)) return;
  throw StoreError(fmt::format(
      "{}: session {} was begun with device '{}', and '{}' is {}: continue with the former",
      options.database.string(), row.session, then.device, now.device,
      is_visual(now) ? "seen on a screen and not felt" : "felt and not seen"));
}

/// Records that the resumed session uses another device or certificate.
void record_other_station(EnteredSession& entered, const store::SessionOpening& then,
                          const store::SessionOpening& now) {
  const auto certificate = [](const store::SessionOpening& opening) {
    return opening.station ? opening.station->calibration : std::string();
  };
  if (then.device != now.device || then.device_serial != now.device_serial) {
    entered.session->deviate(entered.clock,
                             {"other-device", one_line(now.device + " " + now.device_serial)});
  }
  if (certificate(then) != certificate(now)) {
    entered.session->deviate(entered.clock, {"other-certificate", certificate(now)});
  }
}

/// Ends the session in its present state.
void give_up(const RunStudy& study, store::StudyStore& store, const store::SessionRow& row) {
  const std::unique_ptr<store::EventSink> sink = store.continue_session(row.session);
  session::Session session = restored(study, store, row, *sink);
  if (session.accepts(session::SessionInput::stop)) session.stop(session.last(), "restarted");
  session.close(session.last());
}

/// Opens a new session with the enrolment number of the previous one, which has ended.
EnteredSession begin_anew(const RunOptions& options, const RunStudy& study,
                          store::StudyStore& store, const store::SessionRow& row,
                          const DescribeOpening& describe) {
  store.replace(row.session, row.participant, utc_now(), "restarted");
  return new_session(options, study, store, row.enrolment, describe);
}

EnteredSession existing_session(const RunOptions& options, const RunStudy& study,
                                store::StudyStore& store, const store::SessionRow& row,
                                const DescribeOpening& describe) {
  const bool may_be_restarted =
      options.on_existing == OnExisting::restart && row.state == store::SessionState::stopped;
  if (may_be_restarted) return begin_anew(options, study, store, row, describe);
  if (row.state != store::SessionState::open) {
    throw StoreError(fmt::format(
        "{}: participant {} already has session {}, which is {}; give another participant id",
        options.database.string(), row.participant, row.session,
        row.state == store::SessionState::completed ? "complete" : "stopped"));
  }
  const nanoseconds gone = away(store, row, store.last_event(row.session).value());
  const std::string stands = standing(store, row, gone);
  if (options.on_existing == OnExisting::refuse) {
    throw StoreError(fmt::format(
        "{}: {}; go on with --on-existing resume, or begin anew with --on-existing restart",
        options.database.string(), stands));
  }
  if (options.on_existing == OnExisting::restart) {
    give_up(study, store, row);
    return begin_anew(options, study, store, row, describe);
  }
  require_young(options, study, stands, gone);
  store::SessionOpening now;
  describe(now);
  const store::SessionOpening then =
      store::opening_from_json(store.events(row.session).front().body);
  require_same_kind(options, row, then, now);
  EnteredSession entered = resumed_session(options, study, store, row, gone);
  record_other_station(entered, then, now);
  return entered;
}

}  // namespace

int answered_trials(const store::StudyStore& store, int session) {
  return static_cast<int>(std::ranges::count_if(store.trials(), [&](const store::TrialRow& trial) {
    return trial.session == session && trial.state == store::TrialState::answered;
  }));
}

EnteredSession enter_session(const RunOptions& options, const RunStudy& study,
                             store::StudyStore& store, const DescribeOpening& describe) {
  if (const auto row = store.session_of(options.participant)) {
    return existing_session(options, study, store, *row, describe);
  }
  return new_session(options, study, store, enrolment_of(options, study.key.study, store),
                     describe);
}

}  // namespace touchtrial::app
