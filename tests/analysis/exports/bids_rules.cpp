#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/dataset_rules.hpp"
#include "core/files.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <sstream>

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
      if (table[0][k] == "motion_file" && !fs::exists(path.parent_path().parent_path() / value)) {
        faults.push_back(name + ": there is no " + value);
      }
      if (table[0][k] == "stim_file" && !fs::exists(dataset / "stimuli" / value)) {
        faults.push_back(name + ": there is no stimuli/" + value);
      }
    }
  }
}

// --- File names and inheritance ---

/// The entities of a file name in the order of BIDS, and its suffix and extension. Source: schema,
/// rules/entities.yaml.
struct NameParts {
  std::map<std::string, std::string> entities;
  std::string suffix;
  std::string extension;
};

NameParts parts_of(const fs::path& path) {
  NameParts parts;
  const std::string name = path.filename().string();
  const std::size_t dot = name.find('.');
  parts.extension = dot == std::string::npos ? "" : name.substr(dot);
  std::istringstream rest(name.substr(0, dot));
  for (std::string part; std::getline(rest, part, '_');) {
    const std::size_t dash = part.find('-');
    if (dash == std::string::npos) {
      parts.suffix = part;
    } else {
      parts.entities[part.substr(0, dash)] = part.substr(dash + 1);
    }
  }
  return parts;
}

/// The metadata files with an extension that apply to a data file, from the top of the dataset
/// down. Source: "Common principles", "The Inheritance Principle", rules 2, 4 and 5.
std::vector<fs::path> inherited(const fs::path& dataset, const fs::path& file,
                                const std::string& suffix, const std::string& extension,
                                Faults& faults) {
  const NameParts own = parts_of(file);
  std::vector<fs::path> levels{dataset};
  for (const fs::path& folder : file.parent_path().lexically_relative(dataset)) {
    if (folder != ".") levels.push_back(levels.back() / folder);
  }
  std::vector<fs::path> found;
  for (const fs::path& level : levels) {
    int at_level = 0;
    for (const auto& entry : fs::directory_iterator(level)) {
      const NameParts other = parts_of(entry.path());
      if (other.suffix != suffix || other.extension != extension) continue;
      if (!std::ranges::all_of(other.entities, [&](const auto& entity) {
            const auto same = own.entities.find(entity.first);
            return same != own.entities.end() && same->second == entity.second;
          })) {
        continue;
      }
      found.push_back(entry.path());
      if (++at_level > 1) faults.push_back(file.string() + ": two files apply at one level");
    }
  }
  return found;
}

json sidecar_of(const fs::path& dataset, const fs::path& file, Faults& faults) {
  json merged = json::object();
  for (const fs::path& one : inherited(dataset, file, parts_of(file).suffix, ".json", faults)) {
    merged.update(parsed(one, faults));
  }
  return merged;
}

/// Labels in folders and names must agree, and entities have their order. Source: schema,
/// rules/files/raw (beh, events, motion, channels) and rules/files/common (core, tables).
bool name_is_allowed(const std::string& name) {
  static const std::string kTask = "_task-[0-9a-zA-Z]+";
  static const std::string kMotion =
      kTask + "_tracksys-[0-9a-zA-Z]+(_run-[0-9]+)?_(motion|events|channels)\\.(tsv|json)";
  static const std::string kData =
      "(beh/\\1@" + kTask + "_(beh|events)\\.tsv|motion/\\1@" + kMotion + "|\\1@_scans\\.tsv)";
  const auto with_session = [](std::string pattern, const std::string& session) {
    for (std::size_t at = pattern.find('@'); at != std::string::npos; at = pattern.find('@')) {
      pattern.replace(at, 1, session);
    }
    return std::regex(pattern);
  };
  static const std::regex kRoot(
      "dataset_description\\.json|README|(participants|scans)\\.json|participants\\.tsv|task-[a-zA-"
      "Z0-9]+_((beh|events|channels)\\.json|channels\\.tsv)|phenotype/"
      "[a-z][a-z0-9_]*\\.(tsv|json)");
  static const std::regex kSessions("(sub-[0-9a-zA-Z]+)/\\1_sessions\\.(tsv|json)");
  static const std::regex kPlain = with_session("(sub-[0-9a-zA-Z]+)/" + kData, "");
  static const std::regex kOfSession =
      with_session("(sub-[0-9a-zA-Z]+)/(ses-[0-9a-zA-Z]+)/" + kData, "_\\2");
  return std::regex_match(name, kRoot) || std::regex_match(name, kSessions) ||
         std::regex_match(name, kPlain) || std::regex_match(name, kOfSession);
}

// --- Motion ---

/// The columns that *_channels.tsv begins with. Source: schema, rules/tabular_data/motion.yaml.
constexpr std::array<const char*, 5> kFirstChannelColumns{"name", "component", "type",
                                                          "tracked_point", "units"};
/// The other columns that need no description. Source: the same.
const std::set<std::string> kOtherChannelColumns{"placement",   "reference_frame",
                                                 "description", "sampling_frequency",
                                                 "status",      "status_description"};
