#include "record/collected_chain.hpp"
#include "record/file_chain.hpp"
#include "record/rows.hpp"
#include "record/schema.hpp"
#include "record/stored_study.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <tbb/parallel_pipeline.h>

namespace touchtrial::record {
namespace {

std::string trace_of(const TrialId& id) {
  return "trace of trial " + std::to_string(id.second);
}

/// Checks the signatures of one file chain. A partial check covers only unblindings and the
/// last event, which vouches for the earlier ones.
class SignatureCheck {
 public:
  explicit SignatureCheck(TraceCheck checks) : checks_every_(checks == TraceCheck::full) {}

  void add(const Event& event, bool is_signed) {
    if (!signatories_) signatories_.emplace(event);
    if (!is_signed && !event.signature.empty()) {
      throw EventFault(event, "follows from the stations' chains, but has a signature");
    }
    last_signed_ = is_signed ? std::optional(event) : std::nullopt;
    if (last_signed_ && (checks_every_ || event.kind == EventKind::study_unblinded))
      signatories_->require(event);
  }
  void finish() const {
    if (last_signed_) signatories_->require(*last_signed_);
  }

 private:
  bool checks_every_;
  std::optional<Signatories> signatories_;
  std::optional<Event> last_signed_;
};

/// The maximum number of sessions in memory at once, regardless of the number of threads.
constexpr std::size_t kParallelSessions = 16;

/// One session in the pipeline of the check: its result or its fault.
struct SessionInFlight {
  int session = 0;
  const SessionOnFile* on_file = nullptr;
  std::vector<Event> events;
  std::exception_ptr read_fault;  ///< why the event after `events` cannot be read
  std::map<int, TraceClaim> claims;
  std::exception_ptr fault;

  void check(const StudyCommitment& commitment, const SessionReader& reader) noexcept {
    try {
      SessionCheck check(session, *on_file, commitment);
      DerivedRows rows;
      for (const Event& event : events) check.add(event, rows);
      if (read_fault) std::rethrow_exception(read_fault);
      check.finish(rows);
      claims = check.claims();
      if (reader) reader(session, std::move(events));
    } catch (...) {
      fault = std::current_exception();
    }
    events = {};
  }
};

/// Checks everything once, and throws EventFault at the first fault.
class Inspection {
 public:
  Inspection(const Database& database, const SessionReader& reader)
      : database_(database), reader_(reader) {}

  void run(TraceCheck traces) {
    if (traces == TraceCheck::full) inspect_structure();
    const std::vector<Event> collected = inspect_stations(traces);
    if (is_collected_) file_ = FileChain(UniquePlaces::at_end);
    SignatureCheck signatures(traces);
    walk(0, [&](const Event& event) {
      if (!collected.empty()) inspect_collected(event, collected);
      file_.add(event);
      signatures.add(event, /*is_signed=*/event.sequence >= std::ssize(collected));
    });
    signatures.finish();
    if (!file_.commitment())
      throw EventFault(0, kNoEvent, "the file's chain is empty [empty-chain]");
    inspect_length(collected);
    inspect_sessions();
    inspect_keys();
    if (traces == TraceCheck::full) inspect_traces();
    inspect_schema();
  }

 private:
  void inspect_structure() const {
    // This is not quick_check, which does not check indices.
    Query query = database_.query("PRAGMA integrity_check(1)");
    if (!query.step()) return;
    const std::string finding = query.text(0);
    if (finding != "ok") throw EventFault(0, kNoEvent, "the file is damaged: " + finding);
  }

  /// Checks every event of a chain against the previous one.
  void walk(int session, const EventVisitor& visit) const {
    ChainLink chain(session);
    for_each_event(database_, session, [&](const Event& event) {
      chain.extend(event);
      visit(event);
    });
  }

