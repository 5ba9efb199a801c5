#include "app/run/session_bounds.hpp"

#include "app/terminal/console.hpp"
#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "core/utc.hpp"
#include "core/version.hpp"
#include "device/platform/stop_signals.hpp"
#include "record/payload_json.hpp"
#include "study/station.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

using std::chrono::nanoseconds;

int answered_trials(const record::StudyStore& store, int session) {
  return static_cast<int>(std::ranges::count_if(store.trials(), [&](const record::TrialRow& trial) {
    return trial.session == session && trial.state == record::TrialState::answered;
  }));
}

/// Draws a session as verification and outcomes do.
study::Draws draws_of(bool pilot, bool simulated) {
  return pilot || simulated ? study::Draws::rehearsal : study::Draws::people;
}

/// Includes numbers that are reserved for a replacement: their first session is still stored.
std::set<int> taken_numbers(const record::StudyStore& store) {
  std::set<int> taken;
  for (const record::SessionRow& row : store.sessions()) taken.insert(row.enrolment);
  return taken;
}

/// A database with another station's numbers belongs to that station, or the station's file is
/// wrong.
void require_own_file(const RunOptions& options, const study::Station& station,
                      const std::set<int>& taken) {
  for (const int number : taken) {
    if (station.place_of(number)) continue;
    throw UsageError(one_line(options.database.string()) + ": has number " +
                     std::to_string(number) + ", which is not station " + station.name +
                     "'s; every station has a database of its own: give another --db, or the right "
                     "station's file");
  }
}

/// The enrolment number of a participant without a session: that of the options, else that of the
/// person whom the participant replaces, else the station's next.
/// \param store  null: there is none yet
/// \throws as next_enrolment_of
int enrolment_of(const RunOptions& options, const study::Station& station,
                 const record::StudyStore* store) {
  if (options.enrolment > 0) return options.enrolment;
  if (store == nullptr) return study::next_enrolment_of(station, {});
  const int free_or_inherited = store->enrolment_for(options.participant);
  const std::set<int> taken = taken_numbers(*store);
  require_own_file(options, station, taken);
  if (taken.contains(free_or_inherited)) return free_or_inherited;
  return study::next_enrolment_of(station, taken);
}

/// The participant's group, if the study's groups are open; else empty.
std::string open_group(const study::StationKey& key, int enrolment, study::Draws draws) {
  const study::GroupPlan& groups = key.study.groups;
  if (!groups.open) return "";
  const auto group = study::group_for(key.study, key.station, enrolment, draws);
  return group ? groups.labels[static_cast<std::size_t>(*group)] : "";
}

EnteredSession new_session(const RunOptions& options, const RunStudy& study, RunDatabase& database,
                           int enrolment, const DescribeOpening& describe) {
  if (!record::is_participant_id(options.participant)) {
    throw UsageError("run: " + in_quotes(options.participant) + " is not a participant id; " +
                     std::string(record::kParticipantIdRule));
  }
  EnteredSession entered;
  entered.enrolment = enrolment;
  record::SessionOpening opening;
  describe(opening);
  const study::Draws draws = draws_of(options.pilot, opening.simulated);
  entered.draw = study.key.draw_of(enrolment, draws, options.visit);
  auto order = study::make_order(study.key.study, entered.draw);
  const std::string schedule = study::schedule_to_json(order->schedule(), study.key);
  record::StudyStore& store = database.made();
  entered.number = store.next_session();
  SystemEntropy entropy;
  const SecretKey key = entropy.secret("participant key");
  entered.sink = std::make_unique<PatientSink>(store.begin_session(
      entered.number, record::wrap_participant_key(study.key.investigator_box, entered.number, key),
      {}, record::keep_participant_key(study.key.station.secret, entered.number, key)));
  entered.session = std::make_unique<session::Session>(
      std::move(order), study.key.study.trials,
      record::SessionRecorder(entered.number, key, *entered.sink), session::seal_with(study.key));
  opening.participant = options.participant;
  opening.enrolment = enrolment;
  opening.visit = options.visit;
  opening.group = open_group(study.key, enrolment, draws);
  opening.study_id = study.key.study_id;
  opening.seal = study.key.seal;
  opening.pilot = options.pilot;
  if (!opening.simulated) opening.opened_utc = utc_text(utc_now());
  entered.session->open({}, opening, schedule);
  if (!opening.group.empty()) {
    print("participant " + options.participant + " is in group " + opening.group + "\n");
  }
  return entered;
}

