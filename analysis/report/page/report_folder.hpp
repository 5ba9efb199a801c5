/// \file The folder that `report DB --out DIR` fills: page, tables, figures and results. Layout:
/// docs/report.md.
#pragma once

#include "analysis/report/figures/figure.hpp"
#include "analysis/report/page/document.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The contents of files by their path within the folder, with "/" as separator.
using ReportFiles = std::map<std::string, std::string>;

/// The page, the tables and the results, without the figures.
/// \param results  the text that `report --json` prints
[[nodiscard]] ReportFiles report_files(const Document& document, const std::string& results);

/// The figures of a report as pictures for its page and as files beside it.
struct DrawnFigures {
  std::vector<Picture> pictures;
  ReportFiles files;    ///< "figures/<id>.svg" and ".pdf", data and scripts (redraw_files)
  std::string missing;  ///< one line on why gnuplot could not draw; empty if it could
};

/// Draws the figures. Without gnuplot the pictures have only their captions and descriptions, and
/// the files are data and scripts.
/// \throws Error if gnuplot is installed and rejects a figure
[[nodiscard]] DrawnFigures draw_report_figures(const std::vector<Figure>& figures);

/// Checks a folder before long work. Does not create it.
/// \throws FileError if the folder holds the report of another study, or a results.json that is not
/// a report's
void refuse_other_study(const std::filesystem::path& folder, const std::string& study);

/// Checks the places of page, results and list before long work.
/// \throws as require_output_place
void refuse_foreign_files(const std::filesystem::path& folder);

/// Writes each file as a whole, and removes the files of an earlier report that this report does
/// not have ("report-files.txt" lists them). Leaves everything else in the folder alone.
/// \throws FileError if a folder or file cannot be written
/// \throws as require_output_place, before anything is written
void write_report_folder(const std::filesystem::path& folder, const ReportFiles& files);

}  // namespace touchtrial::analysis
