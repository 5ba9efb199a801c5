#include "analysis/exports/column_meanings.hpp"

#include "analysis/outcomes/incidents.hpp"
#include "record/event_kinds.hpp"

#include <map>

namespace touchtrial::analysis {
namespace {

using Levels = std::vector<std::pair<std::string, std::string>>;
using Meanings = std::map<std::string, ColumnMeaning>;

ColumnMeaning yes_or_no(std::string description) {
  return {std::move(description), "", {{"0", "no"}, {"1", "yes"}}};
}

Levels incident_levels() {
  Levels levels;
  for (const record::EventKind kind : incident_kinds()) {
    const record::EventKindRow& row = record::row_of(kind);
    levels.emplace_back(row.name, row.meaning);
  }
  const Levels marks{
      {"session-begins", "the session begins, or continues after the program had ended"},
      {"session-ends", "the session ends"},
      {"plane-on", "a plane can be felt from now on"},
      {"contact", "the stylus comes near the plane"},
      {"plane-off", "the plane can no longer be felt"},
      {"time-up", "the time limit for exploring was reached, and the force has faded"},
      {"answered", "the participant answered"},
      {"practised", "the participant answered in practice"}};
  levels.insert(levels.end(), marks.begin(), marks.end());
  return levels;
}

Meanings trial_meanings() {
  const Levels states{{"answered", "the participant answered"},
                      {"timed-out", "time ran out without an answer"},
                      {"interrupted", "interrupted and never repeated"},
                      {"voided", "its block was restarted"},
                      {"presented", "had not ended at the end of the session"}};
  const Levels kinds{
      {"scored", "may enter the report"},
      {"lead-in", "starts a block and is not scored"},
      {"catch",
       "not scored: a plane without texture, or the highest level of a track without "
       "an effect on its procedure"},
      {"control", "not scored: with the hand off the device"}};
  return {
      {"trial", {"Number of the trial in its session, from 1"}},
      {"block", {"Number of the trial's block, from 0"}},
      {"method", {"Method by which the texture was extracted from its image"}},
      {"class", {"Texture that was presented"}},
      {"trial_type", {"Texture that was presented"}},
      {"exemplar", {"Image from which the presented texture was extracted"}},
      {"stim_file", {"Image from which the presented texture was extracted, below stimuli/"}},
      {"motion_file",
       {"Recording of the trial, below the folder of the participant's session; its run is the "
        "trial"}},
      {"response", {"Texture or other choice that the participant answered; empty: no response"}},
      {"correct",
       yes_or_no("Whether the response is the right one; a trial without a response is wrong; "
                 "empty if no response is right")},
      {"confidence",
       {"Confidence in the response, from 1 (a guess) upwards, if the study asks for it"}},
      {"reaction_time_s", {"From the moment the plane can be felt to the response", "s"}},
      {"response_time", {"From the moment the plane can be felt to the response", "s"}},
      {"from_contact_s", {"From first contact with the plane to the response", "s"}},
      {"contact_s", {"Time in contact with the plane", "s"}},
      {"path_mm", {"Length of the stylus' path in contact", "mm"}},
      {"force_rms_n", {"Root mean square of the force sent while in contact", "N"}},
      {"saturated_share", {"Share of the time in contact with the force at its limit, 0 to 1"}},
      {"valid",
       yes_or_no("Whether the trial meets the study's validity rule; before unblinding, only the "
                 "rule's unencrypted part")},
      {"presented_at_s", {"Beginning of the trial, since the session's opening", "s"}},
      {"counted", yes_or_no("Whether the trial enters the report")},
      {"kind", {"What the trial is for", "", kinds}},
      {"state", {"How the trial ended", "", states}},
      {"explorations", {"Number of explorations of the plane in the last presentation"}},
      {"first_contact_s", {"From the moment the plane can be felt to first contact", "s"}},
      {"position", {"Index of the response among the pictures shown, from 0"}},
      {"first_position", {"Index of the first response if it was changed, from 0"}},
      {"valid_in_clear",
       yes_or_no("Validity by the unencrypted data: duration of the exploration")},
      {"contact_ok",
       yes_or_no("Whether the hand was at the plane long enough; empty without a trace")},
      {"path_ok",
       yes_or_no("Whether the hand moved far enough along the plane; empty without a trace")},
      {"force_ok", yes_or_no("Whether the hand pushed neither too lightly nor too hard; empty "
                             "without a trace")},
      {"speed_ok", yes_or_no("Whether the hand moved neither too slowly nor too fast; empty "
                             "without a trace")},
      {"within_limits", yes_or_no("Validity by the encrypted data: path, force and saturation")},
      {"limited_ticks",
       {"Servo ticks whose force the safety chain or a limit of the device changed; real time "
        "only"}},
      {"samples", {"Samples in the trial's trace"}},
      {"sampling_hz", {"Sampling rate of the trial's trace", "Hz"}},
      {"overruns", {"Servo ticks that came too late"}},
      {"paused",
       yes_or_no("Whether the session was paused before the answer; if so, there are no reaction "
                 "times")},
      {"gain_db",
       {"Gain of the presented plane, relative to the gain in the pack; empty for a catch trial",
        "dB"}},
      {"track", {"Track of the trial, from 1; none with the hand off the device"}},
      {"standard",
       {"Standard of the track: a texture, and the value with which comparisons differ"}},
      {"level_db",
       {"Level of the comparison: for detection its gain, for discrimination 20 log10 of the "
        "difference over the standard",
        "dB"}},
      {"picture", {"Texture whose picture was shown with the question"}},
      {"scale", {"Id of the scale that the rating is on"}},
      {"rating", {"Rating: 0 to 1 on a line, from 1 on points"}},
  };
}

Meanings session_meanings() {
  const Levels states{
      {"completed", "all trials done"}, {"stopped", "ended before that"}, {"open", "not ended"}};
  const ColumnMeaning counts = yes_or_no("Whether the session's trials enter the report");
  return {
      {"participant", {"The participant's id in the study"}},
      {"session", {"Number of the session in the study's database, from 1"}},
      {"enrolment", {"Number of enrolment, from 1; decides the order of presentation"}},
      {"visit", {"Number of the participant's visit, from 1"}},
      {"group",
       {"Group to which the participant was assigned; empty before unblinding unless groups are "
        "open, and for sessions that are not shown"}},
      {"session_state", {"How the session ended", "", states}},
      {"participants.csv/state", {"How the session ended", "", states}},
      {"safety_sessions.csv/state", {"How the session ended", "", states}},
      {"excluded", yes_or_no("Whether the session was excluded")},
      {"withdrawn", yes_or_no("Whether the participant withdrew and takes no further part")},
      {"erased", yes_or_no("Whether the data were erased at the participant's request")},
      {"pilot", yes_or_no("Whether the session is a pilot")},
      {"simulated", yes_or_no("Whether the participant was simulated, not a person")},
      {"counted_session", counts},
      {"participants.csv/counted", counts},
      {"device", {"Driver of the haptic device"}},
      {"replaced_by",
       {"Id of the participant who replaced this one and inherited the enrolment number; the same "
        "id if the session was restarted"}},
      {"after_look",
       {"Decisions about the session after its outcomes had been seen, separated by \"; \": "
        "excluded, replaced, erased"}},
      {"shown", yes_or_no("Whether outcomes of the session may be shown yet")},
      {"opened_utc", {"Opening of the session, ISO 8601; empty for simulated sessions"}},
      {"closed_utc",
       {"End of the session, ISO 8601; empty for simulated sessions and before the end"}},
  };
}

Meanings collection_meanings() {
  return {
      {"practice_rounds", {"Rounds of practice"}},
      {"practice_presentations", {"Textures presented in practice"}},
      {"practice_correct", {"Of them, answered correctly"}},
      {"order_block",
       {"Block within which the order of methods was randomised; negative: no partner; empty if "
        "the session is not shown"}},
      {"practice_passed", yes_or_no("Whether practice was passed")},
      {"resumed", {"Number of times that the session was resumed after the program had ended"}},
      {"stop_reason", {"Why the session was stopped; (sealed) before unblinding"}},
      {"exclusion_reason", {"Why the session was excluded; (sealed) before unblinding"}},
      {"replacement_reason", {"Why the participant was replaced; (sealed) before unblinding"}},
      {"withdrawal_reason", {"Why the participant withdrew; (sealed) before unblinding"}},
      {"largest_force_n",
       {"Largest force sent in the session's presentations, to tenths; empty without "
        "presentations, and while it is sealed",
        "N"}},
      {"largest_force_of",
       {"Presentations over which the largest force was taken",
        "",
        {{"session", "all of a session that has ended"},
         {"so-far", "those stored of a session that has not"},
         {"none", "nothing was presented or sent"},
         {"not-known", "without the key"}}}},
      {"station", {"Station that recorded the session, from 1; empty in a station's own file"}},
      {"device_serial", {"Serial number of the haptic device; empty if it has none"}},
      {"device_model", {"Model of the haptic device, as reported by it; real time only"}},
      {"device_firmware", {"Firmware of the haptic device, as reported by it; real time only"}},
      {"device_max_force_n", {"Largest force of the haptic device; real time only", "N"}},
      {"device_force_scale",
       {"Force calibration by the laboratory: felt newtons per newton of the driver along x "
        "(right), y (up) and z (towards the person), separated by blanks; real time only"}},
      {"device_length_scale",
       {"Length calibration by the laboratory: true millimetres per millimetre of the driver, "
        "along the same axes"}},
      {"certificate",
       {"SHA-256 of the certificate of the device's acceptance, or UNVERIFIED DEVICE; real time "
        "only"}},
      {"servo_hz", {"Requested servo rate; real time only", "Hz"}},
      {"scheduling", {"Scheduling that the servo's thread obtained; real time only"}},
      {"visual",
       yes_or_no("Whether textures were shown on a screen instead of felt; real time only")},
      {"interruptions",
       {"Presentations that were interrupted, repeated or not, except by a pause"}},
      {"pauses", {"Number of times that the session was paused"}},
      {"notes", {"Number of notes made during the session"}},
      {"stops", {"Number of stops in safety_events.csv"}},
      {"deviations", {"Number of deviations in safety_events.csv"}},
      {"safety_sessions.csv/interruptions", {"Number of interruptions in safety_events.csv"}},
      {"answers", {"Answers of a session that has ended"}},
      {"one_key", yes_or_no("Whether at least 95 % of 20 or more answers used one key; only if "
                            "that does not reveal outcomes")},
      {"rate_hz", {"Rate that the servo achieved", "Hz"}},
      {"lateness_p50_us", {"Lateness of the servo's ticks: median", "us"}},
      {"lateness_p99_us", {"Lateness of the servo's ticks: 99 % quantile", "us"}},
      {"lateness_p999_us", {"Lateness of the servo's ticks: 99.9 % quantile", "us"}},
      {"lateness_worst_us", {"Lateness of the servo's ticks: maximum", "us"}},
      {"lost", {"Samples missing from the trace"}},
      {"held", {"Samples that repeat the previous one in place of a missing one"}},
  };
}

Meanings event_meanings() {
  return {
      {"questionnaire", {"Name of the questionnaire: handedness, closing"}},
      {"question", {"Id of the question"}},
      {"question_kind",
       {"Kind of answer to the question; empty if the study file no longer has the question",
        "",
        {{"choice", "one of several options"}, {"number", "a number"}, {"text", "free text"}}}},
      {"wording", {"Wording of the question, in the study's language"}},
      {"answer",
       {"A number, or the index of the chosen option, from 0; empty for an answer in words"}},
      {"words", {"Text of the chosen option, or typed text"}},
      {"event", {"Place of the event in its chain"}},
      {"events.csv/kind", {"Kind of the event"}},
      {"safety_events.csv/kind", {"Kind of the event"}},
      {"incident", {"What happened", "", incident_levels()}},
      {"at_s",
       {"Time since the session's opening; empty while it is sealed, and for later records", "s"}},
      {"at_utc",
       {"Time, ISO 8601, of events that are not on a session's clock; empty for simulated "
        "participants"}},
      {"events.csv/body", {"Members of the event as JSON: the reason, the remark, the trial"}},
      {"flight", {"Name of the flight record's file"}},
      {"onset",
       {"Time since the session's opening; in motion/, since the first sample of the run", "s"}},
      {"duration", {"Duration; n/a: not recorded", "s"}},
      {"exploration",
       {"Which of the trial's explorations begins, from 1; if a trial presents several planes, "
        "each is explored once"}},
      {"incidents.csv/trial", {"Trial that was interrupted"}},
      {"safety_events.csv/trial", {"Trial that was interrupted"}},
      {"code",
       {"Further information: reason of an interruption or of a stop by the program, code of a "
        "deviation, cause of a resumption (pause, program-ended), or after-outcomes for an "
        "exclusion when outcomes had been seen"}},
      {"deviations.csv/code", {"Code of the deviation"}},
      {"marks.csv/trial", {"Number of the trial in its session; empty outside trials"}},
      {"marks.csv/code", {"Code of the event that was sent to other instruments"}},
      {"mark", {"Event that was sent to other instruments"}},
      {"value", {"Code of the event that was sent to other instruments"}},
      {"latency_s",
       {"From the event to the end of the write on the serial line; empty if nothing was written",
        "s"}},
      {"lsl_time", {"Time of the event on the Lab Streaming Layer's clock", "s"}},
      {"lsl_s", {"Time of the event on the Lab Streaming Layer's clock", "s"}},
      {"lsl_uncertainty_s", {"Uncertainty of that clock's reading", "s"}},
      {"safety_fault", {"Fault detected by the safety chain, for interruptions in real time"}},
      {"device_fault", {"Fault that the device reported, for interruptions in real time"}},
      {"text", {"Typed text: note, reason or description; empty while it is sealed"}},
      {"looks.csv/at", {"Time of the look, ISO 8601"}},
      {"looks.csv/kind", {"Kind of the look, as in the report"}},
      {"looks.csv/participants", {"Participants whose outcomes were shown"}},
      {"looks.csv/participant", {"The one participant that the look was at; empty: all"}},
      {"looks.csv/station", {"Station of the look; 0: the whole study"}},
      {"looks.csv/reason", {"Why the outcomes were looked at"}},
  };
}

Meanings people_meanings() {
  return {
      {"participant_id", {"The participant's label in this dataset"}},
      {"session_id", {"The session's label in this dataset"}},
      {"filename", {"File, below the folder of the participant's session"}},
      {"acq_time",
       {"Time of the first sample. Dates are shifted: each participant's first session opens on "
        "1920-01-01 at 00:00:00, and later sessions the true number of days after it; simulated "
        "sessions have no date"}},
      {"age_band", {"Age as stated by the participant, in bands of ten years"}},
      {"sex", {"Sex or gender as stated by the participant"}},
      {"handedness",
       {"Handedness by the inventory's score: right above 60, left below -60",
        "",
        {{"right", "right-handed"}, {"left", "left-handed"}, {"ambidextrous", "neither"}}}},
      {"handedness_score",
       {"Laterality quotient of the four-item Edinburgh inventory (Veale 2014), -100 (left) to "
        "100 (right); empty if not stated"}},
      {"consent", {"Number of the participant's consent, from 1"}},
      {"consent_version", {"Version of the consent form that was signed"}},
      {"consented_utc", {"Time of the consent, ISO 8601"}},
      {"age", {"Age in years, as stated"}},
      {"gender", {"Gender, as stated"}},
      {"contact", {"How to reach the participant"}},
  };
}

Meanings all_meanings() {
  Meanings all = trial_meanings();
  all.merge(session_meanings());
  all.merge(collection_meanings());
  all.merge(event_meanings());
  all.merge(people_meanings());
  return all;
}

}  // namespace

ColumnMeaning meaning_of(const std::string& column, std::string_view file) {
  static const Meanings kMeanings = all_meanings();
  if (column.starts_with(kRatingColumn)) {
    return {"Rating on the scale " + column.substr(kRatingColumn.size())};
  }
  auto found = kMeanings.find(std::string(file) + "/" + column);
  if (found == kMeanings.end()) found = kMeanings.find(column);
  if (found != kMeanings.end()) return found->second;
  return {"Column of the protocol's own analysis"};
}

const std::vector<std::string>& columns_of(std::string_view file) {
  static const std::map<std::string_view, std::vector<std::string>> kColumns{
      {"answers.csv",
       {"participant", "session", "questionnaire", "question", "question_kind", "wording", "answer",
        "words", "simulated"}},
      {"consents.csv", {"participant", "consent", "consent_version", "simulated"}},
      {"deviations.csv", {"participant", "session", "code", "text", "simulated"}},
      {"events.csv",
       {"participant", "session", "event", "kind", "at_s", "at_utc", "body", "safety_fault",
        "device_fault", "flight", "simulated"}},
      {"incidents.csv",
       {"participant", "session", "event", "incident", "at_s", "trial", "code", "safety_fault",
        "device_fault", "text", "simulated"}},
      {"looks.csv",
       {"at", "kind", "participants", "participant", "station", "reason", "simulated"}},
      {"marks.csv",
       {"participant", "session", "trial", "mark", "code", "at_s", "latency_s", "lsl_s",
        "lsl_uncertainty_s", "simulated"}},
      {"personal.csv",
       {"participant", "consent_version", "consented_utc", "age", "gender", "contact"}},
      {"safety_events.csv",
       {"participant", "session", "event", "kind", "at_s", "at_utc", "trial", "code",
        "safety_fault", "device_fault", "text", "simulated"}},
      {"safety_sessions.csv",
       {"participant", "session", "state", "excluded", "withdrawn", "erased", "device",
        "interruptions", "stops", "deviations", "largest_force_n", "largest_force_of",
        "simulated"}},
      {"servo.csv",
       {"session", "trial", "rate_hz", "lateness_p50_us", "lateness_p99_us", "lateness_p999_us",
        "lateness_worst_us", "lost", "held", "overruns", "simulated"}},
      {"sessions.csv", {"participant", "session", "opened_utc", "closed_utc", "simulated"}},
  };
  return kColumns.at(file);
}

}  // namespace touchtrial::analysis
