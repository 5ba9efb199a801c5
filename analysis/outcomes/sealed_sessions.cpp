#include "analysis/outcomes/sealed_sessions.hpp"

#include "analysis/outcomes/outcomes.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "record/damage.hpp"
#include "record/opened_parts.hpp"
#include "record/payload_json.hpp"
#include "record/sealing.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

std::string event_name(const record::Event& event) {
  return fmt::format("{}, event {}", record::chain_name(event.session), event.sequence);
}

[[noreturn]] void throw_does_not_open(const record::Event& event) {
  throw VerificationError(event_name(event) +
                          ": the sealed part does not open: the event is damaged, or was rewritten "
                          "without the key; restore a backup of the database [does-not-open]");
}

/// Calls `visit` with an opened event and its secret text, if its session has a key.
template <typename Visit>
void read_secret(const record::Event& stored, const SessionKeys& keys, Visit visit) {
  const auto key = keys.find(stored.session);
  if (key == keys.end() || !key->second.participant) return;
  const auto [event, secret] = open_event(stored, *key->second.participant);
  try {
    visit(event, secret);
  } catch (const StoreError& error) {
    throw VerificationError(event_name(event) + ": " + error.what());
  }
}

template <typename Visit>
void for_each_secret(const StudyEvents& events, const SessionKeys& keys, record::EventKind kind,
                     Visit visit) {
  events.for_each_of(std::span(&kind, 1),
                     [&](const record::Event& stored) { read_secret(stored, keys, visit); });
}

/// The trials and measures from a session's events.
struct OpenedTrials {
  record::DerivedRows rows;
  Measures measures;
  std::exception_ptr fault;

  /// Stores an error instead of throwing it, so that the first session's error is reported,
  /// whichever thread finishes first.
  /// \param with_measures  also reads measures
  void open(std::vector<record::Event> events, const SecretKey& key, bool with_measures) noexcept {
    try {
      const record::EventOpener opener(key);
      for (record::Event& event : events) add(event, opener, with_measures);
    } catch (const StoreError& error) {
      fault = std::make_exception_ptr(VerificationError(error.what()));
    } catch (...) {
      fault = std::current_exception();
    }
  }

  /// Appends the trials to the trials of earlier sessions.
  void move_to(std::vector<record::TrialRow>& trials, Measures* all_measures) {
    if (fault) std::rethrow_exception(fault);
    for (const auto& [id, row] : rows.trials) trials.push_back(row);
    if (all_measures != nullptr) all_measures->merge(measures);
    rows = {};
  }

 private:
  void add(record::Event& event, const record::EventOpener& opener, bool with_measures) {
    const auto opened = opener(event);
    if (!opened) throw_does_not_open(event);
    event.at = opened->at;
    event.sealed.clear();
    if (event.kind != record::EventKind::trace_stored) {
      return record::fold(rows, event, opened->body);
    }
    const auto body = record::body_of(event, [&](const std::string&) {
      return record::from_parts<record::TraceBody>(opened->body);
    });
    record::fold(rows, event, body);
    if (!with_measures) return;
    measures.insert_or_assign({event.session, body.trial},
                              record::measures_from_json(opened->secret));
  }
};

std::optional<SecretKey> unwrapped_key(const std::optional<Bytes>& wrapped,
                                       const BoxKeys& investigator,
                                       const record::SessionRow& session) {
  if (session.erased) return std::nullopt;
  if (!wrapped) {
    throw VerificationError(
        fmt::format("session {}: the participant's key is missing although nobody withdrew; "
                    "restore a backup of the database",
                    session.session));
  }
  const auto key = record::unwrap_participant_key(investigator, session.own_session, *wrapped);
  if (!key) {
    throw VerificationError(
        fmt::format("session {}: the participant's key does not open with this study key; "
                    "restore a backup of the database",
                    session.session));
  }
  return key;
}

