#include "analysis/exports/bids/bids_sidecars_json.hpp"

#include "analysis/exports/bids/bids_motion.hpp"
#include "analysis/exports/column_meanings.hpp"
#include "analysis/outcomes/collection.hpp"
#include "analysis/report/json_figures.hpp"
#include "core/version.hpp"
#include "study/languages.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

void put_if_nonempty(Json& object, const char* key, const std::string& value) {
  if (!value.empty()) object[key] = value;
}

/// The exporting program. The README names the recording program.
Json generated_by() {
  return Json::array({{{"Name", "Touchtrial"},
                       {"Version", program_version()},
                       {"Description", "touchtrial export --format bids"}}});
}

std::string with_stamp(const std::string& text, bool simulated) {
  return simulated ? text + " (SIMULATED)" : text;
}

void put_columns(Json& object, const std::vector<std::string>& columns) {
  for (const std::string& column : columns) {
    if (column == "participant_id" || column == "session_id") continue;
    const ColumnMeaning meaning = meaning_of(column);
    Json column_object{{"Description", meaning.description}};
    put_if_nonempty(column_object, "Units", meaning.unit);
    for (const auto& [value, value_meaning] : meaning.levels)
      column_object["Levels"][value] = value_meaning;
    object[column] = column_object;
  }
}

std::string task_description(const DatasetSource& study) {
  const record::StudyCommitment& commitment = study.store.commitment();
  const Prescription prescription = prescription_from_json(commitment.configuration);
  if (prescription.intervals > 0) {
    return fmt::format(
        "Each trial presents {} planes through a force-feedback device, one after the other and "
        "invisibly; the participant explores each and then gives one of {} "
        "answers about them. {}Protocol: {}.",
        prescription.intervals, commitment.positions,
        prescription.adaptive ? "A procedure chooses the level of each trial. " : "",
        commitment.protocol);
  }
  return fmt::format(
      "Each trial presents an invisible texture through a force-feedback device; the participant "
      "explores it and then {}. Protocol: {}.",
      commitment.positions > 0 ? fmt::format("names one of {} textures", commitment.positions)
                               : "rates it",
      commitment.protocol);
}

/// The study's own instructions, or the name of the program's instructions that it uses.
std::string instructions(const study::Study& study) {
  const auto custom = study.session.instructions.find(study.session.language);
  if (custom == study.session.instructions.end()) {
    const std::string draft = study::draft_notice(study.session.language);
    return "Touchtrial's default instructions, in the language \"" + study.session.language + "\"" +
           (study.session.texts.contains(study.session.language) ? ", some replaced" : "") +
           (draft.empty() ? "" : "; " + draft);
  }
  return fmt::format("{}", fmt::join(custom->second, "\n\n"));
}

Json columns_object(const std::vector<std::string>& columns, bool simulated) {
  Json object = Json::object();
  put_columns(object, columns);
  if (simulated) object["stamp"] = {{"Description", "SIMULATED: no row comes from a person"}};
  return object;
}

/// The software that presented the stimuli. Source: BIDS 1.11, "Task events".
void put_presentation(Json& object, const DatasetSource& study) {
  object["StimulusPresentation"] = {{"SoftwareName", "Touchtrial"},
                                    {"SoftwareVersion", study.store.commitment().program_version}};
}

/// The description of the task, for the sidecars of every datatype.
Json task_object(const DatasetSource& study, const DatasetOptions& options) {
  const record::StudyCommitment& commitment = study.store.commitment();
  Json object{{"TaskName", commitment.study}, {"TaskDescription", task_description(study)}};
  if (study.key != nullptr) object["Instructions"] = instructions(study.key->study);
  put_if_nonempty(object, "InstitutionName", options.institution);
  return object;
}

/// The number of channels of each type in a recording.
std::map<std::string_view, int> channel_counts() {
  static const DataTable kChannels = motion_channels();
  const auto type = std::ranges::find(kChannels.columns, "type") - kChannels.columns.begin();
  std::map<std::string_view, int> counts;
  for (const std::vector<DataCell>& channel : kChannels.rows) {
    ++counts[std::get<std::string>(channel[static_cast<std::size_t>(type)])];
  }
  return counts;
}

}  // namespace

std::string dataset_description_json(const DatasetSource& study, const DatasetOptions& options) {
  const record::StudyCommitment& commitment = study.store.commitment();
  Json object{{"Name", with_stamp(commitment.study, commitment.simulated)},
              {"BIDSVersion", kBidsVersion},
              {"DatasetType", "raw"}};
  put_if_nonempty(object, "License", options.license);
  if (!options.authors.empty()) object["Authors"] = options.authors;
  if (study.key != nullptr && !study.key->study.session.ethics_number.empty()) {
    object["EthicsApprovals"] = {study.key->study.session.ethics_number};
  }
  object["GeneratedBy"] = generated_by();
  put_stamp(object, commitment.simulated, simulated_devices(study.store.sessions()));
  object["pilot"] = commitment.pilot;
  object["study_id"] = commitment.study_id;
  return json_text(object);
}

