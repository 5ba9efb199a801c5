/// \file The folder that `report DB --out DIR` fills: page, tables, figures and results.
/// Layout: docs/report.md.
#pragma once

#include "analysis/figures/figure.hpp"
#include "analysis/page/document.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Whole files by their path within the folder, with "/" between its parts.
using ReportFiles = std::map<std::string, std::string>;

/// Page, tables and results, without figures.
/// \param results  what `report --json` prints
[[nodiscard]] ReportFiles report_files(const Document& document, const std::string& results);

/// The figures of a report as parts of its page and as files beside it.
struct DrawnFigures {
  std::vector<Picture> pictures;
  ReportFiles files;    ///< "figures/<id>.svg" and ".pdf"
  std::string missing;  ///< why nothing could be drawn, one line; empty if all is drawn
};

/// Without gnuplot the pictures have only their words, and there are no files.
/// \throws Error if gnuplot is there and refuses a figure
[[nodiscard]] DrawnFigures draw_report_figures(const std::vector<Figure>& figures);

/// Checks a folder before long work. Does not make it.
/// \throws FileError if the folder holds the report of another study, or a results.json that is not
/// a
///   report's
void refuse_other_study(const std::filesystem::path& folder, const std::string& study);

/// Checks a folder before long work: a page or results that no report's list names belong to
/// somebody else. \throws FileError if there is such a file
void refuse_strangers(const std::filesystem::path& folder);

/// Writes every file, each as a whole, and removes the files of an earlier report that this one
/// does not have (their list is "report-files.txt"). Leaves everything else in the folder alone.
/// \throws FileError if the folder has one of the files and the list does not name it (then nothing
///   is written), or if a folder or file cannot be written
void write_report_folder(const std::filesystem::path& folder, const ReportFiles& files);

}  // namespace touchtrial::analysis
