#include "protocols/store/collected_chain.hpp"

#include "core/errors.hpp"
#include "protocols/store/event_fault.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace touchtrial::store {
namespace {

using std::chrono::nanoseconds;

/// The session that an event of a file chain is about, by its number at the station; 0: none.
int session_about(const Event& event) {
  switch (event.kind) {
    case EventKind::session_opened:
      return body_of(event, session_opened_from_json).session;
    case EventKind::session_closed:
      return body_of(event, session_closed_from_json).session;
    case EventKind::participant_excluded:
    case EventKind::participant_withdrawn:
      return body_of(event, participant_from_json).session;
    case EventKind::participant_replaced:
      return body_of(event, replacement_from_json).session;
    case EventKind::participant_noted:
      return body_of(event, note_from_json).session;
    default:
      return 0;
  }
}

std::string named(const StationChain& station, int own_session) {
  return "session " + std::to_string(own_session) + " of " + station.name;
}

/// One station's chain on its way into the collected one.
class Feed {
 public:
  Feed(const StationChain& station, int number, bool simulated)
      : station_(&station), number_(number), simulated_(simulated) {
    for (const Event& event : station.events) {
      if (event.kind == EventKind::session_opened) {
        const SessionOpenedBody body = body_of(event, session_opened_from_json);
        opened_.emplace(body.session, body);
      }
      if (event.kind == EventKind::session_closed) ended_.insert(session_about(event));
      if (event.kind == EventKind::participant_replaced) replaced_.insert(session_about(event));
    }
    skip();
  }

  [[nodiscard]] const StationChain& station() const noexcept { return *station_; }
  [[nodiscard]] int number() const noexcept { return number_; }
  [[nodiscard]] bool is_done() const noexcept { return next_ == station_->events.size(); }
  [[nodiscard]] const Event& head() const { return station_->events[next_]; }
  /// That the head is about.
  [[nodiscard]] const SessionOpenedBody& session() const { return opened_.at(about_); }
  [[nodiscard]] const std::map<int, SessionOpenedBody>& opened() const noexcept { return opened_; }
  [[nodiscard]] const std::set<int>& ended() const noexcept { return ended_; }

  /// Whether a session's place is taken by another sooner or later.
  [[nodiscard]] bool is_replaced(int session) const { return replaced_.contains(session); }
  /// Decides whose head comes first.
  [[nodiscard]] std::tuple<int, nanoseconds, int> rank() const {
    return {simulated_ ? session().enrolment : 0, head().at, simulated_ ? 0 : session().enrolment};
  }
  void advance() {
    ++next_;
    skip();
  }

 private:
  /// To the next event about a session that has ended.
  void skip() {
    for (; !is_done(); ++next_) {
      about_ = session_about(head());
      if (about_ != 0 && ended_.contains(about_)) return;
    }
  }

  const StationChain* station_;
  int number_;
  bool simulated_;
  std::map<int, SessionOpenedBody> opened_;
  std::set<int> ended_;
  std::set<int> replaced_;
  std::size_t next_ = 0;
  int about_ = 0;
};

/// All of a commitment but the version of the program, which stations may differ in.
StudyCommitment without_version(const StationChain& station) {
  StudyCommitment commitment = body_of(station.events.front(), commitment_from_json);
  commitment.program_version.clear();
  return commitment;
}

/// What differs, in words, where two stations cannot be of one study.
std::string difference(const StudyCommitment& a, const StudyCommitment& b) {
  if (a.study_id != b.study_id) return "they are of different studies";
  if (a.simulated != b.simulated) return "one is of simulated participants, the other is not";
  if (a.pilot != b.pilot) return "one is of a pilot, the other is not";
  if (a.seal != b.seal) return "their seals differ, as the study was changed between them";
  if (a.pack != b.pack) return "they were recorded with different packs";
  return "their studies' configurations differ";
}

void require_one_study(std::span<const StationChain> stations) {
  const StudyCommitment first = without_version(stations.front());
  for (const StationChain& station : stations.subspan(1)) {
    const StudyCommitment other = without_version(station);
    if (other == first) continue;
    throw StoreError(one_line(stations.front().name + " and " + station.name +
                              " cannot be collected into one: " + difference(first, other) +
                              "; collect stations of one study"));
  }
}

/// Makes the collected chain, event by event.
class Collection {
 public:
  explicit Collection(std::span<const StationChain> stations) : stations_(stations) {
    const bool simulated = body_of(stations.front().events.front(), commitment_from_json).simulated;
    int number = 0;
    for (const StationChain& station : stations) feeds_.emplace_back(station, ++number, simulated);
    for (const Feed& feed : feeds_) {
      for (const int session : feed.ended()) {
        if (!feed.is_replaced(session)) continue;
        former_participants_.insert(feed.opened().at(session).participant);
        former_enrolments_.insert(feed.opened().at(session).enrolment);
      }
    }
  }