/// Source: "Motion", "Restricted keyword list for channel component".
const std::set<std::string> kComponents{"x",      "y",      "z",      "quat_x",
                                        "quat_y", "quat_z", "quat_w", "n/a"};
/// Source: "Motion", "Restricted keyword list for channel type".
const std::set<std::string> kChannelTypes{"ACCEL", "ANGACCEL", "GYRO", "JNTANG", "LATENCY",
                                          "MAGN",  "MISC",     "ORNT", "POS",    "VEL"};
/// Required fields of *_motion.json. Source: schema, rules/sidecars/motion.yaml.
constexpr std::array<const char*, 2> kMotionFields{"TaskName", "SamplingFrequency"};
/// All its fields but the counts of channels. Source: the same; npm's validator refuses others.
const std::set<std::string> kAllMotionFields{"TaskName",
                                             "TaskDescription",
                                             "Instructions",
                                             "InstitutionName",
                                             "InstitutionAddress",
                                             "InstitutionalDepartmentName",
                                             "DeviceSerialNumber",
                                             "Manufacturer",
                                             "ManufacturersModelName",
                                             "SoftwareVersions",
                                             "SamplingFrequency",
                                             "SamplingFrequencyEffective",
                                             "SubjectArtefactDescription",
                                             "TrackingSystemName",
                                             "TrackedPointsCount",
                                             "MissingValues",
                                             "MotionChannelCount"};

/// Checks *_channels.tsv, and the counts of channels in the recording's JSON.
Lines check_channels(const fs::path& dataset, const fs::path& recording, const json& sidecar,
                     Faults& faults) {
  const std::vector<fs::path> files = inherited(dataset, recording, "channels", ".tsv", faults);
  if (files.empty()) {
    faults.push_back(recording.string() + ": has no channels.tsv");
    return {{""}};
  }
  const Lines table = check_tsv(files.back(), faults);
  const auto fault = [&](const std::string& what) {
    faults.push_back(files.back().string() + ": " + what);
  };
  for (std::size_t k = 0; k < table[0].size(); ++k) {
    const bool is_known = k < kFirstChannelColumns.size()
                              ? table[0][k] == kFirstChannelColumns[k]
                              : kOtherChannelColumns.contains(table[0][k]);
    if (!is_known) fault("column " + table[0][k]);
  }
  if (table[0].size() < kFirstChannelColumns.size()) {
    fault("lacks a column");
    return {{""}};
  }
  std::map<std::string, int> counts;
  std::set<std::string> names;
  for (std::size_t i = 1; i < table.size(); ++i) {
    const std::string& type = table[i][2];
    if (!names.insert(table[i][0]).second) fault("has two channels " + table[i][0]);
    if (!kComponents.contains(table[i][1])) fault("component " + table[i][1]);
    if (!kChannelTypes.contains(type)) fault("type " + type);
    if (type == "POS" && table[i][1] == "n/a") fault("a position without an axis");
    if (type == "LATENCY" && table[i][4] != "s") fault("a latency that is not in seconds");
    ++counts[type];
  }
  for (const std::string& type : kChannelTypes) {
    if (sidecar.value(type + "ChannelCount", 0) != counts[type]) fault("miscounts " + type);
  }
  const auto column = std::ranges::find(table[0], "reference_frame") - table[0].begin();
  const json frames = sidecar_of(dataset, files.back(), faults)
                          .value("reference_frame", json::object())
                          .value("Levels", json::object());
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (static_cast<std::size_t>(column) == table[0].size()) break;
    const std::string& frame = table[i][static_cast<std::size_t>(column)];
    if (frame != "n/a" && !frames.contains(frame)) fault("frame " + frame + " is not described");
  }
  return table;
}

