#include "protocols/collect/station_push.hpp"

#include "protocols/collect/server_rows.hpp"
#include "protocols/collect/server_schema.hpp"
#include "protocols/collect/server_study.hpp"
#include "protocols/collect/server_tables.hpp"
#include "protocols/store/damage.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <span>
#include <thread>
#include <utility>

namespace touchtrial::collect {
namespace {

using std::chrono::milliseconds;

/// After so many failures with nothing pushed between them, about half a minute, pushing gives up.
constexpr int kMostFailures = 10;
constexpr milliseconds kFirstWait{100};
constexpr milliseconds kLongestWait{5000};

/// Another program pushed the same station meanwhile: the server must be looked at again.
class Overtaken : public Contention {
 public:
  using Contention::Contention;
};

store::DerivedRows folded(std::span<const store::Event> events) {
  store::DerivedRows rows;
  for (const store::Event& event : events) store::fold(rows, event);
  return rows;
}

class StationPush {
 public:
  StationPush(StationFile& station, const ServerAddress& server, const PushOptions& options,
              PushReport& report)
      : station_(station), address_(server), options_(options), report_(report) {
    chain_ = station.file_chain();
    if (chain_.empty()) throw StoreError(station.name() + ": its file chain is empty");
    const store::FileChain file = store::checked_file_chain(chain_);
    courses_ = file.sessions();
    commitment_ = *file.commitment();
    for (const auto& [session, course] : courses_) {
      if (course.closed) continue;
      (course.is_cut_short() ? report_.cut_short : report_.left_open).push_back(named(session));
    }
  }

  void run() {
    if (options_.dry_run) return look_only();
    int failures = 0;
    while (true) {
      const int before = done_;
      try {
        return attempt();
      } catch (const LostConnection& error) {
        server_.reset();
        // An address that never answered is more likely wrong than late.
        if (!was_connected_) throw;
        if (done_ > before) failures = 0;
        if (++failures > kMostFailures) give_up(error);
        ++report_.reconnections;
      } catch (const Contention& error) {
        sent_.reset();  // it was certainly not committed
        if (done_ > before) failures = 0;
        if (++failures > kMostFailures) give_up(error);
      }
      wait_after(failures);
    }
  }

  /// How many sessions the server lacked at first.
  [[nodiscard]] int to_push() const noexcept { return to_push_; }

 private:
  [[nodiscard]] PushedSession named(int session) const {
    const store::SessionOpenedBody& opened = courses_.at(session).opened;
    return {session, opened.participant, opened.enrolment};
  }
  /// The hash of the second event: no two stations have the same one, as it holds the hashes of the
  /// first session's key and first event.
  [[nodiscard]] const Digest& identity() const { return chain_[1].hash; }
  [[nodiscard]] std::span<const store::Event> chain_to(std::int64_t end) const {
    return std::span(chain_).first(static_cast<std::size_t>(end));
  }

  void attempt() {
    if (!server_) server_ = std::make_unique<ServerConnection>(address_);
    was_connected_ = true;
    bring_forward(*server_);
    const std::int64_t stored = stored_length();
    note_plan(stored);
    // Only the server knows how a commit ended whose answer was lost.
    if (const auto sent = std::exchange(sent_, std::nullopt); sent && sent->end <= stored) {
      note_pushed(*sent);
    }
    push(segments(stored));
    // Others may have pushed some of them meanwhile.
    report_.already_there = finished_ - static_cast<int>(report_.pushed.size());
    restore_keys();
    if (report_.keys_destroyed > 0) report_.keys_wiped = server_->wipe_deleted_keys();
  }

  void look_only() {
    server_ = std::make_unique<ServerConnection>(address_);
    const bool has_tables = server_version(*server_).has_value();
    if (has_tables) require_current(*server_);
    const std::int64_t stored = has_tables ? stored_length() : 0;
    note_plan(stored);
    for (const ChainSegment& segment : segments(stored)) {
      for (const int session : segment.sessions) report_.pushed.push_back(named(session));
      report_.chain_events += segment.end - segment.first;
      if (!has_tables) continue;
      server_->look([&](ServerWork& work) {
        for (const int session : segment.sessions) {
          const store::DerivedRows rows = folded(station_.events(session));
          refuse_if_there_or_taken(work, *server_,
                                   row_on_server(rows, report_.station, session, segment.end));
        }
      });
    }
  }

