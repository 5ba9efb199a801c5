/// \file Positions and forces of trials as BIDS Motion data: one run a trial. Private to exports.
/// Source: BIDS specification 1.11, "Motion"; docs/exports.md, "Motion".
#pragma once

#include "analysis/exports/bids/bids_people.hpp"
#include "analysis/exports/data_table.hpp"
#include "analysis/exports/export_folder.hpp"
#include "record/session_bodies.hpp"
#include "record/trace.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The explorations of a trial within its recording.
struct Recording {
  double rate_hz = 1000.0;
  std::chrono::nanoseconds first_sample{};  ///< since the session's opening
  std::vector<std::int64_t> samples;        ///< of each exploration
  /// The start of each, since the first sample; empty: not recorded.
  std::vector<std::optional<std::chrono::nanoseconds>> began;
};

/// \param row  opened
/// \param body  of its `trace-stored`, opened
[[nodiscard]] Recording recording_of(const record::TrialRow& row, const record::TraceBody& body);

/// The channels of every recording, in the order of the columns of motion_text: *_channels.tsv.
[[nodiscard]] DataTable motion_channels();

/// One row a sample, without a header. Latencies have six decimals, millimetres three and newtons
/// four, which keeps apart all steps that a trace stores (1 um and 1/4096 N).
[[nodiscard]] std::string motion_text(const record::Trace& trace, const Recording& recording);

/// The recording of a trial, below the folder of its session, as in *_scans.tsv.
[[nodiscard]] std::string motion_file(const BidsSession& session, const std::string& task,
                                      int trial);

/// The columns of the events of a run.
[[nodiscard]] const std::vector<std::string>& motion_event_columns();

/// Recording, JSON and events of every trial with a trace, the scans of every session, and what
/// all recordings share. Each trace is opened when its file is written, several at a time.
/// \param study  unblinded, with its key
[[nodiscard]] std::vector<ExportFile> motion_files(const DatasetSource& study,
                                                   const DatasetOptions& options,
                                                   const std::vector<BidsSession>& sessions,
                                                   const std::string& task);

}  // namespace touchtrial::analysis
