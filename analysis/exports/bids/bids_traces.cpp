#include "analysis/exports/bids/bids_traces.hpp"

#include "analysis/exports/bids/bids_sidecars_json.hpp"
#include "analysis/exports/gzip.hpp"
#include "analysis/sealed_sessions.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"

#include <cmath>
#include <iterator>
#include <map>
#include <memory>

#include <fmt/format.h>

namespace touchtrial {
namespace {

Trace opened_trace(const DatasetSource& study, const TrialRow& row, const SecretKey& own) {
  const auto box = study.store.sealed_trace(row.session, row.trial);
  if (box) {
    auto trace =
        unsealed_trace(row.session, row.trial, *box, own, static_cast<std::size_t>(row.samples));
    if (trace) return *std::move(trace);
  }
  throw VerificationError(fmt::format(
      "session {}, trial {}: its trace is missing or does not open; run `touchtrial verify` and "
      "restore the database from a backup",
      row.session, row.trial));
}

/// Rounded as it will be printed, so that nothing is printed as -0.000.
double rounded(double value, double steps) {
  return std::round(value * steps) / steps + 0.0;
}

}  // namespace

const std::vector<std::string>& trace_columns() {
  static const std::vector<std::string> kColumns{"x_mm",      "y_mm",      "z_mm",
                                                 "force_x_n", "force_y_n", "force_z_n"};
  return kColumns;
}

std::string trace_text(const Trace& trace) {
  std::string text;
  text.reserve(trace.samples.size() * 50);
  for (const TraceSample& sample : trace.samples) {
    const Vec3& at = sample.position_mm;
    const Vec3& force = sample.force_n;
    fmt::format_to(std::back_inserter(text), "{:.3f}\t{:.3f}\t{:.3f}\t{:.5f}\t{:.5f}\t{:.5f}\n",
                   rounded(at.x, 1e3), rounded(at.y, 1e3), rounded(at.z, 1e3),
                   rounded(force.x, 1e5), rounded(force.y, 1e5), rounded(force.z, 1e5));
  }
  return text;
}

std::vector<ExportFile> trace_files(const DatasetSource& study,
                                    const std::vector<BidsSession>& sessions,
                                    const std::string& task) {
  const auto keys =
      std::make_shared<std::map<int, SecretKey>>(participant_keys(study.store, *study.key));
  std::map<int, const BidsSession*> by_number;
  for (const BidsSession& session : sessions) by_number[session.row.session] = &session;
  std::vector<ExportFile> files;
  for (const TrialRow& row : study.store.trials()) {
    const auto session = by_number.find(row.session);
    if (session == by_number.end() || row.samples == 0) continue;
    const std::string name =
        fmt::format("{}/{}_task-{}_recording-trial{:03}_stim", session->second->folder(),
                    session->second->stem(), task, row.trial);
    files.push_back({name + ".tsv.gz", [study, row, keys](const std::filesystem::path& path) {
                       const Trace trace = opened_trace(study, row, keys->at(row.session));
                       replace_file(path, ByteView(gzip(trace_text(trace))));
                     }});
    files.push_back(
        text_file(name + ".json", trace_sidecar_json(row, session->second->row.simulated)));
  }
  return files;
}

}  // namespace touchtrial
