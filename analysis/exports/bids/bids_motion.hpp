/// \file Positions and forces of trials as BIDS Motion data: one run per trial. Private to exports.
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
  std::vector<std::int64_t> samples;        ///< number of samples of each exploration
  /// The start of each exploration since the first sample; empty: not recorded.
  std::vector<std::optional<std::chrono::nanoseconds>> starts;
};

/// \param row  the opened trial
/// \param body  of the trial's opened `trace-stored` event
[[nodiscard]] Recording recording_of(const record::TrialRow& row, const record::TraceBody& body);

/// *_channels.tsv: the channels of every recording, in the order of motion_text's columns.
[[nodiscard]] DataTable motion_channels();

/// One row per sample, without a header. Latencies have six decimals, millimetres three and newtons
/// four, which preserves the resolution of traces (1 um and 1/4096 N).
[[nodiscard]] std::string motion_text(const record::Trace& trace, const Recording& recording);

/// The path of a trial's recording in its session's folder, as in *_scans.tsv.
[[nodiscard]] std::string motion_file(const BidsSession& session, const std::string& task,
                                      int trial);

/// The columns of a run's events.
[[nodiscard]] const std::vector<std::string>& motion_event_columns();

/// Recording, JSON and events of every trial with a trace, the scans of every session, and the
/// descriptions common to all recordings. Each trace is opened when its file is written, several at
/// a time.
/// \param study  unblinded, with its key
[[nodiscard]] std::vector<ExportFile> motion_files(const DatasetSource& study,
                                                   const DatasetOptions& options,
                                                   const std::vector<BidsSession>& sessions,
                                                   const std::string& task);

}  // namespace touchtrial::analysis
