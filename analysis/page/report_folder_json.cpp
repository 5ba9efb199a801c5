#include "analysis/page/report_folder.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {

void refuse_other_study(const std::filesystem::path& folder, const std::string& study) {
  const std::filesystem::path file = folder / "results.json";
  if (!is_there(file)) return;
  const Bytes bytes = read_file(file);
  const auto json = nlohmann::json::parse(bytes.begin(), bytes.end(), nullptr, false);
  const bool named = json.is_object() && json.contains("study") && json["study"].is_string();
  if (named && json["study"].get<std::string>() == study) return;
  const std::string what = named
                               ? "is of the study \"" + one_line(json["study"].get<std::string>()) +
                                     "\", not \"" + one_line(study) + "\""
                               : "is no results of a report";
  throw FileError(one_line(file.string()) + ": " + what + "; give another folder with --out");
}

}  // namespace touchtrial::analysis
