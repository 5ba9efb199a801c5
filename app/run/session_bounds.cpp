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

/// The draws of a session, as in verification and outcomes.
study::Draws draws_of(bool pilot, bool simulated) {
  return pilot || simulated ? study::Draws::rehearsal : study::Draws::people;
}

/// Includes numbers reserved for a replacement, because their first session is still stored.
std::set<int> used_numbers(const record::StudyStore& store) {
  std::set<int> numbers;
  for (const record::SessionRow& row : store.sessions()) numbers.insert(row.enrolment);
  return numbers;
}

/// Refuses a database with another station's numbers, because it or the station's file is the wrong
/// one.
void require_station_numbers(const RunOptions& options, const study::Station& station,
                             const std::set<int>& numbers) {
  for (const int number : numbers) {
    if (station.place_of(number)) continue;
    throw UsageError(one_line(options.database.string()) + ": has number " +
                     std::to_string(number) + ", which is not station " + station.name +
                     "'s; every station needs its own database: give another --db, or the right "
                     "station's file");
  }
}

/// The enrolment number of a participant without a session: from the options, or else that of the
/// replaced person, or else the station's next.
/// \param store  null: there is none yet
/// \throws as next_enrolment_of
int enrolment_of(const RunOptions& options, const study::Station& station,
                 const record::StudyStore* store) {
  if (options.enrolment > 0) return options.enrolment;
  if (store == nullptr) return study::next_enrolment_of(station, {});
  const int enrolment = store->enrolment_for(options.participant);
  const std::set<int> numbers = used_numbers(*store);
  require_station_numbers(options, station, numbers);
  if (numbers.contains(enrolment)) return enrolment;
  return study::next_enrolment_of(station, numbers);
}

/// The participant's group, if the study's groups are open; otherwise empty.
std::string open_group(const study::StationKey& key, int enrolment, study::Draws draws) {
  const study::GroupPlan& groups = key.study.groups;
  if (!groups.open) return "";
  const auto group = study::group_for(key.study, key.station, enrolment, draws);
  return group ? groups.labels[static_cast<std::size_t>(*group)] : "";
}

