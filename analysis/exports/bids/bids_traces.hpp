/// \file Positions and forces of trials as BIDS stimulus recordings. Private to exports.
/// Source: BIDS specification 1.10, "Physiological and other continuous recordings".
#pragma once

#include "analysis/exports/bids/bids_people.hpp"
#include "analysis/exports/export_folder.hpp"
#include "protocols/store/trace.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The columns of a recording, in order; meaning_of describes them.
[[nodiscard]] const std::vector<std::string>& trace_columns();

/// Rows without a header. Millimetres have three decimals and newtons four, which keeps apart all
/// steps that a trace stores (1 um and 1/4096 N).
[[nodiscard]] std::string trace_text(const store::Trace& trace);

/// A recording and its JSON file for every trial with a trace. Each trace is opened when its file
/// is written, several at a time.
/// \param study  unblinded, with its key
[[nodiscard]] std::vector<ExportFile> trace_files(const DatasetSource& study,
                                                  const std::vector<BidsSession>& sessions,
                                                  const std::string& task);

}  // namespace touchtrial::analysis