/// The time of a session's opening, by the clock of the file's chain.
nanoseconds opened_at(const record::StudyStore& store, int session) {
  nanoseconds at{};
  store.for_each(record::EventKind::session_opened, [&](const record::Event& event) {
    if (record::from_json<record::SessionOpenedBody>(event.body).session == session) at = event.at;
  });
  return at;
}

std::string visit_words(const RunOptions& options, const RunStudy& study) {
  return fmt::format("{}: participant {}, visit {} of {}", one_line(options.database.string()),
                     options.participant, options.visit, study.key.study.visits.count);
}

/// Opens the session of a participant's next visit.
/// \throws StoreError if it is too early
EnteredSession next_visit(const RunOptions& options, const RunStudy& study, RunDatabase& database,
                          const record::SessionRow& last, const DescribeOpening& describe) {
  const auto refuse = [&](const std::string& why) {
    throw StoreError(visit_words(options, study) + ": " + why);
  };
  if (last.withdrawn || last.excluded) {
    refuse(fmt::format("cannot follow session {}, whose participant {}", last.session,
                       last.withdrawn ? "has withdrawn" : "was excluded"));
  }
  if (last.state != record::SessionState::completed) {
    refuse(fmt::format(
        "cannot follow session {}, which is {}; complete visit {} first, with "
        "--visit {} and --on-existing {}",
        last.session, last.state == record::SessionState::open ? "still open" : "stopped",
        last.visit, last.visit, last.state == record::SessionState::open ? "resume" : "restart"));
  }
  // Virtual time has no waiting between visits.
  const bool in_days = !options.is_simulated() || options.real_time;
  const study::VisitPlan& plan = study.key.study.visits;
  const nanoseconds before = opened_at(database.made(), last.session);
  const double days = study::days_between(before, utc_now());
  const bool is_clock_wrong = in_days && days < 0.0;
  if (is_clock_wrong && options.accept_clock.empty()) {
    refuse(
        fmt::format("visit {} was opened at {}, and this machine's clock shows {}: one of the "
                    "two was wrong; set the clock if it is this one, or else give "
                    "--accept-clock REASON, which is recorded",
                    last.visit, utc_words(before), utc_words(utc_now())));
  }
  if (in_days && !is_clock_wrong && days < plan.min_days) {
    const auto min_gap = std::chrono::duration<double, std::ratio<86'400>>(plan.min_days);
    refuse(
        fmt::format("comes {:.1f} days after visit {} by this machine's clock, and the study has "
                    "at least {} days between visits: come back after {}",
                    days, last.visit, plan.min_days,
                    utc_words(before + std::chrono::ceil<nanoseconds>(min_gap))));
  }
  EnteredSession entered = new_session(options, study, database, last.enrolment, describe);
  if (is_clock_wrong) {
    entered.session->deviate(
        {}, {"wrong-clock", fmt::format("visit {} was opened at {}: {}", last.visit,
                                        utc_words(before), options.accept_clock)});
  }
  if (in_days && plan.max_days && days > *plan.max_days) {
    const std::string late = fmt::format("{:.1f} days after visit {}, at most {} in the study",
                                         days, last.visit, *plan.max_days);
    spdlog::warn("{}: comes {}; recorded as the deviation visit-late", visit_words(options, study),
                 late);
    entered.session->deviate({}, {"visit-late", late});
  }
  return entered;
}