  void wait_after(int failures) const {
    const milliseconds time = std::min(kFirstWait * (1 << (failures - 1)), kLongestWait);
    if (options_.wait) return options_.wait(time);
    std::this_thread::sleep_for(time);
  }

  [[noreturn]] void give_up(const StoreError& error) const {
    throw StoreError(std::string(error.what()) + "; gave up after " +
                     std::to_string(kMostFailures) +
                     " attempts; run the same command again to go on from there");
  }

  /// How much of the file chain the server has.
  /// \throws StoreError if it has another one
  [[nodiscard]] std::int64_t stored_length() {
    return server_->look([&](ServerWork& work) -> std::int64_t {
      refuse_other_study(work, *server_, chain_.front());
      if (chain_.size() < 2) return 0;
      const std::optional<int> station = find_station(work, identity());
      if (!station) return 0;
      report_.station = *station;
      return length_there(work, *station);
    });
  }

  [[nodiscard]] std::int64_t length_there(ServerWork& work, int station) const {
    const store::ChainHead head = chain_head(work, station);
    const auto here = static_cast<std::int64_t>(chain_.size());
    if (const auto parted = parting(work, station, chain_)) {
      server_->refuse(
          "has another event " + std::to_string(*parted) + " of the chain of " + station_.name() +
          " (station " + std::to_string(station) +
          "): two copies of this file went on by themselves; find out which is to count, "
          "and sync that one");
    }
    report_.ahead = std::max<std::int64_t>(head.length - here, 0);
    return std::min(head.length, here);
  }

  /// Counts the sessions to push, at the first attempt.
  void note_plan(std::int64_t stored) {
    if (std::exchange(planned_, true)) return;
    for (const auto& [session, course] : courses_) {
      if (!course.closed_at) continue;
      ++finished_;
      ++(*course.closed_at < stored ? report_.already_there : to_push_);
    }
  }

  [[nodiscard]] std::vector<ChainSegment> segments(std::int64_t stored) {
    // A file without sessions has no identity, and nothing to collect.
    if (chain_.size() < 2) return {};
    return segments_of(
        courses_, static_cast<std::int64_t>(chain_.size()), stored,
        [&](int session) { return station_.wrapped_keys(session).participant.has_value(); });
  }

  struct SentSession {
    store::SessionRow row;  ///< with the number on the server
    store::SessionOnFile course;
    std::map<std::int64_t, SentTrace> traces;
  };

  /// What is read and packed at once: a session, and with a segment's last one, or alone in a
  /// segment without sessions, the segment's part of the file chain.
  struct Parcel {
    const ChainSegment& segment;
    std::optional<int> session;
    bool is_last;
  };
  struct PackedParcel {
    std::optional<SentSession> session;
    std::vector<InsertStatement> statements;
  };

  static std::vector<Parcel> parcels_of(const std::vector<ChainSegment>& segments) {
    std::vector<Parcel> parcels;
    for (const ChainSegment& segment : segments) {
      for (const int session : segment.sessions) {
        parcels.push_back({segment, session, session == segment.sessions.back()});
      }
      if (segment.sessions.empty()) parcels.push_back({segment, std::nullopt, true});
    }
    return parcels;
  }

  /// While the server works on a parcel, another thread reads and packs the next one: no more than
  /// two are in memory, however many sessions a segment closes.
  void push(const std::vector<ChainSegment>& segments) {
    const std::vector<Parcel> parcels = parcels_of(segments);
    auto parcel = parcels.begin();
    std::future<PackedParcel> ahead;  // waits for its thread before it goes
    const auto next_parcel = [&](int station) {
      PackedParcel ready = ahead.valid() ? ahead.get() : packed(*parcel, station);
      if (++parcel != parcels.end()) {
        ahead = std::async(std::launch::async,
                           [this, &next = *parcel, station] { return packed(next, station); });
      }
      return ready;
    };
    for (const ChainSegment& segment : segments) {
      sent_ = segment;
      push(segment, next_parcel);
      note_pushed(segment);
      sent_.reset();
    }
  }

