#include "analysis/exports/psych_ds_description_json.hpp"

#include "analysis/exports/column_meanings.hpp"
#include "analysis/json_figures.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json variable_json(const std::string& column) {
  const ColumnMeaning& meaning = meaning_of(column);
  std::string description = meaning.description;
  const char* separator = " (";
  for (const auto& [value, means] : meaning.levels) {
    description += fmt::format("{}{}: {}", separator, value, means);
    separator = "; ";
  }
  if (!meaning.levels.empty()) description += ")";
  Json variable{{"@type", "PropertyValue"}, {"name", column}, {"description", description}};
  if (!meaning.unit.empty()) variable["unitText"] = meaning.unit;
  return variable;
}

std::string description_of(const store::StudyCommitment& commitment) {
  return fmt::format(
      "{}{}Textures felt through a force-feedback device, one of {} named in each trial. "
      "Protocol: {}.",
      commitment.simulated ? "SIMULATED: every participant is a program. " : "",
      commitment.pilot ? "A pilot, not to be pooled with the study's data. " : "",
      commitment.positions, commitment.protocol);
}

}  // namespace

std::string psych_ds_description_json(const DatasetSource& study, const DatasetOptions& options,
                                      const std::vector<std::string>& columns) {
  const store::StudyCommitment& commitment = study.store.commitment();
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

}  // namespace touchtrial::analysis
