#include "analysis/exports/dataset.hpp"

#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/incidents.hpp"
#include "analysis/outcomes/quality.hpp"
#include "analysis/report/results.hpp"
#include "analysis/report/text_figures.hpp"
#include "record/event_kinds.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

/// Whether a character is an ASCII letter or digit, in every locale.
bool is_plain(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

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

Meanings of_trials() {
  const Levels states{{"answered", "the participant answered"},
                      {"timed-out", "time ran out without an answer"},
                      {"interrupted", "interrupted and never repeated"},
                      {"voided", "its block was restarted"},
                      {"presented", "had not ended at the end of the session"}};
  const Levels kinds{{"scored", "may enter the report"},
                     {"lead-in", "starts a block and is not scored"},
                     {"catch",
                      "a plane without texture, or the highest level of a track without an effect "
                      "on its procedure; not scored"},
                     {"control", "with the hand off the device; not scored"}};
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
      {"response", {"Texture or other choice that the participant answered"}},
      {"correct", yes_or_no("Whether the response is the right one; a trial without a "
                            "response is wrong")},
      {"confidence", {"Confidence in the response, from 1 (a guess) upwards"}},
      {"reaction_time_s", {"From the moment the plane can be felt to the response", "s"}},
      {"response_time", {"From the moment the plane can be felt to the response", "s"}},
      {"from_contact_s", {"From first contact with the plane to the response", "s"}},
      {"contact_s", {"Time in contact with the plane", "s"}},
      {"path_mm", {"Length of the stylus' path in contact", "mm"}},
      {"force_rms_n", {"Root mean square of the force sent while in contact", "N"}},
      {"saturated_share", {"Share of the time in contact with the force at its limit, 0 to 1"}},
      {"valid", yes_or_no("Whether the trial meets the study's validity rule")},
      {"presented_at_s", {"Beginning of the trial, since the session's opening", "s"}},
      {"counted", yes_or_no("Whether the trial enters the report")},
      {"kind", {"What the trial is for", "", kinds}},
      {"state", {"How the trial ended", "", states}},
      {"explorations", {"Number of explorations of the plane before the response"}},
      {"first_contact_s", {"From the moment the plane can be felt to first contact", "s"}},
      {"position", {"Index of the response among the pictures shown, from 0"}},
      {"first_position", {"Index of the first response if it was changed, from 0"}},
      {"valid_in_clear",
       yes_or_no("Validity by the unencrypted data: duration of the exploration")},
      {"contact_ok", yes_or_no("Whether the hand was at the plane long enough")},
      {"path_ok", yes_or_no("Whether the hand moved far enough along the plane")},
      {"force_ok", yes_or_no("Whether the hand pushed neither too lightly nor too hard")},
      {"speed_ok", yes_or_no("Whether the hand moved neither too slowly nor too fast")},
      {"within_limits", yes_or_no("Validity by the encrypted data: path, force and saturation")},
      {"limited_ticks", {"Servo ticks whose force the safety chain changed"}},
      {"samples", {"Samples in the trial's trace"}},
      {"sampling_hz", {"Sampling rate of the trial's trace", "Hz"}},
      {"overruns", {"Servo ticks that came too late"}},
      {"paused",
       {"Whether the session was paused before the answer; if so, there are no reaction times"}},
      {"gain_db", {"Gain of the presented plane, relative to the gain in the pack", "dB"}},
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

Meanings of_sessions() {
  return {
      {"participant", {"The participant's id in the study"}},
      {"session", {"Number of the session in the study's database, from 1"}},
      {"enrolment", {"Number of enrolment, from 1; decides the order of presentation"}},
      {"visit", {"Number of the participant's visit, from 1"}},
      {"group", {"Group to which the participant was assigned"}},
      {"session_state",
       {"How the session ended",
        "",
        {{"completed", "all trials done"},
         {"stopped", "ended before that"},
         {"open", "not ended"}}}},
      {"excluded", yes_or_no("Whether the session was excluded")},
      {"withdrawn", yes_or_no("Whether the participant withdrew")},
      {"erased", yes_or_no("Whether the data were erased at the participant's request")},
      {"pilot", yes_or_no("Whether the session is a pilot")},
      {"simulated", yes_or_no("Whether the participant was simulated, not a person")},
      {"counted_session", yes_or_no("Whether the session's trials enter the report")},
      {"device", {"Driver of the haptic device"}},
      {"replaced_by",
       {"Id of the participant who replaced this one and inherited the enrolment number"}},
      {"after_look",
       {"Decisions about the session after its outcomes had been seen: excluded, replaced, "
        "erased"}},
      {"shown", yes_or_no("Whether outcomes of the session may be shown yet")},
  };
}

Meanings of_collection() {
  return {
      {"practice_rounds", {"Rounds of practice"}},
      {"practice_presentations", {"Textures presented in practice"}},
      {"practice_correct", {"Of them, answered correctly"}},
      {"order_block", {"Block within which the order of methods was randomised; negative: none"}},
      {"practice_passed", yes_or_no("Whether practice was passed")},
      {"resumed", {"Number of times that the session was resumed after the program had ended"}},
      {"stop_reason", {"Why the session was stopped"}},
      {"exclusion_reason", {"Why the session was excluded"}},
      {"replacement_reason", {"Why the participant was replaced"}},
      {"withdrawal_reason", {"Why the participant withdrew"}},
      {"largest_force_n", {"Largest force sent in the session's presentations", "N"}},
      {"station", {"Station that recorded the session; empty in a station's own file"}},
      {"device_serial", {"Serial number of the haptic device"}},
      {"device_model", {"Model of the haptic device, as reported by it"}},
      {"device_firmware", {"Firmware of the haptic device, as reported by it"}},
      {"device_max_force_n", {"Largest force of the haptic device", "N"}},
      {"device_force_scale",
       {"Force calibration by the laboratory: felt newtons per newton of the driver along x "
        "(right), y (up) and z (towards the person)"}},
      {"device_length_scale",
       {"Length calibration by the laboratory: true millimetres per millimetre of the driver, "
        "along the same axes"}},
      {"certificate",
       {"SHA-256 of the certificate of the device's acceptance, or UNVERIFIED DEVICE"}},
      {"servo_hz", {"Requested servo rate", "Hz"}},
      {"scheduling", {"Scheduling of the servo's thread"}},
      {"visual", yes_or_no("Whether textures were shown on a screen instead of felt")},
      {"interruptions", {"Presentations that were interrupted, repeated or not"}},
      {"pauses", {"Number of times that the session was paused"}},
      {"notes", {"Number of notes made during the session"}},
      {"answers", {"Answers of a session that has ended"}},
      {"one_key", yes_or_no("Whether at least 95 % of 20 or more answers used one key; only if "
                            "that does not reveal outcomes")},
  };
}

Meanings of_what_was_said() {
  return {
      {"questionnaire", {"Name of the questionnaire"}},
      {"question", {"Id of the question"}},
      {"question_kind",
       {"Kind of answer to the question",
        "",
        {{"choice", "one of several options"}, {"number", "a number"}, {"text", "words"}}}},
      {"wording", {"Wording of the question"}},
      {"answer", {"A number, or the index of the chosen option, from 0"}},
      {"words", {"Text of the chosen option, or typed text"}},
      {"event", {"Place of the event in its chain"}},
      {"incident", {"What happened", "", incident_levels()}},
      {"at_s", {"Time since the session's opening", "s"}},
      {"onset",
       {"Time since the session's opening; in motion/, since the first sample of the run", "s"}},
      {"duration", {"Duration; n/a: not recorded", "s"}},
      {"exploration",
       {"Which of the trial's explorations begins, from 1; if a trial presents several planes, "
        "each is explored once"}},
      {"code",
       {"Further information: reason of an interruption or of a stop by the program, code of a "
        "deviation, or cause of a resumption"}},
      {"mark", {"Event that was sent to other instruments"}},
      {"value", {"Code of the event that was sent to other instruments"}},
      {"latency_s", {"From the event to the end of the write on the serial line", "s"}},
      {"lsl_time", {"Time of the event on the Lab Streaming Layer's clock", "s"}},
      {"lsl_s", {"Time of the event on the Lab Streaming Layer's clock", "s"}},
      {"lsl_uncertainty_s", {"Uncertainty of that clock's reading", "s"}},
      {"safety_fault", {"Fault detected by the safety chain"}},
      {"device_fault", {"Fault that the device reported"}},
      {"text", {"Typed text"}},
      {"consent", {"Number of the participant's consent, from 1"}},
      {"consent_version", {"Version of the consent form that was signed"}},
  };
}

Meanings of_participants() {
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
        "100 (right)"}},
  };
}

