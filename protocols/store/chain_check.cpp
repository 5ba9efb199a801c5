#include "protocols/store/chain_check.hpp"

#include "protocols/store/chain_link.hpp"
#include "protocols/store/derived_rows.hpp"
#include "protocols/store/event_fault.hpp"
#include "protocols/store/event_rows.hpp"
#include "protocols/store/file_chain.hpp"
#include "protocols/store/schema_check.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <string>

namespace touchtrial {
namespace {

/// What a trace-stored event says of its trace.
struct TraceClaim {
  std::int64_t sequence = 0;
  Digest digest{};
};

[[noreturn]] void fault(std::int64_t session, std::int64_t sequence, const std::string& what) {
  throw EventFault(session, sequence, what);
}

std::string trace_of(const TrialId& id) {
  return "trace of trial " + std::to_string(id.second);
}

/// Walks through everything once; the first thing that does not hold is thrown.
class Inspection {
 public:
  explicit Inspection(const Database& database) : database_(database) {}

  void run(TraceCheck traces) {
    if (traces == TraceCheck::full) inspect_structure();
    walk(0, [&](const Event& event) { file_.add(event); });
    if (!file_.commitment()) fault(0, kNoEvent, "the file's chain is empty");
    inspect_sessions();
    // Exclusions and withdrawals change rows of sessions, which exist only now.
    for_each_event(database_, 0, [&](const Event& event) { fold(expected_, event); });
    inspect_keys();
    if (traces == TraceCheck::full) inspect_traces();
    inspect_session_rows();
    inspect_trial_rows();
    inspect_schema();
  }

 private:
  void inspect_structure() const;
  template <typename Visit>
  ChainLink walk(int session, Visit visit) const;
  void inspect_sessions();
  void inspect_session(int session, const SessionOnFile& on_file);
  void inspect_opening(const Event& event, const SessionOnFile& on_file) const;
  void inspect_end(int session, const ChainLink& chain, const SessionOnFile& on_file) const;
  void note_trace(const Event& event);
  void inspect_keys() const;
  void inspect_traces();
  void inspect_session_rows() const;
  void inspect_trial_rows() const;
  void inspect_responses() const;
  void inspect_schema() const;

