#include "record/collected_chain.hpp"

#include "core/errors.hpp"
#include "record/damage.hpp"
#include "record/file_chain.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace touchtrial::record {
namespace {

using std::chrono::nanoseconds;

std::string session_label(const StationChain& station, int own_session) {
  return "session " + std::to_string(own_session) + " of " + station.name;
}

/// One station's chain, as a source of the collected one.
class Feed {
 public:
  Feed(const StationChain& station, int number, bool simulated)
      : station_(&station), number_(number), simulated_(simulated) {
    for (const Event& event : station.events) file_.add(event);
    skip_to_ended();
  }

  [[nodiscard]] const StationChain& station() const noexcept { return *station_; }
  [[nodiscard]] int number() const noexcept { return number_; }
  [[nodiscard]] bool is_done() const noexcept { return next_ == station_->events.size(); }
  [[nodiscard]] const Event& head() const { return station_->events[next_]; }
  /// The session that the head is about.
  [[nodiscard]] const SessionOnFile& session() const { return sessions().at(head_session_); }
  [[nodiscard]] const std::map<int, SessionOnFile>& sessions() const { return file_.sessions(); }

  /// The feed with the lowest rank comes first.
  [[nodiscard]] std::tuple<int, int, nanoseconds, int> rank() const {
    const SessionOpenedBody& opening = session().opened;
    return {simulated_ ? opening.visit : 0, simulated_ ? opening.enrolment : 0, head().at,
            simulated_ ? 0 : opening.enrolment};
  }
  void advance() {
    ++next_;
    skip_to_ended();
  }

 private:
  /// Moves to the next event about a session that has ended.
  void skip_to_ended() {
    for (; !is_done(); ++next_) {
      head_session_ = session_about(head());
      if (head_session_ != 0 && session().closed) return;
    }
  }

  const StationChain* station_;
  int number_;
  bool simulated_;
  FileChain file_;
  std::size_t next_ = 0;
  int head_session_ = 0;
};

StudyCommitment commitment_of(const StationChain& station) {
  return body_of<StudyCommitment>(station.events.front());
}

/// A station's commitment without the parts that may differ between stations.
StudyCommitment common_commitment(const StationChain& station) {
  StudyCommitment commitment = commitment_of(station);
  commitment.program_version.clear();
  commitment.station.reset();
  return commitment;
}

/// Why two stations do not belong to one study.
std::string difference(const StudyCommitment& a, const StudyCommitment& b) {
  if (a.study_id != b.study_id) return "they belong to different studies [other-study]";
  if (a.simulated != b.simulated) return "only one has simulated participants [simulated]";
  if (a.pilot != b.pilot) return "only one is a pilot [pilot]";
  if (a.seal != b.seal) return "their seals differ, because the study was changed [other-seal]";
  if (a.pack != b.pack) return "they were recorded with different packs [other-pack]";
  if (a.investigator != b.investigator)
    return "they name different investigators [other-investigator]";
  return "their studies' configurations differ [other-configuration]";
}

void require_one_study(std::span<const StationChain> stations) {
  const StudyCommitment first = common_commitment(stations.front());
  for (const StationChain& station : stations.subspan(1)) {
    const StudyCommitment other = common_commitment(station);
    if (other == first) continue;
    throw StoreError(one_line(stations.front().name + " and " + station.name +
                              " cannot be collected into one: " + difference(first, other) +
                              "; collect stations of one study"));
  }
}

/// Participant ids and enrolment numbers of some sessions, each with its visit.
class Places {
 public:
  void insert(const SessionOpenedBody& session) {
    participants_.emplace(session.participant, session.visit);
    enrolments_.emplace(session.enrolment, session.visit);
  }
  /// Removes one session with this place.
  void remove(const SessionOpenedBody& session) {
    participants_.extract({session.participant, session.visit});
    enrolments_.extract({session.enrolment, session.visit});
  }
  /// Whether one of the sessions has the same participant id or enrolment number.
  [[nodiscard]] bool has(const SessionOpenedBody& session) const {
    return participants_.contains({session.participant, session.visit}) ||
           enrolments_.contains({session.enrolment, session.visit});
  }

 private:
  std::multiset<std::pair<std::string, int>> participants_;
  std::multiset<std::pair<int, int>> enrolments_;
};

/// Builds the collected chain, event by event.
class Collection {
 public:
  explicit Collection(std::span<const StationChain> stations) : stations_(stations) {
    const bool simulated = commitment_of(stations.front()).simulated;
    int number = 0;
    for (const StationChain& station : stations) feeds_.emplace_back(station, ++number, simulated);
    for (const Feed& feed : feeds_) {
      for (const auto& [own_session, session] : feed.sessions()) {
        if (session.closed && session.replaced_at) awaiting_replacement_.insert(session.opened);
      }
    }
  }

  CollectedChain build() {
    const Event& first = stations_.front().events.front();
    StudyCommitment commitment = commitment_of(stations_.front());
    commitment.station.reset();
    append(EventKind::study_committed, first.at, to_json(commitment));
    while (Feed* const next = next_feed()) append_head(*next);
    refuse_duplicate_places();
    append_participant_looks();
    append_study_closed();
    append_unblinding();
    for (const Feed& feed : feeds_) {
      for (const auto& [own_session, session] : feed.sessions()) {
        if (!session.closed) chain_.left_out.push_back({feed.number(), own_session});
      }
    }
    return std::move(chain_);
  }

