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

/// As in reports.
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
    return filled(texts_.at("dialogue").at(key), values);
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
  /// kAgeBands, as displayed.
  [[nodiscard]] std::vector<std::string> ages() const {
    std::vector<std::string> bands(kAgeBands.begin(), kAgeBands.end());
    bands.front() = text("age_under", {{"years", "18"}});
    bands.back() = text("age_from", {{"years", "70"}});
    return bands;
  }
  /// kHands, as displayed.
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
std::string option_in(const std::array<std::string_view, count>& options,
                      const std::string& answer) {
  const auto index = number_in<std::size_t>(answer);
  return index ? std::string(options.at(*index)) : std::string();
}

}  // namespace

ParticipantAnswers ask_participant(const AskQuestions& ask, const ParticipantQuestions& questions) {
  const DialogueTexts texts(questions.session);
  const std::string& version = questions.session.consent_version;
  ParticipantAnswers person;
  person.id = questions.proposed;
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
  person.age_band = option_in(kAgeBands, answers.at(0));
  person.hand = option_in(kHands, answers.at(1));
  return person;
}

namespace {

/// \throws UsageError if the window is closed or a signal ends the program
std::vector<std::string> answers_in(ParticipantWindow& window, const session::QuestionStep& step) {
  while (!window.end_reason() && EndingSignals::which() == 0) {
    if (const auto reply = window.attend(step)) return reply->answers;
  }
  const std::string stopped = EndingSignals::message();
  throw UsageError("run: " + (stopped.empty() ? "the window was closed" : stopped) +
                   " before a participant was chosen; no session began");
}

void record(const ParticipantAnswers& person, const RunOptions& options,
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

/// "age 20-29, pen in the left hand"; empty if neither was given.
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
    if (!is_there(database)) return;
    const auto store = record::StudyStore::open(database, record::StudyStore::Access::read_only);
    sessions = store.sessions();
    visits = analysis::upcoming_visits(store);
  }
  [[nodiscard]] const analysis::UpcomingVisit* next_visit(const std::string& id) const {
    const auto found = std::ranges::find(visits, id, &analysis::UpcomingVisit::participant);
    return found == visits.end() ? nullptr : &*found;
  }
  /// Of the participant's last session; 0 if none.
  [[nodiscard]] int last_visit(const std::string& id) const {
    int last = 0;
    for (const record::SessionRow& row : sessions) {
      if (row.participant == id) last = std::max(last, row.visit);
    }
    return last;
  }
};

/// The number of the session's visit: from the options, else the participant's next, or the one
/// that is resumed or restarted.
int visit_of(const RunOptions& options, const KnownPeople& people, const std::string& id) {
  if (options.visit > 1) return options.visit;
  if (const analysis::UpcomingVisit* const next = people.next_visit(id)) return next->visit;
  return std::max(1, people.last_visit(id));
}

/// The questions of ask_participant, with doubts about an id.
ParticipantQuestions questions_for(const RunOptions& options, const study::StationKey& key,
                                   const KnownPeople& people) {
  const DialogueTexts texts(key.study.session);
  const auto refusal_for =
      [texts, of = std::to_string(key.study.visits.count)](const analysis::UpcomingVisit& next) {
        return texts.text(
            "next_visit",
            {{"id", next.participant}, {"visit", std::to_string(next.visit)}, {"of", of}});
      };
  ParticipantQuestions questions;
  questions.session = key.study.session;
  std::string questioned_id;  // the id that was already questioned
  if (options.visit == 1 && !people.visits.empty() && people.visits.front().is_due(utc_now())) {
    questioned_id = people.visits.front().participant;
    questions.proposed = questioned_id;
    questions.note = refusal_for(people.visits.front());
  } else if (options.visit == 1) {
    questions.proposed = proposed_participant(people.sessions, key.station);
  }
  questions.refusal = [&options, &people, texts, refusal_for,
                       questioned_id](const std::string& id) mutable -> std::string {
    if (!record::is_participant_id(id)) return texts.text("id_rule");
    const bool is_mentioned = std::exchange(questioned_id, id) == id;
    if (const analysis::UpcomingVisit* const next = people.next_visit(id)) {
      if (options.visit > 1) return "";
      // A mistyped id must not become another participant's next visit.
      if (next->is_due(utc_now())) return is_mentioned ? "" : refusal_for(*next);
      return texts.text(
          "too_early",
          {{"id", id}, {"visit", std::to_string(next->visit)}, {"time", utc_words(*next->from)}});
    }
    if (people.last_visit(id) > 0) {
      const bool may_be = options.visit > 1 || options.on_existing != OnExisting::refuse;
      return may_be ? "" : texts.text("has_session", {{"id", id}});
    }
    const auto meant = likely_id(id, people.ids);
    if (!meant || is_mentioned) return "";
    return texts.text("looks_like", {{"known", *meant}, {"id", id}});
  };
  return questions;
}

}  // namespace

RunOptions with_participant(const RunOptions& options, const study::StationKey& key) {
  const KnownPeople people(options.database);
  const ParticipantQuestions questions = questions_for(options, key, people);
  const std::string& version = key.study.session.consent_version;
  ParticipantWindowOptions wanted;
  wanted.monitor = options.console_monitor > 0 ? options.console_monitor : options.monitor;
  wanted.size_px = options.window_px;
  wanted.session.language = key.study.session.language;
  wanted.session.texts = key.study.session.texts;
  ParticipantWindow window(wanted);
  ParticipantAnswers person;
  run_beside(window, [&] {
    person = ask_participant(
        [&](const session::QuestionStep& step) { return answers_in(window, step); }, questions);
  });
  if (person.has_consented) {
    record(person, options, version);
  } else if (!version.empty()) {
    throw UsageError(fmt::format(
        "run: participant {} has not signed the consent form, version {}; no session began",
        person.id, version));
  }
  RunOptions known = options;
  known.participant = person.id;
  known.visit = visit_of(options, people, person.id);
  known.remark = remark_on(person);
  known.no_consent = !person.has_consented;
  return known;
}

}  // namespace touchtrial::app
