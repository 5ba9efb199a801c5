#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/dataset_rules.hpp"
#include "analysis/exports/gunzip.hpp"
#include "core/files.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Faults = std::vector<std::string>;
using Lines = std::vector<std::vector<std::string>>;

Lines split(const std::string& text) {
  Lines lines{{""}};
  for (const char c : text) {
    if (c == '\n') {
      lines.push_back({""});
    } else if (c == '\t') {
      lines.back().emplace_back();
    } else {
      lines.back().back() += c;
    }
  }
  lines.pop_back();
  return lines;
}

bool is_number(const std::string& text) {
  return number_in<double>(text).has_value();
}

json parsed(const fs::path& path, Faults& faults) {
  if (!fs::exists(path)) {
    faults.push_back(path.string() + ": is missing");
    return json::object();
  }
  json object = json::parse(text_of_file(path), nullptr, false);
  if (!object.is_object()) faults.push_back(path.string() + ": is no JSON object");
  return object.is_object() ? object : json::object();
}

void check_description(const fs::path& folder, const std::string& type, Faults& faults) {
  const json object = parsed(folder / "dataset_description.json", faults);
  for (const char* key : {"Name", "BIDSVersion"}) {
    if (!object.contains(key) || !object[key].is_string()) {
      faults.push_back(folder.string() + ": dataset_description.json lacks " + key);
    }
  }
  if (object.value("DatasetType", "raw") != type) faults.push_back("DatasetType is not " + type);
  if (type == "derivative" && !object.contains("GeneratedBy")) {
    faults.emplace_back("a derivative lacks GeneratedBy");
  }
}

/// Checks the rules for any TSV file: its text, header and rows. Returns only rows that fit the
/// header.
Lines check_tsv(const fs::path& path, Faults& faults) {
  const std::string text = text_of_file(path);
  const auto fault = [&](const std::string& what) {
    faults.push_back(path.string() + ": " + what);
  };
  if (text.empty() || text.back() != '\n') fault("does not end with a line feed");
  if (text.find('\r') != std::string::npos) fault("has a carriage return");
  if (text.starts_with("\xEF\xBB\xBF")) fault("has a byte order mark");
  Lines lines = split(text);
  if (lines.empty()) return {{""}};
  static const std::regex kSnakeCase("[a-z][a-z0-9]*(_[a-z0-9]+)*");
  std::set<std::string> names;
  for (const std::string& name : lines[0]) {
    if (!names.insert(name).second) fault("has two columns " + name);
    if (!std::regex_match(name, kSnakeCase)) fault("has a column " + name);
  }
  const bool is_events = path.filename().string().ends_with("_events.tsv");
  if ((names.contains("onset") && names.contains("duration")) != is_events) {
    fault("must have onset and duration if it lists events, and else not both");
  }
  for (const auto& row : lines) {
    if (row.size() != lines[0].size()) fault("has a row of another length");
    for (const std::string& value : row) {
      if (value.empty()) fault("has an empty value in place of n/a");
    }
  }
  std::erase_if(lines, [width = lines[0].size()](const auto& row) { return row.size() != width; });
  return lines;
}

void check_columns(const fs::path& path, const Lines& table, const json& sidecar, Faults& faults) {
  for (const std::string& name : table.at(0)) {
    if (name == "participant_id" || name == "session_id") continue;
    if (!sidecar.contains(name) || !sidecar[name].contains("Description")) {
      faults.push_back(path.string() + ": column " + name + " is not described");
      continue;
    }
    if (!sidecar[name].contains("Levels")) continue;
    const auto column = std::find(table[0].begin(), table[0].end(), name) - table[0].begin();
    for (std::size_t i = 1; i < table.size(); ++i) {
      const std::string& value = table[i].at(column);
      if (value != "n/a" && !sidecar[name]["Levels"].contains(value)) {
        faults.push_back(path.string() + ": " + name + " has no level " + value);
      }
    }
  }
}