 private:
  void append(EventKind kind, nanoseconds at, std::string body, Bytes sealed = {}) {
    const Event* const last = chain_.events.empty() ? nullptr : &chain_.events.back();
    chain_.events.push_back(next_on_file(last, kind, at, std::move(body), std::move(sealed)));
  }

  /// Whether a feed opens a session whose place is occupied at this point of the chain.
  [[nodiscard]] bool is_occupied(const Feed& feed) const {
    return feed.head().kind == EventKind::session_opened &&
           occupied_places_.has(feed.session().opened);
  }

  /// Whether a feed opens a session that is never replaced, in a place whose former holder has not
  /// been replaced in the chain yet. This happens if stations' clocks differ by more than the time
  /// until the replacement.
  [[nodiscard]] bool must_wait(const Feed& feed) const {
    return feed.head().kind == EventKind::session_opened && !feed.session().replaced_at &&
           awaiting_replacement_.has(feed.session().opened);
  }

  /// The feed whose head comes next; null when all are done. A session waits for the replacement of
  /// its place's former holder while any other event remains. Two sessions that wait for each other
  /// do not clash if both places are free in the end; the earlier one is then first.
  Feed* next_feed() {
    Feed* best = nullptr;
    Feed* waiting = nullptr;
    Feed* blocked = nullptr;
    const auto prefer = [](Feed*& first, Feed& feed) {
      if (first == nullptr || feed.rank() < first->rank()) first = &feed;
    };
    for (Feed& feed : feeds_) {
      if (feed.is_done()) continue;
      if (is_occupied(feed)) {
        prefer(blocked, feed);
      } else {
        prefer(must_wait(feed) ? waiting : best, feed);
      }
    }
    if (best != nullptr) return best;
    return waiting != nullptr ? waiting : blocked;
  }

  [[nodiscard]] const Feed& feed_of(const SessionPlace& place) const {
    return feeds_[static_cast<std::size_t>(place.station) - 1];
  }
  [[nodiscard]] const SessionOnFile& session_at(const SessionPlace& place) const {
    return feed_of(place).sessions().at(place.own_session);
  }

  /// A participant id and an enrolment number belong to at most one session of a visit that was not
  /// replaced. Replaced sessions occupy no place, whenever they were replaced.
  void refuse_duplicate_places() const {
    std::map<std::pair<std::string, int>, SessionPlace> participants;
    std::map<std::pair<int, int>, SessionPlace> enrolments;
    for (const SessionPlace& place : chain_.sessions) {
      if (session_at(place).replaced_at) continue;
      const SessionOpenedBody& opening = session_at(place).opened;
      const auto [participant, is_new] =
          participants.emplace(std::pair(opening.participant, opening.visit), place);
      if (!is_new) refuse_duplicate(participant->second, place);
      const auto [enrolment, is_free] =
          enrolments.emplace(std::pair(opening.enrolment, opening.visit), place);
      if (!is_free) refuse_duplicate(enrolment->second, place);
    }
  }

  [[noreturn]] void refuse_duplicate(const SessionPlace& first, const SessionPlace& second) const {
    const SessionOpenedBody& earlier = session_at(first).opened;
    const SessionOpenedBody& opening = session_at(second).opened;
    const bool same_participant = earlier.participant == opening.participant;
    throw StoreError(one_line(
        (same_participant ? "participant " + opening.participant
                          : "enrolment " + std::to_string(opening.enrolment) + " (participants " +
                                earlier.participant + " and " + opening.participant + ")") +
        " is used twice, by " + session_label(feed_of(first).station(), first.own_session) +
        " and by " + session_label(feed_of(second).station(), second.own_session) +
        "; exclude and replace one of them at its station" +
        (earlier.enrolment == opening.enrolment
             ? ", and do not run the successor, who would inherit the number"
             : "") +
        ", or leave that station's file out"));
  }

  /// Appends the feed's head, with the session's number in the collected chain.
  void append_head(Feed& feed) {
    const SessionOpenedBody& session = feed.session().opened;
    const SessionPlace place{.station = feed.number(), .own_session = session.session};
    const Event& event = feed.head();
    if (event.kind == EventKind::session_opened) {
      chain_.sessions.push_back(place);
      numbers_[place] = static_cast<int>(chain_.sessions.size());
      occupied_places_.insert(session);
      append(event.kind, event.at, body_of(event, [&](const std::string& body) {
               return renumbered_opening(body, numbers_.at(place), place.station);
             }));
    } else {
      if (event.kind == EventKind::participant_replaced) {
        occupied_places_.remove(session);
        awaiting_replacement_.remove(session);
      }
      std::string renumbered_body = body_of(
          event, [&](const std::string& body) { return renumbered(body, numbers_.at(place)); });
      append(event.kind, event.at, std::move(renumbered_body), event.sealed);
    }
    feed.advance();
  }