  /// \return the chain collected from the stations' chains; empty if there are no stations
  [[nodiscard]] std::vector<Event> inspect_stations(TraceCheck traces) {
    std::vector<StationChain> stations;
    std::int64_t lowest = 0;
    for (const std::int64_t session : sessions_with_events(database_)) {
      lowest = std::clamp(session, -std::int64_t{std::numeric_limits<int>::max()}, lowest);
    }
    for (int station = 1; station <= -lowest; ++station) {
      stations.push_back(inspect_station(station, traces));
      if (station > 1 && !comes_before(stations[stations.size() - 2], stations.back())) {
        throw EventFault(-station, kNoEvent,
                         "is not in the order of stations: it belongs before the previous station");
      }
    }
    if (stations.empty()) return {};
    try {
      is_collected_ = true;
      return collected_chain(stations).events;
    } catch (const EventFault&) {
      throw;
    } catch (const StoreError& error) {
      throw EventFault(0, kNoEvent, error.what());
    }
  }

  [[nodiscard]] StationChain inspect_station(int station, TraceCheck traces) const {
    StationChain chain{.name = "station " + std::to_string(station), .events = {}};
    FileChain file;
    SignatureCheck signatures(traces);
    walk(-station, [&](const Event& event) {
      file.add(event);
      signatures.add(event, /*is_signed=*/true);
      chain.events.push_back(event);
    });
    signatures.finish();
    if (!station_identity(chain.events)) throw EventFault(-station, kNoEvent, "opens no session");
    return chain;
  }

  /// A collected study's chain begins with the chain collected from its stations; later decisions
  /// follow.
  void inspect_collected(const Event& event, const std::vector<Event>& collected) const {
    if (event.sequence < static_cast<std::int64_t>(collected.size())) {
      if (event.hash == collected[static_cast<std::size_t>(event.sequence)].hash) return;
      throw EventFault(0, event.sequence, "differs from the chain collected from the stations");
    }
    if (event.kind == EventKind::session_opened || event.kind == EventKind::session_closed ||
        event.kind == EventKind::participant_replaced) {
      throw EventFault(0, event.sequence,
                       "was added after collecting; a collected study has no sessions of its own");
    }
  }

  void inspect_length(const std::vector<Event>& collected) const {
    if (collected.empty()) return;
    if (!read_event(database_, 0, static_cast<std::int64_t>(collected.size()) - 1)) {
      throw EventFault(0, kNoEvent, "lacks events of the chain collected from the stations");
    }
  }

  /// One thread reads sessions, others check them, and results are added in order: the first fault
  /// by session is reported, whichever thread finds one first. No exception leaves a filter,
  /// because oneTBB would leak the sessions in flight.
  void inspect_sessions() {
    using InFlight = std::shared_ptr<SessionInFlight>;
    auto next = file_.sessions().begin();
    std::exception_ptr fault;
    std::atomic<bool> has_fault = false;
    const auto read = [&](tbb::flow_control& control) -> InFlight {
      if (has_fault || next == file_.sessions().end()) {
        control.stop();
        return nullptr;
      }
      return read_session(*next++);
    };
    const auto check = [&](const InFlight& session) {
      if (!session->fault) session->check(*file_.commitment(), reader_);
      return session;
    };
    const auto add = [&](const InFlight& session) {
      if (fault) return;
      fault = session->fault;
      has_fault = fault != nullptr;
      if (!fault) add_session(*session);
    };
    const auto in_order = tbb::filter_mode::serial_in_order;
    tbb::parallel_pipeline(kParallelSessions, tbb::make_filter<void, InFlight>(in_order, read) &
                                                  tbb::make_filter<InFlight, InFlight>(
                                                      tbb::filter_mode::parallel, check) &
                                                  tbb::make_filter<InFlight, void>(in_order, add));
    if (fault) std::rethrow_exception(fault);
    for (const std::int64_t session : sessions_with_events(database_)) {
      if (session < 0) continue;
      const bool has_session = session <= std::numeric_limits<int>::max() &&
                               file_.sessions().count(static_cast<int>(session)) > 0;
      if (!has_session)
        throw EventFault(session, kNoEvent, "the file's chain has no such session [stray-session]");
    }
  }

  [[nodiscard]] std::shared_ptr<SessionInFlight> read_session(
      const std::pair<const int, SessionOnFile>& entry) const {
    auto session = std::make_shared<SessionInFlight>();
    session->session = entry.first;
    session->on_file = &entry.second;
    if (entry.second.opened.station > 0 && !is_collected_) {
      session->fault = std::make_exception_ptr(
          EventFault(0, entry.second.opened_at, "the chain of the session's station is missing"));
    } else {
      session->events = read_events(database_, session->session, session->read_fault);
    }
    return session;
  }

