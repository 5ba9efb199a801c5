#include "protocols/collect/collect.hpp"

#include "protocols/store/collected_draft.hpp"
#include "protocols/store/damage.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::collect {
namespace {

/// A station and the chain that was read from it, in order.
struct Station {
  store::StationChain chain;
  store::FileChain says;  ///< what the chain says
  std::unique_ptr<StationFile> file;
};

[[noreturn]] void refuse(const std::string& text) {
  throw StoreError(one_line(text));
}

/// Calls `work`; faults of the station come out as DamagedStore with its name.
template <typename Work>
void named(const std::string& station, Work&& work) {
  try {
    work();
  } catch (const store::EventFault& fault) {
    throw store::DamagedStore(one_line(
        fmt::format("{}: {}; restore it from a backup, or leave it out", station, fault.what())));
  }
}

Station read_station(std::unique_ptr<StationFile> file) {
  Station station;
  station.chain = {.name = file->name(), .events = file->file_chain()};
  named(station.chain.name,
        [&] { station.says = store::checked_file_chain(station.chain.events); });
  station.file = std::move(file);
  return station;
}

/// The session that an event of a file chain opens, or its kind, in words.
std::string about(const store::Event& event) {
  if (event.kind == store::EventKind::session_opened) {
    const store::SessionOpenedBody body = store::session_opened_from_json(event.body);
    return fmt::format(" (session {}, participant {})", body.session, body.participant);
  }
  return fmt::format(" ({})", store::name_of(event.kind));
}

/// Keeps the copy of a station's file that went further.
/// \throws StoreError if each went on by itself
void keep_further(Station& kept, Station& other, CollectReport& report) {
  const std::vector<store::Event>& a = kept.chain.events;
  const std::vector<store::Event>& b = other.chain.events;
  const auto same = [](const store::Event& x, const store::Event& y) { return x.hash == y.hash; };
  const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end(), same);
  if (in_a != a.end() && in_b != b.end()) {
    refuse(fmt::format(
        "{} and {} are copies of one station's file, and each went on by itself: they part at "
        "event {} of the file's chain{}{}; leave out the one that the station did not go on with",
        kept.chain.name, other.chain.name, in_a->sequence, about(*in_a), about(*in_b)));
  }
  if (in_a == a.end() && in_b != b.end()) std::swap(kept, other);
  report.superfluous.push_back(other.chain.name);
}

/// Each station once, in their order.
std::vector<Station> distinct(Stations files, CollectReport& report) {
  std::map<Digest, Station> by_identity;
  for (std::unique_ptr<StationFile>& file : files) {
    Station station = read_station(std::move(file));
    const auto identity = store::station_identity(station.chain.events);
    if (!identity) {
      report.superfluous.push_back(station.chain.name);
      continue;
    }
    const auto [place, is_new] = by_identity.try_emplace(*identity);
    if (is_new) {
      place->second = std::move(station);
    } else {
      keep_further(place->second, station, report);
    }
  }
  if (by_identity.empty()) refuse("none of the databases holds a session; nothing is collected");
  std::vector<Station> stations;
  for (auto& [identity, station] : by_identity) stations.push_back(std::move(station));
  std::ranges::sort(stations, store::comes_before, &Station::chain);
  return stations;
}

/// The collected study while its sessions come in.
class Collecting {
 public:
  Collecting(Stations files, store::CollectedDraft draft, CollectReport& report)
      : draft_(std::move(draft)), stations_(distinct(std::move(files), report)) {
    std::vector<store::StationChain> chains;
    for (Station& station : stations_) chains.push_back(std::move(station.chain));
    const store::CollectedChain& chain = draft_.begin(chains);
    places_ = chain.sessions;
    report.stations = static_cast<int>(stations_.size());
    report.sessions = static_cast<int>(places_.size());
    for (const store::SessionPlace& place : chain.left_out) {
      report.left_out.push_back(left_out(place));
    }
  }