record::PersonKeys unwrapped_keys(const record::WrappedKeys& wrapped, const BoxKeys& investigator,
                                  const record::SessionRow& session) {
  record::PersonKeys keys{.participant = unwrapped_key(wrapped.participant, investigator, session),
                          .safety = {}};
  if (!wrapped.safety) return keys;
  keys.safety = record::unwrap_safety_key(investigator, session.own_session, *wrapped.safety);
  if (keys.safety) return keys;
  throw VerificationError(
      fmt::format("session {}: the safety key does not open with this study key; restore a backup "
                  "of the database",
                  session.session));
}

}  // namespace

void require_key_of(const record::StudyStore& store, const study::StudyKey& key) {
  const record::StudyCommitment& commitment = store.commitment();
  if (key.study_id != commitment.study_id) {
    throw VerificationError(fmt::format(
        "the key is of study {} ({}), but the database is of study {} ({}); give the key that was "
        "made with this database's pack",
        one_line(key.study.name), key.study_id, one_line(commitment.study), commitment.study_id));
  }
  if (key.seal != commitment.seal) {
    throw VerificationError(
        fmt::format("the key does not match the seal of study {} ({}): key or study changed after "
                    "the first session; give the key from that time",
                    one_line(commitment.study), to_hex(commitment.seal).substr(0, 16)));
  }
  if (key.investigator_signature != commitment.investigator) {
    throw VerificationError(
        "the database names another investigator than the key: it was not created with this "
        "study's files; give the key that belongs to it [other-investigator]");
  }
}

std::optional<SecretKey> participant_key(const record::StudyStore& store,
                                         const study::StudyKey& key,
                                         const record::SessionRow& session) {
  return unwrapped_key(store.wrapped_key(session.session), key.box(), session);
}

record::PersonKeys person_keys(const record::StudyStore& store, const study::StudyKey& key,
                               const record::SessionRow& session) {
  return unwrapped_keys(store.wrapped_keys(session.session), key.box(), session);
}

SessionKeys person_keys(const record::StudyStore& store, const study::StudyKey& key) {
  const BoxKeys investigator = key.box();
  SessionKeys all;
  for (const record::SessionRow& session : store.sessions()) {
    all.emplace(session.session,
                unwrapped_keys(store.wrapped_keys(session.session), investigator, session));
  }
  return all;
}

record::OpenedEvent open_event(const record::Event& event, const SecretKey& key) {
  std::optional<record::OpenedEvent> opened = record::opened_event(event, key);
  if (!opened) throw_does_not_open(event);
  return *std::move(opened);
}

record::Event readable_event(const record::Event& event, const record::SessionRow& row,
                             const record::PersonKeys& keys) {
  if (event.sealed.empty()) return event;
  if (!record::opening_key(event, keys)) return event;
  std::optional<record::Event> opened;
  if (event.session <= 0) {
    opened = record::opened_person_text(event, row.own_session, keys);
  } else if (keys.participant) {
    return open_event(event, *keys.participant).event;
  } else if (auto safety = record::opened_safety_event(event, *keys.safety)) {
    opened = std::move(safety->event);
  }
  if (!opened) throw_does_not_open(event);
  return *std::move(opened);
}

std::vector<record::TrialRow> open_trials(const record::StudyStore& store,
                                          const SessionKeys& keys) {
  std::vector<record::TrialRow> trials;
  for (const auto& [session, person] : keys) {
    if (!person.participant) continue;
    OpenedTrials opened;
    opened.open(store.events(session), *person.participant, /*with_measures=*/false);
    opened.move_to(trials, nullptr);
  }
  return trials;
}

/// One session; each is read by one thread.
struct OpenedSessions::Session {
  record::SessionRow row;
  record::WrappedKeys wrapped;
  record::PersonKeys keys;
  std::vector<record::Event> kept_events;  ///< see StudyEvents::is_kept
  OpenedTrials trials;
  std::exception_ptr fault;  ///< an error from opening the key

