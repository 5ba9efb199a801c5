#include "record/collected_chain.hpp"
#include "record/file_chain.hpp"
#include "record/merging/bundle.hpp"
#include "record/merging/bundle_table.hpp"

#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::merging {
namespace {

using Chain = std::vector<record::Event>;

/// A part of a file chain, up to the end of a session or of the chain.
struct Part {
  BundleRow row;
  std::optional<int> session;  ///< the session whose end is the part's end; empty: none
};

/// The parts depend only on the chain, so that every call sends the same ones.
std::vector<Part> parts_of(StationFile& station, const Chain& chain,
                           const record::FileChain& chain_state) {
  std::map<std::size_t, std::optional<int>> ends;  // sessions by the sequence after their ends
  ends[chain.size()] = std::nullopt;
  for (const auto& [session, on_file] : chain_state.sessions()) {
    if (on_file.closed_at) ends[static_cast<std::size_t>(*on_file.closed_at) + 1] = session;
  }
  std::vector<Part> parts;
  std::int64_t first = 0;
  for (const auto& [end, session] : ends) {
    Part part{.row = {.station = *record::station_identity(chain),
                      .seal = chain_state.commitment()->seal},
              .session = session};
    part.row.end = static_cast<std::int64_t>(end);
    part.row.first = std::exchange(first, part.row.end);
    part.row.head = chain[end - 1].hash;
    if (session) {
      const record::WrappedKeys keys = station.wrapped_keys(*session);
      part.row.keys = keys.participant.has_value() + keys.safety.has_value();
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

/// \param last  the station's last part
/// \return the fault of a row; empty if it has none
std::string fault_of_row(const BundleRow& row, const Chain& chain, const BundleRow& last) {
  if (row.seal != last.seal) {
    return "belongs to another study, or to this one with another key; create a database for each "
           "study, or ask the table's owner to delete that row";
  }
  const bool is_in_chain = row.end > 0 && row.end <= last.end &&
                           chain[static_cast<std::size_t>(row.end) - 1].hash == row.head;
  if (row.station != last.station || is_in_chain) return "";
  return "ends with an event that this file lacks: it is an older copy, was rolled back, or two "
         "copies were continued separately; do not record in it, and sync the file that the "
         "station still uses, to a new database if both were synced";
}

/// The parts that the table lacks. A part is sent again if its keys have been destroyed since.
std::vector<Part> missing_parts(std::vector<Part> parts, const std::vector<BundleRow>& rows,
                                SendReport& report) {
  std::erase_if(parts, [&](const Part& part) {
    bool is_sent = false;
    for (const BundleRow& row : rows) {
      if (!row.is_same_part(part.row)) continue;
      is_sent = is_sent || row.keys == part.row.keys;
      if (row.keys > part.row.keys) report.rows_with_erased_keys.push_back(row.number);
    }
    if (is_sent && part.session) ++report.already_there;
    return is_sent;
  });
  return parts;
}

void send(StationFile& station, const Chain& chain, const Part& part, BundleTable& table) {
  const BundleHalf events{{chain.begin() + part.row.first, chain.begin() + part.row.end}};
  Bytes session;
  if (part.session) {
    BundleHalf half{station.events(*part.session), station.wrapped_keys(*part.session)};
    station.for_each_trace(
        *part.session, [&](int trial, const Bytes& box) { half.traces.emplace_back(trial, box); });
    session = pack_bundle(half);
    if (session.size() > kMaxBundleBytes) {
      throw StoreError(fmt::format("{}: session {} is larger than 128 MiB; merge this file instead",
                                   one_line(station.name()), *part.session));
    }
  }
  table.add(part.row, pack_bundle(events), session);
}

}  // namespace

SendReport send_station(StationFile& station, BundleTable& table, bool dry_run,
                        const CollectProgress& progress) {
  SendReport report;
  const Chain chain = station.file_chain();
  record::FileChain chain_state;
  for (const record::Event& event : chain) chain_state.add(event);
  for (const auto& [session, on_file] : chain_state.sessions()) {
    if (!on_file.closed) report.left_out.push_back(left_out_of(station, session, on_file));
  }
  if (!record::station_identity(chain)) return report;  // no session was ever opened
  std::vector<Part> parts = parts_of(station, chain, chain_state);
  const std::vector<BundleRow> rows = table.rows();
  for (const BundleRow& row : rows) {
    const std::string fault = fault_of_row(row, chain, parts.back().row);
    if (fault.empty()) continue;
    throw StoreError(
        fmt::format("{}: {}: {} {}", one_line(station.name()), table.address(), row.name(), fault));
  }
  parts = missing_parts(std::move(parts), rows, report);
  int sent = 0;
  for (const Part& part : parts) {
    if (!dry_run) send(station, chain, part, table);
    if (part.session)
      report.sent.push_back(chain_state.sessions().at(*part.session).opened.participant);
    if (progress) progress(++sent, static_cast<int>(parts.size()));
  }
  return report;
}

}  // namespace touchtrial::merging
