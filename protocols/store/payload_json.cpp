#include "protocols/store/payload_json.hpp"

#include "core/errors.hpp"
#include "protocols/store/json_object.hpp"
#include "protocols/store/study_store.hpp"

#include <limits>

namespace touchtrial {
namespace {

using nlohmann::json;

constexpr std::int64_t kAny = std::numeric_limits<std::int64_t>::max();

json hex(const Digest& digest) {
  return to_hex(digest);
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
  const JsonObject object(text);
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
  return compact({{"participant", body.participant},
                  {"enrolment", body.enrolment},
                  {"study_id", body.study_id},
                  {"seal", hex(body.seal)},
                  {"device", body.device},
                  {"device_serial", body.device_serial},
                  {"opened_utc", body.opened_utc},
                  {"simulated", body.simulated},
                  {"pilot", body.pilot}});
}

SessionOpening opening_from_json(const std::string& text) {
  const JsonObject object(text);
  return {.participant = object.text("participant"),
          .enrolment = object.count("enrolment", 1),
          .study_id = object.text("study_id"),
          .seal = object.digest("seal"),
          .device = object.text("device"),
          .device_serial = object.text("device_serial"),
          .opened_utc = object.text("opened_utc"),
          .simulated = object.flag("simulated"),
          .pilot = object.flag("pilot")};
}

std::string to_json(const AnswerBody& body) {
  json object = {{"trial", body.trial}, {"position", body.position}};
  if (body.first_position) object["first_position"] = *body.first_position;
  if (body.confidence) object["confidence"] = *body.confidence;
  return compact(object);
}

AnswerBody answer_from_json(const std::string& text) {
  const JsonObject object(text);
  return {.trial = object.count("trial", 1),
          .position = object.count("position", 0),
          .first_position = object.optional_count("first_position", 0),
          .confidence = object.optional_count("confidence", 0)};
}

std::string to_json(const TraceBody& body) {
  return compact({{"trial", body.trial},
                  {"samples", body.samples},
                  {"rate_hz", finite(body.rate_hz, "rate_hz")},
                  {"overruns", body.overruns},
                  {"valid", body.valid},
                  {"trace", hex(body.trace)}});
}

TraceBody trace_body_from_json(const std::string& text) {
  const JsonObject object(text);
  return {.trial = object.count("trial", 1),
          .samples = object.integer("samples", 0, kAny),
          .rate_hz = object.number("rate_hz"),
          .overruns = object.integer("overruns", 0, kAny),
          .valid = object.flag("valid"),
          .trace = object.digest("trace")};
}

std::string to_json(const TrialMeasures& body) {
  return compact({{"contact_s", finite(body.contact_s, "contact_s")},
                  {"path_mm", finite(body.path_mm, "path_mm")},
                  {"force_rms_n", finite(body.force_rms_n, "force_rms_n")},
                  {"saturated_share", finite(body.saturated_share, "saturated_share")},
                  {"within_limits", body.within_limits}});
}

TrialMeasures measures_from_json(const std::string& text) try {
  const JsonObject object(text);
  return {.contact_s = object.number("contact_s"),
          .path_mm = object.number("path_mm"),
          .force_rms_n = object.number("force_rms_n"),
          .saturated_share = object.number("saturated_share"),
          .within_limits = object.flag("within_limits")};
} catch (const StoreError& error) {
  throw StoreError(std::string("sealed measures of a trial: ") + error.what() +
                   "; the database is damaged or of another version, restore it from a backup");
}

std::string to_json(const ChainEnd& body) {
  return compact({{"length", body.length}, {"head", hex(body.head)}});
}

ChainEnd chain_end_from_json(const std::string& text) {
  const JsonObject object(text);
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
  const JsonObject object(text);
  return {.session = object.count("session", 1),
          .participant = object.text("participant"),
          .enrolment = object.count("enrolment", 1),
          .first = object.digest("first"),
          .key = object.digest("key")};
}

std::string to_json(const SessionClosedBody& body) {
  return compact({{"session", body.session},
                  {"length", body.length},
                  {"head", hex(body.head)},
                  {"complete", body.complete}});
}

SessionClosedBody session_closed_from_json(const std::string& text) {
  const JsonObject object(text);
  return {.session = object.count("session", 1),
          .length = object.integer("length", 1, kAny),
          .head = object.digest("head"),
          .complete = object.flag("complete")};
}

std::string to_json(const ParticipantBody& body) {
  return compact({{"session", body.session}, {"reason", body.reason}});
}

ParticipantBody participant_from_json(const std::string& text) {
  const JsonObject object(text);
  return {.session = object.count("session", 1), .reason = object.text("reason")};
}

std::string to_json(const UnblindingBody& body) {
  return compact({{"reason", body.reason}, {"interim", body.interim}});
}

UnblindingBody unblinding_from_json(const std::string& text) {
  const JsonObject object(text);
  return {.reason = object.text("reason"), .interim = object.flag("interim")};
}

std::string presented_to_json(int trial, int block) {
  return compact({{"trial", trial}, {"block", block}});
}

std::string interrupted_to_json(int trial, const std::string& reason) {
  return compact({{"trial", trial}, {"reason", reason}});
}

std::string trial_to_json(int trial) {
  return compact({{"trial", trial}});
}

TrialBody trial_from_json(const std::string& text) {
  const JsonObject object(text);
  return {.trial = object.count("trial", 1),
          .block = object.optional_count("block", 0).value_or(0),
          .reason = object.optional_text("reason").value_or("")};
}

std::string remark_to_json(const std::string& text) {
  return compact({{"text", text}});
}

std::string completion_to_json(bool complete) {
  return compact({{"complete", complete}});
}

bool completion_from_json(const std::string& text) {
  return JsonObject(text).flag("complete");
}

}  // namespace touchtrial