/// A stored open session, decrypted with the station's copy of its key.
struct StoredSession {
  SecretKey key{};
  std::string schedule;  ///< JSON
  std::vector<record::Event> events;
  nanoseconds away{};  ///< since its last event; less than 0 if the clock was set back since
};

/// \throws StoreError if this station does not hold the session's key
StoredSession stored_session(const RunOptions& options, const RunStudy& study,
                             const record::StudyStore& store, const record::SessionRow& row) {
  const auto refuse = [&] {
    throw StoreError(
        fmt::format("{}: session {} does not open with this station's file; give the file of the "
                    "station that began it, with --station-file",
                    options.database.string(), row.session));
  };
  const auto kept = store.kept_key(row.session);
  const auto key =
      kept ? record::kept_participant_key(study.key.station.secret, row.own_session, *kept)
           : std::nullopt;
  if (!key) refuse();
  StoredSession session{.key = *key, .schedule = {}, .events = {}};
  for (const record::Event& stored : store.events(row.session)) {
    auto opened = record::opened_event(stored, *key);
    if (!opened) refuse();
    if (stored.sequence == 0) session.schedule = std::move(opened->secret);
    session.events.push_back(std::move(opened->event));
  }
  session.away = utc_now() - opened_at(store, row.session) - session.events.back().at;
  return session;
}

std::string standing(const record::StudyStore& store, const record::SessionRow& row,
                     nanoseconds away) {
  const auto minutes =
      std::chrono::duration_cast<std::chrono::minutes>(std::max(nanoseconds{}, away)).count();
  return fmt::format("participant {} has session {}, with {} trials answered, left {} h {} min ago",
                     row.participant, row.session, answered_trials(store, row.session),
                     minutes / 60, minutes % 60);
}

session::Session restored(const RunStudy& study, const StoredSession& kept,
                          const record::SessionRow& row, record::EventSink& sink) {
  const study::ScheduleDraw draw =
      study.key.draw_of(row.enrolment, draws_of(row.pilot, row.simulated), row.visit);
  auto order = study::make_order(study.key.study, draw);
  if (study::schedule_from_json(kept.schedule, study.key) != order->schedule()) {
    throw StoreError(
        one_line(fmt::format("session {} was begun with another order than the study "
                             "draws now; run `touchtrial verify`",
                             row.session)));
  }
  session::Session session(std::move(order), study.key.study.trials,
                           record::SessionRecorder(row.session, kept.key, sink),
                           session::seal_with(study.key));
  session.restore(kept.events);
  return session;
}

/// In virtual time, no time passes between two runs of the program.
nanoseconds time_after(const RunOptions& options, nanoseconds last, nanoseconds away) {
  return options.is_simulated() && !options.real_time ? last : last + away;
}

/// Records that the clock was set back since the session's last event by more than a usual
/// correction.
void record_clock(const RunOptions& options, nanoseconds away, EnteredSession& entered) {
  constexpr std::chrono::seconds kSmall{5};
  const bool is_virtual = options.is_simulated() && !options.real_time;
  if (is_virtual || away >= -kSmall) return;
  const auto back = std::chrono::duration_cast<std::chrono::seconds>(-away).count();
  entered.session->deviate(
      entered.clock,
      {"clock-set-back", fmt::format("this machine's clock shows {}, {} s before the "
                                     "session's last event",
                                     utc_words(utc_now()), back)});
}

EnteredSession resumed_session(const RunOptions& options, const RunStudy& study,
                               record::StudyStore& store, const StoredSession& kept,
                               const record::SessionRow& row) {
  EnteredSession entered;
  entered.number = row.session;
  entered.enrolment = row.enrolment;
  entered.draw = study.key.draw_of(row.enrolment, draws_of(row.pilot, row.simulated), row.visit);
  entered.sink = std::make_unique<PatientSink>(store.continue_session(row.session));
  entered.session = std::make_unique<session::Session>(restored(study, kept, row, *entered.sink));
  session::Session& session = *entered.session;
  const nanoseconds away = std::max(nanoseconds{}, kept.away);
  entered.clock = time_after(options, session.last(), away);
  session.resume_after_exit(entered.clock, {.after = "program-ended",
                                            .away_s = std::chrono::duration<double>(away).count(),
                                            .program_version = std::string(program_version())});
  record_clock(options, kept.away, entered);
  return entered;
}

