#include "protocols/store/payload_json.hpp"

#include "core/errors.hpp"
#include "protocols/store/payload_object.hpp"
#include "protocols/store/study_store.hpp"

#include <limits>

namespace touchtrial::store {
namespace {

using nlohmann::json;

constexpr std::int64_t kAny = std::numeric_limits<std::int64_t>::max();

json hex(const Digest& digest) {
  return to_hex(digest);
}

json station_object(const StationRecord& station) {
  return {{"model", station.model},
          {"firmware", station.firmware},
          {"max_force_n", finite(station.max_force_n, "max_force_n")},
          {"visual", station.visual},
          {"rate_hz", finite(station.rate_hz, "rate_hz")},
          {"scheduling", station.scheduling},
          {"calibration", station.calibration}};
}

std::optional<StationRecord> station_of(const std::optional<PayloadObject>& object) {
  if (!object) return std::nullopt;
  return StationRecord{.model = object->text("model"),
                       .firmware = object->text("firmware"),
                       .max_force_n = object->number("max_force_n"),
                       .visual = object->flag("visual"),
                       .rate_hz = object->number("rate_hz"),
                       .scheduling = object->text("scheduling"),
                       .calibration = object->text("calibration")};
}

json servo_object(const ServoHealth& servo) {
  return {{"rate_hz", finite(servo.rate_hz, "rate_hz")},
          {"lateness_p50_us", finite(servo.lateness_p50_us, "lateness_p50_us")},
          {"lateness_p99_us", finite(servo.lateness_p99_us, "lateness_p99_us")},
          {"lateness_p999_us", finite(servo.lateness_p999_us, "lateness_p999_us")},
          {"lateness_worst_us", finite(servo.lateness_worst_us, "lateness_worst_us")},
          {"lost", servo.lost},
          {"held", servo.held}};
}

std::optional<ServoHealth> servo_of(const std::optional<PayloadObject>& object) {
  if (!object) return std::nullopt;
  return ServoHealth{.rate_hz = object->number("rate_hz"),
                     .lateness_p50_us = object->number("lateness_p50_us"),
                     .lateness_p99_us = object->number("lateness_p99_us"),
                     .lateness_p999_us = object->number("lateness_p999_us"),
                     .lateness_worst_us = object->number("lateness_worst_us"),
                     .lost = object->integer("lost", 0, kAny),
                     .held = object->integer("held", 0, kAny)};
}

}  // namespace

std::string to_json(const StudyCommitment& body) {
  return compact({{"study", body.study},
                  {"protocol", body.protocol},
                  {"study_id", body.study_id},
                  {"seal", hex(body.seal)},
                  {"pack", hex(body.pack)},
                  {"configuration", body.configuration},
                  {"scored_trials", body.scored_trials},
                  {"positions", body.positions},
                  {"simulated", body.simulated},
                  {"pilot", body.pilot},
                  {"program_version", body.program_version}});
}

StudyCommitment commitment_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.study = object.text("study"),
          .protocol = object.text("protocol"),
          .study_id = object.text("study_id"),
          .seal = object.digest("seal"),
          .pack = object.digest("pack"),
          .configuration = object.text("configuration"),
          .scored_trials = object.count("scored_trials", 0),
          .positions = object.count("positions", 0),
          .simulated = object.flag("simulated"),
          .pilot = object.flag("pilot"),
          .program_version = object.text("program_version")};
}

std::string to_json(const SessionOpening& body) {
  json object = {{"participant", body.participant},
                 {"enrolment", body.enrolment},
                 {"study_id", body.study_id},
                 {"seal", hex(body.seal)},
                 {"device", body.device},
                 {"device_serial", body.device_serial},
                 {"opened_utc", body.opened_utc},
                 {"simulated", body.simulated},
                 {"pilot", body.pilot}};
  if (body.station) object["station"] = station_object(*body.station);
  return compact(object);
}