EnteredSession start_new_session(const RunOptions& options, const RunStudy& study,
                                 RunDatabase& database, int enrolment,
                                 const DescribeOpening& describe) {
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
  record::StudyStore& store = database.open_or_create();
  entered.number = store.next_session();
  SystemEntropy entropy;
  const SecretKey key = entropy.secret("participant key");
  entered.sink = std::make_unique<PatientSink>(store.begin_session(
      entered.number, record::wrap_participant_key(study.key.investigator_box, entered.number, key),
      {}, record::seal_station_copy(study.key.station.secret, entered.number, key)));
  entered.session = std::make_unique<session::Session>(
      std::move(order), study.key.study.trials,
      record::SessionRecorder(entered.number, key, *entered.sink),
      session::block_serialiser(study.key));
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
nanoseconds opening_time(const record::StudyStore& store, int session) {
  nanoseconds opening{};
  store.for_each(record::EventKind::session_opened, [&](const record::Event& event) {
    if (record::from_json<record::SessionOpenedBody>(event.body).session == session)
      opening = event.at;
  });
  return opening;
}

std::string visit_words(const RunOptions& options, const RunStudy& study) {
  return fmt::format("{}: participant {}, visit {} of {}", one_line(options.database.string()),
                     options.participant, options.visit, study.key.study.visits.count);
}

/// Opens the session of a participant's next visit.
/// \throws StoreError if it is too early
EnteredSession start_next_visit(const RunOptions& options, const RunStudy& study,
                                RunDatabase& database, const record::SessionRow& previous_session,
                                const DescribeOpening& describe) {
  const auto refuse = [&](const std::string& reason) {
    throw StoreError(visit_words(options, study) + ": " + reason);
  };
  if (previous_session.withdrawn || previous_session.excluded) {
    refuse(fmt::format("cannot follow session {}, whose participant {}", previous_session.session,
                       previous_session.withdrawn ? "has withdrawn" : "was excluded"));
  }
  if (previous_session.state != record::SessionState::completed) {
    refuse(
        fmt::format("cannot follow session {}, which is {}; complete visit {} first, with "
                    "--visit {} and --on-existing {}",
                    previous_session.session,
                    previous_session.state == record::SessionState::open ? "still open" : "stopped",
                    previous_session.visit, previous_session.visit,
                    previous_session.state == record::SessionState::open ? "resume" : "restart"));
  }
  // Virtual time does not pass between visits.
  const bool counts_days = !options.is_simulated() || options.real_time;
  const study::VisitPlan& plan = study.key.study.visits;
  const nanoseconds previous_opening =
      opening_time(database.open_or_create(), previous_session.session);
  const double days = study::days_between(previous_opening, utc_now());
  const bool is_clock_wrong = counts_days && days < 0.0;
  if (is_clock_wrong && options.accept_clock.empty()) {
    refuse(
        fmt::format("visit {} was opened at {}, and this machine's clock shows {}: one of the "
                    "two was wrong; set the clock if it is this one, or else give "
                    "--accept-clock REASON, which is recorded",
                    previous_session.visit, utc_words(previous_opening), utc_words(utc_now())));
  }
  if (counts_days && !is_clock_wrong && days < plan.min_days) {
    const auto min_gap = std::chrono::duration<double, std::ratio<86'400>>(plan.min_days);
    refuse(fmt::format(
        "{:.1f} days have passed since visit {} by this machine's clock, and the study requires "
        "at least {} days between visits: come back after {}",
        days, previous_session.visit, plan.min_days,
        utc_words(previous_opening + std::chrono::ceil<nanoseconds>(min_gap))));
  }
  EnteredSession entered =
      start_new_session(options, study, database, previous_session.enrolment, describe);
  if (is_clock_wrong) {
    entered.session->deviate(
        {}, {"wrong-clock", fmt::format("visit {} was opened at {}: {}", previous_session.visit,
                                        utc_words(previous_opening), options.accept_clock)});
  }
  if (counts_days && plan.max_days && days > *plan.max_days) {
    const std::string lateness = fmt::format("{:.1f} days after visit {}, at most {} in the study",
                                             days, previous_session.visit, *plan.max_days);
    spdlog::warn("{}: {}; recorded as the deviation visit-late", visit_words(options, study),
                 lateness);
    entered.session->deviate({}, {"visit-late", lateness});
  }
  return entered;
}

/// A stored open session, decrypted with the station's copy of its key.
struct StoredSession {
  SecretKey key{};
  std::string schedule;  ///< JSON
  std::vector<record::Event> events;
  nanoseconds elapsed{};  ///< time since its last event; negative if the clock was set back
};

/// \throws StoreError if this station does not have the session's key
StoredSession load_stored_session(const RunOptions& options, const RunStudy& study,
                                  const record::StudyStore& store, const record::SessionRow& row) {
  const auto refuse = [&] {
    throw StoreError(fmt::format(
        "{}: session {} cannot be decrypted with this station's file; give the file of the "
        "station that started it, with --station-file",
        options.database.string(), row.session));
  };
  const auto sealed_key = store.kept_key(row.session);
  const auto key =
      sealed_key ? record::open_station_copy(study.key.station.secret, row.own_session, *sealed_key)
                 : std::nullopt;
  if (!key) refuse();
  StoredSession session{.key = *key, .schedule = {}, .events = {}};
  for (const record::Event& stored : store.events(row.session)) {
    auto plain_event = record::opened_event(stored, *key);
    if (!plain_event) refuse();
    if (stored.sequence == 0) session.schedule = std::move(plain_event->secret);
    session.events.push_back(std::move(plain_event->event));
  }
  session.elapsed = utc_now() - opening_time(store, row.session) - session.events.back().at;
  return session;
}

std::string progress_summary(const record::StudyStore& store, const record::SessionRow& row,
                             nanoseconds elapsed) {
  const auto minutes =
      std::chrono::duration_cast<std::chrono::minutes>(std::max(nanoseconds{}, elapsed)).count();
  return fmt::format("participant {} has session {}, with {} trials answered, left {} h {} min ago",
                     row.participant, row.session, answered_trials(store, row.session),
                     minutes / 60, minutes % 60);
}

session::Session restore_session(const RunStudy& study, const StoredSession& saved,
                                 const record::SessionRow& row, record::EventSink& sink) {
  const study::ScheduleDraw draw =
      study.key.draw_of(row.enrolment, draws_of(row.pilot, row.simulated), row.visit);
  auto order = study::make_order(study.key.study, draw);
  if (study::schedule_from_json(saved.schedule, study.key) != order->schedule()) {
    throw StoreError(
        one_line(fmt::format("session {} was started with another order than the study "
                             "draws now; run `touchtrial verify`",
                             row.session)));
  }
  session::Session session(std::move(order), study.key.study.trials,
                           record::SessionRecorder(row.session, saved.key, sink),
                           session::block_serialiser(study.key));
  session.restore(saved.events);
  return session;
}

/// The session's clock after a pause; virtual time does not pass between two runs of the program.
nanoseconds clock_after_pause(const RunOptions& options, nanoseconds last_event_time,
                              nanoseconds elapsed) {
  return options.is_simulated() && !options.real_time ? last_event_time : last_event_time + elapsed;
}

/// Records that the clock was set back since the session's last event by more than a usual
/// correction.
void record_clock(const RunOptions& options, nanoseconds elapsed, EnteredSession& entered) {
  constexpr std::chrono::seconds kSmall{5};
  const bool is_virtual = options.is_simulated() && !options.real_time;
  if (is_virtual || elapsed >= -kSmall) return;
  const auto seconds_back = std::chrono::duration_cast<std::chrono::seconds>(-elapsed).count();
  entered.session->deviate(
      entered.clock,
      {"clock-set-back", fmt::format("this machine's clock shows {}, {} s before the "
                                     "session's last event",
                                     utc_words(utc_now()), seconds_back)});
}

EnteredSession resume_session(const RunOptions& options, const RunStudy& study,
                              record::StudyStore& store, const StoredSession& saved,
                              const record::SessionRow& row) {
  EnteredSession entered;
  entered.number = row.session;
  entered.enrolment = row.enrolment;
  entered.draw = study.key.draw_of(row.enrolment, draws_of(row.pilot, row.simulated), row.visit);
  entered.sink = std::make_unique<PatientSink>(store.continue_session(row.session));
  entered.session =
      std::make_unique<session::Session>(restore_session(study, saved, row, *entered.sink));
  session::Session& session = *entered.session;
  const nanoseconds elapsed = std::max(nanoseconds{}, saved.elapsed);
  entered.clock = clock_after_pause(options, session.last(), elapsed);
  session.resume_after_exit(entered.clock,
                            {.after = "program-ended",
                             .away_s = std::chrono::duration<double>(elapsed).count(),
                             .program_version = std::string(program_version())});
  record_clock(options, saved.elapsed, entered);
  return entered;
}

void require_recent(const RunOptions& options, const RunStudy& study,
                    const std::string& progress_summary, nanoseconds elapsed) {
  const double limit_h = study.key.study.trials.resume_within_h;
  if (std::chrono::duration<double, std::ratio<3600>>(elapsed).count() <= limit_h) return;
  throw StoreError(fmt::format(
      "{}: {}, by this machine's clock, which shows {}; the study allows sessions to be "
      "resumed within {} h; set the clock if it is wrong, or start again with "
      "--on-existing restart",
      options.database.string(), progress_summary, utc_words(utc_now()), limit_h));
}

/// Refuses to resume a session on another kind of device: a session on a screen is not blind, and
/// trials without force do not count.
void require_same_kind(const RunOptions& options, const record::SessionRow& row,
                       const record::SessionOpening& previous,
                       const record::SessionOpening& current) {
  if (current.is_visual() == previous.is_visual() && current.simulated == previous.simulated)
    return;
  throw StoreError(fmt::format(
      "{}: session {} was started with device '{}', and '{}' is {}: continue with the former",
      options.database.string(), row.session, previous.device, current.device,
      current.simulated     ? "simulated"
      : current.is_visual() ? "seen on a screen and not felt"
                            : "felt and not seen"));
}

/// Records that the resumed session uses another device or certificate.
void record_other_station(EnteredSession& entered, const record::SessionOpening& previous,
                          const record::SessionOpening& current) {
  const auto certificate = [](const record::SessionOpening& opening) {
    return opening.station ? opening.station->calibration : std::string();
  };
  if (previous.device != current.device || previous.device_serial != current.device_serial) {
    entered.session->deviate(
        entered.clock, {"other-device", one_line(current.device + " " + current.device_serial)});
  }
  if (certificate(previous) != certificate(current)) {
    entered.session->deviate(entered.clock, {"other-certificate", certificate(current)});
  }
}

/// Ends the session in its present state.
/// \throws StoreError if all its trials are done, because a complete session cannot be restarted
void end_stored_session(const RunOptions& options, const RunStudy& study, record::StudyStore& store,
                        const StoredSession& saved, const record::SessionRow& row) {
  const std::unique_ptr<record::EventSink> sink = store.continue_session(row.session);
  session::Session session = restore_session(study, saved, row, *sink);
  if (session.phase() == session::SessionPhase::finished) {
    throw StoreError(fmt::format(
        "{}: all trials of session {} (participant {}) are done; end it with --on-existing resume",
        one_line(options.database.string()), row.session, row.participant));
  }
  if (session.accepts(session::SessionInput::stop)) session.stop(session.last(), "", "restarted");
  session.close(session.last(), study::trial_question_of(study.key.study).has_pictures());
}

/// Opens a new session with the enrolment number of the previous, ended one.
EnteredSession restart_session(const RunOptions& options, const RunStudy& study,
                               RunDatabase& database, const record::SessionRow& row,
                               const DescribeOpening& describe) {
  database.open_or_create().replace(row.session, row.participant, utc_now(), "restarted");
  return start_new_session(options, study, database, row.enrolment, describe);
}

EnteredSession enter_existing_session(const RunOptions& options, const RunStudy& study,
                                      RunDatabase& database, const record::SessionRow& row,
                                      const DescribeOpening& describe) {
  record::StudyStore& store = database.open_or_create();
  if (row.withdrawn) {
    throw StoreError(fmt::format(
        "{}: participant {} has withdrawn (session {}), and cannot take part again; give "
        "another participant id",
        one_line(options.database.string()), row.participant, row.session));
  }
  if (row.excluded) {
    spdlog::warn("{}: participant {} was excluded (session {}), and is left out of the outcomes",
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
  const StoredSession saved = load_stored_session(options, study, store, row);
  const std::string progress = progress_summary(store, row, saved.elapsed);
  if (options.on_existing == OnExisting::refuse) {
    throw StoreError(fmt::format(
        "{}: {}; continue with --on-existing resume, or start again with --on-existing restart",
        options.database.string(), progress));
  }
  if (options.on_existing == OnExisting::restart) {
    end_stored_session(options, study, store, saved, row);
    return restart_session(options, study, database, row, describe);
  }
  require_recent(options, study, progress, saved.elapsed);
  record::SessionOpening current;
  describe(current);
  const record::SessionOpening previous =
      record::from_json<record::SessionOpening>(saved.events.front().body);
  require_same_kind(options, row, previous, current);
  EnteredSession entered = resume_session(options, study, store, saved, row);
  record_other_station(entered, previous, current);
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
  std::set<int> numbers;
  if (path_exists(options.database)) {
    numbers = used_numbers(
        record::StudyStore::open(options.database, record::StudyStore::Access::read_only));
  }
  const int next = study::next_enrolment_of(key.station, numbers);
  const int planned_count = key.study.registration.participants;
  if (options.enrolment <= std::max(planned_count, next)) return;
  confirm(fmt::format(
              "run: --enrolment {} {}; the next number is {}, which a participant gets "
              "without --enrolment",
              options.enrolment,
              planned_count > 0
                  ? fmt::format("is beyond the {} participants that the study plans", planned_count)
                  : "leaves numbers out",
              next),
          options.yes);
}

EnteredSession enter_session(const RunOptions& options, const RunStudy& study,
                             RunDatabase& database, const DescribeOpening& describe) {
  require_planned_visit(options, study.key.study);
  const record::StudyStore* const store = database.existing_store();
  const auto row = store == nullptr ? std::nullopt : store->session_of(options.participant);
  if (row && options.visit == row->visit + 1) {
    return start_next_visit(options, study, database, *row, describe);
  }
  if (row && options.visit != row->visit) {
    const bool has_next_visit =
        row->state == record::SessionState::completed && row->visit < study.key.study.visits.count;
    throw StoreError(fmt::format("{}: the last visit was visit {} (session {}); give --visit {}",
                                 visit_words(options, study), row->visit, row->session,
                                 has_next_visit ? row->visit + 1 : row->visit));
  }
  if (row) return enter_existing_session(options, study, database, *row, describe);
  if (options.visit > 1) {
    throw StoreError(visit_words(options, study) +
                     ": there is no earlier visit; check the participant id, or give --visit 1");
  }
  return start_new_session(options, study, database,
                           enrolment_of(options, study.key.station, store), describe);
}

namespace {

constexpr int kShellOffset = 128;
constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr std::array kNames = {"SIGINT", "SIGTERM", "SIGHUP"};

std::atomic<int> received_signal{0};
std::array<struct sigaction, kSignals.size()> previous_actions{};

extern "C" void store_signal(int signal) {
  received_signal.store(signal);
}

}  // namespace

EndingSignals::EndingSignals() {
  received_signal.store(0);
  struct sigaction action {};
  action.sa_handler = store_signal;
  // A second signal ends the program at once.
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i)
    sigaction(kSignals[i], &action, &previous_actions[i]);
}

EndingSignals::~EndingSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i)
    sigaction(kSignals[i], &previous_actions[i], nullptr);
}