  /// Whether an event records a look at one participant's outcomes.
  static bool is_personal(const Event& event) {
    return event.kind == EventKind::study_unblinded &&
           !body_of<UnblindingBody>(event).participant.empty();
  }

  /// The last event of a kind on a station's chain, other than looks at one participant.
  static const Event* last_event_of(const StationChain& station, EventKind kind) {
    const auto found =
        std::find_if(station.events.rbegin(), station.events.rend(),
                     [&](const Event& event) { return event.kind == kind && !is_personal(event); });
    return found == station.events.rend() ? nullptr : &*found;
  }

  /// Every look at one participant, with the sessions that it shows, by time and station.
  void append_participant_looks() {
    std::multimap<nanoseconds, UnblindingBody> looks;
    for (const Feed& feed : feeds_) {
      const std::span<const Event> events = feed.station().events;
      for (std::size_t i = 0; i < events.size(); ++i) {
        if (!is_personal(events[i])) continue;
        UnblindingBody body = body_of<UnblindingBody>(events[i]);
        body.sessions.emplace();
        for (const Event& before : events.first(i)) {
          if (before.kind != EventKind::session_opened) continue;
          const SessionOpenedBody opening = body_of<SessionOpenedBody>(before);
          const auto number = numbers_.find({feed.number(), opening.session});
          if (opening.participant != body.participant || number == numbers_.end()) continue;
          body.sessions->push_back(number->second);
        }
        std::ranges::sort(*body.sessions);
        looks.emplace(events[i].at, std::move(body));
      }
    }
    for (const auto& [at, body] : looks) append(EventKind::study_unblinded, at, to_json(body));
  }

  /// The study is closed if all stations closed it.
  void append_study_closed() {
    nanoseconds at = nanoseconds::min();
    for (const StationChain& station : stations_) {
      const Event* const closed = last_event_of(station, EventKind::study_closed);
      if (closed == nullptr) return;
      at = std::max(at, closed->at);
    }
    append(EventKind::study_closed, at, "{}");
    closed_ = true;
  }

  /// The study is unblinded if all stations with sessions unblinded it. If one of them did so only
  /// for an interim look, or a station still collects data, it becomes an interim look at the
  /// sessions of the stations' looks.
  void append_unblinding() {
    nanoseconds at = nanoseconds::min();
    const auto has_ended = [](const auto& entry) { return entry.second.closed.has_value(); };
    bool interim = !closed_;
    std::vector<std::string> reasons;
    std::vector<int> shown_sessions;
    for (const Feed& feed : feeds_) {
      if (std::ranges::none_of(feed.sessions(), has_ended)) continue;
      const Event* const look = last_event_of(feed.station(), EventKind::study_unblinded);
      if (look == nullptr) return;
      const StudyState state = state_of_chain(feed.station().events);
      if (!state.unblinded) return;
      at = std::max(at, look->at);
      interim = interim || state.interim.has_value();
      if (std::ranges::find(reasons, state.unblinding_reason) == reasons.end()) {
        reasons.push_back(state.unblinding_reason);
      }
      for (const auto& [own_session, session] : feed.sessions()) {
        if (session.closed && state.reports(own_session))
          shown_sessions.push_back(numbers_.at({feed.number(), own_session}));
      }
    }
    if (reasons.empty()) return;
    std::string reason = reasons.front();
    for (std::size_t i = 1; i < reasons.size(); ++i) reason += "; " + reasons[i];
    UnblindingBody body{.reason = reason, .interim = interim};
    std::ranges::sort(shown_sessions);
    if (interim) body.sessions = std::move(shown_sessions);
    append(EventKind::study_unblinded, at, to_json(body));
  }

  std::span<const StationChain> stations_;
  std::vector<Feed> feeds_;
  CollectedChain chain_;
  std::map<SessionPlace, int> numbers_;
  Places occupied_places_;       ///< of sessions not replaced so far
  Places awaiting_replacement_;  ///< of sessions that are replaced later in the chain
  bool closed_ = false;
};

/// The event that opens a file's first session; null if there is none.
const Event* first_opening(std::span<const Event> chain) {
  const auto found = std::ranges::find(chain, EventKind::session_opened, &Event::kind);
  return found == chain.end() ? nullptr : &*found;
}

}  // namespace

std::optional<Digest> station_identity(std::span<const Event> chain) {
  const Event* const first = first_opening(chain);
  return first == nullptr ? std::nullopt : std::optional(first->hash);
}

bool comes_before(const StationChain& a, const StationChain& b) {
  const auto rank = [](const StationChain& station) {
    const Event& first = *first_opening(station.events);
    const bool simulated = body_of<StudyCommitment>(station.events.front()).simulated;
    const int enrolment = body_of<SessionOpenedBody>(first).enrolment;
    return std::tuple(simulated ? enrolment : 0, first.at, simulated ? 0 : enrolment, first.hash);
  };
  return rank(a) < rank(b);
}

CollectedChain collected_chain(std::span<const StationChain> stations) {
  require_one_study(stations);
  return Collection(stations).build();
}

}  // namespace touchtrial::record
