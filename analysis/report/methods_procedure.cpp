// What participants were told, saw and heard, and how a session went.
#include "analysis/report/methods_parts.hpp"
#include "core/hash.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"
#include "study/setting_words.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::analysis {
namespace {

constexpr std::size_t kHashShown = 16;  ///< digits

int sessions_with(const std::vector<const SessionRecord*>& sessions, std::string_view code) {
  return static_cast<int>(std::ranges::count_if(sessions, [&](const SessionRecord* session) {
    return std::ranges::find(session->deviations, code, &Deviation::code) !=
           session->deviations.end();
  }));
}

std::string sight_sentence(const study::Study& study) {
  return "Participants saw " + study::sight_words(study) + ".";
}

std::string masking_sentence(const study::Study& study,
                             const std::vector<const SessionRecord*>& sessions) {
  const study::MaskingPlan& masking = study.session.masking;
  if (!masking.wanted) return "No masking noise was played.";
  std::string text = "Headphones played " + study::masking_words(masking);
  const int without = sessions_with(sessions, "no-masking-noise");
  if (without > 0) text += fmt::format(", but for {}", counted(without, "session"));
  return text + ", to mask the sound of the device.";
}

/// Of all texts that participants could read, in the study's language.
std::string hash_of_texts(const study::SessionPlan& session) {
  nlohmann::json texts = study::texts_of(session);
  const auto own = session.instructions.find(session.language);
  if (own != session.instructions.end()) texts["pages"] = own->second;
  const std::string text = texts.dump();
  return to_hex(sha256(bytes_of(text))).substr(0, kHashShown);
}

std::string instructions_sentence(const study::SessionPlan& session) {
  const auto own = session.instructions.find(session.language);
  const bool has_own = own != session.instructions.end() && !own->second.empty();
  std::string text = fmt::format(
      "Instructions were read on the screen ({}; {}; SHA-256 of the texts {}",
      study::language_words(session),
      has_own ? counted(static_cast<int>(own->second.size()), "page") + " of the study's own"
              : "the program's text",
      hash_of_texts(session));
  if (has_own) return text + ").";
  return text + fmt::format(
                    "): hold the stylus like a pencil with the forearm on a rest, stroke sideways "
                    "in long even strokes at {:g} to {:g} mm/s, press with {:g} to {:g} N, and "
                    "neither tap nor drill.",
                    study::kMinStrokeMmS, study::kMaxStrokeMmS, study::kMinPressureN,
                    study::kMaxPressureN);
}

std::string practice_sentence(const study::Study& study,
                              const std::vector<const SessionRecord*>& sessions) {
  const study::Practice practice = study::practice_of(study);
  if (practice.trials.empty()) return "There was no practice.";
  const bool is_judged = practice.criterion > 0;
  std::string text = "Practice came first: " + study::practice_words(study);
  if (is_judged) text += ", with feedback after each answer";
  const int failed = sessions_with(sessions, "practice-not-passed");
  if (failed > 0) {
    text += fmt::format("; the criterion was not reached in {}", counted(failed, "session"));
  }
  return text + ".";
}

std::string after_time(study::OnTimeout on_timeout) {
  return on_timeout == study::OnTimeout::fade
             ? "then the plane faded, and an answer was still asked for"
             : "then the plane faded, and the trial ended without an answer";
}

std::string free_sentence(const study::Study& study) {
  const study::TrialOptions& trials = study.trials;
  std::string text =
      fmt::format("The plane could be explored freely for {} s at most; {}.",
                  number_text(trials.explore_limit_s), after_time(trials.on_timeout));
  if (trials.answer_after != study::MinTouch{0.0, 0.0}) {
    text += " An answer needed a touch: " + study::touch_words(trials.answer_after) + ".";
  }
  return text +
         " Until the time was up participants could go back to the plane before they answered, and "
         "could change an answer before they went on.";
}

std::string clock_sentence(const study::Study& study, const study::Ask& ask,
                           const study::InContact& exploring) {
  return fmt::format(
      "Each of a trial's {} planes appeared when the stylus was more than {:g} mm above it, and "
      "could be felt for {} s, which were counted only in contact and at {}; tones marked its "
      "beginning and end. A trial with a plane whose time had not run down within {} s was "
      "repeated.",
      ask.planes, study::kLiftedMm, number_text(exploring.seconds),
      study::range_words(exploring.range), number_text(study.trials.explore_limit_s));
}

std::string exploring_sentence(const study::Study& study, const study::Ask& ask) {
  if (const auto* const clock = std::get_if<study::InContact>(&ask.exploring)) {
    return clock_sentence(study, ask, *clock);
  }
  return free_sentence(study);
}

std::string feedback_sentence(const study::Ask& ask) {
  if (!ask.scales().empty()) return {};
  return ask.feedback ? "After each answer participants were told whether it was right."
                      : "Outside practice no feedback was given.";
}

std::string confidence_sentence(const study::Ask& ask) {
  if (ask.confidence_levels == 0) return {};
  return fmt::format(
      "After each answer participants said how sure they were, from 1 (a guess) to {} (certain).",
      ask.confidence_levels);
}

std::string breaks_sentence(const study::TrialOptions& trials) {
  std::vector<std::string> when;
  if (trials.break_every > 0)
    when.push_back(fmt::format("after every {} trials", trials.break_every));
  if (trials.break_after_min > 0.0) {
    when.push_back(fmt::format("after {} min", number_text(trials.break_after_min)));
  }
  if (when.empty()) return {};
  return "There was a break " + listed(when, " and ") + ".";
}

std::string interruption_sentence(const study::TrialOptions& trials,
                                  const std::vector<const SessionRecord*>& sessions) {
  int interruptions = 0;
  for (const SessionRecord* session : sessions) interruptions += session->interruptions;
  if (interruptions == 0) return {};
  const auto became = [&]() -> std::string {
    switch (trials.on_interruption) {
      case study::OnInterruption::repeat:
        return "repeated";
      case study::OnInterruption::leave_out:
        return "left out";
      case study::OnInterruption::restart_block:
        return "followed by a fresh start of their block in another order";
    }
    return {};
  };
  return fmt::format("Presentations that a fault or a stop had interrupted ({} in all) were {}.",
                     interruptions, became());
}

std::string visits_sentence(const study::VisitPlan& visits) {
  const std::string words = study::visits_words(visits);
  return words.empty() ? "" : "Visits of each participant: " + words + ".";
}

std::string blinding_sentence(const StudyHead& head, const study::Study& study) {
  std::string text = study.double_blind
                         ? "Neither participants nor experimenters knew what was presented: "
                         : "Participants did not know what was presented, experimenters might: ";
  text +=
      "stimuli had codes for names, and schedules and answers were sealed under a key that only "
      "the investigator had.";
  if (!head.state.closed || !head.state.unblinded) return text;
  const auto early = std::ranges::count_if(head.looks, &Look::is_unregistered);
  if (early == 0) return text + " Outcomes were opened after the end of data collection.";
  return text + fmt::format(" Before its end outcomes were looked at {} that was not registered.",
                            early == 1 ? std::string("once in a look")
                                       : fmt::format("{} times in looks", early));
}

std::string questions_sentence(const study::SessionPlan& session) {
  std::vector<std::string> asked;
  if (session.handedness) asked.emplace_back("the handedness inventory");
  const std::size_t own = session.closing_questions.size();
  if (session.closing) {
    asked.emplace_back(
        "three questions after the trials (whether the device had been heard, what was gone by, "
        "remarks)");
  }
  if (own > 0) {
    asked.push_back(
        fmt::format("{} of the study's own", counted(static_cast<int>(own), "further question")));
  }
  if (asked.empty()) return {};
  return "Participants also answered " + listed(asked, " and ") + ".";
}

}  // namespace

Cited procedure_paragraph(const StudyHead& head, const Outcomes& outcomes,
                          const ProtocolMethods& protocol) {
  const study::Study& study = outcomes.design;
  const study::Ask ask = study::ask_of(study);
  const std::vector<const SessionRecord*> sessions = counted_records(head, outcomes);
  Paragraph paragraph;
  paragraph.say(sight_sentence(study));
  paragraph.say(masking_sentence(study, sessions));
  paragraph.say(instructions_sentence(study.session));
  paragraph.say(practice_sentence(study, sessions));
  paragraph.say(protocol.trial);
  paragraph.say(exploring_sentence(study, ask));
  paragraph.say(feedback_sentence(ask));
  paragraph.say(confidence_sentence(ask));
  paragraph.say(protocol.sequence);
  paragraph.say(visits_sentence(study.visits));
  paragraph.say(breaks_sentence(study.trials));
  paragraph.say(interruption_sentence(study.trials, sessions));
  paragraph.say(questions_sentence(study.session));
  paragraph.say(blinding_sentence(head, study));
  return paragraph.cited();
}

}  // namespace touchtrial::analysis