Meanings all_meanings() {
  Meanings all = of_trials();
  all.merge(of_sessions());
  all.merge(of_collection());
  all.merge(of_participants());
  all.merge(of_what_was_said());
  return all;
}

}  // namespace

std::string participant_label(const std::string& participant) {
  std::string label;
  for (const char c : participant) {
    if (is_plain(c) && c != 'Z') {
      label += c;
    } else {
      label += 'Z';
      label += c == '-' ? 'd' : c == '_' ? 'u' : c == '+' ? 'p' : 'Z';
    }
  }
  return label;
}

std::string plain_label(const std::string& name) {
  std::string label;
  std::copy_if(name.begin(), name.end(), std::back_inserter(label), is_plain);
  return label.empty() ? "study" : label;
}

std::string about_study(const DatasetSource& study) {
  const record::StudyCommitment& commitment = study.store.commitment();
  const std::vector<record::SessionRow> sessions = study.store.sessions();
  const auto counts =
      std::count_if(sessions.begin(), sessions.end(),
                    [&](const record::SessionRow& row) { return session_counts(row, commitment); });
  const bool has_choices = commitment.positions > 0;
  const bool has_planes = prescription_from_json(commitment.configuration).intervals > 0;
  std::string text;
  if (commitment.simulated) {
    text +=
        "SIMULATED: every participant in this dataset is a program. Nothing in it comes from a "
        "person.\n\n";
  }
  if (commitment.pilot) text += "A pilot: do not pool with the study's data.\n\n";
  text += fmt::format(
      "A psychophysical study of textures felt through a force-feedback device, recorded "
      "with Touchtrial {}. Protocol: {}; {}{} scored trials a participant; {} that count{}.\n\n",
      commitment.program_version, commitment.protocol,
      has_choices ? fmt::format("{} {} to choose from; ", commitment.positions,
                                has_planes ? "answers" : "textures")
                  : "",
      commitment.scored_trials, counted(counts, "completed session"), counts == 1 ? "s" : "");
  text +=
      study.outcomes != nullptr
          ? "Participants who had their data erased are not included. A trial enters the report if "
            "`counted` is 1: its session was completed and not excluded, it is scored, and it "
            "ended. " +
                std::string(has_choices ? "A trial without a response counts as wrong.\n\n"
                                        : "A trial without an answer has no rating.\n\n")
          : "Exported before unblinding: stimuli, answers and their times are sealed, and "
            "practice, lead-ins and catch trials cannot be distinguished from scored trials.\n\n";
  return text;
}

std::string report_in_dataset(const DatasetSource& study, Typed typed) {
  if (study.outcomes == nullptr) return quality_json(make_quality(study.store));
  Outcomes outcomes = *study.outcomes;
  if (typed == Typed::left_out) {
    for (QuestionAnswer& answer : outcomes.answers) answer.words.clear();
  }
  return analysis_of(outcomes.design).results(outcomes, {})->json();
}

ColumnMeaning meaning_of(const std::string& column) {
  static const Meanings kMeanings = all_meanings();
  if (column.starts_with(kRatingColumn)) {
    return {"Rating on the scale " + column.substr(kRatingColumn.size())};
  }
  const auto found = kMeanings.find(column);
  if (found != kMeanings.end()) return found->second;
  return {"Column of the protocol's own analysis"};
}

}  // namespace touchtrial::analysis
