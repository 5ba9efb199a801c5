#include "analysis/exports/export_csv.hpp"

#include "analysis/exports/export_folder.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/json_figures.hpp"
#include "core/files.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

/// What the folder holds, for whoever finds it without us.
std::string contents_json(const StudyCommitment& commitment, bool blinded,
                          const std::vector<std::filesystem::path>& files) {
  nlohmann::ordered_json contents{{"study", commitment.study}, {"protocol", commitment.protocol}};
  put_stamp(contents, commitment.simulated);
  contents["pilot"] = commitment.pilot;
  contents["blinded"] = blinded;
  contents["program_version"] = commitment.program_version;
  contents["files"] = nlohmann::ordered_json::array();
  for (const auto& file : files) contents["files"].push_back(file.filename().string());
  return json_text(contents);
}

}  // namespace

std::vector<std::filesystem::path> export_csv(const StudyStore& store,
                                              const std::optional<Outcomes>& outcomes,
                                              const std::filesystem::path& folder) {
  make_export_folder(folder);
  std::vector<std::filesystem::path> files;
  const auto write = [&](const std::string& name, const DataTable& table) {
    files.push_back(folder / name);
    replace_file(files.back(), csv_text(table));
  };
  write("trials.csv", trials_table(store, outcomes));
  write("participants.csv", participants_table(store));
  for (std::size_t i = 0; outcomes && i < outcomes->methods.size(); ++i) {
    write("confusion_" + outcomes->methods[i] + ".csv",
          confusion_table(*outcomes, static_cast<int>(i)));
  }
  const std::filesystem::path contents = folder / "export.json";
  replace_file(contents, contents_json(store.commitment(), !outcomes, files));
  files.push_back(contents);
  return files;
}

}  // namespace touchtrial
