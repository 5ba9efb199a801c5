#include "analysis/verification/verification.hpp"

#include "analysis/outcomes/outcomes.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/verification/chain_notes.hpp"
#include "analysis/verification/session_course.hpp"
#include "core/errors.hpp"
#include "core/named.hpp"
#include "record/damage.hpp"
#include "record/payload_json.hpp"
#include "study/protocol.hpp"
#include "study/signed_pack.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

// Each check below returns a description of what it checked, and throws an Error if it fails.

std::string check_chain(const record::StudyStore& store) {
  if (const auto fault = store.first_fault()) throw VerificationError(shown(*fault));
  return fmt::format("the file's chain and those of {}, their traces and tables",
                     counted(static_cast<std::int64_t>(store.sessions().size()), "session"));
}

std::string check_key(const record::StudyStore& store, const study::StudyKey& key) {
  const std::string& study_id = store.commitment().study_id;
  if (key.study_id != study_id) {
    throw VerificationError(fmt::format("is the key of study {}, but the database is of study {}",
                                        key.study_id, one_line(study_id)));
  }
  return "the key of study " + study_id;
}

std::string check_seal(const record::StudyStore& store, const study::StudyKey& key) {
  require_key_of(store, key);
  const record::StudyCommitment& commitment = store.commitment();
  store.for_each(record::EventKind::opened, [&](const record::Event& event) {
    const record::SessionOpening opening = record::from_json<record::SessionOpening>(event.body);
    if (opening.study_id == commitment.study_id && opening.seal == commitment.seal) return;
    throw VerificationError(
        fmt::format("session {}: was opened under another study's seal; it does not belong here",
                    event.session));
  });
  return fmt::format("{}..., in the first event and every session's",
                     to_hex(commitment.seal).substr(0, 16));
}

std::string check_configuration(const record::StudyStore& store, const study::StudyKey& key) {
  const record::StudyCommitment& commitment = store.commitment();
  const auto require = [](bool is_equal, const char* what) {
    if (!is_equal) throw VerificationError(std::string(what) + " differs between key and database");
  };
  require(key.configuration == commitment.configuration, "the configuration");
  require(key.study.name == commitment.study, "the study's name");
  require(key.study.protocol_name() == commitment.protocol, "the protocol");
  require(key.study.scored_trials() == commitment.scored_trials, "the number of scored trials");
  require(key.study.registration.safety_record_years == commitment.safety_record_years,
          "how long safety records are kept");
  require(static_cast<int>(study::choices_of(key.study).size()) == commitment.positions,
          "the number of pictures");
  // A prepared study may be rehearsed with simulated participants in a separate database. A
  // simulated study must not be run with people.
  require(!key.simulated || commitment.simulated, "whether the study is simulated");
  return "the database's unencrypted configuration is the key's study";
}

/// Checks a session's events against the course given by the key and the enrolment number.
SessionCourse checked_course(const record::StudyStore& store, const study::StudyKey& key,
                             const record::SessionRow& session) {
  try {
    const std::optional<SecretKey> session_key = participant_key(store, key, session);
    SessionCourse course(key.study,
                         key.draw_of(session.enrolment, draws_of(session), session.visit),
                         session_key.has_value());
    for (const record::Event& event : store.events(session.session)) {
      // Only resumptions, whose duration is sealed, and answers to an adaptive order need opening.
      const bool needs_opening =
          session_key && (event.kind == record::EventKind::resumed ||
                          (course.is_adaptive() && event.kind == record::EventKind::answered));
      course.follow(needs_opening ? open_event(event, *session_key).event : event);
    }
    return course;
  } catch (const UsageError& error) {  // StudyError too
    throw VerificationError(fmt::format("session {}: the study has no order for enrolment {}: {}",
                                        session.session, session.enrolment, error.what()));
  }
}

/// Whether a session records that its clock or the previous visit's clock was wrong.
bool has_wrong_clock(const record::StudyStore& store, int session) {
  return std::ranges::any_of(store.events(session), [](const record::Event& event) {
    return event.kind == record::EventKind::deviated &&
           record::from_json<record::DeviationBody>(event.body).code == "wrong-clock";
  });
}

