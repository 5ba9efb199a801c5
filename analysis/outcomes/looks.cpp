#include "analysis/outcomes/looks.hpp"

#include "analysis/outcomes/collection.hpp"
#include "core/named.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace touchtrial::analysis {
namespace {

using std::chrono::nanoseconds;

/// Reads one chain's events in order; collects its sessions and the looks at them.
class ChainReading {
 public:
  /// \param registered  the registered looks, by number of participants
  /// \param visits  that a participant needs to count
  ChainReading(int station, std::vector<int> registered, int visits)
      : station_(station), registered_(std::move(registered)), visits_(visits) {}

  /// Sessions that the plan does not cover, such as pilots.
  void exclude_sessions(std::set<int> sessions) { others_ = std::move(sessions); }

  void add(const record::Event& event) {
    using record::EventKind;
    switch (event.kind) {
      case EventKind::session_opened: {
        const record::SessionOpenedBody body =
            record::from_json<record::SessionOpenedBody>(event.body);
        participants_[body.session] = body.participant;
        // A participant is counted by the last visit.
        if (body.visit != visits_) others_.insert(body.session);
        last_opened = event.at;
        return;
      }
      case EventKind::session_closed: {
        const record::SessionClosedBody body =
            record::from_json<record::SessionClosedBody>(event.body);
        ended_.insert(body.session);
        if (body.complete && !others_.contains(body.session)) counted_.insert(body.session);
        return;
      }
      case EventKind::participant_excluded: {
        const record::ParticipantBody body = record::from_json<record::ParticipantBody>(event.body);
        if (body.after_outcomes) record.excluded_afterwards.insert(body.session);
        return decide(event, record.excluded_afterwards);
      }
      case EventKind::participant_withdrawn:
        if (record::from_json<record::WithdrawalBody>(event.body).kept == record::Retention::data)
          return;
        return decide(event, record.erased_afterwards);
      case EventKind::participant_replaced:
        return decide(event, record.replaced_afterwards);
      case EventKind::study_closed:
        closed = event.at;
        return;
      case EventKind::study_unblinded:
        return look(event);
      default:
        return;
    }
  }

  /// Sets the time from which all outcomes were known, even if this chain has no look.
  void set_seen_from(nanoseconds at) { seen_from_ = at; }

  /// The result, including the state that a look now would have.
  [[nodiscard]] LookRecord take() {
    record.participants = static_cast<int>(counted_.size());
    record.may_look = is_registered();
    return std::move(record);
  }

  LookRecord record;
  nanoseconds last_opened = nanoseconds::min();  ///< the last session
  nanoseconds closed = nanoseconds::max();

 private:
  void decide(const record::Event& event, std::set<int>& afterwards) {
    const int session = record::session_from_json(event.body);
    counted_.erase(session);
    const bool seen = seen_.contains(session) || event.at >= seen_from_ ||
                      persons_.contains(participants_[session]);
    if (seen) afterwards.insert(session);
  }

  void look(const record::Event& event) {
    const record::UnblindingBody body = record::from_json<record::UnblindingBody>(event.body);
    Look look{event.at,         static_cast<int>(counted_.size()),
              body.reason,      LookKind::final,
              body.participant, station_};
    if (!look.participant.empty()) {
      look.kind = LookKind::person;
      look.participants = 1;
      persons_.insert(look.participant);
    } else {
      look.kind = kind_of(body);
      seen_.insert(ended_.begin(), ended_.end());
    }
    record.looks.push_back(std::move(look));
  }

  [[nodiscard]] LookKind kind_of(const record::UnblindingBody& body) {
    if (!body.interim) return LookKind::final;
    if (!body.question_alone || !is_registered()) return LookKind::unregistered;
    made_[static_cast<int>(counted_.size())] = counted_;
    return LookKind::registered;
  }

  /// Whether a look now would be a registered one. A registered look can be repeated at the same
  /// sessions.
  [[nodiscard]] bool is_registered() const {
    const auto participants = static_cast<int>(counted_.size());
    if (std::ranges::find(registered_, participants) == registered_.end()) return false;
    const auto made = made_.find(participants);
    return made == made_.end() || made->second == counted_;
  }

