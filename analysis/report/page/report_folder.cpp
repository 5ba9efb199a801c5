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
constexpr std::uintmax_t kMaxListBytes = 1U << 20U;

/// Whether a report could have written a file of this name. Other files are never removed, even if
/// the list names them.
bool is_report_path(const std::string& path) {
  if (path == kMethods) return true;
  if (!path.starts_with("tables/") && !path.starts_with("figures/")) return false;
  const std::string name = path.substr(path.find('/') + 1);
  return !name.empty() && name.front() != '.' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-.") == std::string::npos;
}

/// The files of an earlier report, by its list.
std::set<std::string> listed_files(const fs::path& folder) {
  std::set<std::string> paths;
  if (!path_exists(folder / kList)) return paths;
  const Bytes bytes = read_file(folder / kList, kMaxListBytes);
  std::istringstream lines(std::string(bytes.begin(), bytes.end()));
  for (std::string line; std::getline(lines, line);) paths.insert(line);
  return paths;
}

/// Whether the list names a file that its file system cannot mark as an output.
bool is_unmarked(const fs::path& folder, const std::set<std::string>& listed_paths,
                 const std::string& path) {
  return listed_paths.contains(path) && origin_of(folder / path) == Origin::unknown;
}

void require_writable(const fs::path& folder, const std::set<std::string>& listed_paths,
                      const std::string& path) {
  if (!is_unmarked(folder, listed_paths, path)) require_output_path(folder / path);
}

std::string list_of(const ReportFiles& files) {
  std::string list;
  for (const auto& [path, content] : files) list += path + '\n';
  return list;
}

/// Why gnuplot cannot be used; empty if it can.
std::string gnuplot_error() {
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
  files["tables/tables.md"] = document_markdown(tables_only(document), "");
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
  const std::set<std::string> listed_paths = listed_files(folder);
  for (const char* path : {"report.html", "results.json"})
    require_writable(folder, listed_paths, path);
  if (!listed_paths.contains("results.json")) require_output_path(folder / kList);
}

void write_report_folder(const fs::path& folder, const ReportFiles& files) {
  make_folder(folder);
  const std::set<std::string> listed_paths = listed_files(folder);
  std::set<std::string> earlier_files = listed_paths;
  std::erase_if(earlier_files, [](const std::string& path) { return !is_report_path(path); });
  for (const auto& [path, content] : files) require_writable(folder, listed_paths, path);
  for (const std::string& path : earlier_files) require_writable(folder, listed_paths, path);
  if (!listed_paths.contains("results.json")) clear_output_path(folder / kList);
  // The list is written first, so that after a crash the next report recognises these files.
  std::string list = list_of(files);
  for (const std::string& path : earlier_files) {
    if (!files.contains(path)) list += path + '\n';
  }
  replace_file(folder / kList, list);
  for (const auto& [path, content] : files) {
    if (path.find('/') != std::string::npos) make_folder((folder / path).parent_path());
    if (is_unmarked(folder, listed_paths, path)) fs::remove(folder / path);
    write_output(folder / path, content);
  }
  for (const std::string& path : earlier_files) {
    if (files.contains(path)) continue;
    if (!is_unmarked(folder, listed_paths, path)) clear_output_path(folder / path);
    std::error_code ignored;
    fs::remove(folder / path, ignored);
  }
  replace_file(folder / kList, list_of(files));
}

DrawnFigures draw_report_figures(const std::vector<Figure>& figures) {
  DrawnFigures drawn;
  drawn.missing = gnuplot_error();
  std::vector<std::string> svg(figures.size());
  if (drawn.missing.empty()) {
    svg = draw_figures(figures, FigureFormat::svg);
    const std::vector<std::string> pdf = draw_figures(figures, FigureFormat::pdf);
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
  if (!path_exists(file)) return;
  const Bytes bytes = read_file(file);
  const auto json = nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
  const bool has_study = json.is_object() && json.contains("study") && json["study"].is_string();
  if (has_study && json["study"].get<std::string>() == study) return;
  const std::string problem = has_study ? "is of the study \"" +
                                              one_line(json["study"].get<std::string>()) +
                                              "\", not \"" + one_line(study) + "\""
                                        : "is not the results of a report";
  throw FileError(one_line(file.string()) + ": " + problem + "; choose another folder with --out");
}

}  // namespace touchtrial::analysis
