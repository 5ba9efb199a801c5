#include "analysis/exports/export_csv.hpp"

#include "analysis/exports/collection_tables.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/json_figures.hpp"
#include "analysis/results.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

/// The contents of the folder, for readers who do not know the program.
std::string contents_json(const store::StudyCommitment& commitment, bool blinded,
                          const std::vector<ExportFile>& files) {
  nlohmann::ordered_json contents{{"study", commitment.study}, {"protocol", commitment.protocol}};
  put_stamp(contents, commitment.simulated);
  contents["study_id"] = commitment.study_id;
  contents["pilot"] = commitment.pilot;
  contents["blinded"] = blinded;
  contents["program_version"] = commitment.program_version;
  contents["files"] = nlohmann::ordered_json::array();
  for (const ExportFile& file : files) contents["files"].push_back(file.name.string());
  return json_text(contents);
}

}  // namespace

std::vector<std::filesystem::path> export_csv(const store::StudyStore& store,
                                              const std::optional<Outcomes>& outcomes,
                                              const std::filesystem::path& folder) {
  const store::StudyCommitment& commitment = store.commitment();
  const Collection collection = collection_of(store, outcomes);
  std::vector<ExportFile> files;
  const auto add = [&](const std::string& name, const DataTable& table) {
    files.push_back(text_file(name, csv_text(table)));
  };
  add("trials.csv", trials_table(store, outcomes));
  add("participants.csv", participants_table(store, collection));
  add("deviations.csv", deviations_table(collection, commitment.simulated));
  add("servo.csv", servo_table(collection, commitment.simulated));
  if (outcomes) {
    for (const auto& [file, table] : analysis_of(outcomes->design).tables(*outcomes)) {
      add(file, table);
    }
    add("unscored_trials.csv", unscored_table(*outcomes));
  }
  add("study.csv", study_table(store, outcomes, collection));
  if (outcomes) files.push_back(text_file("study_file.json", outcomes->design.text));
  files.push_back(text_file("export.json", contents_json(commitment, !outcomes, files)));
  return write_export(folder, {commitment.study, commitment.study_id, "csv"}, files);
}

}  // namespace touchtrial::analysis
