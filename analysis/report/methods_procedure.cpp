// The paragraph on the procedure.
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

int deviation_count(const std::vector<const SessionRecord*>& sessions, std::string_view code) {
  return static_cast<int>(std::ranges::count_if(sessions, [&](const SessionRecord* session) {
    return std::ranges::find(session->deviations, code, &Deviation::code) !=
           session->deviations.end();
  }));
}

std::string masking_sentence(const study::Study& study,
                             const std::vector<const SessionRecord*>& sessions) {
  const study::MaskingPlan& masking = study.session.masking;
  if (!masking.wanted) return "No masking noise was played.";
  std::string text = "Headphones played " + study::masking_words(masking);
  const int silent_sessions = deviation_count(sessions, "no-masking-noise");
  if (silent_sessions > 0)
    text += fmt::format(", except in {}", counted(silent_sessions, "session"));
  return text + ", to mask the sound of the device.";
}

/// The hash of all texts that participants could read, in the study's language.
std::string hash_of_texts(const study::SessionPlan& session) {
  nlohmann::json texts = study::texts_of(session);
  const auto pages = session.instructions.find(session.language);
  if (pages != session.instructions.end()) texts["pages"] = pages->second;
  const std::string text = texts.dump();
  return to_hex(sha256(bytes_of(text))).substr(0, kHashDigits);
}

/// The question on the answer screen, in the participants' language.
std::string question_on_screen(const study::Study& study, const study::TrialQuestion& question) {
  std::string key = question.title();
  if (key.empty()) {
    const bool is_spoken = study.session.sight == study::Sight::blindfold;
    key = is_spoken                       ? "answer_spoken_title"
          : study.presented_methods() > 1 ? "answer_fits_title"
                                          : "answer_title";
  }
  const study::Texts texts = study::texts_of(study.session);
  const auto& screens = texts.at("screens");
  const auto text = screens.find(key);
  return quoted_statement(text == screens.end() ? key : text->second);
}

std::string answer_sentence(const study::Study& study, const study::TrialQuestion& question) {
  std::string text = "The question was " + question_on_screen(study, question) + "; ";
  text += study.session.sight == study::Sight::blindfold
              ? "answers were spoken, and the experimenter entered them"
              : "answers were given with keys or the mouse";
  text += ", without a time limit";
  if (question.scales().empty()) text += ", and could be changed once";
  return text + ".";
}

/// The screen during exploration.
/// \param is_visual  whether the screen shows the textures
std::string screen_sentence(const study::Study& study, const study::TrialQuestion& question,
                            bool is_visual) {
  if (is_visual || study.session.sight == study::Sight::blindfold) return {};
  std::string text =
      "Participants started each trial with a key; while a plane was felt the screen ";
  text += question.planes > 1
              ? "showed the number of the plane and how much of its time had elapsed"
              : "was empty";
  if (!study::practice_of(study).trials.empty()) {
    text += ", and in practice showed bars of force and speed with the instructed ranges";
  }
  return text + ".";
}

/// The size of a pixel of the participants' screen, if it was the same in all sessions.
std::string pixel_sentence(const study::TrialQuestion& question,
                           const std::vector<const SessionRecord*>& sessions) {
  if (!question.has_pictures() && question.scales().empty()) return {};
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
  const auto pages = session.instructions.find(session.language);
  const bool has_pages = pages != session.instructions.end() && !pages->second.empty();
  std::string text = fmt::format(
      "Instructions were read on the screen ({}; {}; SHA-256 of the texts {}",
      study::language_words(session),
      has_pages ? counted(static_cast<int>(pages->second.size()), "page") + " of the study's own"
                : "the program's text",
      hash_of_texts(session));
  if (has_pages) return text + ").";
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
        ", with feedback after each answer; participants who missed the criterion continued with "
        "the trials and were noted";
  }
  const int failed = deviation_count(sessions, "practice-not-passed");
  if (failed > 0) {
    text += fmt::format("; the criterion was missed in {}", counted(failed, "session"));
  }
  return text + ".";
}

std::string timeout_words(study::OnTimeout on_timeout) {
  return fmt::format("then the plane faded within {} ms, and {}", study::kFade.count(),
                     on_timeout == study::OnTimeout::fade ? "an answer was still asked for"
                                                          : "the trial ended without an answer");
}

std::string free_sentence(const study::Study& study) {
  const study::TrialOptions& trials = study.trials;
  std::string text =
      fmt::format("The plane could be explored freely for {} s at most; {}.",
                  number_text(trials.explore_limit_s), timeout_words(trials.on_timeout));
  if (trials.answer_after != study::MinTouch{0.0, 0.0}) {
    text += " An answer needed a touch: " + study::touch_words(trials.answer_after) + ".";
  }
  return text +
         " Participants ended the exploration themselves, and could return to the plane before "
         "they answered until the time was up.";
}

std::string clock_sentence(const study::Study& study, const study::TrialQuestion& question,
                           const study::TimedContact& exploring) {
  return fmt::format(
      "Each of a trial's {} planes appeared when the stylus was more than {:g} mm above it. It "
      "could be felt for {} s, counted only in contact and at {} (speed along the plane and force "
      "of the wall without its texture), then faded within {} ms; tones marked its beginning and "
      "end. A trial was repeated if the time of a plane had not elapsed within {} s.",
      question.planes, study::kLiftedMm, number_text(exploring.seconds),
      study::range_words(exploring.range), study::kFade.count(),
      number_text(study.trials.explore_limit_s));
}

