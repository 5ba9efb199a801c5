#include "record/merging/collect.hpp"

#include "record/collected_draft.hpp"
#include "record/damage.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::merging {
namespace {

/// A station and its chain.
struct Station {
  record::StationChain chain;
  record::FileChain chain_state;
  std::unique_ptr<StationFile> file;
};

[[noreturn]] void refuse(const std::string& text) {
  throw StoreError(one_line(text));
}

/// Calls `work`; faults of the station are rethrown as DamagedStore with its name.
template <typename Work>
void with_station_name(const std::string& station, Work&& work) {
  try {
    work();
  } catch (const record::EventFault& fault) {
    throw record::DamagedStore(one_line(
        fmt::format("{}: {}; restore it from a backup, or leave it out", station, fault.what())));
  }
}

Station read_station(std::unique_ptr<StationFile> file) {
  Station station;
  station.chain.name = file->name();
  with_station_name(station.chain.name, [&] {
    station.chain.events = file->file_chain();
    station.chain_state = record::checked_file_chain(station.chain.events);
  });
  station.file = std::move(file);
  return station;
}

/// The session that an event of a file chain opens, or the event's kind, as text.
std::string event_label(const record::Event& event) {
  if (event.kind == record::EventKind::session_opened) {
    const record::SessionOpenedBody body = record::from_json<record::SessionOpenedBody>(event.body);
    return fmt::format(" (session {}, participant {})", body.session, body.participant);
  }
  return fmt::format(" ({})", record::name_of(event.kind));
}

/// Selects the longer of two copies of a station's file, and reports the other as redundant.
/// \param longer  set to the longer copy
/// \throws StoreError if they diverged
void keep_longer(Station& longer, Station& other, CollectReport& report) {
  const std::vector<record::Event>& a = longer.chain.events;
  const std::vector<record::Event>& b = other.chain.events;
  const auto is_same = [](const record::Event& x, const record::Event& y) {
    return x.hash == y.hash;
  };
  const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end(), is_same);
  if (in_a != a.end() && in_b != b.end()) {
    refuse(fmt::format(
        "{} and {} are copies of one station's file, and have diverged: they differ from event {} "
        "of the file's chain{}{}; omit the one that the station no longer uses",
        longer.chain.name, other.chain.name, in_a->sequence, event_label(*in_a),
        event_label(*in_b)));
  }
  if (in_a == a.end() && in_b != b.end()) std::swap(longer, other);
  report.redundant.push_back(other.chain.name);
}

/// Returns each station once, in the order of comes_before.
std::vector<Station> distinct_stations(Stations files, CollectReport& report) {
  std::map<Digest, Station> by_identity;
  for (std::unique_ptr<StationFile>& file : files) {
    Station station = read_station(std::move(file));
    const auto identity = record::station_identity(station.chain.events);
    if (!identity) {
      report.redundant.push_back(station.chain.name);
      continue;
    }
    const auto [entry, is_new] = by_identity.try_emplace(*identity);
    if (is_new) {
      entry->second = std::move(station);
    } else {
      keep_longer(entry->second, station, report);
    }
  }
  if (by_identity.empty())
    refuse("none of the databases contains a session; nothing was collected");
  std::vector<Station> stations;
  for (auto& [identity, station] : by_identity) stations.push_back(std::move(station));
  std::ranges::sort(stations, record::comes_before, &Station::chain);
  return stations;
}

/// The collected study under construction.
class Collector {
 public:
  Collector(Stations files, record::CollectedDraft draft, CollectReport& report)
      : draft_(std::move(draft)), stations_(distinct_stations(std::move(files), report)) {
    std::vector<record::StationChain> chains;
    for (Station& station : stations_) chains.push_back(std::move(station.chain));
    const record::CollectedChain& chain = draft_.begin(chains);
    places_ = chain.sessions;
    report.stations = static_cast<int>(stations_.size());
    report.sessions = static_cast<int>(places_.size());
    for (const record::SessionPlace& place : chain.left_out) {
      const Station& station = stations_[static_cast<std::size_t>(place.station) - 1];
      report.left_out.push_back(left_out_of(*station.file, place.own_session,
                                            station.chain_state.sessions().at(place.own_session)));
    }
  }

  void add_sessions(const CollectProgress& progress) {
    const int count = static_cast<int>(places_.size());
    for (int session = 1; session <= count; ++session) {
      const record::SessionPlace& place = places_[static_cast<std::size_t>(session) - 1];
      const int own_session = place.own_session;
      StationFile& file = this->file(place.station);
      with_station_name(file.name(), [&] {
        draft_.add_session(session, file.events(own_session), file.wrapped_keys(own_session));
        file.for_each_trace(own_session,
                            [&](int trial, const Bytes& box) { draft_.add_trace(trial, box); });
        draft_.end_traces();
      });
      if (progress) progress(session, count);
    }
  }

  void finish() && { std::move(draft_).finish(); }

 private:
  StationFile& file(int station) { return *stations_[static_cast<std::size_t>(station) - 1].file; }

  record::CollectedDraft draft_;
  std::vector<Station> stations_;
  std::vector<record::SessionPlace> places_;
};

}  // namespace

std::string SessionLeftOut::words() const {
  return one_line(fmt::format(
      "{}: session {} (participant {}) {}", station, session, participant,
      cut_short ? "was replaced or withdrawn before it ended: it cannot be continued, and is "
                  "left out permanently"
                : "has not ended and is left out; run this again when it has"));
}

SessionLeftOut left_out_of(const StationFile& station, int session,
                           const record::SessionOnFile& on_file) {
  return {.station = station.name(),
          .session = session,
          .participant = on_file.opened.participant,
          .cut_short = on_file.is_cut_short()};
}

CollectReport collect_into_file(Stations stations, const std::filesystem::path& target,
                                const CollectProgress& progress) {
  CollectReport report;
  Collector collector(std::move(stations), record::CollectedDraft::in_file(target), report);
  collector.add_sessions(progress);
  std::move(collector).finish();
  return report;
}

}  // namespace touchtrial::merging
