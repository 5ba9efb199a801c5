#include "analysis/exports/bids/bids_traces.hpp"

#include "analysis/exports/bids/bids_sidecars_json.hpp"
#include "analysis/sealed_sessions.hpp"
#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>

#include <fmt/format.h>
#include <zlib.h>

namespace touchtrial::analysis {
namespace {

/// Shared by the recordings that are written at the same time.
struct SharedReading {
  SessionKeys keys;
  std::mutex store;  ///< held by the one thread that reads the store
};

store::Trace opened_trace(const DatasetSource& study, const store::TrialRow& row,
                          SharedReading& shared) {
  const auto box = [&] {
    const std::lock_guard lock(shared.store);
    return study.store.sealed_trace(row.session, row.trial);
  }();
  return open_trace(box, row, shared.keys);
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

// On traces, level 6 gives 4 % less output but takes two and a half times as long.
constexpr int kLevel = 4;
constexpr int kGzipWindow = 15 + 16;  ///< the largest, with a gzip header (zlib.h, deflateInit2)
constexpr int kMemoryLevel = 8;

/// Ends the stream on every path, exceptions included.
struct Deflate {
  Deflate() {
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, kGzipWindow, kMemoryLevel, Z_DEFAULT_STRATEGY) !=
        Z_OK) {
      throw FileError("a file cannot be compressed: there is not enough memory; close programs");
    }
  }
  ~Deflate() { deflateEnd(&stream); }
  Deflate(const Deflate&) = delete;
  Deflate& operator=(const Deflate&) = delete;

  z_stream stream{};
};

/// Compresses at level 4 in the format of RFC 1952. The header has no name and no time, so that
/// equal contents give equal bytes.
/// \throws FileError if there is not enough memory
Bytes gzip(std::string_view content) {
  Deflate deflating;
  z_stream& stream = deflating.stream;
  Bytes packed(deflateBound(&stream, static_cast<uLong>(content.size())));
  // zlib does not write to its input.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = packed.data();
  stream.avail_out = static_cast<uInt>(packed.size());
  if (content.size() > 0xffff'ffffU || packed.size() > 0xffff'ffffU ||
      deflate(&stream, Z_FINISH) != Z_STREAM_END) {
    throw FileError("a file cannot be compressed: it has more than 4 GB; export without traces");
  }
  packed.resize(stream.total_out);
  return packed;
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
  shared->keys = person_keys(study.store, *study.key);
  std::map<int, const BidsSession*> by_number;
  for (const BidsSession& session : sessions) by_number[session.row.session] = &session;
  std::vector<ExportFile> files;
  for (const store::TrialRow& row : open_trials(study.store, shared->keys)) {
    const auto session = by_number.find(row.session);
    if (session == by_number.end() || !row.has_trace()) continue;
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