  /// \param next_parcel  called with the station's number on the server once for each of the
  ///   segment's parcels
  template <typename NextParcel>
  void push(const ChainSegment& segment, const NextParcel& next_parcel) {
    report_.keys_destroyed += server_->change([&](ServerWork& work) {
      int keys_destroyed = 0;
      lock_station(work, identity());
      const int station = station_number(work);
      if (chain_head(work, station).length != segment.first) {
        throw Overtaken(address_.shown() + ": another program pushes this station");
      }
      for (const auto& [session, course] : courses_) {
        const bool is_there = course.closed_at && *course.closed_at < segment.first;
        if (is_there && is_decided_between(course, segment.first, segment.end)) {
          const store::SessionOnFile now = course_until(course, segment.end);
          keys_destroyed += update_session(work, station, session, now) ? 1 : 0;
        }
      }
      std::vector<SentSession> sent;
      for (std::size_t i = 0; i < std::max<std::size_t>(segment.sessions.size(), 1); ++i) {
        PackedParcel parcel = next_parcel(station);
        if (parcel.session) {
          refuse_if_there_or_taken(work, *server_, parcel.session->row);
          sent.push_back(*std::move(parcel.session));
        }
        for (const InsertStatement& statement : parcel.statements) statement.send(work);
      }
      for (const SentSession& one : sent) {
        check_session_arrival(work, *server_, one.row.session, one.row.own_session, one.course,
                              commitment_, one.traces, options_.investigator);
      }
      check_chain_arrival(work, *server_, station, chain_to(segment.end), segment.first);
      report_.station = station;
      return keys_destroyed;
    });
  }

  /// Reads what belongs into a parcel from the station's file. Asks no server.
  [[nodiscard]] PackedParcel packed(const Parcel& parcel, int station) const {
    PackedParcel ready;
    Insertions insertions;
    const ChainSegment& segment = parcel.segment;
    if (parcel.session) {
      ready.session = packed_session(insertions, station, *parcel.session, segment.end);
    }
    if (parcel.is_last) {
      insert_events(insertions, chain_number(station),
                    chain_to(segment.end).subspan(static_cast<std::size_t>(segment.first)));
    }
    ready.statements = insertions.take();
    return ready;
  }

  [[nodiscard]] SentSession packed_session(Insertions& insertions, int station, int session,
                                           std::int64_t end) const {
    const std::vector<store::Event> events = station_.events(session);
    const store::DerivedRows rows = folded(events);
    store::SessionRow row = row_on_server(rows, station, session, end);
    row.session = server_session(*server_, station, session);
    insert_session(insertions, row);
    insert_events(insertions, row.session, events);
    const store::SessionOnFile course = course_until(courses_.at(session), end);
    store::WrappedKeys keys = station_.wrapped_keys(session);
    if (course.erased_at) keys.participant.reset();
    if (course.safety_erased_at) keys.safety.reset();
    insert_keys(insertions, row.session, keys);
    insert_trials(insertions, row.session, rows);
    return {row, course, insert_traces(insertions, row.session, station_, session)};
  }

  // The owner's role can delete any key. The session's own station brings it back.
  void restore_keys() {
    // An older copy of the file does not know who has withdrawn since.
    if (report_.station == 0 || report_.ahead > 0) return;
    const int restored = server_->change([&](ServerWork& work) {
      int count = 0;
      lock_station(work, identity());
      for (const auto& [session, own_session] : sessions_of_station(work, report_.station)) {
        const auto course = courses_.find(own_session);
        if (course == courses_.end()) continue;
        // What the file no longer has was erased.
        store::WrappedKeys lost = station_.wrapped_keys(own_session);
        const store::WrappedKeys there = read_keys(work, session);
        if (lost.participant == there.participant) lost.participant.reset();
        if (lost.safety == there.safety) lost.safety.reset();
        if (lost.participant) destroy_key(work, session, /*of_safety=*/false);
        if (lost.safety) destroy_key(work, session, /*of_safety=*/true);
        Insertions insertions;
        insert_keys(insertions, session, lost);
        for (const InsertStatement& statement : insertions.take()) statement.send(work);
        count += lost.participant || lost.safety ? 1 : 0;
      }
      return count;
    });
    report_.keys_restored += restored;
  }