int EndingSignals::signal_number() noexcept {
  if (device::StopOnSignals::stop_requested())
    return device::StopOnSignals::exit_code() - kShellOffset;
  return received_signal.load();
}

std::string EndingSignals::message() {
  if (device::StopOnSignals::stop_requested()) return device::StopOnSignals::message();
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (kSignals[i] == received_signal.load()) return std::string("stopped by ") + kNames[i];
  }
  return "";
}

RunExperimenter::RunExperimenter(
    session::Experimenter& inner, std::function<std::string()> end_reason,
    std::function<std::optional<session::ExperimenterRequest>()> extra_request,
    std::function<std::string()> alert)
    : inner_(inner),
      end_reason_(std::move(end_reason)),
      extra_request_(std::move(extra_request)),
      alert_(std::move(alert)) {}

void RunExperimenter::show(const session::SessionStatus& status) {
  session::SessionStatus extended_status = status;
  if (alert_) extended_status.alert = alert_();
  inner_.show(extended_status);
}

std::optional<session::ExperimenterRequest> RunExperimenter::request() {
  std::string reason = EndingSignals::message();
  if (reason.empty()) reason = end_reason_();
  if (!reason.empty())
    return session::ExperimenterRequest{session::ExperimenterRequest::Kind::leave, reason, ""};
  if (auto request = extra_request_ ? extra_request_() : std::nullopt) return request;
  return inner_.request();
}