  CollectedChain made() {
    const Event& first = stations_.front().events.front();
    append(EventKind::study_committed, first.at, first.body);
    while (Feed* const next = next_feed()) take(*next);
    refuse_taken_twice();
    end_collection();
    unblind();
    for (const Feed& feed : feeds_) {
      for (const auto& [session, opened] : feed.opened()) {
        if (!feed.ended().contains(session)) chain_.left_out.push_back({feed.number(), session});
      }
    }
    return std::move(chain_);
  }

 private:
  void append(EventKind kind, nanoseconds at, std::string body) {
    Event event{.session = 0,
                .sequence = static_cast<std::int64_t>(chain_.events.size()),
                .kind = kind,
                .at = at,
                .body = std::move(body),
                .sealed = {},
                .previous = chain_.events.empty() ? Digest{} : chain_.events.back().hash,
                .hash = {}};
    event.hash = event_hash(event);
    chain_.events.push_back(std::move(event));
  }

  /// Whether a feed opens a session whose place somebody has, as far as the chain has come.
  [[nodiscard]] bool is_taken(const Feed& feed) const {
    return feed.head().kind == EventKind::session_opened &&
           (participants_.contains(feed.session().participant) ||
            enrolments_.contains(feed.session().enrolment));
  }

  /// Whether a feed opens a session that stays, in a place that another had before, who is still
  /// to come: clocks of stations may differ by more than it took to replace somebody.
  [[nodiscard]] bool comes_later(const Feed& feed) const {
    if (feed.head().kind != EventKind::session_opened) return false;
    const SessionOpenedBody& session = feed.session();
    if (feed.is_replaced(session.session)) return false;
    return former_participants_.contains(session.participant) ||
           former_enrolments_.contains(session.enrolment);
  }

  /// The feed whose head comes next; none when all are done. What is in somebody's place waits for
  /// that one's replacement while anything else is left. Two that wait for each other's are no
  /// clash, if both places are free in the end: then time decides.
  Feed* next_feed() {
    Feed* best = nullptr;
    Feed* later = nullptr;
    Feed* waits = nullptr;
    const auto prefer = [](Feed*& known, Feed& feed) {
      if (known == nullptr || feed.rank() < known->rank()) known = &feed;
    };
    for (Feed& feed : feeds_) {
      if (feed.is_done()) continue;
      if (is_taken(feed)) {
        prefer(waits, feed);
      } else {
        prefer(comes_later(feed) ? later : best, feed);
      }
    }
    if (best != nullptr) return best;
    return later != nullptr ? later : waits;
  }

  [[nodiscard]] const Feed& feed_of(const SessionPlace& place) const {
    return feeds_[static_cast<std::size_t>(place.station) - 1];
  }
  [[nodiscard]] const SessionOpenedBody& opening_at(const SessionPlace& place) const {
    return feed_of(place).opened().at(place.own_session);
  }

  /// A participant id and an enrolment number belong to one session that nobody replaced. Whoever
  /// was replaced stands in nobody's way, at whatever moment that was.
  void refuse_taken_twice() const {
    std::map<std::string, SessionPlace> participants;
    std::map<int, SessionPlace> enrolments;
    for (const SessionPlace& place : chain_.sessions) {
      if (feed_of(place).is_replaced(place.own_session)) continue;
      const SessionOpenedBody& opened = opening_at(place);
      const auto [participant, is_new] = participants.emplace(opened.participant, place);
      if (!is_new) refuse_taken(participant->second, place);
      const auto [enrolment, is_free] = enrolments.emplace(opened.enrolment, place);
      if (!is_free) refuse_taken(enrolment->second, place);
    }
  }

  [[noreturn]] void refuse_taken(const SessionPlace& first, const SessionPlace& second) const {
    const SessionOpenedBody& taken = opening_at(first);
    const SessionOpenedBody& opened = opening_at(second);
    const bool participant = taken.participant == opened.participant;
    throw StoreError(one_line(
        (participant ? "participant " + opened.participant
                     : "enrolment " + std::to_string(opened.enrolment) + " (participants " +
                           taken.participant + " and " + opened.participant + ")") +
        " is taken twice, by " + named(feed_of(first).station(), first.own_session) + " and by " +
        named(feed_of(second).station(), second.own_session) +
        "; exclude and replace one of them at its station" +
        (taken.enrolment == opened.enrolment
             ? ", and run nobody under the successor's id, who would inherit the number"
             : "") +
        ", or leave that station's file out"));
  }

