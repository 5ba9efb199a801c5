// What participants were told, saw and heard, and how a session went.
#include "analysis/report/methods_parts.hpp"
#include "analysis/report/page/wording.hpp"
#include "core/hash.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"
#include "study/setting_words.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <ratio>
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

/// The question as screens ask it, in the participants' language.
std::string question_on_screen(const study::Study& study, const study::Ask& ask) {
  std::string key = ask.title();
  if (key.empty()) {
    const bool spoken = study.session.sight == study::Sight::blindfold;
    key = spoken                          ? "answer_spoken_title"
          : study.presented_methods() > 1 ? "answer_fits_title"
                                          : "answer_title";
  }
  const study::Texts texts = study::texts_of(study.session);
  const auto& screens = texts.at("screens");
  const auto text = screens.find(key);
  return quoted_statement(text == screens.end() ? key : text->second);
}

std::string answer_sentence(const study::Study& study, const study::Ask& ask) {
  std::string text = "The question was " + question_on_screen(study, ask) + "; ";
  text += study.session.sight == study::Sight::blindfold
              ? "answers were spoken, and the experimenter entered them"
              : "answers were given with keys or the mouse";
  text += ", without a limit of time";
  if (ask.scales().empty()) text += ", and could be changed once";
  return text + ".";
}

/// What the screen shows in a trial before the question.
/// \param is_visual  whether textures are shown on it instead of felt
std::string screen_sentence(const study::Study& study, const study::Ask& ask, bool is_visual) {
  if (is_visual || study.session.sight == study::Sight::blindfold) return {};
  std::string text = "Participants began each trial by a key; while a plane was felt the screen ";
  text += ask.planes > 1
              ? "showed which plane of the trial it was and how much of its time was over"
              : "was empty";
  if (!study::practice_of(study).trials.empty()) {
    text += ", and in practice bars of force and speed with the ranges of the instructions";
  }
  return text + ".";
}

/// The size of a pixel of the participants' screen, if it was the same in all sessions.
std::string pixel_sentence(const study::Ask& ask,
                           const std::vector<const SessionRecord*>& sessions) {
  if (!ask.has_pictures() && ask.scales().empty()) return {};
  std::set<std::string> sizes;
  for (const SessionRecord* session : sessions) {
    if (!session->station || !session->station->screen) continue;
    const record::ScreenRecord& screen = *session->station->screen;
    sizes.insert(fmt::format("{:.3g} mm ({})", screen.mm_per_px, screen.source));
  }
  if (sizes.empty()) return {};
  return "A pixel of the participants' screen measured " + listed(sizes, " or ") + ".";
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
  if (!study.practice.classes.empty()) {
    text += fmt::format(" (textures: {})",
                        listed(study.practice.classes, " and ", &study::StudyClass::label));
  }
  if (is_judged) {
    text +=
        ", with feedback after each answer; whoever did not reach the criterion went on to the "
        "trials and was noted";
  }
  const int failed = sessions_with(sessions, "practice-not-passed");
  if (failed > 0) {
    text += fmt::format("; the criterion was not reached in {}", counted(failed, "session"));
  }
  return text + ".";
}

std::string after_time(study::OnTimeout on_timeout) {
  return fmt::format("then the plane faded within {} ms, and {}", study::kFade.count(),
                     on_timeout == study::OnTimeout::fade ? "an answer was still asked for"
                                                          : "the trial ended without an answer");
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
         " Participants ended the exploration themselves, and until the time was up could go back "
         "to the plane before they answered.";
}

std::string clock_sentence(const study::Study& study, const study::Ask& ask,
                           const study::InContact& exploring) {
  return fmt::format(
      "Each of a trial's {} planes appeared when the stylus was more than {:g} mm above it, and "
      "could be felt for {} s, which were counted only in contact and at {} (speed along the plane "
      "and force of the wall without its texture), and then faded within {} ms; tones marked its "
      "beginning and end. A trial with a plane whose time had not run down within {} s was "
      "repeated.",
      ask.planes, study::kLiftedMm, number_text(exploring.seconds),
      study::range_words(exploring.range), study::kFade.count(),
      number_text(study.trials.explore_limit_s));
}

std::string exploring_sentence(const study::Study& study, const study::Ask& ask) {
  if (const auto* const clock = std::get_if<study::InContact>(&ask.exploring)) {
    return clock_sentence(study, ask, *clock);
  }
  return free_sentence(study);
}

std::string feedback_sentence(const study::Study& study, const study::Ask& ask) {
  if (!ask.scales().empty()) return {};
  if (ask.feedback) return "After each answer participants were told whether it was right.";
  return study::practice_of(study).trials.empty() ? "No feedback was given."
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
  return "There was a break " + listed(when, " and ") + "; participants ended it.";
}

/// \param is_clocked  whether planes have a clock, so that trials are repeated that leave it running
std::string interruption_sentence(const study::TrialOptions& trials, bool is_clocked,
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
  return fmt::format("Presentations that {}a fault or a stop had interrupted ({} in all) were {}.",
                     is_clocked ? "were not explored as asked for, or that " : "", interruptions,
                     became());
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
      "the investigator had. Orders were drawn with the Mersenne Twister (MT19937-64), seeded by a "
      "secret of each participant.";
  if (!head.state.closed || !head.state.unblinded) return text;
  const auto early = std::ranges::count_if(head.looks, &Look::is_unregistered);
  if (early == 0) return text + " Outcomes were opened after the end of data collection.";
  return text + fmt::format(" Before its end outcomes were looked at {} that was not registered.",
                            early == 1 ? std::string("once in a look")
                                       : fmt::format("{} times in looks", early));
}

/// The time from a session's opening to its last answer, of people.
std::string duration_sentence(const Outcomes& outcomes) {
  if (outcomes.simulated) return {};
  std::map<int, double> ends_min;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (!trial.counted || !trial.row.answered_at) continue;
    double& end_min = ends_min[trial.row.session];
    end_min = std::max(
        end_min, std::chrono::duration<double, std::ratio<60>>(*trial.row.answered_at).count());
  }
  if (ends_min.empty()) return {};
  std::vector<double> minutes;
  for (const auto& [session, end_min] : ends_min) minutes.push_back(end_min);
  const auto [least, most] = std::ranges::minmax(minutes);
  return fmt::format(
      "From its opening to the last scored answer the median session lasted {} min ({} to {}).",
      plain_figure(quartiles(minutes).median, 0), plain_figure(least, 0), plain_figure(most, 0));
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
  paragraph.say(pixel_sentence(ask, sessions));
  paragraph.say(masking_sentence(study, sessions));
  paragraph.say(instructions_sentence(study.session));
  paragraph.say(practice_sentence(study, sessions));
  paragraph.say(protocol.trial);
  paragraph.say(exploring_sentence(study, ask));
  paragraph.say(screen_sentence(study, ask, outcomes.visual));
  paragraph.say(answer_sentence(study, ask));
  paragraph.say(feedback_sentence(study, ask));
  paragraph.say(confidence_sentence(ask));
  paragraph.say(protocol.sequence);
  paragraph.say(visits_sentence(study.visits));
  paragraph.say(breaks_sentence(study.trials));
  paragraph.say(interruption_sentence(
      study.trials, std::holds_alternative<study::InContact>(ask.exploring), sessions));
  paragraph.say(questions_sentence(study.session));
  paragraph.say(duration_sentence(outcomes));
  paragraph.say(blinding_sentence(head, study));
  return paragraph.cited();
}

}  // namespace touchtrial::analysis