void RunExperimenter::acknowledged(int trial) {
  inner_.acknowledged(trial);
  try {
    print("trial " + std::to_string(trial) + " acknowledged\n");
  } catch (const ClosedPipe& error) {
    throw FileError(std::string(error.what()) +
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

/// Clears the database's log, which still contains the erased key of a session while another
/// program reads the database.
void require_key_erased(const RunOptions& options, int session, record::StudyStore& store) {
  if (store.clear_log()) return;
  const std::string database = one_line(options.database.string());
  spdlog::warn(
      "{}: another program has it open, so this station's key of session {} is not yet erased from "
      "{}-wal, which is recorded; close that program, then run `touchtrial status {}`",
      database, session, database, database);
  store.note(session, utc_now(), "key-not-erased",
             "another program had the database open when the session ended");
}

}  // namespace

int conclude_session(const RunOptions& options, int session, const session::SessionTally& tally,
                     record::StudyStore& store, std::string problem) {
  if (problem.empty() && !is_on_disk(options.database, session, store)) {
    problem = one_line(options.database.string()) + " was changed while the session ran";
  }
  if (!problem.empty()) {
    throw StoreError(
        fmt::format("{}, and the file does not contain all of session {} of participant {}; {}",
                    problem, session, options.participant, save_copy(options.database, store)));
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
  if (EndingSignals::signal_number() != 0) return kShellOffset + EndingSignals::signal_number();
  return row.state == record::SessionState::completed && !tally.left ? 0 : 1;
}

}  // namespace touchtrial::app