std::string derivative_description_json(const DatasetSource& study) {
  const record::StudyCommitment& commitment = study.store.commitment();
  Json object{{"Name", with_stamp("Report of " + commitment.study, commitment.simulated)},
              {"BIDSVersion", kBidsVersion},
              {"DatasetType", "derivative"},
              {"GeneratedBy", generated_by()}};
  put_stamp(object, commitment.simulated, simulated_devices(study.store.sessions()));
  return json_text(object);
}

std::string columns_json(const std::vector<std::string>& columns, bool simulated) {
  return json_text(columns_object(columns, simulated));
}

std::string events_json(const DatasetSource& study, const std::vector<std::string>& columns) {
  Json object = columns_object(columns, study.store.commitment().simulated);
  put_presentation(object, study);
  return json_text(object);
}

std::string task_json(const DatasetSource& study, const DatasetOptions& options,
                      const std::vector<std::string>& columns) {
  Json object = task_object(study, options);
  put_presentation(object, study);
  put_stamp(object, study.store.commitment().simulated, simulated_devices(study.store.sessions()));
  put_columns(object, columns);
  return json_text(object);
}

// Contains exactly the fields of the specification, because the npm validator checks each file
// separately and rejects others.
std::string motion_json(const DatasetSource& study, const DatasetOptions& options,
                        const BidsSession& session, const record::TraceBody& body) {
  Json object = task_object(study, options);
  object["SamplingFrequency"] = body.rate_hz;
  object["SamplingFrequencyEffective"] = body.servo ? body.servo->rate_hz : body.rate_hz;
  object["TrackingSystemName"] = with_stamp(
      "Handle of the force-feedback device, driver " + session.row.device, session.row.simulated);
  for (const SessionRecord& record : study.outcomes->collection.sessions) {
    if (record.row.session != session.row.session) continue;
    put_if_nonempty(object, "DeviceSerialNumber", record.device_serial);
    if (!record.station) continue;
    put_if_nonempty(object, "ManufacturersModelName", record.station->model);
    put_if_nonempty(object, "SoftwareVersions", record.station->firmware);
  }
  const std::map<std::string_view, int> counts = channel_counts();
  for (const char* type :
       {"ACCEL", "ANGACCEL", "GYRO", "JNTANG", "LATENCY", "MAGN", "MISC", "ORNT", "POS", "VEL"}) {
    const auto found = counts.find(type);
    object[std::string(type) + "ChannelCount"] = found == counts.end() ? 0 : found->second;
  }
  object["MotionChannelCount"] = object["POSChannelCount"];
  object["TrackedPointsCount"] = 1;
  object["MissingValues"] = "n/a";
  return json_text(object);
}

std::string channels_json() {
  const Json object{
      {"reference_frame",
       {{"Description", "Frame of positions and forces"},
        {"Levels",
         {{"plane",
           {{"Description",
             "The felt plane: the origin is the top left corner of the texture, x goes to "
             "its right edge, y to its bottom edge, and z out of the plane, towards the "
             "hand"}}}}}}}};
  return json_text(object);
}

std::string questionnaire_json(const BidsQuestionnaire& questionnaire, const std::string& language,
                               bool simulated) {
  const std::string description =
      questionnaire.tool == "handedness"
          ? "Edinburgh Handedness Inventory, short form (Veale 2014), and the "
            "hand that held the pen"
          : "Questions of the study, questionnaire \"" + questionnaire.tool + "\"";
  Json object{{"MeasurementToolMetadata", {{"Description", description}}}};
  put_stamp(object, simulated);
  const std::vector<std::string>& columns = questionnaire.table.columns;
  const std::size_t first = columns.size() - questionnaire.questions.size();
  for (std::size_t i = 0; i < questionnaire.questions.size(); ++i) {
    const study::Question* const question = questionnaire.questions[i];
    Json question_object{{"Description", "Answer to the question " + columns[first + i]}};
    if (question != nullptr) question_object["Description"] = in_language(question->text, language);
    for (std::size_t k = 0; question != nullptr && k < question->options.size(); ++k) {
      question_object["Levels"][std::to_string(k)] = in_language(question->options[k], language);
    }
    object[columns[first + i]] = question_object;
  }
  return json_text(object);
}

}  // namespace touchtrial::analysis