  [[nodiscard]] int station_number(ServerWork& work) {
    if (const std::optional<int> known = find_station(work, identity())) return *known;
    return register_station(work, *server_, identity(),
                            one_line(std::filesystem::path(station_.name()).filename().string()),
                            chain_.front());
  }

  /// The session's row as the chain up to `end` has it, without its number on the server.
  /// \throws StoreError if the session has no events
  [[nodiscard]] store::SessionRow row_on_server(const store::DerivedRows& rows, int station,
                                                int session, std::int64_t end) const {
    const auto found = rows.sessions.find(session);
    if (found == rows.sessions.end()) {
      throw StoreError(station_.name() + ": session " + std::to_string(session) +
                       " has no events; run `touchtrial verify`");
    }
    const store::SessionOnFile course = course_until(courses_.at(session), end);
    store::SessionRow row = found->second;
    row.excluded = course.excluded_at.has_value();
    row.withdrawn = course.withdrawn_at.has_value();
    row.erased = course.erased_at.has_value();
    row.replaced_by = course.replaced_by;
    row.own_session = session;
    row.station = station;
    return row;
  }

  void note_pushed(const ChainSegment& segment) {
    ++done_;
    report_.chain_events += segment.end - segment.first;
    for (const int session : segment.sessions) report_.pushed.push_back(named(session));
    if (options_.progress) options_.progress(static_cast<int>(report_.pushed.size()), to_push_);
  }

  StationFile& station_;
  const ServerAddress& address_;
  const PushOptions& options_;
  PushReport& report_;
  std::vector<store::Event> chain_;
  Courses courses_;
  store::StudyCommitment commitment_;
  std::unique_ptr<ServerConnection> server_;
  bool was_connected_ = false;
  bool planned_ = false;
  int finished_ = 0;  ///< sessions of the file
  int to_push_ = 0;
  std::optional<ChainSegment> sent_;  ///< sent without an answer so far
  int done_ = 0;                      ///< transactions; after progress, failures count from 0 again
};

store::SessionState state_named(int session, const std::string& name) {
  const auto* const found =
      std::find(store::kSessionStates.begin(), store::kSessionStates.end(), name);
  if (found == store::kSessionStates.end()) {
    throw store::EventFault(session, store::kNoEvent, "no state of a session: " + one_line(name));
  }
  return static_cast<store::SessionState>(found - store::kSessionStates.begin());
}

}  // namespace

void push_station(StationFile& station, const ServerAddress& server, const PushOptions& options,
                  PushReport& report) {
  StationPush push(station, server, options, report);
  try {
    push.run();
  } catch (const StoreError& error) {
    if (report.pushed.empty() || options.dry_run) throw;
    throw StoreError(std::string(error.what()) + "; before that, " +
                     std::to_string(report.pushed.size()) + " of " +
                     std::to_string(push.to_push()) + " sessions were pushed");
  }
}

std::vector<EnrolledSession> sessions_on_server(const ServerAddress& address) {
  ServerConnection server(address);
  if (!server_version(server)) return {};
  return server.look([&](ServerWork& work) {
    std::vector<EnrolledSession> sessions;
    for (const pqxx::row& row : work.exec(
             "SELECT s.station, s.enrolment, s.state, s.excluded = 0 AND s.withdrawn = 0 AND "
             "s.replaced_by IS NULL, s.session, coalesce(t.name, '') FROM sessions s LEFT JOIN "
             "stations t USING(station) ORDER BY s.session")) {
      if (row[1].as<std::int64_t>() < 1) {
        throw store::EventFault(row[4].as<int>(), store::kNoEvent,
                                "its enrolment number is below 1");
      }
      sessions.push_back({.station = row[0].as<int>(),
                          .enrolment = row[1].as<int>(),
                          .state = state_named(row[4].as<int>(), row[2].as<std::string>()),
                          .counts = row[3].as<bool>(),
                          .station_name = row[5].as<std::string>()});
    }
    return sessions;
  });
}

}  // namespace touchtrial::collect