std::string exploring_sentence(const study::Study& study, const study::TrialQuestion& question) {
  if (const auto* const clock = std::get_if<study::TimedContact>(&question.exploring)) {
    return clock_sentence(study, question, *clock);
  }
  return free_sentence(study);
}

std::string feedback_sentence(const study::Study& study, const study::TrialQuestion& question) {
  if (!question.scales().empty()) return {};
  if (question.feedback) return "After each answer participants were told whether it was right.";
  return study::practice_of(study).trials.empty() ? "No feedback was given."
                                                  : "Outside practice no feedback was given.";
}

std::string confidence_sentence(const study::TrialQuestion& question) {
  if (question.confidence_levels == 0) return {};
  return fmt::format(
      "After each answer participants rated their confidence, from 1 (a guess) to {} (certain).",
      question.confidence_levels);
}

std::string breaks_sentence(const study::TrialOptions& trials) {
  std::vector<std::string> occasions;
  if (trials.break_every > 0)
    occasions.push_back(fmt::format("after every {} trials", trials.break_every));
  if (trials.break_after_min > 0.0) {
    occasions.push_back(fmt::format("after {} min", number_text(trials.break_after_min)));
  }
  if (occasions.empty()) return {};
  return "There was a break " + listed(occasions, " and ") + "; participants ended it.";
}

/// \param is_timed  whether planes are timed, so that trials that are not explored are repeated
std::string interruption_sentence(const study::TrialOptions& trials, bool is_timed,
                                  const std::vector<const SessionRecord*>& sessions) {
  int interruptions = 0;
  for (const SessionRecord* session : sessions) interruptions += session->interruptions;
  if (interruptions == 0) return {};
  const auto consequence = [&]() -> std::string {
    switch (trials.on_interruption) {
      case study::OnInterruption::repeat:
        return "repeated";
      case study::OnInterruption::leave_out:
        return "left out";
      case study::OnInterruption::restart_block:
        return "followed by a restart of their block in another order";
    }
    return {};
  };
  return fmt::format(
      "Presentations that {}were interrupted by a fault or a stop ({} in all) were {}.",
      is_timed ? "were not explored as instructed, or " : "", interruptions, consequence());
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
      "stimuli were named by codes, and schedules and answers were sealed with a key that only the "
      "investigator had. Orders were drawn with the Mersenne Twister (MT19937-64), seeded by a "
      "secret for each participant.";
  if (!head.state.closed || !head.state.unblinded) return text;
  const auto early_looks = std::ranges::count_if(head.looks, &Look::is_unregistered);
  if (early_looks == 0) return text + " Outcomes were opened after the end of data collection.";
  return text + fmt::format(" Before its end outcomes were looked at {}.",
                            early_looks == 1 ? std::string("once, unregistered")
                                             : fmt::format("{} times, unregistered", early_looks));
}

/// The time from the opening of a session to its last answer.
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
      "The median session lasted {} min ({} to {}) from its opening to the last scored answer.",
      plain_figure(quartiles(minutes).median, 0), plain_figure(least, 0), plain_figure(most, 0));
}

std::string questions_sentence(const study::SessionPlan& session) {
  std::vector<std::string> questionnaires;
  if (session.handedness) questionnaires.emplace_back("the handedness inventory");
  const std::size_t question_count = session.closing_questions.size();
  if (session.closing) {
    questionnaires.emplace_back(
        "three questions after the trials (whether the device was heard, which cues were used, "
        "remarks)");
  }
  if (question_count > 0) {
    questionnaires.push_back(fmt::format(
        "{} of the study", counted(static_cast<int>(question_count), "further question")));
  }
  if (questionnaires.empty()) return {};
  return "Participants also answered " + listed(questionnaires, " and ") + ".";
}

}  // namespace

CitedText procedure_paragraph(const StudyHead& head, const Outcomes& outcomes,
                              const ProtocolMethods& protocol) {
  const study::Study& study = outcomes.design;
  const study::TrialQuestion question = study::trial_question_of(study);
  const std::vector<const SessionRecord*> sessions = counted_records(head, outcomes);
  Paragraph paragraph;
  paragraph.add("Participants saw " + study::sight_words(study) + ".");
  paragraph.add(pixel_sentence(question, sessions));
  paragraph.add(masking_sentence(study, sessions));
  paragraph.add(instructions_sentence(study.session));
  paragraph.add(practice_sentence(study, sessions));
  paragraph.add(protocol.trial);
  paragraph.add(exploring_sentence(study, question));
  paragraph.add(screen_sentence(study, question, outcomes.visual));
  paragraph.add(answer_sentence(study, question));
  paragraph.add(feedback_sentence(study, question));
  paragraph.add(confidence_sentence(question));
  paragraph.add(protocol.sequence);
  paragraph.add(visits_sentence(study.visits));
  paragraph.add(breaks_sentence(study.trials));
  paragraph.add(interruption_sentence(
      study.trials, std::holds_alternative<study::TimedContact>(question.exploring), sessions));
  paragraph.add(questions_sentence(study.session));
  paragraph.add(duration_sentence(outcomes));
  paragraph.add(blinding_sentence(head, study));
  return paragraph.cited();
}

}  // namespace touchtrial::analysis