/// A recording has no header, a column for each channel, latencies from 0 upwards in seconds, the
/// JSON that is required, events, and a row in *_scans.tsv. Source: "Motion".
void check_motion(const fs::path& dataset, const fs::path& path, Faults& faults) {
  static const std::regex kLatency("[0-9]+(\\.[0-9]{1,6})?|n/a");
  static const std::regex kTime(
      "[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}(\\.[0-9]{1,6})?");
  const std::string name = path.filename().string();
  const auto fault = [&](const std::string& what) { faults.push_back(name + ": " + what); };
  const json sidecar = sidecar_of(dataset, path, faults);
  for (const char* field : kMotionFields) {
    if (!sidecar.contains(field)) fault(std::string("lacks ") + field);
  }
  for (const auto& [field, value] : sidecar.items()) {
    const bool counts = field.ends_with("ChannelCount") &&
                        kChannelTypes.contains(field.substr(0, field.find("ChannelCount")));
    if (!counts && !kAllMotionFields.contains(field)) fault("has a field " + field);
  }
  const Lines channels = check_channels(dataset, path, sidecar, faults);
  double before = 0.0;
  const Lines rows = split(text_of_file(path));
  for (const auto& row : rows) {
    if (row.size() + 1 != channels.size()) return fault("has a column without a channel");
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (row[k] != "n/a" && !is_number(row[k])) return fault("has no number but " + row[k]);
      if (channels[k + 1][2] != "LATENCY") continue;
      const double latency = number_in<double>(row[k]).value_or(before);
      if (!std::regex_match(row[k], kLatency) || latency < before) fault("latency " + row[k]);
      if (&row == &rows.front() && latency != 0.0) fault("does not begin at 0");
      before = latency;
    }
  }
  if (!fs::exists(path.parent_path() / std::regex_replace(name, std::regex("_motion"), "_events")))
    fault("has no events");
  const NameParts parts = parts_of(path);
  const fs::path folder = path.parent_path().parent_path();
  const std::string session =
      parts.entities.contains("ses") ? "_ses-" + parts.entities.at("ses") : "";
  const Lines scans =
      check_tsv(folder / ("sub-" + parts.entities.at("sub") + session + "_scans.tsv"), faults);
  const auto scan = std::ranges::find_if(
      scans, [&](const auto& row) { return row[0] == path.lexically_relative(folder).string(); });
  if (scans[0] != std::vector<std::string>{"filename", "acq_time"} || scan == scans.end() ||
      !std::regex_match(scan->back(), kTime)) {
    fault("has no time in scans.tsv");
  }
}

/// Every file of *_scans.tsv is there, once. Source: "Data summary files", "Scans file".
void check_scans(const fs::path& path, Faults& faults) {
  std::set<std::string> seen;
  const Lines table = check_tsv(path, faults);
  for (std::size_t i = 1; i < table.size(); ++i) {
    const bool is_there = fs::exists(path.parent_path() / table[i][0]);
    if (!is_there || !seen.insert(table[i][0]).second) faults.push_back("scans: " + table[i][0]);
  }
}

// --- Other tables ---

/// Rows of events begin with a time and a duration, in order; unknown times come last. Source:
/// schema, rules/tabular_data/events.yaml and rules/checks/events.yaml.
void check_events(const fs::path& dataset, const fs::path& path, Faults& faults) {
  const std::string name = path.filename().string();
  const Lines table = check_tsv(path, faults);
  check_columns(path, table, sidecar_of(dataset, path, faults), faults);
  if (table[0].size() < 2 || table[0][0] != "onset" || table[0][1] != "duration") {
    faults.push_back(name + ": does not begin with onset and duration");
    return;
  }
  double before = 0.0;
  for (std::size_t i = 1; i < table.size(); ++i) {
    const double onset = table[i][0] == "n/a" ? std::numeric_limits<double>::infinity()
                                              : number_in<double>(table[i][0]).value_or(-1.0);
    if (onset < before) faults.push_back(name + ": onset " + table[i][0]);
    if (table[i][1] != "n/a" && number_in<double>(table[i][1]).value_or(-1.0) < 0.0) {
      faults.push_back(name + ": duration " + table[i][1]);
    }
    before = onset;
  }
}

/// The answers to a questionnaire, one row a participant. Source: "Phenotypic and assessment data";
/// schema, rules/tabular_data/modality_agnostic.yaml, Phenotype.
void check_phenotype(const fs::path& dataset, const fs::path& path, Faults& faults) {
  const std::string name = path.string();
  const json sidecar = parsed(name.substr(0, name.size() - 4) + ".json", faults);
  if (!sidecar.contains("MeasurementToolMetadata")) faults.push_back(name + ": not described");
  const Lines table = check_tsv(path, faults);
  check_columns(path, table, sidecar, faults);
  std::set<std::string> listed;
  if (table[0][0] != "participant_id") faults.push_back(name + ": participant_id is not first");
  for (std::size_t i = 1; i < table.size(); ++i) {
    if (!fs::exists(dataset / table[i][0])) faults.push_back(name + ": nobody is " + table[i][0]);
    if (!listed.insert(table[i][0]).second) faults.push_back(name + ": twice " + table[i][0]);
  }
}

/// Source: "Data summary files", "Sessions file".
void check_sessions(const fs::path& dataset, const fs::path& path, Faults& faults) {
  const std::string name = path.string();
  const Lines table = check_tsv(path, faults);
  check_columns(name, table, parsed(name.substr(0, name.size() - 4) + ".json", faults), faults);
  if (table[0][0] != "session_id") faults.push_back(name + ": session_id is not first");
  const Lines people = check_tsv(dataset / "participants.tsv", faults);
  for (const std::string& column : table[0]) {
    if (std::ranges::count(people[0], column) > 0) {
      faults.push_back(name + ": participants.tsv has a column " + column + " too");
    }
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
    if (name.ends_with("_motion.tsv")) check_motion(dataset, entry.path(), faults);
    if (name.ends_with("_scans.tsv")) check_scans(entry.path(), faults);
    if (name.ends_with("_sessions.tsv")) check_sessions(dataset, entry.path(), faults);
  }
  return faults;
}

}  // namespace touchtrial