/// Checks the days between each participant's visits. Simulated studies are in virtual time.
void require_days_between(const record::StudyStore& store, const study::StudyKey& key) {
  if (key.study.visits.count < 2 || store.commitment().simulated) return;
  std::map<std::pair<int, int>, std::chrono::nanoseconds> opened;  // by enrolment and visit
  for (const record::Event& event : store.events(0)) {
    if (event.kind != record::EventKind::session_opened) continue;
    const auto body = record::body_of<record::SessionOpenedBody>(event);
    opened[{body.enrolment, body.visit}] = event.at;
    const auto previous = opened.find({body.enrolment, body.visit - 1});
    if (previous == opened.end()) continue;
    const double days = study::days_between(previous->second, event.at);
    if (days >= key.study.visits.min_days) continue;
    if (days < 0.0 && has_wrong_clock(store, body.session)) continue;
    throw VerificationError(
        fmt::format("session {}: was opened {:.2f} days after the previous visit, but the study "
                    "requires at least {} between visits",
                    body.session, days, key.study.visits.min_days));
  }
}

/// Checks that sessions record their assigned group, or none if groups are blinded.
void require_assigned_groups(const record::StudyStore& store, const study::StudyKey& key) {
  const study::GroupPlan& groups = key.study.groups;
  std::map<int, record::SessionRow> rows;
  for (const record::SessionRow& row : store.sessions()) rows[row.session] = row;
  store.for_each(record::EventKind::opened, [&](const record::Event& event) {
    const auto row = rows.find(event.session);
    if (row == rows.end()) return;
    const auto group = key.group_of(row->second.enrolment, draws_of(row->second));
    const std::string expected =
        group && groups.open ? groups.labels[static_cast<std::size_t>(*group)] : "";
    if (record::body_of<record::SessionOpening>(event).group == expected) return;
    throw VerificationError(
        fmt::format("session {}: its group is not the one assigned to enrolment {}", event.session,
                    row->second.enrolment));
  });
}

/// The station that recorded a session; empty if its file names none.
std::string recording_station(const record::StudyStore& store, const record::SessionRow& session) {
  std::optional<record::StationIdentity> station = store.commitment().station;
  if (session.station > 0) {
    const std::vector<record::Event> chain = store.station_chain(session.station);
    if (chain.empty()) throw VerificationError("a session names a station that is missing here");
    station = record::from_json<record::StudyCommitment>(chain.front().body).station;
  }
  return station ? station->name : std::string();
}

/// Checks that the recording station owns the session's enrolment number, so that a station cannot
/// record sessions as another station.
void require_own_station(const record::StudyStore& store, const study::StudyKey& key,
                         const record::SessionRow& session) {
  const std::string recorder = recording_station(store, session);
  const study::Station* const owner = study::station_of(key.stations, session.enrolment);
  if (recorder.empty() || owner == nullptr || owner->name == recorder) return;
  throw VerificationError(
      fmt::format("session {}: enrolment {} belongs to station {}, but the file is station {}'s",
                  session.session, session.enrolment, owner->name, recorder));
}

std::string check_schedule(const record::StudyStore& store, const study::StudyKey& key) {
  const std::map<int, study::Schedule> schedules =
      open_schedules(store, key, person_keys(store, key));
  require_days_between(store, key);
  require_assigned_groups(store, key);
  int presentations = 0;
  for (const record::SessionRow& session : store.sessions()) {
    require_own_station(store, key, session);
    const SessionCourse course = checked_course(store, key, session);
    presentations += course.presentations();
    const auto schedule = schedules.find(session.session);
    if (schedule == schedules.end()) continue;  // withdrawn
    if (schedule->second == course.scheduled()) continue;
    throw VerificationError(fmt::format("session {}: the schedule is not that of enrolment {}",
                                        session.session, session.enrolment));
  }
  return fmt::format("{} sessions' schedules recomputed, {} presentations in their places",
                     schedules.size(), presentations);
}