SessionOpening opening_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.participant = object.text("participant"),
          .enrolment = object.count("enrolment", 1),
          .study_id = object.text("study_id"),
          .seal = object.digest("seal"),
          .device = object.text("device"),
          .device_serial = object.text("device_serial"),
          .opened_utc = object.text("opened_utc"),
          .simulated = object.flag("simulated"),
          .pilot = object.flag("pilot"),
          .station = station_of(object.optional_object("station"))};
}

std::string to_json(const AnswerBody& body) {
  json object = {{"trial", body.trial}, {"position", body.position}};
  if (body.first_position) object["first_position"] = *body.first_position;
  if (body.confidence) object["confidence"] = *body.confidence;
  return compact(object);
}

AnswerBody answer_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.trial = object.count("trial", 1),
          .position = object.count("position", 0),
          .first_position = object.optional_count("first_position", 0),
          .confidence = object.optional_count("confidence", 0)};
}

std::string to_json(const PracticeBody& body) {
  return compact({{"round", body.round},
                  {"presentation", body.presentation},
                  {"position", body.position},
                  {"correct", body.correct}});
}

PracticeBody practice_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.round = object.count("round", 1),
          .presentation = object.count("presentation", 1),
          .position = object.count("position", 0),
          .correct = object.flag("correct")};
}

std::string to_json(const DeviationBody& body) {
  return compact({{"code", body.code}, {"text", body.text}});
}

DeviationBody deviation_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.code = object.text("code"), .text = object.text("text")};
}

std::string to_json(const ResumedBody& body) {
  return compact({{"after", body.after},
                  {"away_s", finite(body.away_s, "away_s")},
                  {"program_version", body.program_version}});
}

ResumedBody resumed_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.after = object.text("after"),
          .away_s = object.number("away_s"),
          .program_version = object.text("program_version")};
}

std::string to_json(const TraceBody& body) {
  json object = {{"trial", body.trial},
                 {"samples", body.samples},
                 {"rate_hz", finite(body.rate_hz, "rate_hz")},
                 {"overruns", body.overruns},
                 {"valid", body.valid},
                 {"trace", hex(body.trace)}};
  if (!body.explorations.empty()) object["explorations"] = body.explorations;
  if (body.servo) object["servo"] = servo_object(*body.servo);
  return compact(object);
}

TraceBody trace_body_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.trial = object.count("trial", 1),
          .samples = object.integer("samples", 0, kAny),
          .rate_hz = object.number("rate_hz"),
          .overruns = object.integer("overruns", 0, kAny),
          .valid = object.flag("valid"),
          .trace = object.digest("trace"),
          .explorations = object.optional_integers("explorations"),
          .servo = servo_of(object.optional_object("servo"))};
}

std::string to_json(const TrialMeasures& body) {
  json object = {{"contact_s", finite(body.contact_s, "contact_s")},
                 {"path_mm", finite(body.path_mm, "path_mm")},
                 {"force_rms_n", finite(body.force_rms_n, "force_rms_n")},
                 {"saturated_share", finite(body.saturated_share, "saturated_share")},
                 {"within_limits", body.within_limits}};
  if (body.limited_ticks) object["limited_ticks"] = *body.limited_ticks;
  return compact(object);
}

TrialMeasures measures_from_json(const std::string& text) try {
  const PayloadObject object(text);
  return {.contact_s = object.number("contact_s"),
          .path_mm = object.number("path_mm"),
          .force_rms_n = object.number("force_rms_n"),
          .saturated_share = object.number("saturated_share"),
          .within_limits = object.flag("within_limits"),
          .limited_ticks = object.optional_integer("limited_ticks")};
} catch (const StoreError& error) {
  throw StoreError(std::string("sealed measures of a trial: ") + error.what() +
                   "; the database is damaged or of another version, restore it from a backup");
}

std::string to_json(const InterruptionDetail& body) {
  return compact({{"safety_fault", body.safety_fault},
                  {"device_fault", body.device_fault},
                  {"ticks", body.ticks},
                  {"flight", body.flight}});
}

InterruptionDetail interruption_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.safety_fault = object.text("safety_fault"),
          .device_fault = object.text("device_fault"),
          .ticks = object.integer("ticks", 0, kAny),
          .flight = object.text("flight")};
}

