/// \file Small studies and sessions to store, and the means to tamper with what was stored.
#pragma once

#include "core/errors.hpp"
#include "core/random.hpp"
#include "record/session_recorder.hpp"
#include "record/study_store.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

namespace touchtrial::fixture {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

inline constexpr nanoseconds kUtc = seconds(1'700'000'000);

inline Digest digest_of(const std::string& text) {
  return sha256(bytes_of(text));
}

inline SecretKey study_master() {
  return digest_of("study master");
}

inline SecretKey participant_key(int session) {
  return digest_of("participant key " + std::to_string(session));
}

inline Signer investigator() {
  return Signer(digest_of("investigator"));
}

inline constexpr const char* kStudyId = "00112233445566778899aabbccddeeff";

inline record::StationIdentity station_identity(const std::string& study_id = kStudyId) {
  const PublicKey key = Signer(digest_of("station")).public_half();
  return {.name = "only",
          .key = key,
          .certificate = investigator().sign(station_statement(study_id, "only", key))};
}

inline record::StudyCommitment commitment() {
  return {.study = "classification",
          .protocol = "classification",
          .study_id = kStudyId,
          .seal = digest_of("seal"),
          .pack = digest_of("pack"),
          .configuration = R"({"classes":["c0","c1"]})",
          .scored_trials = 3,
          .positions = 5,
          .simulated = true,
          .pilot = false,
          .program_version = "0.1.0",
          .investigator = investigator().public_half(),
          .station = station_identity()};
}

/// Opens a database of the fixture to write in it as the investigator.
inline record::StudyStore writable(const std::filesystem::path& path) {
  record::StudyStore store = record::StudyStore::open(path, record::StudyStore::Access::read_write);
  store.sign_with(investigator());
  return store;
}

inline std::string participant_of(int session) {
  return "P" + std::to_string(session);
}

inline record::SessionOpening opening(int session) {
  return {.participant = participant_of(session),
          .enrolment = session,
          .study_id = commitment().study_id,
          .seal = commitment().seal,
          .device = "simulated",
          .device_serial = "",
          .opened_utc = "",
          .simulated = true,
          .pilot = false};
}

/// A hand that strokes to and fro while a texture of the given rms force shakes it.
inline record::Trace stroking(std::size_t samples, double texture_rms_n, std::uint64_t seed = 1) {
  RandomStream random(seed, "trace fixture");
  record::Trace trace;
  trace.rate_hz = 1000.0;
  double phase = 0.0;
  double shake_mm = 0.0;
  double shake_mm_per_ms = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    const double t_s = static_cast<double>(i) * 1e-3;
    phase += (0.1 + 0.05 * std::sin(0.7 * t_s)) / 30.0;  // 50 to 150 mm/s over 60 mm
    shake_mm_per_ms = 0.8 * shake_mm_per_ms + 0.02 * texture_rms_n * random.normal();
    shake_mm = 0.99 * shake_mm + shake_mm_per_ms;
    const double tremor_mm = 0.05 * std::sin(56.0 * t_s);
    trace.samples.push_back(
        {.position_mm = {50.0 + 30.0 * std::sin(phase) + tremor_mm + shake_mm,
                         40.0 + 8.0 * std::sin(0.43 * phase) - tremor_mm,
                         -1.75 + 0.1 * std::sin(3.1 * t_s) + 0.1 * shake_mm},
         .force_n = {texture_rms_n * random.normal(), texture_rms_n * random.normal(),
                     0.7 + 0.04 * std::sin(3.1 * t_s) + texture_rms_n * random.normal()}});
  }
  return trace;
}

/// Records a session of `trials` trials; the last is not answered in time, the second is answered
/// after a change of mind and with a confidence.
inline void record_trials(record::SessionRecorder& recorder, int session, int trials,
                          const record::Trace& trace, const record::SessionOpening& how) {
  recorder.opened(nanoseconds(0), how, R"({"schedule":")" + std::to_string(session) + "\"}");
  recorder.add(seconds(1), record::EventKind::instructed, record::TextBody{.text = "read aloud"});
  for (int trial = 1; trial <= trials; ++trial) {
    const nanoseconds start = seconds(20 * trial);
    recorder.presented(start, trial, (trial - 1) / 2);
    recorder.first_contact(start + milliseconds(350), trial);
    if (trial == trials) {
      recorder.timed_out(start + seconds(10), trial);
    } else {
      record::AnswerBody answer{
          .trial = trial, .answer = ChoiceAnswer{trial % 5}, .confidence = {}};
      if (trial == 2) answer.answer = ChoiceAnswer{trial % 5, 4};
      if (trial == 2) answer.confidence = 3;
      recorder.answered(start + seconds(9), answer);
    }
    recorder.trace_stored(
        start + seconds(11),
        {.trial = trial,
         .samples = 0,
         .rate_hz = 999.75,
         .overruns = trial,
         .valid = trial != 3,
         .trace = {}},
        {.contact_s = 0.1 * trial, .path_mm = 512.5, .force_rms_n = 0.05, .saturated_share = 0.0},
        trace);
  }
  recorder.closed(seconds(20 * trials + 30), true);
}

