// Choosing the participant: the questions before a session whose participant no option names.
#include "app/run/participant_dialogue.hpp"

#include "study/languages.hpp"
#include "support/catch.hpp"
#include "windows/virtual_screen.hpp"

#include <chrono>
#include <deque>
#include <string_view>
#include <vector>

namespace touchtrial {
namespace {

using Replies = std::deque<std::vector<std::string>>;

record::SessionRow session_of(const std::string& participant, int enrolment) {
  record::SessionRow row;
  row.participant = participant;
  row.enrolment = enrolment;
  return row;
}

study::Station station_with(int first, int last) {
  study::Station station{"attic", {}, {}};
  station.ranges.push_back({first, last});
  return station;
}

TEST_CASE("the first of a station has the id of the plan, and others follow the one before") {
  const study::Station all = station_with(1, 100);
  CHECK(app::proposed_participant({}, all) == "P01");
  CHECK(app::proposed_participant({}, station_with(11, 20)) == "P11");
  CHECK(app::proposed_participant({session_of("P01", 1), session_of("P02", 2)}, all) == "P03");
  CHECK(app::proposed_participant({session_of("Ada", 1)}, all).empty());
}

/// Asks with these replies.
/// \param seen  gets what stood in the field of each first question
app::ParticipantAnswers answers_to(Replies replies, const std::string& version,
                                   std::vector<std::string>* seen = nullptr,
                                   const std::string& language = "en") {
  app::ParticipantQuestions questions;
  questions.session.language = language;
  questions.session.consent_version = version;
  questions.proposed_id = "P07";
  questions.note = "P07 is due for visit 2 of 2.";
  questions.refusal = [](const std::string& id) {
    return id == "P06" ? std::string("P06 was here.") : std::string();
  };
  const app::ParticipantAnswers answers = app::ask_participant(
      [&](const session::QuestionStep& step) {
        REQUIRE_FALSE(replies.empty());
        std::vector<std::string> reply = replies.front();
        replies.pop_front();
        REQUIRE(step.questionnaire->questions.size() == reply.size());
        if (seen != nullptr) {
          seen->push_back(std::string(step.typed) + "|" +
                          step.questionnaire->questions.front().text.at(language));
        }
        return reply;
      },
      questions);
  CHECK(replies.empty());
  return answers;
}

TEST_CASE("only people with consent are asked for age and hand") {
  const app::ParticipantAnswers yes = answers_to({{"P07", "0"}, {"2", "1"}}, "2026-03");
  CHECK(yes.id == "P07");
  CHECK(yes.has_consented);
  CHECK(yes.age_band == "20-29");
  CHECK(yes.hand == "left");
  const app::ParticipantAnswers silent = answers_to({{"P07", "0"}, {"", ""}}, "");
  CHECK(silent.age_band.empty());
  CHECK(silent.hand.empty());
  CHECK_FALSE(answers_to({{"P07", "1"}}, "2026-03").has_consented);
}

TEST_CASE("a refused participant id is asked for again, with the reason") {
  std::vector<std::string> seen;
  CHECK(answers_to({{"P06", "0"}, {"P08", "0"}, {"", ""}}, "", &seen).id == "P08");
  REQUIRE(seen.size() == 3);
  CHECK(seen[0].starts_with("P07|"));
  CHECK_THAT(seen[0], holds_text("P07 is due for visit 2 of 2."));
  CHECK(seen[1].starts_with("P06|"));
  CHECK_THAT(seen[1], holds_text("P06 was here."));
}

TEST_CASE("the dialogue is in the study's language, and what is recorded is not") {
  for (const std::string_view code : study::language_codes()) {
    const study::Language& language = study::language_of(code);
    std::vector<std::string> seen;
    const app::ParticipantAnswers answers =
        answers_to({{"P07", "0"}, {"7", "0"}}, "", &seen, language.code);
    REQUIRE(seen.size() == 2);
    CHECK_THAT(seen[0], holds_text(language.texts.at("dialogue").at("id")));
    CHECK_THAT(seen[1], holds_text(language.texts.at("dialogue").at("age")));
    CHECK(answers.age_band == "70 or more");
    CHECK(answers.hand == "right");
  }
}

/// Presses keys one after the other: '#' is Enter; a digit also types itself, as on a keyboard.
void press(app::ParticipantWindow& window, const std::string& keys) {
  for (const char key : keys) {
    app::InputEvent event{.at = std::chrono::steady_clock::now(),
                          .key = key == '#' ? app::Key::enter : app::Key::digit,
                          .digit = key == '#' ? 0 : key - '0'};
    window.inject(event);
    if (key == '#') continue;
    event.kind = app::InputEvent::Kind::letter;
    event.letter = static_cast<unsigned char>(key);
    window.inject(event);
  }
}

TEST_CASE("the experimenter answers in a window, where the proposed id stands already") {
  const auto screen = VirtualScreen::open("1280x720");
  app::ParticipantWindowOptions wanted;
  wanted.size_px = {1280, 720};
  app::ParticipantWindow window(wanted);
  app::ParticipantAnswers answers;
  constexpr std::chrono::milliseconds kPatience{300'000};
  app::run_beside(window, [&] {
    int step = 0;
    answers = app::ask_participant(
        [&](const session::QuestionStep& asked) {
          CHECK_FALSE(window.show_step(asked));
          CHECK(window.wait_until_shown(kPatience));
          press(window, step++ == 0 ? "8#1#" : "3#2#");
          for (;;) {
            if (const auto reply = window.show_step(asked)) return reply->answers;
          }
        },
        {.proposed_id = "P0", .refusal = [](const std::string&) { return std::string(); }});
  });
  CHECK(answers.id == "P08");
  CHECK(answers.has_consented);
  CHECK(answers.age_band == "20-29");
  CHECK(answers.hand == "left");
}

}  // namespace
}  // namespace touchtrial