void require_recent(const RunOptions& options, const RunStudy& study, const std::string& standing,
                    nanoseconds away) {
  const double limit_h = study.key.study.trials.resume_within_h;
  if (std::chrono::duration<double, std::ratio<3600>>(away).count() <= limit_h) return;
  throw StoreError(
      fmt::format("{}: {}, by this machine's clock, which shows {}; the study lets sessions be "
                  "resumed within {} h; set the clock if it is wrong, or start again with "
                  "--on-existing restart",
                  options.database.string(), standing, utc_words(utc_now()), limit_h));
}

/// Refuses to resume a session on another kind of device: a session on a screen is not blind, and
/// trials without force do not count.
void require_same_kind(const RunOptions& options, const record::SessionRow& row,
                       const record::SessionOpening& then, const record::SessionOpening& now) {
  if (now.is_visual() == then.is_visual() && now.simulated == then.simulated) return;
  throw StoreError(fmt::format(
      "{}: session {} was begun with device '{}', and '{}' is {}: continue with the former",
      options.database.string(), row.session, then.device, now.device,
      now.simulated     ? "simulated"
      : now.is_visual() ? "seen on a screen and not felt"
                        : "felt and not seen"));
}

/// Records that the resumed session uses another device or certificate.
void record_other_station(EnteredSession& entered, const record::SessionOpening& then,
                          const record::SessionOpening& now) {
  const auto certificate = [](const record::SessionOpening& opening) {
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
/// \throws StoreError if its trials are done: it is then complete and cannot be restarted
void give_up(const RunOptions& options, const RunStudy& study, record::StudyStore& store,
             const StoredSession& kept, const record::SessionRow& row) {
  const std::unique_ptr<record::EventSink> sink = store.continue_session(row.session);
  session::Session session = restored(study, kept, row, *sink);
  if (session.phase() == session::SessionPhase::finished) {
    throw StoreError(fmt::format(
        "{}: all trials of session {} (participant {}) are done; end it with --on-existing resume",
        one_line(options.database.string()), row.session, row.participant));
  }
  if (session.accepts(session::SessionInput::stop)) session.stop(session.last(), "", "restarted");
  session.close(session.last(), study::ask_of(study.key.study).has_pictures());
}

/// Opens a new session with the enrolment number of the previous, ended one.
EnteredSession restart_session(const RunOptions& options, const RunStudy& study,
                               RunDatabase& database, const record::SessionRow& row,
                               const DescribeOpening& describe) {
  database.made().replace(row.session, row.participant, utc_now(), "restarted");
  return new_session(options, study, database, row.enrolment, describe);
}

EnteredSession existing_session(const RunOptions& options, const RunStudy& study,
                                RunDatabase& database, const record::SessionRow& row,
                                const DescribeOpening& describe) {
  record::StudyStore& store = database.made();
  if (row.withdrawn) {
    throw StoreError(fmt::format(
        "{}: participant {} has withdrawn (session {}), and takes no further part; give "
        "another participant id",
        one_line(options.database.string()), row.participant, row.session));
  }
  if (row.excluded) {
    spdlog::warn("{}: participant {} was excluded (session {}), and enters no outcomes",
                 one_line(options.database.string()), row.participant, row.session);
  }
  const bool may_be_restarted =
      options.on_existing == OnExisting::restart && row.state == record::SessionState::stopped;
  if (may_be_restarted) return restart_session(options, study, database, row, describe);
  if (row.state != record::SessionState::open) {
    throw StoreError(fmt::format(
        "{}: participant {} already has session {}, which is {}; give another participant id{}",
        options.database.string(), row.participant, row.session,
        row.state == record::SessionState::completed ? "complete" : "stopped",
        row.state == record::SessionState::completed && row.visit < study.key.study.visits.count
            ? fmt::format(", or --visit {} for the next visit", row.visit + 1)
            : ""));
  }
  const StoredSession kept = stored_session(options, study, store, row);
  const std::string stands = standing(store, row, kept.away);
  if (options.on_existing == OnExisting::refuse) {
    throw StoreError(fmt::format(
        "{}: {}; continue with --on-existing resume, or start again with --on-existing restart",
        options.database.string(), stands));
  }
  if (options.on_existing == OnExisting::restart) {
    give_up(options, study, store, kept, row);
    return restart_session(options, study, database, row, describe);
  }
  require_recent(options, study, stands, kept.away);
  record::SessionOpening now;
  describe(now);
  const record::SessionOpening then =
      record::from_json<record::SessionOpening>(kept.events.front().body);
  require_same_kind(options, row, then, now);
  EnteredSession entered = resumed_session(options, study, store, kept, row);
  record_other_station(entered, then, now);
  return entered;
}

}  // namespace

void require_planned_visit(const RunOptions& options, const study::Study& study) {
  const int visits = study.visits.count;
  if (options.visit <= visits) return;
  throw UsageError(visits == 1 ? "run: the study has one visit; leave --visit out"
                               : fmt::format("run: the study has {} visits; give --visit 1 to {}",
                                             visits, visits));
}

void confirm_enrolment(const RunOptions& options, const study::StationKey& key) {
  if (options.enrolment == 0 || key.station.name != study::kOnlyStation) return;
  std::set<int> taken;
  if (is_there(options.database)) {
    taken = taken_numbers(
        record::StudyStore::open(options.database, record::StudyStore::Access::read_only));
  }
  const int next = study::next_enrolment_of(key.station, taken);
  const int planned = key.study.registration.participants;
  if (options.enrolment <= std::max(planned, next)) return;
  confirm(
      fmt::format("run: --enrolment {} {}; the next number is {}, which a participant gets "
                  "without --enrolment",
                  options.enrolment,
                  planned > 0
                      ? fmt::format("is beyond the {} participants that the study plans", planned)
                      : "leaves numbers out",
                  next),
      options.yes);
}

EnteredSession enter_session(const RunOptions& options, const RunStudy& study,
                             RunDatabase& database, const DescribeOpening& describe) {
  require_planned_visit(options, study.key.study);
  const record::StudyStore* const store = database.present();
  const auto row = store == nullptr ? std::nullopt : store->session_of(options.participant);
  if (row && options.visit == row->visit + 1) {
    return next_visit(options, study, database, *row, describe);
  }
  if (row && options.visit != row->visit) {
    const bool is_followed =
        row->state == record::SessionState::completed && row->visit < study.key.study.visits.count;
    throw StoreError(fmt::format("{}: the last visit was visit {} (session {}); give --visit {}",
                                 visit_words(options, study), row->visit, row->session,
                                 is_followed ? row->visit + 1 : row->visit));
  }
  if (row) return existing_session(options, study, database, *row, describe);
  if (options.visit > 1) {
    throw StoreError(visit_words(options, study) +
                     ": there is no visit before; check the participant id, or give --visit 1");
  }
  return new_session(options, study, database, enrolment_of(options, study.key.station, store),
                     describe);
}

namespace {

constexpr int kShellOffset = 128;
constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr std::array kNames = {"SIGINT", "SIGTERM", "SIGHUP"};

std::atomic<int> came{0};
std::array<struct sigaction, kSignals.size()> earlier{};

extern "C" void store_signal(int signal) {
  came.store(signal);
}

}  // namespace

EndingSignals::EndingSignals() {
  came.store(0);
  struct sigaction action {};
  action.sa_handler = store_signal;
  // A second signal ends the program at once.
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &earlier[i]);
}

