#include "analysis/exports/export_json.hpp"

#include "analysis/exports/collection_tables.hpp"
#include "analysis/exports/export_folder.hpp"
#include "analysis/exports/export_tables.hpp"
#include "analysis/json_figures.hpp"
#include "analysis/results.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

struct JsonValue {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(const std::string& text) const { return text; }
  Json operator()(std::int64_t number) const { return number; }
  Json operator()(double number) const { return number; }
  Json operator()(std::chrono::nanoseconds time) const {
    return std::chrono::duration<double>(time).count();
  }
};

/// The rows as an array of objects whose keys are the columns.
Json rows_json(const DataTable& table) {
  Json rows = Json::array();
  for (const std::vector<DataCell>& cells : table.rows) {
    Json row = Json::object();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      row[table.columns[i]] = std::visit(JsonValue{}, cells[i]);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::filesystem::path export_json(const store::StudyStore& store,
                                  const std::optional<Outcomes>& outcomes,
                                  const std::filesystem::path& folder) {
  const store::StudyCommitment& commitment = store.commitment();
  Json document{{"study", commitment.study}, {"protocol", commitment.protocol}};
  put_stamp(document, commitment.simulated);
  document["study_id"] = commitment.study_id;
  if (outcomes) {
    document["report"] = Json::parse(analysis_of(outcomes->design).results(*outcomes, {})->json());
  } else {
    document["quality"] = quality_object(make_quality(store));
  }
  const Collection collection = collection_of(store, outcomes);
  document["participants"] = rows_json(participants_table(store, collection));
  document["deviations"] = rows_json(deviations_table(collection, commitment.simulated));
  document["servo"] = rows_json(servo_table(collection, commitment.simulated));
  document["trials"] = rows_json(trials_table(store, outcomes));
  if (outcomes) document["unscored_trials"] = rows_json(unscored_table(*outcomes));
  return write_export(folder, {commitment.study, commitment.study_id, "json"},
                      {text_file("study.json", json_text(document))})
      .front();
}

}  // namespace touchtrial::analysis
