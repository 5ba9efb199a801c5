/// \file The folder that `report DB --out DIR` writes: page, tables, figures and results. Layout:
/// docs/report.md.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/page/document.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Contents of files by path within the folder, separated by "/".
using ReportFiles = std::map<std::string, std::string>;

/// The page, the tables and the results, without the figures.
/// \param results  the output of `report --json`
[[nodiscard]] ReportFiles report_files(const Document& document, const std::string& results);

/// The figures of a report for its page and as files.
struct DrawnFigures {
  std::vector<Picture> pictures;
  ReportFiles files;    ///< "figures/<id>.svg" and ".pdf"; data and scripts (redraw_files)
  std::string missing;  ///< why gnuplot could not draw, on one line; empty if it could
};

/// Without gnuplot the pictures have only captions and descriptions, and the files are data and
/// scripts.
/// \throws Error if gnuplot is installed and rejects a figure
[[nodiscard]] DrawnFigures draw_report_figures(const std::vector<Figure>& figures);

/// Checks a folder before long work. Does not create it.
/// \throws FileError if the folder contains the report of another study, or a results.json that is
///   not a report's
void refuse_other_study(const std::filesystem::path& folder, const std::string& study);

/// Checks that page, results and list can be written, before long work.
/// \throws as require_output_path
void refuse_foreign_files(const std::filesystem::path& folder);

/// Replaces whole files, and removes files of an earlier report (listed in "report-files.txt") that
/// this report lacks. Changes nothing else in the folder.
/// \throws FileError if a folder or file cannot be written
/// \throws as require_output_path, before anything is written
void write_report_folder(const std::filesystem::path& folder, const ReportFiles& files);

}  // namespace touchtrial::analysis