  const Database& database_;
  FileChain file_;
  DerivedRows expected_;
  std::map<TrialId, TraceClaim> claims_;
};

void Inspection::inspect_structure() const {
  // Not quick_check, which takes indices on trust.
  Query query = database_.query("PRAGMA integrity_check(1)");
  if (!query.step()) return;
  const std::string finding = query.text(0);
  if (finding != "ok") fault(0, kNoEvent, "the file is damaged: " + finding);
}

/// Every event of a chain held to the one before it.
template <typename Visit>
ChainLink Inspection::walk(int session, Visit visit) const {
  ChainLink chain(session);
  for_each_event(database_, session, [&](const Event& event) {
    if (const auto broken = chain.broken_by(event)) {
      fault(session, std::min(event.sequence, chain.length()), *broken);
    }
    chain.extend(event);
    visit(event);
  });
  return chain;
}

void Inspection::inspect_sessions() {
  for (const auto& [session, on_file] : file_.sessions()) inspect_session(session, on_file);
  for (const std::int64_t session : sessions_with_events(database_)) {
    const bool known = session > 0 && session <= std::numeric_limits<int>::max() &&
                       file_.sessions().count(static_cast<int>(session)) > 0;
    if (!known) fault(session, kNoEvent, "the file's chain knows no such session");
  }
}

void Inspection::inspect_session(int session, const SessionOnFile& on_file) {
  const ChainLink chain = walk(session, [&](const Event& event) {
    if (event.sequence == 0) inspect_opening(event, on_file);
    fold(expected_, event);
    if (event.kind == EventKind::trace_stored) note_trace(event);
  });
  inspect_end(session, chain, on_file);
}

void Inspection::inspect_opening(const Event& event, const SessionOnFile& on_file) const {
  if (event.hash != on_file.opened.first) {
    fault(event.session, 0, "the session's first event is not the one on the file's chain");
  }
  const SessionOpening opening = body_of(event, opening_from_json);
  const StudyCommitment& commitment = *file_.commitment();
  if (opening.study_id != commitment.study_id || opening.seal != commitment.seal) {
    fault(event.session, 0, "the session belongs to another study");
  }
  if (opening.participant != on_file.opened.participant ||
      opening.enrolment != on_file.opened.enrolment) {
    fault(event.session, 0, "participant or enrolment differs from the file's chain");
  }
}

void Inspection::inspect_end(int session, const ChainLink& chain,
                             const SessionOnFile& on_file) const {
  const std::int64_t last = chain.length() - 1;
  if (last < 0) {
    fault(0, on_file.opened_at, "session " + std::to_string(session) + " has no events");
  }
  const SessionState state = expected_.sessions.at(session).state;
  if (!on_file.closed) {
    if (state == SessionState::open) return;
    fault(session, last, "the session is closed, but not on the file's chain");
  }
  const SessionClosedBody& closed = *on_file.closed;
  if (closed.length != chain.length()) {
    fault(session, last,
          "session " + std::to_string(session) + " ends at event " + std::to_string(last) +
              ", the file's chain says " + std::to_string(closed.length - 1));
  }
  if (closed.head != chain.head()) {
    fault(session, last, "the session's last event is not the one on the file's chain");
  }
  if (state != (closed.complete ? SessionState::completed : SessionState::stopped)) {
    fault(session, last, "the session's end differs from the file's chain");
  }
}

void Inspection::note_trace(const Event& event) {
  const TraceBody body = body_of(event, trace_body_from_json);
  const TrialId id(event.session, body.trial);
  const TraceClaim claim{.sequence = event.sequence, .digest = body.trace};
  if (!claims_.emplace(id, claim).second) {
    fault(event.session, event.sequence, trace_of(id) + " is stored twice");
  }
}

void Inspection::inspect_keys() const {
  std::map<std::int64_t, Digest> stored;
  Query query = database_.query("SELECT session, wrapped FROM participant_keys");
  while (query.step()) stored[query.integer(0)] = sha256(query.blob(1));
  for (const auto& [session, on_file] : file_.sessions()) {
    const auto key = stored.extract(session);
    if (key.empty() && !on_file.withdrawn) {
      fault(session, kNoEvent, "the participant's key is missing without a withdrawal");
    }
    if (key.empty()) continue;
    if (on_file.withdrawn)
      fault(session, kNoEvent, "the participant withdrew, but the key is still there");
    if (key.mapped() != on_file.opened.key)
      fault(session, kNoEvent, "the participant's key was altered");
  }
  if (!stored.empty()) fault(stored.begin()->first, kNoEvent, "a participant's key has no session");
}

void Inspection::inspect_traces() {
  Query query = database_.query("SELECT session, trial, box FROM traces ORDER BY session, trial");
  auto claim = claims_.begin();
  using Wide = std::pair<std::int64_t, std::int64_t>;
  const auto missing = [&] {
    fault(claim->first.first, claim->second.sequence, trace_of(claim->first) + " is missing");
  };
  while (query.step()) {
    const Wide id(query.integer(0), query.integer(1));
    if (claim != claims_.end() && Wide(claim->first) < id) missing();
    if (claim == claims_.end() || Wide(claim->first) != id) {
      fault(id.first, kNoEvent, "trace of trial " + std::to_string(id.second) + " has no event");
    }
    if (sha256(query.blob(2)) != claim->second.digest) {
      fault(id.first, claim->second.sequence, trace_of(claim->first) + " was altered");
    }
    ++claim;
  }
  if (claim != claims_.end()) missing();
}

/// The first id at which two sorted lists of rows differ.
template <typename Id, typename Row, typename IdOf>
std::optional<Id> first_difference(const std::map<Id, Row>& expected, const std::vector<Row>& found,
                                   IdOf id_of) {
  auto row = found.begin();
  for (const auto& [id, expected_row] : expected) {
    if (row == found.end() || id < id_of(*row)) return id;
    if (!(*row == expected_row)) return id_of(*row);
    ++row;
  }
  if (row != found.end()) return id_of(*row);
  return std::nullopt;
}

void Inspection::inspect_session_rows() const {
  const auto differs = first_difference(expected_.sessions, read_sessions(database_),
                                        [](const SessionRow& row) { return row.session; });
  if (differs) fault(*differs, kNoEvent, "derived table sessions disagrees with the events");
}

bool same_response(const TrialRow& a, const TrialRow& b) {
  return a.answered_at == b.answered_at && a.position == b.position &&
         a.first_position == b.first_position && a.confidence == b.confidence;
}

void Inspection::inspect_trial_rows() const {
  const std::vector<TrialRow> found = read_trials(database_);
  const auto id_of = [](const TrialRow& row) { return TrialId(row.session, row.trial); };
  const auto differs = first_difference(expected_.trials, found, id_of);
  if (!differs) return inspect_responses();
  const auto expected = expected_.trials.find(*differs);
  const auto row = std::find_if(found.begin(), found.end(),
                                [&](const TrialRow& r) { return id_of(r) == *differs; });
  const bool in_both = expected != expected_.trials.end() && row != found.end();
  const bool response = in_both && !same_response(expected->second, *row);
  fault(differs->first, kNoEvent,
        std::string("derived table ") + (response ? "responses" : "trials") +
            " disagrees with the events at trial " + std::to_string(differs->second));
}

/// Responses to trials that the table of trials does not have.
void Inspection::inspect_responses() const {
  Query query = database_.query(
      "SELECT r.session, r.trial FROM responses r LEFT JOIN trials t USING(session, trial) "
      "WHERE t.trial IS NULL LIMIT 1");
  if (!query.step()) return;
  fault(query.integer(0), kNoEvent,
        "derived table responses disagrees with the events at trial " +
            std::to_string(query.integer(1)));
}

/// Last, so that a fault of what is stored is named before that of a trigger that let it happen.
void Inspection::inspect_schema() const {
  if (const auto differs = schema_fault(database_)) fault(0, kNoEvent, *differs);
}

}  // namespace

std::optional<ChainFault> find_first_fault(const Database& database, TraceCheck traces) {
  try {
    Inspection(database).run(traces);
    return std::nullopt;
  } catch (const EventFault& found) {
    const bool is_int = found.session() >= 0 && found.session() <= std::numeric_limits<int>::max();
    return ChainFault{.session = is_int ? static_cast<int>(found.session()) : 0,
                      .sequence = std::max(found.sequence(), std::int64_t{0}),
                      .what = found.bare()};
  }
}

}  // namespace touchtrial
