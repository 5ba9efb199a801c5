/// \file The folder that `report DB --out DIR` fills: page, tables, figures and results.
/// Layout: docs/report.md.
#pragma once

#include "analysis/page/document.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace touchtrial::analysis {

/// Whole files by their path within the folder, "/" between its parts.
using ReportFiles = std::map<std::string, std::string>;

/// Page, tables and results; figures are added by whoever draws them ("figures/<id>.svg").
/// \param results  what `report --json` prints
[[nodiscard]] ReportFiles report_files(const Document& document, const std::string& results);

/// For before long work. Does not make the folder.
/// \throws FileError if the folder holds the report of another study, or a results.json that is no
///   report's
void refuse_other_study(const std::filesystem::path& folder, const std::string& study);

/// For before long work too: page and results that no report's list names are somebody else's.
/// \throws FileError if there is one
void refuse_strangers(const std::filesystem::path& folder);

/// Writes every file, each as a whole, and takes away those that an earlier report wrote and this
/// one does not have (their list is "report-files.txt"); touches nothing else in the folder.
/// \throws FileError if a file is there that the list does not name (nothing is written then), or
/// if
///   a folder or file cannot be written
void write_report_folder(const std::filesystem::path& folder, const ReportFiles& files);

}  // namespace touchtrial::analysis
