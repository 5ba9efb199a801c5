#include "app/run/participant_dialogue.hpp"

#include "app/console.hpp"
#include "app/participant_ids.hpp"
#include "app/run/session_bounds.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"
#include "protocols/store/personal_data.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

/// As reports show ages.
constexpr std::array<std::string_view, 8> kAgeBands = {"under 18", "18-19", "20-29", "30-39",
                                                       "40-49",    "50-59", "60-69", "70 or more"};
constexpr std::array<std::string_view, 2> kHands = {"right", "left"};
constexpr std::array<std::string_view, 2> kYesNo = {"yes", "no"};

}  // namespace

std::string proposed_participant(const std::vector<store::SessionRow>& sessions,
                                 const design::Station& station) {
  std::vector<std::string> ids;
  for (const store::SessionRow& row : sessions) ids.push_back(row.participant);
  if (!ids.empty()) return next_id(ids).value_or("");
  return fmt::format("P{:02}", design::next_enrolment_of(station, {}));
}

namespace {

design::Question choice_of(const std::string& id, const std::string& text,
                           std::span<const std::string_view> options, bool required) {
  design::Question question{id, design::QuestionKind::choice, {{"en", text}}, {}, required};
  for (const std::string_view option : options) {
    question.options.push_back({{"en", std::string(option)}});
  }
  return question;
}

/// The option that was chosen; empty if the question was left out.
template <std::size_t count>
std::string option_in(const std::array<std::string_view, count>& options,
                      const std::string& answer) {
  const auto index = number_in<std::size_t>(answer);
  return index ? std::string(options.at(*index)) : std::string();
}

}  // namespace

ParticipantAnswers ask_participant(const AskQuestions& ask, const ParticipantQuestions& questions) {
  ParticipantAnswers person;
  person.id = questions.proposed;
  const std::string consent =
      questions.consent_version.empty()
          ? "Experimenter: has the participant signed the consent form?"
          : "Experimenter: has the participant signed the consent form, version " +
                questions.consent_version + "?";
  for (std::string why_not;;) {
    const std::string id =
        "Experimenter: the participant's id (not a name)" + (why_not.empty() ? "" : "\n" + why_not);
    const design::Questionnaire first{
        "participant",
        {{"participant", design::QuestionKind::text, {{"en", id}}, {}, true},
         choice_of("consent", consent, kYesNo, true)}};
    const std::vector<std::string> answers = ask({&first, person.id});
    person.id = answers.at(0);
    person.has_consented = answers.at(1) == "0";
    why_not = questions.why_not(person.id);
    if (why_not.empty()) break;
  }
  if (!person.has_consented) return person;
  const design::Questionnaire second{
      "person",
      {choice_of("age", "Experimenter: how old is the participant?", kAgeBands, false),
       choice_of("hand", "Experimenter: which hand holds the pen?", kHands, false)}};
  const std::vector<std::string> answers = ask({&second});
  person.age_band = option_in(kAgeBands, answers.at(0));
  person.hand = option_in(kHands, answers.at(1));
  return person;
}

namespace {

/// \throws UsageError if the window is gone or a signal ends the program
std::vector<std::string> answers_in(ParticipantWindow& window, const session::QuestionStep& step) {
  while (!window.gone() && EndingSignals::which() == 0) {
    if (const auto reply = window.attend(step)) return reply->answers;
  }
  const std::string stopped = EndingSignals::message();
  throw UsageError("run: " + (stopped.empty() ? "the window was closed" : stopped) +
                   " before anybody said who the participant is; no session began");
}

void record(const ParticipantAnswers& person, const RunOptions& options,
            const std::string& version) {
  store::PersonalRecord consent;
  consent.participant = person.id;
  consent.consent_version = version.empty() ? "not named" : version;
  consent.consented_utc = utc_text(utc_now());
  const std::filesystem::path path = store::personal_data_path(options.database);
  store::PersonalData(path).put(consent);
  print(fmt::format("{}: consent of participant {} to version {} recorded\n", path.string(),
                    person.id, consent.consent_version));
}

/// "age 20-29, pen in the left hand"; empty if nothing was said.
std::string remark_on(const ParticipantAnswers& person) {
  std::string remark;
  if (!person.age_band.empty()) remark = "age " + person.age_band;
  if (person.hand.empty()) return remark;
  return remark + (remark.empty() ? "" : ", ") + "pen in the " + person.hand + " hand";
}

}  // namespace

RunOptions with_participant(const RunOptions& options, const design::StationKey& key) {
  std::vector<store::SessionRow> sessions;
  if (is_there(options.database)) {
    sessions =
        store::StudyStore::open(options.database, store::StudyStore::Access::read_only).sessions();
  }
  ParticipantQuestions questions;
  if (options.visit == 1) questions.proposed = proposed_participant(sessions, key.station);
  questions.consent_version = key.study.session.consent_version;
  questions.why_not = [&](const std::string& id) -> std::string {
    if (!store::is_participant_id(id)) return "Use 1 to 32 of 0-9, A-Z, a-z, +, -, _.";
    const bool has_come = std::ranges::count(sessions, id, &store::SessionRow::participant) > 0;
    if (!has_come || options.visit > 1 || options.on_existing != OnExisting::refuse) return "";
    return id + " has a session already.";
  };
  ParticipantWindowOptions wanted;
  wanted.monitor = options.console_monitor > 0 ? options.console_monitor : options.monitor;
  wanted.size_px = options.window_px;
  ParticipantWindow window(wanted);
  ParticipantAnswers person;
  run_beside(window, [&] {
    person = ask_participant(
        [&](const session::QuestionStep& step) { return answers_in(window, step); }, questions);
  });
  if (person.has_consented) {
    record(person, options, questions.consent_version);
  } else if (!questions.consent_version.empty()) {
    throw UsageError(fmt::format(
        "run: participant {} has not signed the consent form, version {}; no session began",
        person.id, questions.consent_version));
  }
  RunOptions known = options;
  known.participant = person.id;
  known.remark = remark_on(person);
  return known;
}

}  // namespace touchtrial::app
