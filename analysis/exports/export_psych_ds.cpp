#include "analysis/exports/export_psych_ds.hpp"

#include "analysis/exports/column_meanings.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/exports/study_tables.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "analysis/report/json_figures.hpp"
#include "core/version.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json variable_json(const std::string& column) {
  const ColumnMeaning meaning = meaning_of(column);
  std::string description = meaning.description;
  const char* separator = " (";
  for (const auto& [value, value_meaning] : meaning.levels) {
    description += fmt::format("{}{}: {}", separator, value, value_meaning);
    separator = "; ";
  }
  if (!meaning.levels.empty()) description += ")";
  Json variable{{"@type", "PropertyValue"}, {"name", column}, {"description", description}};
  if (!meaning.unit.empty()) variable["unitText"] = meaning.unit;
  return variable;
}

std::string description_of(const record::StudyCommitment& commitment) {
  return fmt::format(
      "{}{}Textures felt through a force-feedback device, {} in each trial. Protocol: {}.",
      commitment.simulated ? "SIMULATED: every participant is a program. " : "",
      commitment.pilot ? "A pilot; do not pool with the study's data. " : "",
      commitment.positions > 0 ? fmt::format("one of {} named", commitment.positions) : "one rated",
      commitment.protocol);
}

/// \param columns  the columns of all data files, without repetitions
std::string psych_ds_description_json(const DatasetSource& study, const DatasetOptions& options,
                                      const std::vector<std::string>& columns) {
  const record::StudyCommitment& commitment = study.store.commitment();
  const std::string stamp = commitment.simulated ? " (SIMULATED)" : "";
  Json object{
      {"@context", "https://schema.org/"}, {"@type", "Dataset"},
      {"name", commitment.study + stamp},  {"description", description_of(commitment)},
      {"identifier", commitment.study_id}, {"keywords", {"psychophysics", "haptics", "texture"}}};
  if (commitment.simulated) object["keywords"].push_back("SIMULATED");
  for (const std::string& author : options.authors) {
    object["author"].push_back({{"@type", "Person"}, {"name", author}});
  }
  if (!options.license.empty()) object["license"] = options.license;
  object["variableMeasured"] = Json::array();
  for (const std::string& column : columns) {
    object["variableMeasured"].push_back(variable_json(column));
  }
  return json_text(object);
}

std::string psych_ds_readme(const DatasetSource& study) {
  return "# " + study.store.commitment().study + "\n\n" + study_readme(study) +
         "`data/*_description-trials_data.csv` has one row per trial, with the key columns "
         "`session` "
         "and `trial`; `data/*_description-participants_data.csv` has one row per session, with "
         "the "
         "key column `session`; the others have one row per answer to a question, incident or "
         "consent. "
         "`dataset_description.json` explains each column.\n";
}

/// The table of participants.csv without participants whose data were erased. Columns that share
/// their name with a column of trials.csv but have another meaning are renamed, because each
/// variable of a dataset has one meaning.
DataTable unerased_participants_table(const record::StudyStore& store,
                                      const Collection& collection) {
  DataTable table = participants_table(store, collection);
  std::replace(table.columns.begin(), table.columns.end(), std::string("state"),
               std::string("session_state"));
  std::replace(table.columns.begin(), table.columns.end(), std::string("counted"),
               std::string("counted_session"));
  const auto column = std::find(table.columns.begin(), table.columns.end(), "erased");
  const auto index = static_cast<std::size_t>(column - table.columns.begin());
  std::erase_if(table.rows, [&](const std::vector<DataCell>& row) {
    return row[index] == DataCell(std::int64_t{1});
  });
  return table;
}

void add_columns(std::vector<std::string>& all, const DataTable& table) {
  for (const std::string& column : table.columns) {
    if (std::find(all.begin(), all.end(), column) == all.end()) all.push_back(column);
  }
}

std::string changes_text() {
  return fmt::format("# Changes\n\n- Exported by Touchtrial {}.\n", program_version());
}

}  // namespace

std::vector<std::filesystem::path> export_psych_ds(const DatasetSource& study,
                                                   const DatasetOptions& options,
                                                   const std::filesystem::path& folder) {
  const record::StudyCommitment& commitment = study.store.commitment();
  const std::optional<Outcomes> outcomes =
      study.outcomes != nullptr ? std::optional(*study.outcomes) : std::nullopt;
  std::vector<ExportFile> files;
  std::vector<std::string> columns;
  const auto add_data = [&](const char* description, const DataTable& table) {
    files.push_back(text_file(
        "data/study-" + plain_label(commitment.study) + "_description-" + description + "_data.csv",
        csv_text(table)));
    add_columns(columns, table);
  };
  add_data("trials", trials_table(study.store, outcomes));
  if (outcomes) add_data("unscored", unscored_table(*outcomes));
  add_data("participants",
           unerased_participants_table(study.store, collection_of(study.store, outcomes)));
  if (outcomes) add_data("answers", answers_table(*outcomes, options.free_text));
  add_data("incidents", incidents_table(study.store, outcomes, options.free_text));
  if (!options.consents.empty()) {
    add_data("consents", consents_table(study.store, options.consents));
  }
  files.push_back(text_file(outcomes ? "results/report.json" : "results/quality.json",
                            report_in_dataset(study, options.free_text)));
  files.push_back(text_file("README.md", psych_ds_readme(study)));
  files.push_back(text_file("CHANGES.md", changes_text()));
  files.push_back(text_file(".psychds-ignore", std::string(kExportMark) + "\n"));
  files.push_back(
      text_file("dataset_description.json", psych_ds_description_json(study, options, columns)));
  return write_export(folder, {commitment.study, commitment.study_id, "psych-ds"}, files);
}

}  // namespace touchtrial::analysis
