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

/// A part of a file chain up to the end of a session, or from the last such end on.
struct Part {
  BundleRow row;
  std::optional<int> session;
};

/// They depend only on the chain, so that every call sends the same ones.
std::vector<Part> parts_of(StationFile& station, const Chain& chain,
                           const record::FileChain& says) {
  std::map<std::size_t, std::optional<int>> ends;  // sessions, by the place after their ends
  ends[chain.size()] = std::nullopt;
  for (const auto& [session, course] : says.sessions()) {
    if (course.closed_at) ends[static_cast<std::size_t>(*course.closed_at) + 1] = session;
  }
  std::vector<Part> parts;
  std::int64_t first = 0;
  for (const auto& [end, session] : ends) {
    Part part{.row = {.station = *record::station_identity(chain), .seal = says.commitment()->seal},
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
    return "is of another study, or of this one under another key; make a database for each study, "
           "or ask the table's owner to delete that row";
  }
  const bool is_known = row.end > 0 && row.end <= last.end &&
                        chain[static_cast<std::size_t>(row.end) - 1].hash == row.head;
  if (row.station != last.station || is_known) return "";
  return "ends with an event that this file lacks: it is an older copy, was rolled back, or two "
         "copies were continued separately; record nothing in it, and sync the file that the "
         "station continues to use, to a new database if both were sent from";
}

/// The parts that the table lacks. A part whose keys were destroyed since is sent again without
/// them.
std::vector<Part> missing_parts(std::vector<Part> parts, const std::vector<BundleRow>& rows,
                                SendReport& report) {
  std::erase_if(parts, [&](const Part& part) {
    bool is_there = false;
    for (const BundleRow& row : rows) {
      if (!row.is_part(part.row)) continue;
      is_there = is_there || row.keys == part.row.keys;
      if (row.keys > part.row.keys) report.rows_with_erased_keys.push_back(row.number);
    }
    if (is_there && part.session) ++report.already_there;
    return is_there;
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
    session = packed(half);
    if (session.size() > kMaxBundleBytes) {
      throw StoreError(fmt::format("{}: session {} is larger than 128 MiB; merge this file instead",
                                   one_line(station.name()), *part.session));
    }
  }
  table.add(part.row, packed(events), session);
}

}  // namespace

SendReport send_station(StationFile& station, BundleTable& table, bool dry_run,
                        const CollectProgress& progress) {
  SendReport report;
  const Chain chain = station.file_chain();
  record::FileChain says;
  for (const record::Event& event : chain) says.add(event);
  for (const auto& [session, course] : says.sessions()) {
    if (!course.closed) report.left_out.push_back(left_out_of(station, session, course));
  }
  if (!record::station_identity(chain)) return report;  // no session was ever opened
  std::vector<Part> parts = parts_of(station, chain, says);
  const std::vector<BundleRow> rows = table.rows();
  for (const BundleRow& row : rows) {
    const std::string what = fault_of_row(row, chain, parts.back().row);
    if (what.empty()) continue;
    throw StoreError(
        fmt::format("{}: {}: {} {}", one_line(station.name()), table.shown(), row.name(), what));
  }
  parts = missing_parts(std::move(parts), rows, report);
  int sent = 0;
  for (const Part& part : parts) {
    if (!dry_run) send(station, chain, part, table);
    if (part.session) report.sent.push_back(says.sessions().at(*part.session).opened.participant);
    if (progress) progress(++sent, static_cast<int>(parts.size()));
  }
  return report;
}

}  // namespace touchtrial::merging
