#include "analysis/report/page/report_folder.hpp"

#include "analysis/report/figures/gnuplot.hpp"
#include "analysis/report/figures/redraw.hpp"
#include "analysis/report/methods.hpp"
#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"

#include <set>
#include <sstream>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

namespace fs = std::filesystem;

constexpr const char* kList = "report-files.txt";
constexpr const char* kMethods = "methods.md";
constexpr std::uintmax_t kLongestList = 1U << 20U;

/// Whether a report could have written a file of this name. No other file may be removed,
/// even if a list names it.
bool could_be_ours(const std::string& path) {
  if (path == kMethods) return true;
  if (!path.starts_with("tables/") && !path.starts_with("figures/")) return false;
  const std::string name = path.substr(path.find('/') + 1);
  return !name.empty() && name.front() != '.' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-.") == std::string::npos;
}

/// Every line of an earlier report's list.
std::set<std::string> claimed_in(const fs::path& folder) {
  std::set<std::string> paths;
  if (!is_there(folder / kList)) return paths;
  const Bytes bytes = read_file(folder / kList, kLongestList);
  std::istringstream lines(std::string(bytes.begin(), bytes.end()));
  for (std::string line; std::getline(lines, line);) paths.insert(line);
  return paths;
}

/// The listed paths that may be removed.
std::set<std::string> removable(const std::set<std::string>& claimed) {
  std::set<std::string> paths;
  for (const std::string& path : claimed) {
    if (could_be_ours(path)) paths.insert(path);
  }
  return paths;
}

/// Whether an earlier report's list names a file that its file system cannot mark as an output.
bool is_unmarked(const fs::path& folder, const std::set<std::string>& claimed,
                 const std::string& path) {
  return claimed.contains(path) && origin_of(folder / path) == Origin::unknown;
}

void require_place(const fs::path& folder, const std::set<std::string>& claimed,
                   const std::string& path) {
  if (!is_unmarked(folder, claimed, path)) require_output_place(folder / path);
}

std::string list_of(const ReportFiles& files) {
  std::string list;
  for (const auto& [path, content] : files) list += path + '\n';
  return list;
}

/// The reason why gnuplot cannot be used; empty if it can.
std::string gnuplot_complaint() {
  try {
    require_gnuplot();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace

ReportFiles report_files(const Document& document, const std::string& results) {
  ReportFiles files;
  files["results.json"] = results;
  files["report.html"] = page_html(document);
  files["tables/tables.md"] = document_markdown(tables_alone(document), "");
  files["tables/tables.tex"] = tables_latex(document);
  if (std::string methods = methods_markdown(document); !methods.empty()) {
    files[kMethods] = std::move(methods);
  }
  for (const Table* table : tables_of(document)) {
    files["tables/" + table->id + ".md"] = table_markdown(*table, document.stamp);
    files["tables/" + table->id + ".tex"] = table_latex(*table, document.stamp);
  }
  return files;
}

void refuse_foreign_files(const fs::path& folder) {
  const std::set<std::string> claimed = claimed_in(folder);
  for (const char* path : {"report.html", "results.json"}) require_place(folder, claimed, path);
  if (!claimed.contains("results.json")) require_output_place(folder / kList);
}

void write_report_folder(const fs::path& folder, const ReportFiles& files) {
  make_folder(folder);
  const std::set<std::string> claimed = claimed_in(folder);
  const std::set<std::string> before = removable(claimed);
  for (const auto& [path, content] : files) require_place(folder, claimed, path);
  for (const std::string& path : before) require_place(folder, claimed, path);
  if (!claimed.contains("results.json")) clear_output_place(folder / kList);
  // The list is written first, so that after a crash the next report still recognises its own
  // files.
  std::string list = list_of(files);
  for (const std::string& path : before) {
    if (!files.contains(path)) list += path + '\n';
  }
  replace_file(folder / kList, list);
  for (const auto& [path, content] : files) {
    if (path.find('/') != std::string::npos) make_folder((folder / path).parent_path());
    if (is_unmarked(folder, claimed, path)) fs::remove(folder / path);
    write_output(folder / path, content);
  }
  for (const std::string& path : before) {
    if (files.contains(path)) continue;
    if (!is_unmarked(folder, claimed, path)) clear_output_place(folder / path);
    std::error_code ignored;
    fs::remove(folder / path, ignored);
  }
  replace_file(folder / kList, list_of(files));
}

DrawnFigures draw_report_figures(const std::vector<Figure>& figures) {
  DrawnFigures drawn;
  drawn.missing = gnuplot_complaint();
  std::vector<std::string> svg(figures.size());
  if (drawn.missing.empty()) {
    svg = all_drawn(figures, FigureFormat::svg);
    const std::vector<std::string> pdf = all_drawn(figures, FigureFormat::pdf);
    for (std::size_t i = 0; i < figures.size(); ++i) {
      drawn.files["figures/" + figures[i].id + ".svg"] = svg[i];
      drawn.files["figures/" + figures[i].id + ".pdf"] = pdf[i];
    }
  }
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const Figure& figure = figures[i];
    for (auto& [name, content] : redraw_files(figure)) {
      drawn.files["figures/" + name] = content;
    }
    drawn.pictures.push_back({figure.id, figure.caption, figure.alt, svg[i], figure.section});
  }
  return drawn;
}

void refuse_other_study(const fs::path& folder, const std::string& study) {
  const fs::path file = folder / "results.json";
  if (!is_there(file)) return;
  const Bytes bytes = read_file(file);
  const auto json = nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
  const bool named = json.is_object() && json.contains("study") && json["study"].is_string();
  if (named && json["study"].get<std::string>() == study) return;
  const std::string what = named
                               ? "is of the study \"" + one_line(json["study"].get<std::string>()) +
                                     "\", not \"" + one_line(study) + "\""
                               : "is not the results of a report";
  throw FileError(one_line(file.string()) + ": " + what + "; choose another folder with --out");
}

}  // namespace touchtrial::analysis
