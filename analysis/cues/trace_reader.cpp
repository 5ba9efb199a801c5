#include "analysis/cues/trace_reader.hpp"

#include "analysis/cues/jobs.hpp"
#include "analysis/sealed_sessions.hpp"
#include "core/errors.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kBatch = 64;

struct WaitingTrace {
  std::size_t place = 0;
  const store::TrialRow* row = nullptr;
  const SecretKey* own = nullptr;
  store::SealedTrace box;
  std::string fault;  ///< why it did not open; empty: it did
};

std::string refusal(const store::TrialRow& row, const std::string& why) {
  return fmt::format(
      "session {}, trial {}: the trace {}; run `touchtrial verify` and restore the "
      "database from a backup",
      row.session, row.trial, why);
}

/// Errors are kept and not thrown, so that the first trial's is told, whichever thread met one
/// first.
void open_and_visit(WaitingTrace& sealed, const TraceVisitor& visit) {
  try {
    const std::optional<store::Trace> trace = store::unsealed_trace(
        sealed.box, *sealed.own, static_cast<std::size_t>(sealed.row->samples));
    if (trace) {
      visit(sealed.place, *trace);
    } else {
      sealed.fault = "does not open";
    }
  } catch (const StoreError& error) {
    sealed.fault = fmt::format("does not decode ({})", error.what());
  }
}

void visit_batch(std::vector<WaitingTrace>& batch, int jobs, const TraceVisitor& visit) {
  in_parallel(jobs, batch.size(), [&](std::size_t i) { open_and_visit(batch[i], visit); });
  for (const WaitingTrace& sealed : batch) {
    if (!sealed.fault.empty()) throw VerificationError(refusal(*sealed.row, sealed.fault));
  }
  batch.clear();
}

}  // namespace

std::vector<std::size_t> visit_traces(const store::StudyStore& store, const design::StudyKey& key,
                                      std::span<const TrialOutcome* const> trials, int jobs,
                                      const TraceVisitor& visit, const TraceProgress& progress) {
  const std::map<int, SecretKey> keys = participant_keys(store, key);
  std::vector<std::size_t> missing;
  std::vector<WaitingTrace> batch;
  for (std::size_t place = 0; place < trials.size(); ++place) {
    const store::TrialRow& row = trials[place]->row;
    std::optional<store::SealedTrace> box = store.sealed_trace(row.session, row.trial);
    const auto own = keys.find(row.session);
    if (!box || own == keys.end()) {
      missing.push_back(place);
      continue;
    }
    batch.push_back({place, &row, &own->second, *std::move(box), {}});
    if (batch.size() < kBatch) continue;
    visit_batch(batch, jobs, visit);
    if (progress) progress(static_cast<int>(place), static_cast<int>(trials.size()));
  }
  visit_batch(batch, jobs, visit);
  if (progress) progress(static_cast<int>(trials.size()), static_cast<int>(trials.size()));
  return missing;
}

}  // namespace touchtrial::analysis