std::string to_json(const ChainEnd& body) {
  return compact({{"length", body.length}, {"head", hex(body.head)}});
}

ChainEnd chain_end_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.length = object.integer("length", 1, kAny), .head = object.digest("head")};
}

std::string to_json(const SessionOpenedBody& body) {
  return compact({{"session", body.session},
                  {"participant", body.participant},
                  {"enrolment", body.enrolment},
                  {"first", hex(body.first)},
                  {"key", hex(body.key)}});
}

SessionOpenedBody session_opened_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.session = object.count("session", 1),
          .participant = object.text("participant"),
          .enrolment = object.count("enrolment", 1),
          .first = object.digest("first"),
          .key = object.digest("key"),
          .station = object.optional_count("station", 1).value_or(0),
          .own_session = object.optional_count("own_session", 1).value_or(0)};
}

std::string to_json(const SessionClosedBody& body) {
  return compact({{"session", body.session},
                  {"length", body.length},
                  {"head", hex(body.head)},
                  {"complete", body.complete}});
}

SessionClosedBody session_closed_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.session = object.count("session", 1),
          .length = object.integer("length", 1, kAny),
          .head = object.digest("head"),
          .complete = object.flag("complete")};
}

std::string to_json(const ParticipantBody& body) {
  return compact({{"session", body.session}, {"reason", body.reason}});
}

ParticipantBody participant_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.session = object.count("session", 1), .reason = object.text("reason")};
}

std::string to_json(const ReplacementBody& body) {
  return compact({{"session", body.session}, {"by", body.by}, {"reason", body.reason}});
}

ReplacementBody replacement_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.session = object.count("session", 1),
          .by = object.text("by"),
          .reason = object.text("reason")};
}

std::string to_json(const NoteBody& body) {
  return compact({{"session", body.session}, {"code", body.code}, {"text", body.text}});
}

NoteBody note_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.session = object.count("session", 1),
          .code = object.text("code"),
          .text = object.text("text")};
}

std::string to_json(const UnblindingBody& body) {
  json object = {{"reason", body.reason}, {"interim", body.interim}};
  if (body.sessions) object["sessions"] = *body.sessions;
  return compact(object);
}

UnblindingBody unblinding_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.reason = object.text("reason"),
          .interim = object.flag("interim"),
          .sessions = object.optional_counts("sessions", 1)};
}

std::string presented_to_json(int trial, int block) {
  return compact({{"trial", trial}, {"block", block}});
}

std::string interrupted_to_json(int trial, const std::string& reason) {
  return compact({{"trial", trial}, {"reason", reason}});
}

std::string block_to_json(int block, int first_trial) {
  return compact({{"block", block}, {"first_trial", first_trial}});
}

BlockBody block_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.block = object.count("block", 0), .first_trial = object.count("first_trial", 1)};
}

std::string trial_to_json(int trial) {
  return compact({{"trial", trial}});
}

TrialBody trial_from_json(const std::string& text) {
  const PayloadObject object(text);
  return {.trial = object.count("trial", 1),
          .block = object.optional_count("block", 0).value_or(0),
          .reason = object.optional_text("reason").value_or("")};
}

std::string remark_to_json(const std::string& text) {
  return compact({{"text", text}});
}

std::string remark_from_json(const std::string& text) {
  return PayloadObject(text).text("text");
}

std::string completion_to_json(bool complete) {
  return compact({{"complete", complete}});
}

bool completion_from_json(const std::string& text) {
  return PayloadObject(text).flag("complete");
}

// Not by way of the structs, so that what they gain later changes no collected chain.
std::string renumbered(const std::string& body, int session) {
  static_cast<void>(PayloadObject(body).count("session", 1));
  json object = json::parse(body);
  object["session"] = session;
  return compact(object);
}

std::string renumbered_opening(const std::string& body, int session, int station) {
  const int own_session = PayloadObject(body).count("session", 1);
  json object = json::parse(body);
  object["session"] = session;
  object["own_session"] = own_session;
  object["station"] = station;
  return compact(object);
}

}  // namespace touchtrial::store