std::string check_responses(const record::StudyStore& store, const study::StudyKey& key) {
  const study::TrialQuestion question = study::trial_question_of(key.study);
  int responses = 0;
  for (const record::TrialRow& row : open_trials(store, person_keys(store, key))) {
    if (!row.answer) continue;
    const std::string mismatch = study::mismatch_of(*row.answer, question);
    if (!mismatch.empty()) {
      throw VerificationError(
          fmt::format("session {}, trial {}: {}", row.session, row.trial, mismatch));
    }
    ++responses;
  }
  if (question.choices().empty()) return fmt::format("{} answers on the scales", responses);
  return fmt::format("{} answers within the {} choices", responses, question.choices().size());
}

/// Opens the parts of erased sessions that are still sealed, and the texts about people on the
/// file's chain.
/// \return the number of opened parts
int check_safety_record(const record::StudyStore& store, const study::StudyKey& key) {
  const std::map<int, record::PersonKeys> keys = person_keys(store, key);
  int parts = 0;
  const auto check = [&](const record::Event& event, const record::SessionRow& row) {
    if (event.sealed.empty()) return;
    parts += readable_event(event, row, keys.at(row.session)).sealed.empty() ? 1 : 0;
  };
  std::map<int, record::SessionRow> rows;
  for (const record::SessionRow& row : store.sessions()) rows[row.session] = row;
  for (const auto& [session, row] : rows) {
    if (!row.erased || !keys.at(session).safety) continue;
    for (const record::Event& event : store.events(session)) {
      if (record::is_safety_record(event.kind)) check(event, row);
    }
  }
  for (const record::Event& event : store.events(0)) {
    const auto row = rows.find(record::session_about(event));
    if (row != rows.end()) check(event, row->second);
  }
  return parts;
}

std::string check_payloads(const record::StudyStore& store, const study::StudyKey& key) {
  int parts = 0;
  const SessionKeys keys = person_keys(store, key);
  for (const auto& [session, person] : keys) {
    if (!person.participant) continue;
    std::chrono::nanoseconds previous{0};
    for (const record::Event& stored : store.events(session)) {
      const record::Event event = open_event(stored, *person.participant).event;
      if (event.at < previous) {
        throw VerificationError(
            fmt::format("session {}, event {}: its time is earlier than the previous event's",
                        session, event.sequence));
      }
      previous = event.at;
      ++parts;
    }
  }
  require_sealed_ends(store, keys);
  parts += check_safety_record(store, key);
  return fmt::format("{} sealed parts of events, including the ends of chains", parts);
}

void check_trace(const record::StudyStore& store, const record::Event& event,
                 const SecretKey& key) {
  const record::TraceBody body =
      record::from_json<record::TraceBody>(open_event(event, key).event.body);
  const auto box = store.sealed_trace(event.session, body.trial);
  const auto fail = [&](const std::string& what) {
    throw VerificationError(
        fmt::format("session {}, trial {}: the trace {}", event.session, body.trial, what));
  };
  if (!box) return fail("is missing");
  const auto trace = record::unsealed_trace(*box, key);
  if (!trace) return fail("does not open");
  if (trace->samples.size() != static_cast<std::size_t>(body.samples))
    fail("has a different number of samples than its event");
}

std::string check_traces(const record::StudyStore& store, const study::StudyKey& key) {
  const SessionKeys keys = person_keys(store, key);
  int traces = 0;
  store.for_each(record::EventKind::trace_stored, [&](const record::Event& event) {
    const auto person = keys.find(event.session);
    if (person == keys.end() || !person->second.participant) return;
    check_trace(store, event, *person->second.participant);
    ++traces;
  });
  return fmt::format("{} traces opened and decoded", traces);
}

std::string check_pack(const record::StudyStore& store, const study::StudyKey* key,
                       const engine::Pack& pack) {
  const record::StudyCommitment& commitment = store.commitment();
  study::require_signed(pack, commitment.study_id, commitment.seal, commitment.investigator);
  if (pack.digest() != commitment.pack) {
    throw VerificationError("the pack is not the one that the database was created with");
  }
  const std::string summary =
      fmt::format("signed, {} fields intact", pack.manifest().entries.size());
  if (key == nullptr) return summary + "; not compared with the key";
  for (const study::KeyedStimulus& field : key->fields()) static_cast<void>(pack.entry(field.code));
  const std::array folders = {key->study.folder, pack.folder().parent_path()};
  const std::size_t shown_count = study::shown_pictures(key->study).size();
  const std::size_t absent_count = study::require_pictures(pack, key->study, folders).size();
  return summary +
         fmt::format(", including every code of the key; {} of {} shown pictures compared",
                     shown_count - absent_count, shown_count);
}