EndingSignals::~EndingSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &earlier[i], nullptr);
}

int EndingSignals::which() noexcept {
  if (device::StopOnSignals::asked()) return device::StopOnSignals::exit_code() - kShellOffset;
  return came.load();
}

std::string EndingSignals::message() {
  if (device::StopOnSignals::asked()) return device::StopOnSignals::message();
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (kSignals[i] == came.load()) return std::string("stopped by ") + kNames[i];
  }
  return "";
}

RunExperimenter::RunExperimenter(session::Experimenter& inner,
                                 std::function<std::string()> end_reason,
                                 std::function<std::optional<session::ExperimenterRequest>()> more,
                                 std::function<std::string()> alert)
    : inner_(inner),
      end_reason_(std::move(end_reason)),
      more_(std::move(more)),
      alert_(std::move(alert)) {}

void RunExperimenter::show(const session::SessionStatus& status) {
  session::SessionStatus shown = status;
  if (alert_) shown.alert = alert_();
  inner_.show(shown);
}

std::optional<session::ExperimenterRequest> RunExperimenter::request() {
  std::string why = EndingSignals::message();
  if (why.empty()) why = end_reason_();
  if (!why.empty())
    return session::ExperimenterRequest{session::ExperimenterRequest::Kind::leave, why, ""};
  if (auto request = more_ ? more_() : std::nullopt) return request;
  return inner_.request();
}