  void add_session(const SessionInFlight& session) {
    for (const auto& [trial, claim] : session.claims) {
      claims_.emplace(TrialId(session.session, trial), claim);
    }
  }

  void inspect_keys() const {
    for (const auto& [session, on_file] : file_.sessions()) {
      SessionCheck(session, on_file, *file_.commitment()).check_keys(read_keys(database_, session));
    }
    Query query = database_.query(
        "SELECT session FROM participant_keys UNION SELECT session FROM safety_keys ORDER BY 1");
    while (query.step()) {
      const std::int64_t session = query.integer(0);
      const bool has_session = session > 0 && session <= std::numeric_limits<int>::max() &&
                               file_.sessions().contains(static_cast<int>(session));
      if (!has_session)
        throw EventFault(session, kNoEvent, "a participant's key has no session [stray-key]");
    }
    inspect_station_keys();
  }

  /// A station has key copies of exactly those open sessions that began with a copy.
  void inspect_station_keys() const {
    std::map<std::int64_t, Digest> copies;
    Query query = database_.query("SELECT session, kept FROM station_keys");
    while (query.step()) copies.emplace(query.integer(0), sha256(query.blob(1)));
    for (const auto& [session, on_file] : file_.sessions()) {
      if (!on_file.opened.kept || on_file.closed || on_file.withdrawn_at) continue;
      const auto copy = copies.extract(session);
      if (copy && copy.mapped() == *on_file.opened.kept) continue;
      throw EventFault(
          session, kNoEvent,
          std::string("the station's copy of the key ") + (copy ? "was altered" : "is missing") +
              "; the session cannot be resumed " + (copy ? "[altered-copy]" : "[missing-copy]"));
    }
    if (copies.empty()) return;
    throw EventFault(copies.begin()->first, kNoEvent,
                     "the station holds the key of a session that is not open [stray-copy]");
  }

  void inspect_traces() {
    Query query = database_.query("SELECT session, trial, box FROM traces ORDER BY session, trial");
    auto claim = claims_.begin();
    using RowId = std::pair<std::int64_t, std::int64_t>;
    const auto refuse_missing = [&] {
      throw EventFault(claim->first.first, claim->second.sequence,
                       trace_of(claim->first) + " is missing [missing-trace]");
    };
    while (query.step()) {
      const RowId id(query.integer(0), query.integer(1));
      if (claim != claims_.end() && RowId(claim->first) < id) refuse_missing();
      if (claim == claims_.end() || RowId(claim->first) != id) {
        throw EventFault(
            id.first, kNoEvent,
            "trace of trial " + std::to_string(id.second) + " has no event [stray-trace]");
      }
      if (blake2b(query.blob(2)) != claim->second.digest) {
        throw EventFault(id.first, claim->second.sequence,
                         trace_of(claim->first) + " was altered [altered-trace]");
      }
      ++claim;
    }
    if (claim != claims_.end()) refuse_missing();
  }

  /// Runs last: a fault of stored data is reported before the missing trigger that allowed it.
  void inspect_schema() const {
    const auto fault = schema_fault(database_);
    if (!fault) return;
    throw EventFault(0, kNoEvent,
                     fault->what + (fault->remedy.empty() ? "" : "; remove it: " + fault->remedy));
  }

  const Database& database_;
  const SessionReader& reader_;
  FileChain file_;
  bool is_collected_ = false;
  std::map<TrialId, TraceClaim> claims_;
};

}  // namespace

std::optional<ChainFault> find_first_fault(const Database& database, TraceCheck traces,
                                           const SessionReader& reader) {
  try {
    Inspection(database, reader).run(traces);
    return std::nullopt;
  } catch (const EventFault& found) {
    const bool is_int = found.session() >= std::numeric_limits<int>::min() &&
                        found.session() <= std::numeric_limits<int>::max();
    return ChainFault{.session = is_int ? static_cast<int>(found.session()) : 0,
                      .sequence = std::max(found.sequence(), std::int64_t{0}),
                      .what = found.description()};
  }
}

}  // namespace touchtrial::record
