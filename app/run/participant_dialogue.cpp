#include "app/run/participant_dialogue.hpp"

#include "analysis/outcomes/study_status.hpp"
#include "app/commands/participant_ids.hpp"
#include "app/run/session_bounds.hpp"
#include "app/terminal/console.hpp"
#include "app/windows/participant/words.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/text.hpp"
#include "core/utc.hpp"
#include "record/personal_data.hpp"
#include "study/languages.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

/// The age bands of reports.
constexpr std::array<std::string_view, 8> kAgeBands = {"under 18", "18-19", "20-29", "30-39",
                                                       "40-49",    "50-59", "60-69", "70 or more"};
constexpr std::array<std::string_view, 2> kHands = {"right", "left"};

}  // namespace

std::string proposed_participant(const std::vector<record::SessionRow>& sessions,
                                 const study::Station& station) {
  std::vector<std::string> ids;
  for (const record::SessionRow& row : sessions) ids.push_back(row.participant);
  if (!ids.empty()) return next_id(ids).value_or("");
  return fmt::format("P{:02}", study::next_enrolment_of(station, {}));
}

namespace {

/// The texts of the dialogue in a study's language.
class DialogueTexts {
 public:
  explicit DialogueTexts(const study::SessionPlan& plan)
      : language_(plan.language), texts_(study::texts_of(plan)) {}

  [[nodiscard]] std::string text(
      const char* key, const std::vector<std::pair<std::string, std::string>>& values = {}) const {
    return fill_placeholders(texts_.at("dialogue").at(key), values);
  }
  [[nodiscard]] study::Translated translated(const std::string& text) const {
    return {{language_, text}};
  }
  [[nodiscard]] study::Question choice(const std::string& id, const std::string& text,
                                       const std::vector<std::string>& options,
                                       bool required) const {
    study::Question question{id, study::QuestionKind::choice, translated(text), {}, required};
    for (const std::string& option : options) question.options.push_back(translated(option));
    return question;
  }
  /// The texts of kAgeBands in the study's language.
  [[nodiscard]] std::vector<std::string> ages() const {
    std::vector<std::string> bands(kAgeBands.begin(), kAgeBands.end());
    bands.front() = text("age_under", {{"years", "18"}});
    bands.back() = text("age_from", {{"years", "70"}});
    return bands;
  }
  /// The texts of kHands in the study's language.
  [[nodiscard]] std::vector<std::string> hands() const {
    const auto& words = texts_.at("handedness");
    return {words.at("pen_right"), words.at("pen_left")};
  }

 private:
  std::string language_;
  study::Texts texts_;
};

/// The chosen option; empty if the question was skipped.
template <std::size_t count>
std::string chosen_option(const std::array<std::string_view, count>& options,
                          const std::string& answer) {
  const auto index = number_in<std::size_t>(answer);
  return index ? std::string(options.at(*index)) : std::string();
}

}  // namespace

ParticipantAnswers ask_participant(const AskQuestions& ask, const ParticipantQuestions& questions) {
  const DialogueTexts texts(questions.session);
  const std::string& version = questions.session.consent_version;
  ParticipantAnswers person;
  person.id = questions.proposed_id;
  const std::string consent = version.empty()
                                  ? texts.text("consent")
                                  : texts.text("consent_version", {{"consent", version}});
  for (std::string remark = questions.note;;) {
    const std::string id = texts.text("id") + (remark.empty() ? "" : "\n" + remark);
    const study::Questionnaire first{
        "participant",
        {{"participant", study::QuestionKind::text, texts.translated(id), {}, true},
         texts.choice("consent", consent, {texts.text("yes"), texts.text("no")}, true)}};
    const std::vector<std::string> answers = ask({&first, person.id});
    person.id = answers.at(0);
    person.has_consented = answers.at(1) == "0";
    remark = questions.refusal(person.id);
    if (remark.empty()) break;
  }
  if (!person.has_consented) return person;
  const study::Questionnaire second{
      "person",
      {texts.choice("age", texts.text("age"), texts.ages(), false),
       texts.choice("hand", texts.text("hand"), texts.hands(), false)}};
  const std::vector<std::string> answers = ask({&second});
  person.age_band = chosen_option(kAgeBands, answers.at(0));
  person.hand = chosen_option(kHands, answers.at(1));
  return person;
}

namespace {

/// \throws UsageError if the window is closed or a signal ends the program
std::vector<std::string> wait_for_answers(ParticipantWindow& window,
                                          const session::QuestionStep& step) {
  while (!window.end_reason() && EndingSignals::signal_number() == 0) {
    if (const auto reply = window.show_step(step)) return reply->answers;
  }
  const std::string signal_message = EndingSignals::message();
  throw UsageError("run: " + (signal_message.empty() ? "the window was closed" : signal_message) +
                   " before a participant was chosen; no session was started");
}

void save_consent(const ParticipantAnswers& person, const RunOptions& options,
                  const std::string& version) {
  record::PersonalRecord consent;
  consent.participant = person.id;
  consent.consent_version = version.empty() ? "not named" : version;
  consent.consented_utc = utc_text(utc_now());
  const std::filesystem::path path = record::personal_data_path(options.database);
  record::PersonalData(path).put(consent);
  print(fmt::format("{}: consent of participant {} to version {} recorded\n", path.string(),
                    person.id, consent.consent_version));
}

/// A note such as "age 20-29, pen in the left hand"; empty if neither was given.
std::string remark_on(const ParticipantAnswers& person) {
  std::string remark;
  if (!person.age_band.empty()) remark = "age " + person.age_band;
  if (person.hand.empty()) return remark;
  return remark + (remark.empty() ? "" : ", ") + "pen in the " + person.hand + " hand";
}

/// The participants of a database.
struct KnownPeople {
  std::vector<record::SessionRow> sessions{};
  std::vector<analysis::UpcomingVisit> visits{};
  std::vector<std::string> ids{};