void RunExperimenter::acknowledged(int trial) {
  inner_.acknowledged(trial);
  try {
    print("trial " + std::to_string(trial) + " acknowledged\n");
  } catch (const ClosedPipe& closed) {
    throw FileError(std::string(closed.what()) +
                    "; the session stays open: continue with --on-existing resume");
  }
}

namespace {

std::string summary(const RunOptions& options, int session, const session::SessionTally& tally,
                    const record::SessionRow& row, const record::StudyStore& store) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(tally.duration).count();
  const bool is_complete = row.state == record::SessionState::completed;
  const char* const end = tally.left ? "left open" : is_complete ? "complete" : "stopped";
  return fmt::format("{}session {} of participant {}: {}, {} trials answered, {} min {} s{}\n",
                     row.simulated ? "SIMULATED: " : "", session, options.participant, end,
                     answered_trials(store, session), seconds / 60, seconds % 60,
                     row.simulated && !options.is_simulated() ? "; it does not count" : "");
}

/// A session's end erases the station's copy of its key, which remains in the database's log while
/// another program reads it.
void require_key_erased(const RunOptions& options, int session, record::StudyStore& store) {
  if (store.clear_log()) return;
  const std::string database = one_line(options.database.string());
  spdlog::warn(
      "{}: another program reads it, so that this station's key of session {} is not erased from "
      "{}-wal yet, which is recorded; close that program, then run `touchtrial status {}`",
      database, session, database, database);
  store.note(session, utc_now(), "key-not-erased",
             "another program had the database open when the session ended");
}

}  // namespace

int conclude_session(const RunOptions& options, int session, const session::SessionTally& tally,
                     record::StudyStore& store, std::string trouble) {
  if (trouble.empty() && !is_on_disk(options.database, session, store)) {
    trouble = one_line(options.database.string()) + " was changed while the session ran";
  }
  if (!trouble.empty()) {
    throw StoreError(
        fmt::format("{}, and does not hold session {} of participant {} to its end; {}", trouble,
                    session, options.participant, save_copy(options.database, store)));
  }
  if (!tally.left) require_key_erased(options, session, store);
  const record::SessionRow row = store.session_of(options.participant).value();
  // Simulated participants have no day sheet.
  print(summary(options, session, tally, row, store) +
        (options.is_simulated() ? "" : head_words(store) + "; write it on the day sheet\n"));
  if (tally.left) {
    std::fprintf(stderr,
                 "touchtrial: %s; the session stays open: continue with the same command and "
                 "--on-existing resume (participant %s)\n",
                 one_line(*tally.left).c_str(), options.participant.c_str());
  }
  if (EndingSignals::which() != 0) return kShellOffset + EndingSignals::which();
  return row.state == record::SessionState::completed && !tally.left ? 0 : 1;
}

}  // namespace touchtrial::app
