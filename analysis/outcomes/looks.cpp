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

/// Reads one chain's events in order and collects the looks at its sessions.
class ChainReading {
 public:
  /// \param registered  the registered looks, by number of participants
  /// \param visits  the number of visits after which a participant counts
  ChainReading(int station, std::vector<int> registered, int visits)
      : station_(station), registered_(std::move(registered)), visits_(visits) {}

  /// Ignores sessions that the plan does not cover, such as pilots.
  void ignore_sessions(std::set<int> sessions) { uncounted_ = std::move(sessions); }

  void add(const record::Event& event) {
    using record::EventKind;
    switch (event.kind) {
      case EventKind::session_opened: {
        const record::SessionOpenedBody body =
            record::from_json<record::SessionOpenedBody>(event.body);
        participants_[body.session] = body.participant;
        // Participants are counted by the last visit.
        if (body.visit != visits_) uncounted_.insert(body.session);
        last_opened = event.at;
        return;
      }
      case EventKind::session_closed: {
        const record::SessionClosedBody body =
            record::from_json<record::SessionClosedBody>(event.body);
        ended_.insert(body.session);
        if (body.complete && !uncounted_.contains(body.session)) counted_.insert(body.session);
        return;
      }
      case EventKind::participant_excluded: {
        const record::ParticipantBody body = record::from_json<record::ParticipantBody>(event.body);
        if (body.after_outcomes) record.excluded_afterwards.insert(body.session);
        return add_decision(event, record.excluded_afterwards);
      }
      case EventKind::participant_withdrawn:
        if (record::from_json<record::WithdrawalBody>(event.body).kept == record::Retention::data)
          return;
        return add_decision(event, record.erased_afterwards);
      case EventKind::participant_replaced:
        return add_decision(event, record.replaced_afterwards);
      case EventKind::study_closed:
        closed = event.at;
        return;
      case EventKind::study_unblinded:
        return add_look(event);
      default:
        return;
    }
  }

  /// Sets a time after which all outcomes were known, even if this chain has no look.
  void set_seen_from(nanoseconds at) { seen_from_ = at; }

  /// The result, including whether a look now would be registered.
  [[nodiscard]] LookRecord release_record() {
    record.participants = static_cast<int>(counted_.size());
    record.may_look = is_registered();
    return std::move(record);
  }

  LookRecord record;
  nanoseconds last_opened = nanoseconds::min();  ///< opening of the last session
  nanoseconds closed = nanoseconds::max();

 private:
  void add_decision(const record::Event& event, std::set<int>& afterwards) {
    const int session = record::session_from_json(event.body);
    counted_.erase(session);
    const bool is_seen = seen_.contains(session) || event.at >= seen_from_ ||
                         individually_seen_.contains(participants_[session]);
    if (is_seen) afterwards.insert(session);
  }

  void add_look(const record::Event& event) {
    const record::UnblindingBody body = record::from_json<record::UnblindingBody>(event.body);
    Look look{event.at,         static_cast<int>(counted_.size()),
              body.reason,      LookKind::final,
              body.participant, station_};
    if (!look.participant.empty()) {
      look.kind = LookKind::person;
      look.participants = 1;
      individually_seen_.insert(look.participant);
    } else {
      look.kind = kind_of(body);
      seen_.insert(ended_.begin(), ended_.end());
    }
    record.looks.push_back(std::move(look));
  }

  [[nodiscard]] LookKind kind_of(const record::UnblindingBody& body) {
    if (!body.interim) return LookKind::final;
    if (!body.question_alone || !is_registered()) return LookKind::unregistered;
    looks_made_[static_cast<int>(counted_.size())] = counted_;
    return LookKind::registered;
  }

  /// Whether a look now would be registered. A registered look may be repeated at the same
  /// sessions.
  [[nodiscard]] bool is_registered() const {
    const auto participants = static_cast<int>(counted_.size());
    if (std::ranges::find(registered_, participants) == registered_.end()) return false;
    const auto previous = looks_made_.find(participants);
    return previous == looks_made_.end() || previous->second == counted_;
  }

  int station_;
  std::vector<int> registered_;
  int visits_;
  std::set<int> uncounted_;                  ///< sessions that never count
  std::map<int, std::set<int>> looks_made_;  ///< sessions of registered looks, by participants
  std::map<int, std::string> participants_;  ///< by session
  std::set<int> counted_;                    ///< counted sessions
  std::set<std::string> individually_seen_;  ///< participants
  std::set<int> ended_;                      ///< ended sessions
  std::set<int> seen_;                       ///< sessions whose outcomes were seen
  nanoseconds seen_from_ = nanoseconds::max();
};

/// Whether an unblinding only combines the stations' looks, which are listed separately.
bool combines_station_looks(const record::Event& event, const std::vector<Look>& looks) {
  if (event.kind != record::EventKind::study_unblinded) return false;
  return std::ranges::any_of(looks, [&](const Look& look) { return look.at == event.at; });
}

/// Marks looks at single participants if several participants were viewed before the study was
/// closed.
void mark_repeated_person_looks(nanoseconds closed, std::vector<Look>& looks) {
  const auto is_early = [&](const Look& look) {
    return look.kind == LookKind::person && look.at < closed;
  };
  std::set<std::string> persons;
  for (const Look& look : looks) {
    if (is_early(look)) persons.insert(look.participant);
  }
  for (Look& look : looks) look.is_one_of_several = persons.size() > 1 && is_early(look);
}

/// The registered looks that this file may make.
std::vector<int> registered_looks(const record::StudyStore& store, const study::StudyKey& key) {
  const auto& analysis = key.study.registration.analysis;
  const bool in_one_file = key.stations.size() < 2 && store.stations() < 2;
  return analysis && in_one_file ? analysis->looks : std::vector<int>{};
}

/// Sessions of another kind than the study, such as pilots.
std::set<int> sessions_of_other_kind(const record::StudyStore& store) {
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
  std::vector<Look> station_looks;
  nanoseconds first_seen = nanoseconds::max();
  // A simulation's stations are unblinded when they are created, which is not a look.
  const int stations = store.commitment().simulated ? 0 : store.stations();
  const int visits = prescription_from_json(store.commitment().configuration).visits_needed;
  for (int station = 1; station <= stations; ++station) {
    ChainReading reading(station, {}, visits);
    for (const record::Event& event : store.events(-station)) reading.add(event);
    for (Look& look : reading.record.looks) {
      if (look.kind != LookKind::person) first_seen = std::min(first_seen, look.at);
      station_looks.push_back(std::move(look));
    }
  }
  ChainReading study(0, registered_looks(store, key), visits);
  study.ignore_sessions(sessions_of_other_kind(store));
  study.set_seen_from(first_seen);
  for (const record::Event& event : store.events(0)) {
    if (!combines_station_looks(event, station_looks)) study.add(event);
  }
  // A station that has closed may look while others still collect.
  for (Look& look : station_looks) {
    const bool is_early = look.kind == LookKind::final && look.at < study.last_opened;
    if (is_early) look.kind = LookKind::unregistered;
  }
  LookRecord record = study.release_record();
  record.looks.insert(record.looks.begin(), station_looks.begin(), station_looks.end());
  mark_repeated_person_looks(study.closed, record.looks);
  return record;
}

}  // namespace touchtrial::analysis