void check_trials(const fs::path& dataset, const fs::path& path, Faults& faults) {
  static const std::regex kTask(".*_(task-[a-zA-Z0-9]+)_beh\\.tsv");
  const std::string name = path.filename().string();
  const std::string task = std::regex_replace(name, kTask, "$1");
  const json sidecar = parsed(dataset / (task + "_beh.json"), faults);
  if (!sidecar.contains("TaskName")) faults.push_back(task + ": no TaskName");
  const Lines table = check_tsv(path, faults);
  check_columns(path, table, sidecar, faults);
  for (std::size_t k = 0; k < table.at(0).size(); ++k) {
    for (std::size_t i = 1; i < table.size(); ++i) {
      const std::string& value = table[i].at(k);
      if (value == "n/a") continue;
      if (table[0][k] == "response_time" && !is_number(value)) {
        faults.push_back(name + ": response_time " + value);
      }
      if (table[0][k] == "stim_file" && !fs::exists(dataset / "stimuli" / value)) {
        faults.push_back(name + ": there is no stimuli/" + value);
      }
    }
  }
}

void check_recording(const fs::path& path, Faults& faults) {
  const std::string name = path.string();
  const json sidecar = parsed(name.substr(0, name.size() - 7) + ".json", faults);
  if (!sidecar.contains("StartTime") || !sidecar["StartTime"].is_number() ||
      !sidecar.contains("Columns") || sidecar.value("SamplingFrequency", 0.0) <= 0.0) {
    faults.push_back(name + ": its JSON lacks SamplingFrequency, StartTime or Columns");
    return;
  }
  for (const json& column : sidecar["Columns"]) {
    if (!sidecar.contains(column.get<std::string>())) faults.push_back(name + ": undescribed");
  }
  const Bytes packed = read_file(path);
  for (int i = 4; i < 8; ++i) {
    if (packed.at(i) != 0) faults.push_back(name + ": its gzip header has a time");
  }
  for (const auto& row : split(gunzip(packed))) {
    if (row.size() != sidecar["Columns"].size() || !is_number(row[0])) {
      faults.push_back(name + ": has a row that does not fit its Columns");
      return;
    }
  }
}

/// Labels in folders and names must agree.
bool name_is_allowed(const std::string& name) {
  static const std::regex kRoot(
      "dataset_description\\.json|README|participants\\.(tsv|json)|task-[a-zA-Z0-9]+_(beh|events)"
      "\\."
      "json|phenotype/[a-z][a-z0-9_]*\\.(tsv|json)");
  static const std::regex kSessions("(sub-[0-9a-zA-Z]+)/\\1_sessions\\.(tsv|json)");
  static const std::regex kPlain(
      "(sub-[0-9a-zA-Z]+)/beh/"
      "\\1_task-[a-zA-Z0-9]+(_(beh|events)\\.tsv|_recording-[a-zA-Z0-9]+_stim\\."
      "(tsv\\.gz|json))");
  static const std::regex kOfSession(
      "(sub-[0-9a-zA-Z]+)/(ses-[0-9a-zA-Z]+)/beh/"
      "\\1_\\2_task-[a-zA-Z0-9]+(_(beh|events)\\.tsv|_recording-"
      "[a-zA-Z0-9]+_stim\\.(tsv\\.gz|json))");
  return std::regex_match(name, kRoot) || std::regex_match(name, kSessions) ||
         std::regex_match(name, kPlain) || std::regex_match(name, kOfSession);
}