  explicit KnownPeople(const std::filesystem::path& database) : ids(known_ids(database)) {
    if (!path_exists(database)) return;
    const auto store = record::StudyStore::open(database, record::StudyStore::Access::read_only);
    sessions = store.sessions();
    visits = analysis::upcoming_visits(store);
  }
  [[nodiscard]] const analysis::UpcomingVisit* next_visit(const std::string& id) const {
    const auto match = std::ranges::find(visits, id, &analysis::UpcomingVisit::participant);
    return match == visits.end() ? nullptr : &*match;
  }
  /// The visit of the participant's last session; 0 if none.
  [[nodiscard]] int last_visit(const std::string& id) const {
    int largest_visit = 0;
    for (const record::SessionRow& row : sessions) {
      if (row.participant == id) largest_visit = std::max(largest_visit, row.visit);
    }
    return largest_visit;
  }
};

/// The visit number of the session: from the options, or else the participant's next visit, or the
/// last one if that is resumed or restarted.
int visit_of(const RunOptions& options, const KnownPeople& people, const std::string& id) {
  if (options.visit > 1) return options.visit;
  if (const analysis::UpcomingVisit* const next = people.next_visit(id)) return next->visit;
  return std::max(1, people.last_visit(id));
}

/// The questions of ask_participant, with the reasons to refuse or question an id.
ParticipantQuestions questions_for(const RunOptions& options, const study::StationKey& key,
                                   const KnownPeople& people) {
  const DialogueTexts texts(key.study.session);
  const auto refusal_for = [texts, visit_count = std::to_string(key.study.visits.count)](
                               const analysis::UpcomingVisit& next) {
    return texts.text(
        "next_visit",
        {{"id", next.participant}, {"visit", std::to_string(next.visit)}, {"of", visit_count}});
  };
  ParticipantQuestions questions;
  questions.session = key.study.session;
  std::string warned_id;  // the last id with a warning
  if (options.visit == 1 && !people.visits.empty() && people.visits.front().is_due(utc_now())) {
    warned_id = people.visits.front().participant;
    questions.proposed_id = warned_id;
    questions.note = refusal_for(people.visits.front());
  } else if (options.visit == 1) {
    questions.proposed_id = proposed_participant(people.sessions, key.station);
  }
  questions.refusal = [&options, &people, texts, refusal_for,
                       warned_id](const std::string& id) mutable -> std::string {
    if (!record::is_participant_id(id)) return texts.text("id_rule");
    const bool already_warned = std::exchange(warned_id, id) == id;
    if (const analysis::UpcomingVisit* const next = people.next_visit(id)) {
      if (options.visit > 1) return "";
      // A mistyped id must not become another participant's next visit.
      if (next->is_due(utc_now())) return already_warned ? "" : refusal_for(*next);
      return texts.text(
          "too_early",
          {{"id", id}, {"visit", std::to_string(next->visit)}, {"time", utc_words(*next->from)}});
    }
    if (people.last_visit(id) > 0) {
      const bool is_allowed = options.visit > 1 || options.on_existing != OnExisting::refuse;
      return is_allowed ? "" : texts.text("has_session", {{"id", id}});
    }
    const auto similar_id = likely_id(id, people.ids);
    if (!similar_id || already_warned) return "";
    return texts.text("looks_like", {{"known", *similar_id}, {"id", id}});
  };
  return questions;
}

}  // namespace

RunOptions with_participant(const RunOptions& options, const study::StationKey& key) {
  const KnownPeople people(options.database);
  const ParticipantQuestions questions = questions_for(options, key, people);
  const std::string& version = key.study.session.consent_version;
  ParticipantWindowOptions dialogue_options;
  dialogue_options.monitor =
      options.console_monitor > 0 ? options.console_monitor : options.monitor;
  dialogue_options.size_px = options.window_px;
  dialogue_options.session.language = key.study.session.language;
  dialogue_options.session.texts = key.study.session.texts;
  ParticipantWindow window(dialogue_options);
  ParticipantAnswers person;
  run_beside(window, [&] {
    person = ask_participant(
        [&](const session::QuestionStep& step) { return wait_for_answers(window, step); },
        questions);
  });
  if (person.has_consented) {
    save_consent(person, options, version);
  } else if (!version.empty()) {
    throw UsageError(fmt::format(
        "run: participant {} has not signed the consent form, version {}; no session was started",
        person.id, version));
  }
  RunOptions result = options;
  result.participant = person.id;
  result.visit = visit_of(options, people, person.id);
  result.remark = remark_on(person);
  result.no_consent = !person.has_consented;
  return result;
}

}  // namespace touchtrial::app