  int station_;
  std::vector<int> registered_;
  int visits_;
  std::set<int> others_;                     ///< sessions that never count
  std::map<int, std::set<int>> made_;        ///< sessions of registered looks, by participants
  std::map<int, std::string> participants_;  ///< by session
  std::set<int> counted_;                    ///< sessions
  std::set<std::string> persons_;            ///< looked at alone
  std::set<int> ended_;                      ///< sessions
  std::set<int> seen_;                       ///< sessions whose outcomes a look has shown
  nanoseconds seen_from_ = nanoseconds::max();
};

/// Whether the unblinding only combines those of the stations, which are listed separately.
bool is_of_stations(const record::Event& event, const std::vector<Look>& looks) {
  if (event.kind != record::EventKind::study_unblinded) return false;
  return std::ranges::any_of(looks, [&](const Look& look) { return look.at == event.at; });
}

/// Marks looks at single participants that were made at several of them before the study was
/// closed.
void mark_persons(nanoseconds closed, std::vector<Look>& looks) {
  const auto is_early = [&](const Look& look) {
    return look.kind == LookKind::person && look.at < closed;
  };
  std::set<std::string> persons;
  for (const Look& look : looks) {
    if (is_early(look)) persons.insert(look.participant);
  }
  for (Look& look : looks) look.is_one_of_several = persons.size() > 1 && is_early(look);
}

/// The registered looks that this file can make.
std::vector<int> registered_looks(const record::StudyStore& store, const study::StudyKey& key) {
  const auto& analysis = key.study.registration.analysis;
  const bool in_one_file = key.stations.size() < 2 && store.stations() < 2;
  return analysis && in_one_file ? analysis->looks : std::vector<int>{};
}

/// Sessions of another kind than the study, such as pilots.
std::set<int> of_other_kind(const record::StudyStore& store) {
  const record::StudyCommitment& commitment = store.commitment();
  std::set<int> sessions;
  for (const record::SessionRow& row : store.sessions()) {
    if (row.pilot == commitment.pilot && row.simulated == commitment.simulated) continue;
    sessions.insert(row.session);
  }
  return sessions;
}

}  // namespace

std::string name_of(LookKind kind) {
  using enum LookKind;
  static constexpr auto kNames = std::to_array<Named<LookKind>>({{"final", final},
                                                                 {"registered", registered},
                                                                 {"unregistered", unregistered},
                                                                 {"one participant", person}});
  return std::string(name_in(kNames, kind));
}

LookRecord look_record(const record::StudyStore& store, const study::StudyKey& key) {
  std::vector<Look> of_stations;
  nanoseconds first_seen = nanoseconds::max();
  // A simulation's stations are unblinded when they are created, which is not a look.
  const int stations = store.commitment().simulated ? 0 : store.stations();
  const int visits = prescription_from_json(store.commitment().configuration).visits_needed;
  for (int station = 1; station <= stations; ++station) {
    ChainReading reading(station, {}, visits);
    for (const record::Event& event : store.events(-station)) reading.add(event);
    for (Look& look : reading.record.looks) {
      if (look.kind != LookKind::person) first_seen = std::min(first_seen, look.at);
      of_stations.push_back(std::move(look));
    }
  }
  ChainReading whole(0, registered_looks(store, key), visits);
  whole.exclude_sessions(of_other_kind(store));
  whole.set_seen_from(first_seen);
  for (const record::Event& event : store.events(0)) {
    if (!is_of_stations(event, of_stations)) whole.add(event);
  }
  // A station that has closed may look while others still collect.
  for (Look& look : of_stations) {
    const bool early = look.kind == LookKind::final && look.at < whole.last_opened;
    if (early) look.kind = LookKind::unregistered;
  }
  LookRecord record = whole.take();
  record.looks.insert(record.looks.begin(), of_stations.begin(), of_stations.end());
  mark_persons(whole.closed, record.looks);
  return record;
}

}  // namespace touchtrial::analysis