/// Rows of events begin with a time and a duration, in order.
void check_events(const fs::path& dataset, const fs::path& path, Faults& faults) {
  static const std::regex kTask(".*_(task-[a-zA-Z0-9]+)_events\\.tsv");
  const std::string name = path.filename().string();
  const std::string task = std::regex_replace(name, kTask, "$1");
  const Lines table = check_tsv(path, faults);
  check_columns(path, table, parsed(dataset / (task + "_events.json"), faults), faults);
  if (table[0].size() < 2 || table[0][0] != "onset" || table[0][1] != "duration") {
    faults.push_back(name + ": does not begin with onset and duration");
    return;
  }
  double before = 0.0;
  for (std::size_t i = 1; i < table.size(); ++i) {
    const double onset = number_in<double>(table[i][0]).value_or(-1.0);
    if (onset < before) faults.push_back(name + ": onset " + table[i][0]);
    before = onset;
  }
}

/// The answers to a questionnaire, by participants and sessions of the dataset.
void check_phenotype(const fs::path& dataset, const fs::path& path, Faults& faults) {
  const std::string name = path.string();
  const json sidecar = parsed(name.substr(0, name.size() - 4) + ".json", faults);
  if (!sidecar.contains("MeasurementToolMetadata")) faults.push_back(name + ": not described");
  const Lines table = check_tsv(path, faults);
  check_columns(path, table, sidecar, faults);
  std::set<std::string> listed;
  const bool has_sessions = table[0].size() > 1 && table[0][1] == "session_id";
  if (table[0][0] != "participant_id") faults.push_back(name + ": participant_id is not first");
  for (std::size_t i = 1; i < table.size(); ++i) {
    const fs::path place = fs::path(table[i][0]) / (has_sessions ? table[i][1] : "");
    if (!fs::exists(dataset / place)) faults.push_back(name + ": nobody is " + place.string());
    if (!listed.insert(place.string()).second) faults.push_back(name + ": twice " + place.string());
  }
}

void check_people(const fs::path& dataset, Faults& faults) {
  const Lines table = check_tsv(dataset / "participants.tsv", faults);
  check_columns("participants.tsv", table, parsed(dataset / "participants.json", faults), faults);
  if (table.at(0).at(0) != "participant_id") faults.emplace_back("participant_id is not first");
  std::set<std::string> listed;
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (!listed.insert(table[i][0]).second) faults.push_back(table[i][0] + " is listed twice");
  }
  std::set<std::string> there;
  for (const auto& entry : fs::directory_iterator(dataset)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("sub-")) there.insert(name);
  }
  if (listed != there) faults.emplace_back("participants.tsv does not list the folders");
}

}  // namespace

std::vector<std::string> bids_faults(const fs::path& dataset) {
  Faults faults;
  check_description(dataset, "raw", faults);
  if (!fs::exists(dataset / "README") || fs::file_size(dataset / "README") <= 150) {
    faults.emplace_back("README says too little");
  }
  check_people(dataset, faults);
  for (const auto& entry : fs::directory_iterator(dataset / "derivatives")) {
    check_description(entry.path(), "derivative", faults);
  }
  for (const auto& entry : fs::recursive_directory_iterator(dataset)) {
    const std::string name = entry.path().lexically_relative(dataset).generic_string();
    const bool unchecked = name.starts_with(".") || name.starts_with("sourcedata/") ||
                           name.starts_with("derivatives/") || name.starts_with("stimuli/");
    if (!entry.is_regular_file() || unchecked) continue;
    if (!name_is_allowed(name)) faults.push_back(name + ": is no name of BIDS");
    if (name.ends_with("_beh.tsv")) check_trials(dataset, entry.path(), faults);
    if (name.ends_with("_events.tsv")) check_events(dataset, entry.path(), faults);
    if (name.starts_with("phenotype/") && name.ends_with(".tsv")) {
      check_phenotype(dataset, entry.path(), faults);
    }
    if (name.ends_with("_stim.tsv.gz")) check_recording(entry.path(), faults);
    if (name.ends_with("_sessions.tsv")) {
      const std::string sidecar = entry.path().string();
      check_columns(name, check_tsv(entry.path(), faults),
                    parsed(sidecar.substr(0, sidecar.size() - 4) + ".json", faults), faults);
    }
  }
  return faults;
}

}  // namespace touchtrial
