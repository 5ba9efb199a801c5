#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/dataset_rules.hpp"

#include <algorithm>
#include <array>
#include <regex>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Faults = std::vector<std::string>;

// A fault is the code of the schema's rule (rules/errors), or the path of a recommended file.

/// Required fields. Source: schema, rules/compiled_metadata.
constexpr std::array<const char*, 3> kRequired{"name", "description", "variableMeasured"};

/// The names in variableMeasured.
std::set<std::string> check_description(const fs::path& dataset, Faults& faults) {
  const fs::path path = dataset / "dataset_description.json";
  if (!fs::exists(path)) {
    faults.emplace_back("MISSING_DATASET_DESCRIPTION");
    return {};
  }
  const json object = json::parse(text_of_file(path), nullptr, false);
  if (!object.is_object()) {
    faults.emplace_back("INVALID_JSON_FORMATTING");
    return {};
  }
  for (const char* key : kRequired) {
    if (!object.contains(key)) faults.push_back(std::string("JSON_KEY_REQUIRED: ") + key);
  }
  if (object.value("@type", "") != "Dataset") faults.emplace_back("INCORRECT_DATASET_TYPE");
  const std::string context = object.value("@context", "");
  if (context != "https://schema.org/" && context != "https://schema.org") {
    faults.emplace_back("UNKNOWN_NAMESPACE");
  }
  std::set<std::string> names;
  for (const json& variable : object.value("variableMeasured", json::array())) {
    if (variable.is_object() && variable.value("@type", "") != "PropertyValue") {
      faults.emplace_back("INVALID_OBJECT_TYPE");
    }
    const std::string name = variable.is_object() ? variable.at("name") : variable;
    if (!names.insert(name).second) faults.push_back(name + " is measured twice");
  }
  return names;
}

/// Source: schema, rules/files/tabular_data/data (fileRegex), and the keywords of objects.
void check_name(const std::string& name, Faults& faults) {
  static const std::regex kName("([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\\.csv");
  static const std::regex kKey("([a-z]+)-[a-zA-Z0-9]+");
  static const std::set<std::string> kOfficial{"study",   "site",     "subject",
                                               "session", "task",     "condition",
                                               "trial",   "stimulus", "description"};
  if (!std::regex_match(name, kName))
    faults.push_back("FILENAME_KEYWORD_FORMATTING_ERROR: " + name);
  for (std::sregex_iterator key(name.begin(), name.end(), kKey), end; key != end; ++key) {
    if (!kOfficial.contains((*key)[1])) faults.push_back("FILENAME_UNOFFICIAL_KEYWORD: " + name);
  }
}

void check_table(const fs::path& path, std::set<std::string>& seen, Faults& faults) {
  const auto records = parse_csv(text_of_file(path));
  if (records.empty() || records[0][0].empty()) {
    faults.push_back("CSV_HEADER_MISSING: " + path.string());
    return;
  }
  const std::set<std::string> header(records[0].begin(), records[0].end());
  const auto row_id = std::ranges::find(records[0], "row_id") - records[0].begin();
  std::set<std::string> ids;
  for (const auto& record : records) {
    const auto place = static_cast<std::size_t>(row_id);
    if (place < record.size() && !ids.insert(record[place]).second) {
      faults.push_back("ROWID_VALUES_NOT_UNIQUE: " + path.string());
    }
  }
  if (header.size() != records[0].size()) faults.push_back("CSV_HEADER_REPEATED: " + path.string());
  for (const auto& record : records) {
    if (record.size() != records[0].size()) {
      faults.push_back("CSV_HEADER_LENGTH_MISMATCH: " + path.string());
    }
  }
  seen.insert(header.begin(), header.end());
}

}  // namespace

std::vector<std::string> psych_ds_faults(const fs::path& dataset) {
  Faults faults;
  const std::set<std::string> measured = check_description(dataset, faults);
  std::set<std::string> seen;
  for (const char* name : {"README.md", "CHANGES.md"}) {
    if (!fs::exists(dataset / name)) faults.push_back(std::string("missing: ") + name);
  }
  if (!fs::is_directory(dataset / "data")) {
    faults.emplace_back("MISSING_DATA_DIRECTORY");
    return faults;
  }
  for (const auto& entry : fs::recursive_directory_iterator(dataset / "data")) {
    if (!entry.is_regular_file()) continue;
    check_name(entry.path().filename().string(), faults);
    check_table(entry.path(), seen, faults);
  }
  for (const std::string& name : seen) {
    if (!measured.contains(name)) faults.push_back("CSV_COLUMN_MISSING_FROM_METADATA: " + name);
  }
  for (const std::string& name : measured) {
    if (!seen.contains(name)) faults.push_back("VARIABLE_MISSING_FROM_CSV_COLUMNS: " + name);
  }
  return faults;
}

}  // namespace touchtrial
