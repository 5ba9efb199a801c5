#include "analysis/verification/head_check.hpp"

#include "core/errors.hpp"
#include "core/text.hpp"
#include "record/damage.hpp"
#include "record/payload_json.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

namespace fs = std::filesystem;

/// By the station's name.
using StationChains = std::multimap<std::string, std::vector<record::Event>>;

void add(std::string& text, const std::string& more) {
  text += (text.empty() ? "" : "; ") + one_line(more);
}

/// The head file of one station's database.
/// \return what the collected study is missing from it; empty: nothing
std::string missing_from_station(const record::HeadReading& reading, const StationChains& chains) {
  const record::HeadRecord& known = reading.record;
  const auto found = std::ranges::find_if(
      chains, [&](const auto& station) { return station.second.front().hash == known.database; });
  if (found == chains.end()) {
    if (known.acknowledged == 0) return {};  // no sessions there yet
    return fmt::format("station {} is missing from the database; its head file {} has {}",
                       known.station, reading.file.string(),
                       counted(known.acknowledged, "acknowledged answer"));
  }
  const auto& [name, chain] = *found;
  const auto length = static_cast<std::size_t>(known.file.length);
  if (length == 0) return {};
  if (length <= chain.size() && chain[length - 1].hash == known.file.hash) return {};
  return fmt::format(
      "station {}'s chain has {} here, but its head file {} has {}: merge its database again", name,
      counted(std::ssize(chain), "event"), reading.file.string(), length);
}

}  // namespace

std::string HeadCheck::fault() const {
  return missing + (missing.empty() || missing_files.empty() ? "" : "; ") + missing_files;
}

std::string HeadCheck::words() const {
  if (!missing.empty()) return "EVENTS ARE MISSING: " + missing;
  if (!confirmed) return missing_files.empty() ? "no head file was compared" : missing_files;
  return fmt::format("up to head {} (event {}, {} acknowledged), by {}{}",
                     record::head_digits(*confirmed), confirmed->file.length,
                     counted(confirmed->acknowledged, "answer"), counted(compared, "head file"),
                     missing_files.empty() ? "" : "; " + missing_files);
}

HeadCheck check_heads(const record::StudyStore& store, const fs::path& database,
                      std::span<const fs::path> given) {
  HeadCheck check;
  try {
    std::vector<record::KnownHead> heads = record::known_heads(store, database);
    std::ptrdiff_t stand_ins = 0;
    for (const fs::path& named : given) {
      const fs::path file = fs::weakly_canonical(named);
      const auto is_same = [&](const record::KnownHead& head) {
        return fs::weakly_canonical(head.file) == file;
      };
      if (std::ranges::any_of(heads, is_same)) continue;
      heads.push_back({file, record::HeadFile(file).reading(head_signers(store.commitment()))});
      if (!heads.back().reading) throw FileError("there is no " + named.string());
      ++stand_ins;
    }
    for (const record::KnownHead& head : heads) {
      if (!head.reading) continue;
      ++check.compared;
      const record::HeadRecord& known = head.reading->record;
      if (!head.reading->damage.empty()) {
        check.notes.push_back(one_line(head.file.string() + ": " + head.reading->damage));
      }
      if (!check.confirmed || known.file.length > check.confirmed->file.length)
        check.confirmed = known;
      const std::vector<record::Loss> missing = record::losses(known, store);
      if (missing.empty()) continue;
      add(check.missing, head.file.string() + ": " + listed(missing, "; ", &record::Loss::what));
    }
    std::erase_if(heads, [](const record::KnownHead& head) { return head.reading.has_value(); });
    // A moved head file is replaced by its copy.
    if (std::ssize(heads) <= stand_ins) return check;
    check.missing_files = listed(
        heads, " and ", [](const record::KnownHead& head) { return one_line(head.file.string()); });
    check.missing_files += heads.size() == 1 ? " is gone" : " are gone";
    check.missing_files +=
        ", but the database refers to it; restore it, or give `touchtrial verify` a copy with "
        "--head-file or the last head with --head";
  } catch (const record::DamagedStore&) {
    throw;
  } catch (const Error& error) {
    // A damaged chain cannot list the head files.
    add(check.missing, error.what());
  }
  return check;
}

StationsCheck check_stations(const record::StudyStore& store,
                             const std::map<std::string, PublicKey>& signers,
                             std::span<const fs::path> given) {
  StationsCheck check;
  StationChains chains;
  std::vector<PublicKey> trusted = {store.commitment().investigator};
  for (int station = 1; station <= store.stations(); ++station) {
    std::vector<record::Event> chain = store.station_chain(station);
    const auto identity = record::body_of<record::StudyCommitment>(chain.front()).station;
    chains.emplace(identity ? identity->name : std::to_string(station), std::move(chain));
  }
  for (const auto& [name, signer] : signers) trusted.push_back(signer);
  std::set<std::string> confirmed;
  for (const fs::path& file : given) {
    try {
      const auto reading = record::HeadFile(file).reading(trusted);
      if (!reading) throw FileError("there is no " + file.string());
      confirmed.insert(reading->record.station);
      if (const std::string lack = missing_from_station(*reading, chains); !lack.empty()) {
        add(check.missing, lack);
      }
    } catch (const FileError& error) {
      add(check.missing, error.what());
    }
  }
  for (const auto& [name, signer] : signers) {
    if (confirmed.contains(name)) continue;
    const auto found = chains.find(name);
    if (found == chains.end()) {
      add(check.absent, "station " + name);
      continue;
    }
    add(check.ends, fmt::format("station {} with event {} (head {})", name, found->second.size(),
                                in_fours(to_hex(found->second.back().hash).substr(0, 16))));
  }
  return check;
}

}  // namespace touchtrial::analysis