  void take(Feed& feed) {
    const SessionOpenedBody& session = feed.session();
    const SessionPlace place{.station = feed.number(), .own_session = session.session};
    const Event& event = feed.head();
    if (event.kind == EventKind::session_opened) {
      chain_.sessions.push_back(place);
      numbers_[place] = static_cast<int>(chain_.sessions.size());
      participants_.insert(session.participant);
      enrolments_.insert(session.enrolment);
      append(event.kind, event.at, body_of(event, [&](const std::string& body) {
               return renumbered_opening(body, numbers_.at(place), place.station);
             }));
    } else {
      if (event.kind == EventKind::participant_replaced) {
        participants_.extract(session.participant);
        enrolments_.extract(session.enrolment);
        former_participants_.extract(session.participant);
        former_enrolments_.extract(session.enrolment);
      }
      append(event.kind, event.at, body_of(event, [&](const std::string& body) {
               return renumbered(body, numbers_.at(place));
             }));
    }
    feed.advance();
  }

  /// The last event of a kind on a station's chain.
  static const Event* last_of(const StationChain& station, EventKind kind) {
    const auto found = std::find_if(station.events.rbegin(), station.events.rend(),
                                    [&](const Event& event) { return event.kind == kind; });
    return found == station.events.rend() ? nullptr : &*found;
  }

  /// Closed is what all stations closed.
  void end_collection() {
    nanoseconds at = nanoseconds::min();
    for (const StationChain& station : stations_) {
      const Event* const closed = last_of(station, EventKind::study_closed);
      if (closed == nullptr) return;
      at = std::max(at, closed->at);
    }
    append(EventKind::study_closed, at, "{}");
    closed_ = true;
  }

  /// Unblinded is what all stations with sessions unblinded; if some of them only for an interim
  /// look, or some station still collects, then for the sessions that the stations' looks show.
  void unblind() {
    nanoseconds at = nanoseconds::min();
    bool interim = !closed_;
    std::vector<std::string> reasons;
    std::vector<int> shown;
    for (const Feed& feed : feeds_) {
      if (feed.ended().empty()) continue;
      const Event* const look = last_of(feed.station(), EventKind::study_unblinded);
      if (look == nullptr) return;
      const StudyState state = state_of_chain(feed.station().events);
      at = std::max(at, look->at);
      interim = interim || state.interim.has_value();
      if (std::ranges::find(reasons, state.unblinding_reason) == reasons.end()) {
        reasons.push_back(state.unblinding_reason);
      }
      for (const int session : feed.ended()) {
        if (state.shows(session)) shown.push_back(numbers_.at({feed.number(), session}));
      }
    }
    if (reasons.empty()) return;
    std::string reason = reasons.front();
    for (std::size_t i = 1; i < reasons.size(); ++i) reason += "; " + reasons[i];
    UnblindingBody body{.reason = reason, .interim = interim};
    std::ranges::sort(shown);
    if (interim) body.sessions = std::move(shown);
    append(EventKind::study_unblinded, at, to_json(body));
  }

  std::span<const StationChain> stations_;
  std::vector<Feed> feeds_;
  CollectedChain chain_;
  std::map<SessionPlace, int> numbers_;
  /// Of sessions that nobody has replaced so far.
  std::multiset<std::string> participants_;
  std::multiset<int> enrolments_;
  /// Of sessions that somebody replaced, until that has come.
  std::multiset<std::string> former_participants_;
  std::multiset<int> former_enrolments_;
  bool closed_ = false;
};

}  // namespace

std::optional<Digest> station_identity(std::span<const Event> chain) {
  if (chain.size() < 2 || chain[1].kind != EventKind::session_opened) return std::nullopt;
  return chain[1].hash;
}

bool comes_before(const StationChain& a, const StationChain& b) {
  const auto rank = [](const StationChain& station) {
    const Event& first = station.events[1];
    const bool simulated = body_of(station.events.front(), commitment_from_json).simulated;
    const int enrolment = body_of(first, session_opened_from_json).enrolment;
    return std::tuple(simulated ? enrolment : 0, first.at, simulated ? 0 : enrolment, first.hash);
  };
  return rank(a) < rank(b);
}

CollectedChain collected_chain(std::span<const StationChain> stations) {
  require_one_study(stations);
  return Collection(stations).made();
}

StudyState state_of_chain(std::span<const Event> chain) {
  StudyState state;
  std::set<int> ended;
  for (const Event& event : chain) {
    if (event.kind == EventKind::study_closed) state.closed = true;
    if (event.kind == EventKind::session_closed) ended.insert(session_about(event));
    if (event.kind != EventKind::study_unblinded) continue;
    const UnblindingBody body = body_of(event, unblinding_from_json);
    state.unblinded = true;
    state.unblinding_reason = body.reason;
    state.interim = body.interim ? std::optional(ended) : std::nullopt;
    if (body.interim && body.sessions) {
      state.interim = std::set<int>(body.sessions->begin(), body.sessions->end());
    }
  }
  return state;
}

}  // namespace touchtrial::store
