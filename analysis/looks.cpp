#include "analysis/looks.hpp"

#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

using std::chrono::nanoseconds;

/// One chain's sessions as its events come, and the looks at them.
class ChainReading {
 public:
  ChainReading(int station, const design::Registration& registration)
      : station_(station), registration_(registration) {}

  void add(const store::Event& event) {
    using store::EventKind;
    switch (event.kind) {
      case EventKind::session_opened: {
        const store::SessionOpenedBody body = store::session_opened_from_json(event.body);
        participants_[body.session] = body.participant;
        last_opened = event.at;
        return;
      }
      case EventKind::session_closed: {
        const store::SessionClosedBody body = store::session_closed_from_json(event.body);
        ended_.insert(body.session);
        if (body.complete) counted_.insert(body.session);
        return;
      }
      case EventKind::participant_excluded: {
        const store::ParticipantBody body = store::participant_from_json(event.body);
        if (body.after_outcomes) record.excluded_afterwards.insert(body.session);
        return leave_out(event, record.excluded_afterwards);
      }
      case EventKind::participant_withdrawn:
        if (store::withdrawal_from_json(event.body).kept == store::Kept::data) return;
        return leave_out(event, record.erased_afterwards);
      case EventKind::participant_replaced:
        return leave_out(event, record.replaced_afterwards);
      case EventKind::study_closed:
        closed = event.at;
        return;
      case EventKind::study_unblinded:
        return look(event);
      default:
        return;
    }
  }

  /// From this time on everybody's outcomes were known, whatever this chain says.
  void seen_from(nanoseconds at) { seen_from_ = at; }

  LookRecord record;
  nanoseconds last_opened = nanoseconds::min();  ///< the last session
  nanoseconds closed = nanoseconds::max();

 private:
  void leave_out(const store::Event& event, std::set<int>& afterwards) {
    const int session = store::session_from_json(event.body);
    counted_.erase(session);
    const bool seen = seen_.contains(session) || event.at >= seen_from_ ||
                      persons_.contains(participants_[session]);
    if (seen) afterwards.insert(session);
  }

  void look(const store::Event& event) {
    const store::UnblindingBody body = store::unblinding_from_json(event.body);
    Look look{event.at,         static_cast<int>(counted_.size()),
              body.reason,      LookKind::final,
              body.participant, station_};
    if (!look.participant.empty()) {
      look.kind = LookKind::person;
      look.participants = 1;
      persons_.insert(look.participant);
    } else {
      look.kind = kind_of(body, look.participants);
      seen_.insert(ended_.begin(), ended_.end());
    }
    record.looks.push_back(std::move(look));
  }

  /// A station's look is never a registered one: those are at the whole study.
  [[nodiscard]] LookKind kind_of(const store::UnblindingBody& body, int participants) const {
    if (!body.interim) return LookKind::final;
    const bool registered = station_ == 0 && registration_.analysis &&
                            std::ranges::find(registration_.analysis->looks, participants) !=
                                registration_.analysis->looks.end();
    return registered ? LookKind::registered : LookKind::unregistered;
  }

  int station_;
  const design::Registration& registration_;
  std::map<int, std::string> participants_;  ///< by session
  std::set<int> counted_;                    ///< sessions
  std::set<std::string> persons_;            ///< looked at alone
  std::set<int> ended_;                      ///< sessions
  std::set<int> seen_;                       ///< sessions whose outcomes a look has shown
  nanoseconds seen_from_ = nanoseconds::max();
};

/// Whether the unblinding was made from those of the stations, which are listed one by one.
bool is_of_stations(const store::Event& event, const std::vector<Look>& looks) {
  if (event.kind != store::EventKind::study_unblinded) return false;
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

}  // namespace

std::string name_of(LookKind kind) {
  switch (kind) {
    case LookKind::final:
      return "final";
    case LookKind::registered:
      return "registered";
    case LookKind::unregistered:
      return "unregistered";
    case LookKind::person:
      break;
  }
  return "one participant";
}

LookRecord look_record(const store::StudyStore& store, const design::Registration& registration) {
  std::vector<Look> of_stations;
  nanoseconds first_seen = nanoseconds::max();
  // Nobody has looked at the stations of a simulation, which are unblinded as they are made.
  const int stations = store.commitment().simulated ? 0 : store.stations();
  for (int station = 1; station <= stations; ++station) {
    ChainReading reading(station, registration);
    for (const store::Event& event : store.events(-station)) reading.add(event);
    for (Look& look : reading.record.looks) {
      if (look.kind != LookKind::person) first_seen = std::min(first_seen, look.at);
      of_stations.push_back(std::move(look));
    }
  }
  ChainReading whole(0, registration);
  whole.seen_from(first_seen);
  for (const store::Event& event : store.events(0)) {
    if (!is_of_stations(event, of_stations)) whole.add(event);
  }
  // A station that has ended may look while others still collect.
  for (Look& look : of_stations) {
    const bool early = look.kind == LookKind::final && look.at < whole.last_opened;
    if (early) look.kind = LookKind::unregistered;
  }
  LookRecord record = std::move(whole.record);
  record.looks.insert(record.looks.begin(), of_stations.begin(), of_stations.end());
  mark_persons(whole.closed, record.looks);
  return record;
}

namespace {

struct Civil {
  std::chrono::year_month_day day;
  std::chrono::hh_mm_ss<std::chrono::seconds> time;
};

Civil civil(nanoseconds at) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(at);
  const auto days = std::chrono::floor<std::chrono::days>(seconds);
  return {std::chrono::sys_days(days), std::chrono::hh_mm_ss(seconds - days)};
}

std::string day_text(const std::chrono::year_month_day& day) {
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(day.year()),
                     static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
}

}  // namespace

std::string date_text(nanoseconds at) {
  const Civil when = civil(at);
  return fmt::format("{} {:02}:{:02} UTC", day_text(when.day), when.time.hours().count(),
                     when.time.minutes().count());
}

std::string iso_date(nanoseconds at) {
  const Civil when = civil(at);
  return fmt::format("{}T{:02}:{:02}:{:02}Z", day_text(when.day), when.time.hours().count(),
                     when.time.minutes().count(), when.time.seconds().count());
}

}  // namespace touchtrial::analysis
