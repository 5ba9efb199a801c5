#include "analysis/exports/collection_reading.hpp"

#include "analysis/exports/csv_reading.hpp"
#include "analysis/outcomes/collection_records.hpp"

#include <algorithm>
#include <array>
#include <sstream>

namespace touchtrial {
namespace {

record::SessionState session_state_of(const std::string& name) {
  if (name == "completed") return record::SessionState::completed;
  return name == "stopped" ? record::SessionState::stopped : record::SessionState::open;
}

std::optional<analysis::PracticeRecord> practice_of(const CsvRow& row) {
  if (row.at("practice_rounds").empty()) return std::nullopt;
  return analysis::PracticeRecord{
      number_of<int>(row.at("practice_rounds")), number_of<int>(row.at("practice_presentations")),
      number_of<int>(row.at("practice_correct")), is_set(row.at("practice_passed"))};
}

std::array<double, 3> axes_of(const std::string& text) {
  std::array<double, 3> axes{};
  std::istringstream words(text);
  for (double& axis : axes) words >> axis;
  return axes;
}

std::optional<record::StationRecord> station_of(const CsvRow& row) {
  if (row.at("visual").empty()) return std::nullopt;
  return record::StationRecord{row.at("device_model"),
                               row.at("device_firmware"),
                               number_of<double>(row.at("device_max_force_n")),
                               is_set(row.at("visual")),
                               number_of<double>(row.at("servo_hz")),
                               row.at("scheduling"),
                               row.at("certificate"),
                               std::nullopt,
                               axes_of(row.at("device_force_scale")),
                               axes_of(row.at("device_length_scale"))};
}

analysis::SessionRecord record_of(const CsvRow& row) {
  analysis::SessionRecord record;
  if (is_set(row.at("erased"))) {
    record.row.session = number_of<int>(row.at("session"));
    record.row.state = session_state_of(row.at("state"));
    record.row.withdrawn = true;
    record.row.erased = true;
    return record;
  }
  record.row = session_row_of(row);
  record.device_serial = row.at("device_serial");
  record.station = station_of(row);
  record.practice = practice_of(row);
  record.exclusion_reason = row.at("exclusion_reason");
  constexpr std::string_view kLate = "after outcomes were seen: ";
  record.after_outcomes = record.exclusion_reason.starts_with(kLate);
  if (record.after_outcomes) record.exclusion_reason.erase(0, kLate.size());
  record.replacement_reason = row.at("replacement_reason");
  record.stop_reason = row.at("stop_reason");
  record.withdrawal_reason = row.at("withdrawal_reason");
  if (!row.at("largest_force_n").empty()) {
    record.largest_force_n = number_of<double>(row.at("largest_force_n"));
  }
  record.resumed = number_of<int>(row.at("resumed"));
  record.interruptions = number_of<int>(row.at("interruptions"));
  record.pauses = number_of<int>(row.at("pauses"));
  record.notes = number_of<int>(row.at("notes"));
  record.answers = maybe<int>(row.at("answers"));
  record.one_key = row.at("one_key") == "1";
  if (row.contains("handedness_score")) {
    record.handedness_score = maybe<double>(row.at("handedness_score"));
  }
  return record;
}

analysis::Prescription prescription_of(const std::filesystem::path& study) {
  CsvRow single;
  for (const CsvRow& row : rows_of(study)) single[row.at("key")] = row.at("value");
  return {number_of<double>(single.at("explore_limit_s")),
          single.at("on_timeout"),
          single.at("order"),
          number_of<int>(single.at("repeats")),
          number_of<int>(single.at("method_orders")),
          single.at("sight"),
          is_set(single.at("masking_wanted")),
          number_of<double>(single.at("masking_dbfs"))};
}

void add_deviations(analysis::Collection& collection, const std::filesystem::path& file) {
  for (const CsvRow& row : rows_of(file)) {
    const int session = number_of<int>(row.at("session"));
    const auto record =
        std::ranges::find(collection.sessions, session,
                          [](const analysis::SessionRecord& one) { return one.row.session; });
    REQUIRE(record != collection.sessions.end());
    CHECK(record->row.participant == row.at("participant"));
    record->deviations.push_back({row.at("code"), row.at("text")});
  }
}

analysis::ServoTrial servo_trial_of(const CsvRow& row) {
  return {
      number_of<int>(row.at("session")),
      number_of<int>(row.at("trial")),
      {number_of<double>(row.at("rate_hz")), number_of<double>(row.at("lateness_p50_us")),
       number_of<double>(row.at("lateness_p99_us")), number_of<double>(row.at("lateness_p999_us")),
       number_of<double>(row.at("lateness_worst_us")), number_of<std::int64_t>(row.at("lost")),
       number_of<std::int64_t>(row.at("held"))},
      number_of<std::int64_t>(row.at("overruns"))};
}

/// The facts that decide which sessions count, of a study with one visit.
record::StudyCommitment commitment_of(const std::filesystem::path& study) {
  record::StudyCommitment commitment;
  commitment.configuration =
      R"({"trials": {"explore_limit_s": 1, "on_timeout": "fade", "order": "permuted",
          "repeats": 1}, "methods": [{}]})";
  for (const CsvRow& row : rows_of(study)) {
    if (row.at("key") == "simulated") commitment.simulated = is_set(row.at("value"));
    if (row.at("key") == "pilot") commitment.pilot = is_set(row.at("value"));
  }
  return commitment;
}

}  // namespace

record::SessionRow session_row_of(const CsvRow& row) {
  record::SessionRow session;
  session.session = number_of<int>(row.at("session"));
  session.own_session = session.session;  // exports do not say its number at the station
  session.station = row.at("station").empty() ? 0 : number_of<int>(row.at("station"));
  session.participant = row.at("participant");
  session.enrolment = number_of<int>(row.at("enrolment"));
  session.state = session_state_of(row.at("state"));
  session.simulated = is_set(row.at("simulated"));
  session.pilot = is_set(row.at("pilot"));
  session.excluded = is_set(row.at("excluded"));
  session.withdrawn = is_set(row.at("withdrawn"));
  session.erased = is_set(row.at("erased"));
  session.device = row.at("device");
  session.replaced_by = row.at("replaced_by");
  return session;
}

analysis::Collection collection_from_csv(const std::filesystem::path& folder,
                                         const record::StudyState& state) {
  analysis::Collection collection;
  collection.prescription = prescription_of(folder / "study.csv");
  std::vector<record::SessionRow> rows;
  for (const CsvRow& row : rows_of(folder / "participants.csv")) {
    rows.push_back(session_row_of(row));
    collection.sessions.push_back(record_of(row));
    collection.visual = collection.visual || row.at("visual") == "1";
  }
  add_deviations(collection, folder / "deviations.csv");
  for (const CsvRow& row : rows_of(folder / "servo.csv")) {
    collection.servo_trials.push_back(servo_trial_of(row));
  }
  collection.flow = analysis::participant_flow(rows, collection.sessions,
                                               commitment_of(folder / "study.csv"), state);
  return collection;
}

}  // namespace touchtrial
