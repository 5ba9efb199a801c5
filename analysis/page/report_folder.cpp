#include "analysis/page/report_folder.hpp"

#include "analysis/page/renderings.hpp"
#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"

#include <set>
#include <sstream>
#include <system_error>

namespace touchtrial::analysis {
namespace {

namespace fs = std::filesystem;

constexpr const char* kList = "report-files.txt";
constexpr std::uintmax_t kLongestList = 1U << 20U;

/// A name that a report could have written: nothing else may be taken away, whatever a list says.
bool could_be_ours(const std::string& path) {
  if (!path.starts_with("tables/") && !path.starts_with("figures/")) return false;
  const std::string name = path.substr(path.find('/') + 1);
  return !name.empty() && name.front() != '.' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-.") == std::string::npos;
}

/// Every line of an earlier report's list, as it stands there.
std::set<std::string> claimed_in(const fs::path& folder) {
  std::set<std::string> paths;
  if (!is_there(folder / kList)) return paths;
  const Bytes bytes = read_file(folder / kList, kLongestList);
  std::istringstream lines(std::string(bytes.begin(), bytes.end()));
  for (std::string line; std::getline(lines, line);) paths.insert(line);
  return paths;
}

/// What may be taken away.
std::set<std::string> removable(const std::set<std::string>& claimed) {
  std::set<std::string> paths;
  for (const std::string& path : claimed) {
    if (could_be_ours(path)) paths.insert(path);
  }
  return paths;
}

void require_own(const fs::path& folder, const std::set<std::string>& claimed,
                 const std::string& path) {
  if (claimed.contains(path) || !is_there(folder / path)) return;
  throw FileError(one_line((folder / path).string()) +
                  ": is there already, and no report wrote it; give another folder with --out, or "
                  "move it away");
}

std::string list_of(const ReportFiles& files) {
  std::string list;
  for (const auto& [path, content] : files) list += path + '\n';
  return list;
}

}  // namespace

ReportFiles report_files(const Document& document, const std::string& results) {
  ReportFiles files;
  files["results.json"] = results;
  files["report.html"] = page_html(document);
  files["tables/tables.md"] = tables_markdown(document);
  files["tables/tables.tex"] = tables_latex(document);
  for (const Table* table : tables_of(document)) {
    files["tables/" + table->id + ".md"] = table_markdown(*table, document.stamp);
    files["tables/" + table->id + ".tex"] = table_latex(*table, document.stamp);
  }
  return files;
}

void refuse_strangers(const fs::path& folder) {
  const std::set<std::string> claimed = claimed_in(folder);
  for (const char* path : {"report.html", "results.json"}) require_own(folder, claimed, path);
}

void write_report_folder(const fs::path& folder, const ReportFiles& files) {
  make_folder(folder);
  const std::set<std::string> claimed = claimed_in(folder);
  for (const auto& [path, content] : files) require_own(folder, claimed, path);
  const std::set<std::string> before = removable(claimed);
  // The list comes first: after a crash the next report still knows what is its own.
  std::string list = list_of(files);
  for (const std::string& path : before) {
    if (!files.contains(path)) list += path + '\n';
  }
  replace_file(folder / kList, list);
  for (const auto& [path, content] : files) {
    if (path.find('/') != std::string::npos) make_folder((folder / path).parent_path());
    replace_file(folder / path, content);
  }
  for (const std::string& path : before) {
    std::error_code ignored;
    if (!files.contains(path)) fs::remove(folder / path, ignored);
  }
  replace_file(folder / kList, list_of(files));
}

}  // namespace touchtrial::analysis