/// Describes the event with a hash; empty if the chain does not contain the hash.
std::string event_with_hash(const std::vector<record::Event>& chain, const std::string& head,
                            const std::string& name) {
  const auto found = std::find_if(chain.begin(), chain.end(), [&](const record::Event& event) {
    return to_hex(event.hash).starts_with(head);
  });
  if (found == chain.end()) return "";
  return fmt::format("event {} of {}, which has {}", found->sequence, name, chain.size());
}

/// Accepts a hash on the file's chain or, in a database collected from several stations, on a
/// station's chain.
std::string check_head(const record::StudyStore& store, const std::string& head) {
  std::string place = event_with_hash(store.events(0), head, "the file's chain");
  for (int station = 1; place.empty() && station <= store.stations(); ++station) {
    place = event_with_hash(store.station_chain(station), head,
                            fmt::format("station {}'s chain", station));
  }
  if (!place.empty()) return place;
  throw VerificationError(
      std::string("no event of the file's chain has the given hash: its end was cut off, or it was "
                  "rewritten") +
      (store.stations() > 0 ? ", as collecting does when sessions are added; give a station's head"
                            : "") +
      " [unknown-head]");
}

template <typename Work>
Check run_check(const std::string& name, Work work) {
  try {
    return {name, CheckState::passed, work()};
  } catch (const Error& error) {
    return {name, CheckState::failed, one_line(error.what())};
  }
}

Check skipped_check(const std::string& name, const std::string& requirement) {
  return {name, CheckState::not_checked, "needs the " + requirement};
}

}  // namespace

std::string name_of(CheckState state) {
  using enum CheckState;
  static constexpr auto kNames = std::to_array<Named<CheckState>>(
      {{"passed", passed}, {"failed", failed}, {"not-checked", not_checked}});
  return std::string(name_in(kNames, state));
}

bool Verification::holds() const noexcept {
  return std::none_of(checks.begin(), checks.end(),
                      [](const Check& check) { return check.state == CheckState::failed; });
}

bool Verification::complete() const noexcept {
  return std::none_of(checks.begin(), checks.end(),
                      [](const Check& check) { return check.state == CheckState::not_checked; });
}

Verification verify_study(const record::StudyStore& store, const study::StudyKey* key,
                          const engine::Pack* pack, const std::string& head) {
  Verification verification;
  try {
    verification.head = store.file_head();
    verification.simulated = store.commitment().simulated;
    verification.investigator = store.commitment().investigator;
    verification.notes = chain_notes(store);
  } catch (const StoreError&) {
    // The check of the chain reports the fault.
  }
  const auto with_key = [&](const char* name, std::string (*check)(const record::StudyStore&,
                                                                   const study::StudyKey&)) {
    verification.checks.push_back(key == nullptr
                                      ? skipped_check(name, "key")
                                      : run_check(name, [&] { return check(store, *key); }));
  };
  verification.checks.push_back(run_check("chain", [&] { return check_chain(store); }));
  with_key("key", check_key);
  if (verification.checks.back().state == CheckState::failed)
    key = nullptr;  // a wrong key opens nothing
  with_key("seal", check_seal);
  with_key("configuration", check_configuration);
  with_key("schedule", check_schedule);
  with_key("responses", check_responses);
  with_key("payloads", check_payloads);
  with_key("traces", check_traces);
  verification.checks.push_back(
      pack == nullptr ? skipped_check("pack", "pack")
                      : run_check("pack", [&] { return check_pack(store, key, *pack); }));
  if (!head.empty()) {
    verification.checks.push_back(run_check("head", [&] { return check_head(store, head); }));
  }
  return verification;
}

}  // namespace touchtrial::analysis