inline record::BufferedEvents session_of(int session, int trials, const record::Trace& trace,
                                         const record::SessionOpening& how) {
  record::BufferedEvents events;
  record::SessionRecorder recorder(session, participant_key(session), events);
  record_trials(recorder, session, trials, trace, how);
  return events;
}

inline record::BufferedEvents session_of(int session, int trials = 3) {
  return session_of(session, trials, stroking(20, 0.05), opening(session));
}

inline record::NewKeys wrapped_key_of(int session) {
  return record::wrap_participant_key(box_keys(study_master()).public_half, session,
                                      participant_key(session));
}

inline void add(record::StudyStore& store, int session, int trials = 3) {
  store.add_session(session_of(session, trials), wrapped_key_of(session), kUtc);
}

/// The message with which `work` is refused; empty if it is not.
template <typename Work>
std::string refusal_of(Work&& work) {
  return message_of<StoreError>([&] { work(); });
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// "session/sequence" of a fault.
inline std::string place_of(const record::ChainFault& fault) {
  return std::to_string(fault.session) + "/" + std::to_string(fault.sequence);
}

/// Whether `work` is refused, and the message names these places in order (support/names.hpp).
template <typename Work>
bool refuses(Work&& work, const std::string& words = "") {
  const std::string line = refusal_of(work);
  return !line.empty() && (words.empty() || names_in_order(line, words));
}

/// An event as it was recorded.
inline record::Event opened(const record::Event& event) {
  return record::opened_event(event, participant_key(event.own_session())).value().event;
}

/// The events of a session as they were recorded.
inline std::vector<record::Event> opened_events(const record::StudyStore& store, int session) {
  std::vector<record::Event> events = store.events(session);
  for (record::Event& event : events) event = opened(event);
  return events;
}

/// The trials of a session with answers and times.
inline std::vector<record::TrialRow> opened_trials(const record::StudyStore& store, int session) {
  record::DerivedRows rows;
  for (const record::Event& event : opened_events(store, session)) fold(rows, event);
  std::vector<record::TrialRow> trials;
  for (const auto& [id, row] : rows.trials) trials.push_back(row);
  return trials;
}

/// A study in a folder of its own.
class StoredFixture {
 public:
  explicit StoredFixture(int sessions = 0, int trials = 3)
      : store(record::StudyStore::create(path, commitment(), kUtc, investigator())) {
    for (int session = 1; session <= sessions; ++session) add(*store, session, trials);
  }
  /// A copy of another study, which must be closed.
  explicit StoredFixture(const std::filesystem::path& original) {
    std::filesystem::copy_file(original, path);
  }

  TempFolder folder;
  std::filesystem::path path = folder.path() / "study.db";
  std::optional<record::StudyStore> store;
};

/// Calls `work` while the triggers that protect events are gone, and puts them back.
template <typename Work>
void without_triggers(SQLite::Database& raw, Work&& work) {
  std::map<std::string, std::string> triggers;
  {
    SQLite::Statement query(raw, "SELECT name, sql FROM sqlite_schema WHERE type = 'trigger'");
    while (query.executeStep()) triggers[query.getColumn(0)] = query.getColumn(1).getString();
  }
  for (const auto& [name, sql] : triggers) raw.exec("DROP TRIGGER " + name);
  work();
  for (const auto& [name, sql] : triggers) raw.exec(sql);
}

/// Closes the store, runs SQL behind its back and those of its triggers, and opens it again.
inline void tamper(StoredFixture& study, const std::string& sql) {
  study.store.reset();
  {
    SQLite::Database raw(study.path.string(), SQLite::OPEN_READWRITE);
    raw.exec("PRAGMA foreign_keys = OFF; PRAGMA synchronous = OFF");
    without_triggers(raw, [&] { raw.exec(sql); });
  }
  // What was tampered with may be the schema, or who signs.
  using Access = record::StudyStore::Access;
  const std::string refused = refusal_of([&] {
    study.store = record::StudyStore::open(study.path, Access::read_write);
    study.store->sign_with(investigator());
  });
  if (!refused.empty() && !study.store) {
    study.store = record::StudyStore::open(study.path, Access::read_only);
  }
}

}  // namespace touchtrial::fixture