  void read(const BoxKeys& investigator, std::vector<record::Event> events) noexcept {
    try {
      keys = unwrapped_keys(wrapped, investigator, row);
      std::ranges::copy_if(events, std::back_inserter(kept_events), StudyEvents::is_kept);
      if (keys.participant)
        trials.open(std::move(events), *keys.participant, /*with_measures=*/true);
    } catch (...) {
      fault = std::current_exception();
    }
  }
};

OpenedSessions::OpenedSessions(const record::StudyStore& store, const study::StudyKey& key)
    : events_(store) {
  const BoxKeys investigator = key.box();
  for (record::SessionRow& row : store.sessions()) {
    Session& session = sessions_[row.session];
    session.wrapped = store.wrapped_keys(row.session);
    session.row = std::move(row);
  }
  const auto read = [&](int number, std::vector<record::Event> events) {
    const auto session = sessions_.find(number);
    if (session != sessions_.end()) session->second.read(investigator, std::move(events));
  };
  if (const auto fault = store.first_fault(record::TraceCheck::skip, read)) {
    throw VerificationError(shown(*fault) +
                            "; no outcomes are shown, see `touchtrial verify` and restore the "
                            "database from a backup");
  }
  EventsOfSessions kept_events;
  for (auto& [number, session] : sessions_) {
    if (session.fault) std::rethrow_exception(session.fault);
    keys_.emplace(number, session.keys);
    kept_events.emplace(number, std::move(session.kept_events));
  }
  events_ = StudyEvents(store, std::move(kept_events));
}

OpenedSessions::~OpenedSessions() = default;

std::vector<record::TrialRow> OpenedSessions::release_trials(Measures& measures) {
  std::vector<record::TrialRow> trials;
  for (auto& [number, session] : sessions_) session.trials.move_to(trials, &measures);
  return trials;
}

void require_sealed_ends(const StudyEvents& events, const SessionKeys& keys) {
  for_each_secret(
      events, keys, record::EventKind::closed,
      [&](const record::Event& event, const std::string& text) {
        const record::ChainEnd end{.length = event.sequence, .head = event.previous};
        if (record::from_json<record::ChainEnd>(text) == end) return;
        throw VerificationError(
            event_name(event) +
            ": the chain does not match its sealed end: it was rewritten without the key; "
            "restore a backup of the database");
      });
}

record::Trace open_trace(const std::optional<record::SealedTrace>& sealed,
                         const record::TrialRow& trial, const SessionKeys& keys) {
  const std::optional<SecretKey>& key = keys.at(trial.session).participant;
  if (sealed && key) {
    if (auto trace = record::unsealed_trace(*sealed, *key)) return *std::move(trace);
  }
  throw VerificationError(fmt::format(
      "session {}, trial {}: its trace is missing or does not open; run `touchtrial verify` and "
      "restore the database from a backup",
      trial.session, trial.trial));
}

std::map<int, study::Schedule> open_schedules(const StudyEvents& events, const study::StudyKey& key,
                                              const SessionKeys& keys) {
  std::vector<record::Event> openings;
  events.for_each_of(std::to_array({record::EventKind::opened}),
                     [&](const record::Event& event) { openings.push_back(event); });
  std::vector<std::optional<study::Schedule>> opened_schedules(openings.size());
  run_all_in_parallel(openings.size(), [&](std::size_t i) {
    read_secret(openings[i], keys, [&](const record::Event&, const std::string& text) {
      opened_schedules[i] = study::schedule_from_json(text, key);
    });
  });
  std::map<int, study::Schedule> schedules;
  for (std::size_t i = 0; i < openings.size(); ++i) {
    if (opened_schedules[i])
      schedules.insert_or_assign(openings[i].session, *std::move(opened_schedules[i]));
  }
  const auto add_block = [&](const record::Event& event, const std::string& text) {
    std::vector<study::Trial>& trials = schedules[event.session].trials;
    const std::vector<study::Trial> block = block_from_json(text, key);
    trials.insert(trials.end(), block.begin(), block.end());
  };
  for_each_secret(events, keys, record::EventKind::block_restarted, add_block);
  return schedules;
}

}  // namespace touchtrial::analysis
