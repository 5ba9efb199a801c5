#include "record/payload_json.hpp"

#include "record/marks.hpp"
#include "record/opened_parts.hpp"
#include "record/payload_io.hpp"

#include <type_traits>

namespace touchtrial::record {
namespace {

using nlohmann::json;

/// A body as `members` gets it: const where it is written.
template <typename Io, typename Body>
using In = std::conditional_t<std::is_same_v<Io, BodyWriter>, const Body, Body>;

std::string compact(const json& object) {
  try {
    return object.dump();
  } catch (const json::exception&) {
    throw StoreError("a text to be stored is not UTF-8; type it again without special characters");
  }
}

/// One member of a body, which may hold others.
template <typename Value, typename... Least>
Value member_of(const std::string& text, const char* key, Least... least) {
  const BodyReader reader(text);
  Value value{};
  reader(key, value, least...);
  return value;
}

}  // namespace

/// Left out of a first visit.
template <typename Io>
void visit_member(Io& io, In<Io, int>& visit) {
  if constexpr (std::is_same_v<Io, BodyWriter>) {
    if (visit == 1) return;
  }
  io.if_any("visit", visit, 2);
}

/// A choice or a rating, whose members are inlined into the body.
template <typename Io>
void answer_members(Io& io, In<Io, std::optional<Answer>>& answer) {
  std::optional<int> position = position_of(answer);
  std::optional<int> first_position = first_position_of(answer);
  std::optional<std::vector<double>> ratings;
  if (answer && !position) ratings = ratings_of(answer);
  io("position", position);
  io("first_position", first_position);
  io("ratings", ratings);
  if constexpr (!std::is_same_v<Io, BodyWriter>) {
    if (position && ratings) throw StoreError("/ratings stands beside a position");
    if (position) answer = Chosen{*position, first_position};
    if (ratings) answer = Rated{std::move(*ratings)};
  }
}

// The members of each body: key, member, and the minimum of a whole number unless it is 0.

template <typename Io>
void members(Io& io, In<Io, StationIdentity>& body) {
  io("name", body.name);
  io("key", body.key);
  io("certificate", body.certificate);
}

template <typename Io>
void members(Io& io, In<Io, StudyCommitment>& body) {
  io("study", body.study);
  io("protocol", body.protocol);
  io("study_id", body.study_id);
  io("seal", body.seal);
  io("pack", body.pack);
  io("configuration", body.configuration);
  io("scored_trials", body.scored_trials);
  io("positions", body.positions);
  io("simulated", body.simulated);
  io("pilot", body.pilot);
  io("safety_record_years", body.safety_record_years);
  io("program_version", body.program_version);
  io("investigator", body.investigator);
  io.part("station", body.station);
}

template <typename Io>
void members(Io& io, In<Io, ScreenRecord>& body) {
  io("mm_per_px", body.mm_per_px);
  io("source", body.source);
}

template <typename Io>
void members(Io& io, In<Io, StationRecord>& body) {
  io("model", body.model);
  io("firmware", body.firmware);
  io("max_force_n", body.max_force_n);
  io("visual", body.visual);
  io("rate_hz", body.rate_hz);
  io("scheduling", body.scheduling);
  io("calibration", body.calibration);
  io.part("screen", body.screen);
  io("force_scale", body.force_scale);
  io("length_scale", body.length_scale);
}

template <typename Io>
void members(Io& io, In<Io, SessionOpening>& body) {
  io("participant", body.participant);
  io("enrolment", body.enrolment, 1);
  visit_member(io, body.visit);
  io.if_any("group", body.group);
  io("study_id", body.study_id);
  io("seal", body.seal);
  io("device", body.device);
  io("device_serial", body.device_serial);
  io("opened_utc", body.opened_utc);
  io("simulated", body.simulated);
  io("pilot", body.pilot);
  io.part("station", body.station);
}

template <typename Io>
void members(Io& io, In<Io, AnswerBody>& body) {
  io("trial", body.trial, 1);
  answer_members(io, body.answer);
  io("confidence", body.confidence);
  io("kind", body.kind);
  io("track", body.track);
  io("level", body.level);
  io("target", body.target);
}

template <typename Io>
void members(Io& io, In<Io, MarksBody>& body) {
  io("codes", body.codes);
  io("trials", body.trials);
  io("at_ns", body.at_ns);
  io("latency_ns", body.latency_ns);
  io("lsl_zero_s", body.lsl_zero_s);
  io("lsl_uncertainty_s", body.lsl_uncertainty_s);
}

template <typename Io>
void members(Io& io, In<Io, PracticeBody>& body) {
  io("round", body.round, 1);
  io("presentation", body.presentation, 1);
  answer_members(io, body.answer);
  io("correct", body.correct);
}

template <typename Io>
void members(Io& io, In<Io, StopBody>& body) {
  io.if_any("code", body.code);
  io.sealed("text", body.text);
}

template <typename Io>
void members(Io& io, In<Io, DeviationBody>& body) {
  io("code", body.code);
  io.sealed("text", body.text);
}

template <typename Io>
void members(Io& io, In<Io, PauseBody>& body) {
  io.sealed("text", body.text);
  io.if_any("trial", body.trial, 1);
}

template <typename Io>
void members(Io& io, In<Io, ResumedBody>& body) {
  io("after", body.after);
  io.sealed("away_s", body.away_s);
  io("program_version", body.program_version);
  io.if_any("trial", body.trial, 1);
}

template <typename Io>
void members(Io& io, In<Io, ServoHealth>& body) {
  io("rate_hz", body.rate_hz);
  io("lateness_p50_us", body.lateness_p50_us);
  io("lateness_p99_us", body.lateness_p99_us);
  io("lateness_p999_us", body.lateness_p999_us);
  io("lateness_worst_us", body.lateness_worst_us);
  io("lost", body.lost);
  io("held", body.held);
}

template <typename Io>
void members(Io& io, In<Io, TraceBody>& body) {
  io("trial", body.trial, 1);
  io.sealed("samples", body.samples);
  io("rate_hz", body.rate_hz);
  io("overruns", body.overruns);
  io("valid", body.valid);
  io("contact_ok", body.hand.contact);
  io("path_ok", body.hand.path);
  io("force_ok", body.hand.force);
  io("speed_ok", body.hand.speed);
  io.sealed("saturated", body.saturated);
  io("trace", body.trace);
  io.sealed("largest_force_n", body.largest_force_n);
  io.if_any("explorations", body.explorations);
  io.if_any("began_ns", body.began_ns);
  io.part("servo", body.servo);
}

template <typename Io>
void members(Io& io, In<Io, TrialMeasures>& body) {
  io("contact_s", body.contact_s);
  io("path_mm", body.path_mm);
  io("force_rms_n", body.force_rms_n);
  io("saturated_share", body.saturated_share);
  io("within_limits", body.within_limits);
  io("limited_ticks", body.limited_ticks);
}

template <typename Io>
void members(Io& io, In<Io, InterruptionDetail>& body) {
  io("safety_fault", body.safety_fault);
  io("device_fault", body.device_fault);
  io("ticks", body.ticks);
  io("flight", body.flight);
}

template <typename Io>
void members(Io& io, In<Io, ClosedBody>& body) {
  io("complete", body.complete);
  io.if_any("answers", body.answers);
  io.if_any("one_key", body.one_key);
  io("largest_force_n", body.largest_force_n);
}

template <typename Io>
void members(Io& io, In<Io, ChainEnd>& body) {
  io("length", body.length, 1);
  io("head", body.head);
}

template <typename Io>
void members(Io& io, In<Io, SessionOpenedBody>& body) {
  io("session", body.session, 1);
  io("participant", body.participant);
  io("enrolment", body.enrolment, 1);
  visit_member(io, body.visit);
  io("first", body.first);
  io("key", body.key);
  io("safety_key", body.safety_key);
  io("kept", body.kept);
  io("remarks", body.remarks);
  io("reasons", body.reasons);
  io.if_any("station", body.station, 1);
  io.if_any("own_session", body.own_session, 1);
}

template <typename Io>
void members(Io& io, In<Io, SessionClosedBody>& body) {
  io("session", body.session, 1);
  io("length", body.length, 1);
  io("head", body.head);
  io("complete", body.complete);
}

template <typename Io>
void members(Io& io, In<Io, ParticipantBody>& body) {
  io("session", body.session, 1);
  io.sealed("reason", body.reason);
  io.if_any("after_outcomes", body.after_outcomes);
}

template <typename Io>
void members(Io& io, In<Io, WithdrawalBody>& body) {
  io("session", body.session, 1);
  io("kept", body.kept);
  io.sealed("reason", body.reason);
  io.if_any("not_erased", body.not_erased);
}

template <typename Io>
void members(Io& io, In<Io, ReplacementBody>& body) {
  io("session", body.session, 1);
  io("by", body.by);
  io.sealed("reason", body.reason);
}

template <typename Io>
void members(Io& io, In<Io, NoteBody>& body) {
  io("session", body.session, 1);
  io("code", body.code);
  io.sealed("text", body.text);
}

template <typename Io>
void members(Io& io, In<Io, UnblindingBody>& body) {
  io("reason", body.reason);
  io("interim", body.interim);
  io.if_any("question_alone", body.question_alone);
  io("sessions", body.sessions);
  io.if_any("participant", body.participant);
}

template <typename Io>
void members(Io& io, In<Io, LossBody>& body) {
  io("reason", body.reason);
  io("missing", body.missing);
  io("answers", body.answers);
}

template <typename Io>
void members(Io& io, In<Io, HeadsBody>& body) {
  io("also", body.also);
}

// Only for reading: writers omit members by kind of event.

template <typename Io>
void members(Io& io, In<Io, TrialBody>& body) {
  io("trial", body.trial, 1);
  io.if_any("block", body.block);
  io.if_any("reason", body.reason);
  io.if_any("safety_fault", body.safety_fault);
  io.if_any("device_fault", body.device_fault);
  io.if_any("largest_force_n", body.largest_force_n);
}

template <typename Io>
void members(Io& io, In<Io, BlockBody>& body) {
  io("block", body.block);
  io("first_trial", body.first_trial, 1);
}

template <typename Body>
std::string to_json(const Body& body) {
  BodyWriter writer;
  members(writer, body);
  return compact(writer.object());
}

template <typename Body>
Body from_json(const std::string& text) {
  BodyReader reader(text);
  Body body;
  members(reader, body);
  return body;
}

template <typename Body>
Body from_parts(const BodyParts& parts) {
  BodyReader reader(parts.clear, parts.hidden);
  Body body;
  members(reader, body);
  return body;
}

template AnswerBody from_parts(const BodyParts&);
template TraceBody from_parts(const BodyParts&);

template std::string to_json(const StudyCommitment&);
template std::string to_json(const SessionOpening&);
template std::string to_json(const AnswerBody&);
template std::string to_json(const PracticeBody&);
template std::string to_json(const StopBody&);
template std::string to_json(const DeviationBody&);
template std::string to_json(const PauseBody&);
template std::string to_json(const ResumedBody&);
template std::string to_json(const TraceBody&);
template std::string to_json(const TrialMeasures&);
template std::string to_json(const InterruptionDetail&);
template std::string to_json(const ClosedBody&);
template std::string to_json(const ChainEnd&);
template std::string to_json(const SessionOpenedBody&);
template std::string to_json(const SessionClosedBody&);
template std::string to_json(const ParticipantBody&);
template std::string to_json(const WithdrawalBody&);
template std::string to_json(const ReplacementBody&);
template std::string to_json(const NoteBody&);
template std::string to_json(const UnblindingBody&);
template std::string to_json(const LossBody&);
template std::string to_json(const HeadsBody&);
template std::string to_json(const MarksBody&);

template StudyCommitment from_json(const std::string&);
template SessionOpening from_json(const std::string&);
template AnswerBody from_json(const std::string&);
template PracticeBody from_json(const std::string&);
template StopBody from_json(const std::string&);
template DeviationBody from_json(const std::string&);
template PauseBody from_json(const std::string&);
template ResumedBody from_json(const std::string&);
template TraceBody from_json(const std::string&);
template InterruptionDetail from_json(const std::string&);
template ClosedBody from_json(const std::string&);
template ChainEnd from_json(const std::string&);
template SessionOpenedBody from_json(const std::string&);
template SessionClosedBody from_json(const std::string&);
template ParticipantBody from_json(const std::string&);
template WithdrawalBody from_json(const std::string&);
template ReplacementBody from_json(const std::string&);
template NoteBody from_json(const std::string&);
template UnblindingBody from_json(const std::string&);
template LossBody from_json(const std::string&);
template HeadsBody from_json(const std::string&);
template TrialBody from_json(const std::string&);
template BlockBody from_json(const std::string&);

MarksBody marks_from_json(const std::string& text) {
  auto marks = from_json<MarksBody>(text);
  const std::size_t count = marks.codes.size();
  if (marks.trials.size() != count || marks.at_ns.size() != count ||
      marks.latency_ns.size() != count) {
    throw StoreError("/codes has another length than the lists beside it");
  }
  return marks;
}

TrialMeasures measures_from_json(const std::string& text) try {
  return from_json<TrialMeasures>(text);
} catch (const StoreError& error) {
  throw StoreError(std::string("sealed measures of a trial: ") + error.what() +
                   "; the database is damaged or of another version, restore it from a backup");
}

std::string presented_to_json(int trial, int block) {
  return compact({{"trial", trial}, {"block", block}});
}

std::string interrupted_to_json(int trial, const std::string& reason,
                                const InterruptionDetail* detail) {
  json body{{"trial", trial}, {"reason", reason}};
  if (detail != nullptr) {
    body["safety_fault"] = detail->safety_fault;
    body["device_fault"] = detail->device_fault;
    body["largest_force_n"] = detail->largest_force_n;
  }
  return compact(body);
}

std::string trial_to_json(int trial) {
  return compact({{"trial", trial}});
}

std::string block_to_json(int block, int first_trial) {
  return compact({{"block", block}, {"first_trial", first_trial}});
}

std::string remark_to_json(const std::string& text) {
  return compact({{"text", text}});
}

std::string remark_from_json(const std::string& text) {
  return member_of<std::string>(text, "text");
}

int session_from_json(const std::string& text) {
  return member_of<int>(text, "session", 1);
}

// Works on JSON, so that members added to the structs later do not change collected chains.
std::string renumbered(const std::string& body, int session) {
  static_cast<void>(session_from_json(body));
  json object = json::parse(body);
  object["session"] = session;
  return compact(object);
}

std::string renumbered_opening(const std::string& body, int session, int station) {
  const int own_session = session_from_json(body);
  json object = json::parse(body);
  object["session"] = session;
  object["own_session"] = own_session;
  object["station"] = station;
  return compact(object);
}

}  // namespace touchtrial::record
