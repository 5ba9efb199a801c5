#include "analysis/exports/bids/bids_traces.hpp"

#include "analysis/exports/bids/bids_sidecars_json.hpp"
#include "analysis/exports/gzip.hpp"
#include "analysis/sealed_sessions.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Shared by the recordings that are written at the same time.
struct SharedReading {
  std::map<int, SecretKey> keys;  ///< by session
  std::mutex store;               ///< held by the one thread that reads the store
};

store::Trace opened_trace(const DatasetSource& study, const store::TrialRow& row,
                          SharedReading& shared) {
  const auto box = [&] {
    const std::lock_guard lock(shared.store);
    return study.store.sealed_trace(row.session, row.trial);
  }();
  if (box) {
    auto trace = store::unsealed_trace(*box, shared.keys.at(row.session),
                                       static_cast<std::size_t>(row.samples));
    if (trace) return *std::move(trace);
  }
  throw VerificationError(fmt::format(
      "session {}, trial {}: its trace is missing or does not open; run `touchtrial verify` and "
      "restore the database from a backup",
      row.session, row.trial));
}

/// Appends a value with kDecimals decimals, and the character after it. Counting in whole steps is
/// several times faster than general formatting of doubles, and never gives -0.000.
template <int kDecimals>
void put_fixed(std::string& text, double value, char after) {
  constexpr std::int64_t kSteps = kDecimals == 3 ? 1000 : 10'000;
  static_assert(kDecimals == 3 || kDecimals == 4);
  const std::int64_t steps = std::llround(value * static_cast<double>(kSteps));
  const std::int64_t size = std::abs(steps);
  if (steps < 0) text += '-';
  const fmt::format_int whole(size / kSteps);
  text.append(whole.data(), whole.size());
  text += '.';
  std::int64_t rest = size % kSteps;
  for (std::int64_t place = kSteps / 10; place > 0; rest %= place, place /= 10) {
    text += static_cast<char>('0' + rest / place);
  }
  text += after;
}

}  // namespace

const std::vector<std::string>& trace_columns() {
  static const std::vector<std::string> kColumns{"x_mm",      "y_mm",      "z_mm",
                                                 "force_x_n", "force_y_n", "force_z_n"};
  return kColumns;
}

std::string trace_text(const store::Trace& trace) {
  std::string text;
  text.reserve(trace.samples.size() * 50);
  for (const store::TraceSample& sample : trace.samples) {
    const Vec3& at = sample.position_mm;
    const Vec3& force = sample.force_n;
    for (const double position_mm : {at.x, at.y, at.z}) put_fixed<3>(text, position_mm, '\t');
    for (const double force_n : {force.x, force.y}) put_fixed<4>(text, force_n, '\t');
    put_fixed<4>(text, force.z, '\n');
  }
  return text;
}

std::vector<ExportFile> trace_files(const DatasetSource& study,
                                    const std::vector<BidsSession>& sessions,
                                    const std::string& task) {
  const auto shared = std::make_shared<SharedReading>();
  shared->keys = participant_keys(study.store, *study.key);
  std::map<int, const BidsSession*> by_number;
  for (const BidsSession& session : sessions) by_number[session.row.session] = &session;
  std::vector<ExportFile> files;
  for (const store::TrialRow& row : study.store.trials()) {
    const auto session = by_number.find(row.session);
    if (session == by_number.end() || row.samples == 0) continue;
    const std::string name =
        fmt::format("{}/{}_task-{}_recording-trial{:03}_stim", session->second->folder(),
                    session->second->stem(), task, row.trial);
    files.push_back({name + ".tsv.gz",
                     [study, row, shared](const std::filesystem::path& path) {
                       const store::Trace trace = opened_trace(study, row, *shared);
                       replace_file(path, ByteView(gzip(trace_text(trace))));
                     },
                     true});
    files.push_back(
        text_file(name + ".json", trace_sidecar_json(row, session->second->row.simulated)));
  }
  return files;
}

}  // namespace touchtrial::analysis
