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

using StationChains = std::multimap<std::string, std::vector<record::Event>>;

void append_fault(std::string& text, const std::string& more) {
  text += (text.empty() ? "" : "; ") + one_line(more);
}

/// Compares the head file of one station's database with the collected chains.
/// \return what the collected study is missing; empty: nothing
std::string missing_from_station(const record::HeadReading& reading, const StationChains& chains) {
  const record::HeadRecord& head_record = reading.record;
  const auto found = std::ranges::find_if(chains, [&](const auto& station) {
    return station.second.front().hash == head_record.database;
  });
  if (found == chains.end()) {
    if (head_record.acknowledged == 0) return {};  // no sessions there yet
    return fmt::format("station {} is missing from the database; its head file {} has {}",
                       head_record.station, reading.file.string(),
                       counted(head_record.acknowledged, "acknowledged answer"));
  }
  const auto& [name, chain] = *found;
  const auto length = static_cast<std::size_t>(head_record.file.length);
  if (length == 0) return {};
  if (length <= chain.size() && chain[length - 1].hash == head_record.file.hash) return {};
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
                      std::span<const fs::path> extra_heads) {
  HeadCheck check;
  try {
    std::vector<record::ExpectedHead> heads = record::expected_heads(store, database);
    std::ptrdiff_t copies = 0;
    for (const fs::path& path : extra_heads) {
      const fs::path file = fs::weakly_canonical(path);
      const auto is_same = [&](const record::ExpectedHead& head) {
        return fs::weakly_canonical(head.file) == file;
      };
      if (std::ranges::any_of(heads, is_same)) continue;
      heads.push_back({file, record::HeadFile(file).reading(head_signers(store.commitment()))});
      if (!heads.back().reading) throw FileError("there is no " + path.string());
      ++copies;
    }
    for (const record::ExpectedHead& head : heads) {
      if (!head.reading) continue;
      ++check.compared;
      const record::HeadRecord& head_record = head.reading->record;
      if (!head.reading->damage.empty()) {
        check.notes.push_back(one_line(head.file.string() + ": " + head.reading->damage));
      }
      if (!check.confirmed || head_record.file.length > check.confirmed->file.length)
        check.confirmed = head_record;
      const std::vector<record::Loss> missing = record::losses(head_record, store);
      if (missing.empty()) continue;
      append_fault(check.missing,
                   head.file.string() + ": " + listed(missing, "; ", &record::Loss::what));
    }
    std::erase_if(heads, [](const record::ExpectedHead& head) { return head.reading.has_value(); });
    // Each extra file replaces one missing head file.
    if (std::ssize(heads) <= copies) return check;
    check.missing_files = listed(heads, " and ", [](const record::ExpectedHead& head) {
      return one_line(head.file.string());
    });
    check.missing_files += heads.size() == 1 ? " is gone" : " are gone";
    check.missing_files +=
        ", but the database refers to it; restore it, or give `touchtrial verify` a copy with "
        "--head-file or the last head with --head";
  } catch (const record::DamagedStore&) {
    throw;
  } catch (const Error& error) {
    // For instance, a damaged chain does not list its head files.
    append_fault(check.missing, error.what());
  }
  return check;
}

StationsCheck check_stations(const record::StudyStore& store,
                             const std::map<std::string, PublicKey>& signers,
                             std::span<const fs::path> extra_heads) {
  StationsCheck check;
  StationChains chains;
  std::vector<PublicKey> trusted_signers = {store.commitment().investigator};
  for (int station = 1; station <= store.stations(); ++station) {
    std::vector<record::Event> chain = store.station_chain(station);
    const auto identity = record::body_of<record::StudyCommitment>(chain.front()).station;
    chains.emplace(identity ? identity->name : std::to_string(station), std::move(chain));
  }
  for (const auto& [name, signer] : signers) trusted_signers.push_back(signer);
  std::set<std::string> confirmed_stations;
  for (const fs::path& file : extra_heads) {
    try {
      const auto reading = record::HeadFile(file).reading(trusted_signers);
      if (!reading) throw FileError("there is no " + file.string());
      confirmed_stations.insert(reading->record.station);
      if (const std::string missing = missing_from_station(*reading, chains); !missing.empty()) {
        append_fault(check.missing, missing);
      }
    } catch (const FileError& error) {
      append_fault(check.missing, error.what());
    }
  }
  for (const auto& [name, signer] : signers) {
    if (confirmed_stations.contains(name)) continue;
    const auto found = chains.find(name);
    if (found == chains.end()) {
      append_fault(check.absent, "station " + name);
      continue;
    }
    append_fault(check.unchecked_ends,
                 fmt::format("station {} with event {} (head {})", name, found->second.size(),
                             in_groups_of_four(to_hex(found->second.back().hash).substr(0, 16))));
  }
  return check;
}

}  // namespace touchtrial::analysis