  void take_sessions(TraceUse traces, const CollectProgress& progress) {
    const int count = static_cast<int>(places_.size());
    for (int session = 1; session <= count; ++session) {
      const store::SessionPlace& place = places_[static_cast<std::size_t>(session) - 1];
      const int own = place.own_session;
      StationFile& file = this->file(place.station);
      named(file.name(), [&] {
        draft_.add_session(session, file.events(own), file.wrapped_keys(own));
        if (traces == TraceUse::fetched) return;
        file.for_each_trace(own,
                            [&](int trial, const Bytes& box) { draft_.add_trace(trial, box); });
        draft_.end_traces();
      });
      if (progress) progress(session, count);
    }
  }

  store::StudyStore finished(TraceUse traces) && {
    if (traces == TraceUse::copied) return std::move(draft_).finished();
    // A station may be asked from one thread at a time, and so may StudyStore.
    const auto files = std::make_shared<std::vector<Station>>(std::move(stations_));
    return std::move(draft_).finished(
        [files, places = std::move(places_)](int session,
                                             int trial) -> std::optional<store::SealedTrace> {
          if (session < 1 || session > static_cast<int>(places.size())) return std::nullopt;
          const auto& [station, own] = places[static_cast<std::size_t>(session) - 1];
          std::optional<Bytes> box =
              (*files)[static_cast<std::size_t>(station) - 1].file->trace(own, trial);
          if (!box) return std::nullopt;
          return store::SealedTrace{.session = own, .trial = trial, .box = *std::move(box)};
        });
  }

 private:
  StationFile& file(int station) { return *stations_[static_cast<std::size_t>(station) - 1].file; }

  [[nodiscard]] SessionLeftOut left_out(const store::SessionPlace& place) const {
    const Station& station = stations_[static_cast<std::size_t>(place.station) - 1];
    const store::SessionOnFile& session = station.says.sessions().at(place.own_session);
    return {.station = station.file->name(),
            .session = place.own_session,
            .participant = session.opened.participant,
            .cut_short = session.is_cut_short()};
  }

  store::CollectedDraft draft_;
  std::vector<Station> stations_;
  std::vector<store::SessionPlace> places_;
};

store::StudyStore collected(Stations files, store::CollectedDraft draft, TraceUse traces,
                            CollectReport& report, const CollectProgress& progress) {
  Collecting collecting(std::move(files), std::move(draft), report);
  collecting.take_sessions(traces, progress);
  return std::move(collecting).finished(traces);
}

}  // namespace

CollectReport collect_into_file(Stations stations, const std::filesystem::path& target,
                                const CollectProgress& progress) {
  CollectReport report;
  static_cast<void>(collected(std::move(stations), store::CollectedDraft::in_file(target),
                              TraceUse::copied, report, progress));
  return report;
}

store::StudyStore collected_for_reading(Stations stations, const std::string& name, TraceUse traces,
                                        CollectReport* report, const CollectProgress& progress) {
  CollectReport unread;
  return collected(std::move(stations), store::CollectedDraft::temporary(name), traces,
                   report == nullptr ? unread : *report, progress);
}

store::StudyStore open_study(const std::string& where, TraceUse traces) {
  if (!is_address(where)) {
    return store::StudyStore::open(where, store::StudyStore::Access::read_only);
  }
  const ServerAddress address(where);
  if (traces == TraceUse::fetched) {
    return collected_for_reading(stations_of_server(address), address.shown(), traces);
  }
  // A reader who wants all of it also wants the derived tables checked.
  DerivedTables derived;
  store::StudyStore study =
      collected_for_reading(stations_of_server(address, &derived), address.shown(), traces);
  derived(study);
  return study;
}

std::string study_name(const std::string& where) {
  if (is_address(where)) return ServerAddress(where).shown();
  return std::filesystem::path(where).filename().string();
}

}  // namespace touchtrial::collect
