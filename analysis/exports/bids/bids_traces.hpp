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

/// Rows without a header: millimetres with three decimals and newtons with four, which tell all
/// steps that a trace stores apart (1 um and 1/4096 N).
[[nodiscard]] std::string trace_text(const store::Trace& trace);

/// For every trial with a trace a recording and its JSON. Traces are opened when they are written,
/// several at a time.
/// \param study  unblinded, with its key
[[nodiscard]] std::vector<ExportFile> trace_files(const DatasetSource& study,
                                                  const std::vector<BidsSession>& sessions,
                                                  const std::string& task);

}  // namespace touchtrial::analysis
