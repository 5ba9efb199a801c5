// Checks that everything a participant reads lies on the screen, in all languages and at several
// sizes. The screens are drawn without a window, and the places of texts and buttons are compared.
#include "app/texts/study_texts.hpp"
#include "app/windows/look.hpp"
#include "app/windows/participant/answer_screen.hpp"
#include "app/windows/participant/canvas.hpp"
#include "app/windows/participant/card_screen.hpp"
#include "app/windows/participant/exploring_screen.hpp"
#include "app/windows/participant/page_layout.hpp"
#include "app/windows/participant/screen.hpp"
#include "protocols/identification/study/identification.hpp"
#include "study/languages.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"
#include "windows/drawn_screen.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include <imgui.h>

namespace touchtrial {
namespace {

study::Question choice(int options) {
  study::Question question{"hand", study::QuestionKind::choice, {}, {}, true};
  question.text = {{"en", "Which hand do you use to hold a toothbrush, or the thing most like it?"},
                   {"de", "Mit welcher Hand halten Sie eine Zahnbürste oder etwas Ähnliches?"}};
  for (int i = 0; i < options; ++i) {
    question.options.push_back({{"en", "mostly the right one, hardly ever the other"},
                                {"de", "meistens die rechte, kaum jemals die andere"}});
  }
  return question;
}

const study::Questionnaire& questions() {
  static const study::Questionnaire all = {
      "closing",
      {choice(5),
       choice(9),
       {"age", study::QuestionKind::number, {{"en", "Age?"}, {"de", "Alter?"}}, {}},
       {"strategy",
        study::QuestionKind::text,
        {{"en", "How did you decide, and what did you listen or look for?"},
         {"de", "Wie haben Sie entschieden, und worauf haben Sie geachtet?"}},
        {}}}};
  return all;
}

std::vector<session::Step> steps_of_a_session() {
  const std::string page =
      "Feeling surfaces\n\nPlease hold the stylus like a pen, rest your forearm, and stroke the "
      "surface to the left and to the right. Do not tap it. Press about as hard as in writing.\n\n"
      "When you have felt enough, press Enter. You then choose a picture. There is no wrong "
      "answer, and nobody sees what you have chosen while you sit here.\n\nÄÖÜß – „so“ … ≤";
  return {session::InstructionStep{{page, page, page + page}},
          session::QuestionStep{&questions()},
          session::PracticeStep{1},
          session::PracticeStep{2},
          session::ReadyStep{1, 25, false},
          session::ReadyStep{3, 5, true},
          session::AnswerStep{.trial = 25,
                              .total = 25,
                              .time_is_up = true,
                              .may_explore_again = true,
                              .confidence_levels = 9},
          session::AnswerStep{.trial = 2, .total = 5, .practice = true},
          session::AnswerStep{
              .trial = 2, .total = 25, .time_is_up = true, .sight = study::Sight::blindfold},
          session::FeedbackStep{0, 1},
          session::FeedbackStep{1, 1},
          session::BreakStep{10, 25},
          session::NoticeStep{session::NoticeStep::What::practice_over},
          session::NoticeStep{session::NoticeStep::What::time_is_up, 3},
          session::NoticeStep{session::NoticeStep::What::stopped, 3},
          session::NoticeStep{session::NoticeStep::What::stopped, 3, false},
          session::PauseStep{},
          session::EndStep{}};
}

/// Checks all pages of a screen, with and without choices.
void check_all_pages(const Paper& paper, app::Screen& screen) {
  for (int page = 0; page < 12 && !screen.is_done(); ++page) {
    CHECK(faults_of(paper.draw(screen)) == "");
    static_cast<void>(screen.handle(key(app::Key::digit, 2)));
    CHECK(faults_of(paper.draw(screen)) == "");
    static_cast<void>(screen.handle(key(app::Key::digit, 1)));
    CHECK(faults_of(paper.draw(screen)) == "");
    static_cast<void>(screen.handle(key(app::Key::enter)));
  }
}

/// A study with every page of instructions.
study::Study full_study(const std::string& language) {
  study::Study study;
  study.protocol = &study::identification::comparison();
  study.task = study.protocol->read(std::nullopt);
  study.classes.resize(5);
  study.trials.practice = 5;
  study.practice.classes.resize(2);
  study.session.language = language;
  study.session.confidence_levels = 5;
  return study;
}

/// The steps above, and the program's own instructions and questions.
std::vector<session::Step> own_steps(const session::SessionTexts& texts) {
  std::vector<session::Step> steps = steps_of_a_session();
  steps.push_back(session::InstructionStep{texts.instructions});
  steps.push_back(session::QuestionStep{&texts.handedness.value()});
  steps.push_back(session::QuestionStep{&texts.closing.value()});
  return steps;
}

TEST_CASE("everything on every screen can be read, in all languages and at all sizes") {
  const Vec2 size = GENERATE(Vec2{1280.0, 720.0}, Vec2{1920.0, 1080.0}, Vec2{3840.0, 2160.0},
                             Vec2{1280.0, 1024.0}, Vec2{3440.0, 1440.0});
  const std::string language = GENERATE("en", "de", "es", "fr", "ja", "zh");
  const double side_mm = GENERATE(25.0, 51.2, 100.0);
  const bool knows = side_mm < 100.0;
  // The largest letters are tried with the pictures that leave them least room.
  const double text_scale = knows ? 1.0 : study::kMaxTextScale;
  CAPTURE(size.x, language, side_mm, text_scale);
  const Paper paper(size, text_scale, app::letters_in(all_texts(language)));
  const session::SessionTexts texts = app::session_texts(full_study(language));
  const app::Words& words = words_in(language);
  Squares shelf(side_mm);
  const app::PhysicalScale physical_scale = {size.x > 2000.0 ? 0.16 : 0.27, knows};
  for (const std::size_t count : {2U, 5U, 9U}) {
    const app::ScreenContext context = {.words = &words,
                                        .language = language,
                                        .mouse = count == 5U,
                                        .shelf = &shelf,
                                        .physical_scale = &physical_scale};
    const std::vector<std::string> labels(count, "corrugated cardboard");
    for (const session::Step& step : count == 5U ? own_steps(texts) : steps_of_a_session()) {
      CAPTURE(step.index(), count);
      check_all_pages(paper, *app::screen_for(step, context, labels));
    }
  }
}

/// The steps of trials with several planes.
std::vector<session::Step> steps_with_intervals() {
  using What = session::NoticeStep::What;
  std::vector<session::Step> steps = {session::PracticeStep{1},
                                      session::ReadyStep{1, 60, false},
                                      session::ReadyStep{60, 60, false, true},
                                      session::IntervalStep{.trial = 1, .interval = 1, .total = 2},
                                      session::IntervalStep{.trial = 1, .interval = 3, .total = 3},
                                      session::IntervalStep{.trial = 1, .hand_off = true},
                                      session::FeedbackStep{0, 1},
                                      session::FeedbackStep{1, 1},
                                      session::NoticeStep{What::practice_over},
                                      session::NoticeStep{What::not_explored},
                                      session::NoticeStep{What::hand_off}};
  for (const char* question : {"threshold_texture", "threshold_stronger", "threshold_coarser",
                               "threshold_odd", "threshold_same"}) {
    for (const study::Sight sight : {study::Sight::curtain, study::Sight::blindfold}) {
      steps.push_back(session::AnswerStep{.trial = 2,
                                          .total = 60,
                                          .confidence_levels = 5,
                                          .question = study::ChoiceQuestion{question, {}},
                                          .sight = sight});
    }
  }
  return steps;
}

TEST_CASE("all screens of trials with several planes can be read, in all languages and sizes") {
  const Vec2 size = GENERATE(Vec2{1280.0, 720.0}, Vec2{1920.0, 1080.0}, Vec2{1280.0, 1024.0},
                             Vec2{3440.0, 1440.0});
  const std::string language = GENERATE("en", "de", "es", "fr", "ja", "zh");
  const double text_scale = GENERATE(1.0, study::kMaxTextScale);
  const bool feedback = GENERATE(false, true);
  const bool mouse = GENERATE(false, true);
  CAPTURE(size.x, language, text_scale, feedback, mouse);
  const Paper paper(size, text_scale, app::letters_in(all_texts(language)));
  Squares shelf(50.0);
  const app::PhysicalScale physical_scale = {0.27, true};
  const study::TrialQuestion ask{.exploring = study::TimedContact{},
                                 .planes = 3,
                                 .question = study::ChoiceQuestion{"threshold_odd", {}},
                                 .feedback = feedback};
  const app::ScreenContext context = {.words = &words_in(language),
                                      .language = language,
                                      .mouse = mouse,
                                      .shelf = &shelf,
                                      .physical_scale = &physical_scale,
                                      .trial_question = ask};
  for (const session::Step& step : steps_with_intervals()) {
    for (const std::vector<std::string>& labels :
         {std::vector<std::string>{"first", "second", "third"},
          std::vector<std::string>{"same", "different"}}) {
      CAPTURE(step.index(), labels.size());
      check_all_pages(paper, *app::screen_for(step, context, labels));
    }
  }
  study::Study study = study::load_study(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) /
                                         "config/discrimination-order.json");
  study.session.language = language;
  for (const study::Sight sight : {study::Sight::curtain, study::Sight::blindfold}) {
    study.session.sight = sight;
    const session::SessionTexts texts = app::session_texts(study);
    check_all_pages(paper,
                    *app::screen_for(session::InstructionStep{texts.instructions}, context, {}));
  }
}

TEST_CASE("with high contrast, no screen has the design's pale colours") {
  const Paper paper({1280.0, 720.0});
  Squares shelf(51.2);
  const app::PhysicalScale physical_scale = {0.27, true};
  const app::Words& words = words_in("en");
  const app::ScreenContext context = {
      .words = &words, .shelf = &shelf, .physical_scale = &physical_scale};
  const auto uses = [&](app::Screen& screen, bool high_contrast, std::uint32_t colour) {
    static_cast<void>(paper.draw(screen, high_contrast));
    const auto& vertices = ImGui::GetBackgroundDrawList()->VtxBuffer;
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](const ImDrawVert& vertex) { return vertex.col == colour; });
  };
  for (const session::Step& step : steps_of_a_session()) {
    CAPTURE(step.index());
    const auto screen = app::screen_for(step, context, {"bark", "cloth"});
    CHECK(uses(*screen, false, app::tone::kGround));
    for (const std::uint32_t pale : {app::tone::kGround, app::tone::kQuiet, app::tone::kEdge}) {
      CHECK_FALSE(uses(*screen, true, pale));
    }
  }
}

TEST_CASE("letters that are new to the fonts are reported, and are there when asked for") {
  Squares shelf(51.2);
  const app::PhysicalScale physical_scale;
  const app::Words& words = words_in("ja");
  const app::ScreenContext context = {
      .words = &words, .shelf = &shelf, .physical_scale = &physical_scale};
  const auto screen = app::screen_for(session::EndStep{}, context, {});
  std::set<char32_t> missing;
  {
    const Paper paper({1280.0, 720.0});
    missing = paper.draw(*screen).missing_letters();
  }
  CHECK(missing.contains(U'終'));
  CHECK_FALSE(missing.contains(U' '));
  const Paper paper({1280.0, 720.0}, 1.0, missing);
  CHECK(paper.draw(*screen).missing_letters().empty());
}

TEST_CASE("a page shows its pictures beside the text, and bold words without their marks") {
  const Paper paper({1280.0, 720.0});
  Squares shelf(51.2);
  const app::PhysicalScale physical_scale;
  const app::Words& words = words_in("en");
  const app::ScreenContext context = {
      .words = &words, .shelf = &shelf, .physical_scale = &physical_scale};
  const auto width_of_body = [&](const std::string& page) {
    const auto screen = app::screen_for(session::InstructionStep{{page}}, context, {});
    const app::Canvas canvas = paper.draw(*screen);
    REQUIRE(canvas.texts().size() >= 2);
    CHECK(canvas.texts()[1].text.find("![](") == std::string::npos);
    return canvas.texts()[1].box.width;
  };
  const double plain = width_of_body("Title\n\nwords");
  CHECK(width_of_body("Title\n\nwords\n\n![](drawing:hand)") == Approx(plain));
  CHECK(width_of_body("Title\n\n![](some.png)\n\nwords") == Approx(plain));
  // Bold letters are wider, and the asterisks take no room.
  const double bold = width_of_body("Title\n\n**words**");
  CHECK(bold > plain);
  CHECK(bold < 1.5 * plain);
}

TEST_CASE("pictures claim a scale only on a screen whose size is known") {
  const Paper paper({1280.0, 720.0});
  const double side_mm = GENERATE(25.0, 100.0);
  Squares shelf(side_mm);
  for (const bool is_known : {true, false}) {
    CAPTURE(side_mm, is_known);
    const app::PhysicalScale physical_scale = {0.27, is_known};
    app::AnswerScreen screen(
        {.trial = 1, .total = 25},
        {.words = &words_in("en"), .shelf = &shelf, .physical_scale = &physical_scale},
        std::vector<std::string>(5, "x"));
    const app::Canvas canvas = paper.draw(screen);
    CHECK(shows(canvas, "10 mm of the surface"));
    CHECK(shows(canvas, "in true size") == (is_known && side_mm < 50.0));
    CHECK(shows(canvas, "% of true size") == (is_known && side_mm > 50.0));
    CHECK(shows(canvas, "size on this screen is unknown") == !is_known);
  }
}

TEST_CASE("the mouse's hint is there in practice too, above the bars") {
  const Vec2 size = GENERATE(Vec2{1280.0, 720.0}, Vec2{1920.0, 1080.0}, Vec2{3840.0, 2160.0});
  const std::string language = GENERATE("en", "de");
  const bool practice = GENERATE(true, false);
  const Paper paper(size);
  Squares shelf(50.0);
  const app::PhysicalScale physical_scale = {0.27, true};
  const app::ScreenContext context = {.words = &words_in(language),
                                      .language = language,
                                      .mouse = true,
                                      .shelf = &shelf,
                                      .physical_scale = &physical_scale};
  app::HandReadings felt;
  felt.force_n = 2.3F;  // too hard, which is said beside the bars
  device::PointerExchange pointer;
  const std::atomic<bool> pressed{false};
  // A plane that fills the window.
  app::ExploringScreen screen(
      {practice ? &felt : nullptr, &pointer, &pressed, nullptr, {1.0, 900, 900}}, context);
  const app::Canvas canvas = paper.draw(screen);
  CHECK(shows(canvas, context.words->exploring_mouse));
  CHECK(faults_of(canvas) == "");
  const app::PlaneOnScreen plane = app::place_plane(size, {900.0, 900.0}, 0.27);
  for (const app::PlacedText& placed : canvas.texts()) {
    CHECK(placed.box.y >= plane.corner.y + 900.0 / plane.mm_per_unit);
  }
}

TEST_CASE("while one of several planes is on, the screen says which and how far its clock is") {
  const std::string language = GENERATE("en", "de", "es", "fr", "ja", "zh");
  const Vec2 size = GENERATE(Vec2{1280.0, 720.0}, Vec2{1280.0, 1024.0}, Vec2{3440.0, 1440.0});
  const bool mouse = GENERATE(true, false);
  const bool practice = GENERATE(true, false);
  const bool hand_off = GENERATE(true, false);
  CAPTURE(language, size.x, mouse, practice, hand_off);
  const Paper paper(size, 1.0, app::letters_in(all_texts(language)));
  Squares shelf(50.0);
  const app::PhysicalScale physical_scale = {0.27, true};
  const app::ScreenContext context = {.words = &words_in(language),
                                      .mouse = mouse,
                                      .shelf = &shelf,
                                      .physical_scale = &physical_scale};
  app::HandReadings felt;
  device::PointerExchange pointer;
  const std::atomic<bool> pressed{false};
  std::atomic<int> explored{0};
  const std::atomic<bool> has_lifted{GENERATE(true, false)};
  const session::IntervalStep interval{.trial = 1, .interval = 2, .total = 3, .hand_off = hand_off};
  app::ExploringScreen screen({practice ? &felt : nullptr,
                               mouse ? &pointer : nullptr,
                               &pressed,
                               nullptr,
                               {1.0, 900, 900},
                               interval,
                               &explored,
                               &has_lifted},
                              context);
  const app::Canvas canvas = paper.draw(screen);
  CHECK(faults_of(canvas) == "");
  CHECK(shows(canvas,
              app::fill_numbers(words_in(language).interval_of, {{"interval", 2}, {"of", 3}})));
  CHECK_FALSE(shows(canvas, words_in(language).exploring_mouse));
  const auto length_of_bar = [&] {
    static_cast<void>(paper.draw(screen));
    float left = 1e9F;
    float right = 0.0F;
    for (const ImDrawVert& vertex : ImGui::GetBackgroundDrawList()->VtxBuffer) {
      if (vertex.col != app::tone::kAccent) continue;
      left = std::min(left, vertex.pos.x);
      right = std::max(right, vertex.pos.x);
    }
    return std::max(0.0F, right - left);
  };
  const float none = length_of_bar();
  explored = app::kExploredSteps / 2;
  const float half = length_of_bar();
  explored = 2 * app::kExploredSteps;  // positions told more than the clock
  const float full = length_of_bar();
  CHECK(none == 0.0F);
  CHECK(full == Approx(2.0F * half).epsilon(0.02));
}

TEST_CASE("after a comfort stop the space bar has no effect, and Enter continues if allowed") {
  const bool can_resume = GENERATE(true, false);
  Drawn stopped(session::NoticeStep{session::NoticeStep::What::stopped, 3, can_resume});
  static_cast<void>(stopped.draw());
  CHECK_FALSE(stopped.press(app::Key::space));
  CHECK(stopped.press(app::Key::enter).has_value() == can_resume);
}

TEST_CASE("a frame that is as large as a bank card gives the scale of the screen") {
  const Vec2 size = GENERATE(Vec2{1280.0, 720.0}, Vec2{1920.0, 1080.0}, Vec2{3840.0, 2160.0});
  const Paper paper(size);
  app::CardScreen screen(85.6 / 320.0);
  CHECK(faults_of(paper.draw(screen)) == "");
  for (const app::Key which :
       {app::Key::right, app::Key::right, app::Key::up, app::Key::left, app::Key::down}) {
    CHECK_FALSE(screen.handle(key(which)));
  }
  CHECK(screen.mm_per_unit() == Approx(85.6 / 321.0));
  app::InputEvent held = key(app::Key::up);
  held.kind = app::InputEvent::Kind::repeat;
  for (int i = 0; i < 500; ++i) CHECK_FALSE(screen.handle(held));
  CHECK(screen.mm_per_unit() == Approx(25.4 / 400.0).epsilon(1e-3));
  CHECK(screen.handle(key(app::Key::enter)));
}

/// A question, and its answer by keys.
struct Asked : Drawn {
  explicit Asked(const session::AnswerStep& step = {.trial = 1, .total = 25},
                 const std::vector<std::string>& labels = std::vector<std::string>(5, "x"))
      : Drawn(step, "en", labels) {
    static_cast<void>(draw());
  }
};

const session::AnswerStep kPictures{.trial = 1, .total = 25};
const session::AnswerStep kWords{
    .trial = 1, .total = 60, .question = study::ChoiceQuestion{"threshold_odd", {}}};
const std::vector<std::string> kThree = {"first", "second", "third"};

TEST_CASE("an answer needs a choice that is there and Next, and can be changed once") {
  Asked asked(GENERATE(kPictures, kWords), kThree);
  CHECK_FALSE(asked.press(app::Key::enter));
  static_cast<void>(asked.press(app::Key::digit, 4));
  static_cast<void>(asked.press(app::Key::digit, 0));
  CHECK_FALSE(asked.press(app::Key::enter));
  static_cast<void>(asked.press(app::Key::digit, 1));
  CHECK(shows(asked.draw(), "You can change your answer once."));
  const bool changes = GENERATE(false, true);
  if (changes) {
    static_cast<void>(asked.press(app::Key::digit, 1));
    static_cast<void>(asked.press(app::Key::right));
    static_cast<void>(asked.press(app::Key::digit, 3));
    static_cast<void>(asked.press(app::Key::digit, 2));
    CHECK(shows(asked.draw(), "Your answer is now fixed."));
  }
  const auto reply = asked.press(app::Key::enter);
  REQUIRE(reply);
  CHECK(position_of(reply->answer) == (changes ? 2 : 0));
  CHECK(first_position_of(reply->answer) == (changes ? std::optional(0) : std::nullopt));
  CHECK_FALSE(asked.press(app::Key::enter));
}

TEST_CASE("choices that are words are shown under their own question, without a scale") {
  Asked asked(kWords, kThree);
  CHECK(shows(asked.draw(), "Which surface was different from the others?"));
  for (const char* word : {"First", "Second", "Third"}) CHECK(shows(asked.draw(), word));
  CHECK_FALSE(shows(asked.draw(), "10 mm"));
}

TEST_CASE("arrows go from choice to choice, and to Next") {
  Asked asked(GENERATE(kPictures, kWords), kThree);
  for (const app::Key which : {app::Key::right, app::Key::right, app::Key::right, app::Key::left}) {
    static_cast<void>(asked.press(which));
  }
  CHECK(asked.screen->attention().focus == 1);
  static_cast<void>(asked.press(app::Key::enter));
  CHECK(asked.screen->attention().focus == app::kNextTarget);
  const auto reply = asked.press(app::Key::enter);
  REQUIRE(reply);
  CHECK(position_of(reply->answer) == 1);
}

TEST_CASE("the announcement of a plane ends by itself, not by a key") {
  Drawn said(session::IntervalStep{.trial = 1});
  CHECK(shows(said.draw(), "Surface 1 of 2"));
  for (const app::Key which : {app::Key::enter, app::Key::space, app::Key::tab, app::Key::right}) {
    CHECK_FALSE(said.press(which));
  }
  CHECK_FALSE(said.press(app::Key::digit, 1));
}

TEST_CASE("confidence is asked after the answer, whose time is when Next was pressed") {
  Asked asked({.trial = 1, .total = 25, .confidence_levels = 4});
  static_cast<void>(asked.press(app::Key::digit, 2));
  app::InputEvent next = key(app::Key::enter);
  next.at = app::InputEvent::Time(std::chrono::seconds(5));
  CHECK_FALSE(asked.screen->handle(next));
  static_cast<void>(asked.draw());
  CHECK_FALSE(asked.press(app::Key::enter));
  static_cast<void>(asked.press(app::Key::digit, 5));
  static_cast<void>(asked.press(app::Key::digit, 4));
  app::InputEvent last = key(app::Key::enter);
  last.at = app::InputEvent::Time(std::chrono::seconds(9));
  const auto reply = asked.screen->handle(last);
  REQUIRE(reply);
  CHECK(position_of(reply->answer) == 1);
  CHECK(reply->confidence == 4);
  CHECK(reply->at == next.at);
}

TEST_CASE("a picture and Next can be clicked; releasing the button elsewhere is not a click") {
  Asked asked;
  const auto click = [&](int id, Vec2 slip) {
    const auto targets = asked.draw().targets();
    const auto found = std::find_if(targets.begin(), targets.end(),
                                    [id](const app::Target& t) { return t.id == id; });
    REQUIRE(found != targets.end());
    app::InputEvent event{.kind = app::InputEvent::Kind::pressed,
                          .position = {found->box.x + 5.0, found->box.y + 5.0}};
    static_cast<void>(asked.screen->handle(event));
    event.kind = app::InputEvent::Kind::released;
    event.position = event.position + slip;
    return asked.screen->handle(event);
  };
  CHECK_FALSE(click(4, {0.0, 0.0}));
  CHECK_FALSE(click(app::kNextTarget, {0.0, -300.0}));
  const auto reply = click(app::kNextTarget, {0.0, 0.0});
  REQUIRE(reply);
  CHECK(position_of(reply->answer) == 4);
}

TEST_CASE("feeling again is offered only if the step allows it") {
  Asked without;
  Asked with({.trial = 1, .total = 25, .may_explore_again = true});
  CHECK(without.draw().targets().size() == 5);
  CHECK(with.draw().targets().size() == 6);
  static_cast<void>(with.press(app::Key::back_tab));
  const auto reply = with.press(app::Key::enter);
  REQUIRE(reply);
  CHECK(reply->explore_again);
}

TEST_CASE("a questionnaire can be answered with keys, and optional questions can be skipped") {
  Drawn asked(session::QuestionStep{&questions()}, "de");
  const auto press = [&](app::Key which, int digit = 0) {
    static_cast<void>(asked.draw());
    CHECK_FALSE(asked.press(which, digit));
  };
  press(app::Key::enter);  // it must be answered
  press(app::Key::digit, 5);
  press(app::Key::enter);
  press(app::Key::digit, 9);
  press(app::Key::digit, 1);
  press(app::Key::enter);
  asked.write(U"2x3,5");
  press(app::Key::enter);
  asked.write(U"Rüe");
  press(app::Key::left);
  asked.write(U"h");
  press(app::Key::remove);
  press(app::Key::backspace);
  const auto reply = asked.press(app::Key::enter);
  REQUIRE(reply);
  CHECK(reply->answers == std::vector<std::string>{"4", "0", "23.5", "Rü"});
}

TEST_CASE("an unacceptable number does not continue, and its bounds are shown") {
  study::Question age{"age", study::QuestionKind::number, {{"de", "Alter?"}}, {}};
  age.min = 18.0;
  age.max = 99.5;
  const study::Questionnaire asked = {"closing", {age}};
  Drawn screen(session::QuestionStep{&asked}, "de");
  const auto has_text = [&](const std::string& text) {
    const std::vector<app::PlacedText> texts = screen.draw().texts();
    return std::ranges::any_of(texts, [&](const app::PlacedText& t) { return t.text == text; });
  };
  CHECK(has_text("18 – 99,5"));
  const auto number = [&](const std::u32string& digits) {
    for (int i = 0; i < 12; ++i) static_cast<void>(screen.press(app::Key::backspace));
    screen.write(digits);
    CHECK(faults_of(screen.draw()) == "");
    return screen.press(app::Key::enter);
  };
  for (const std::u32string no : {U"17", U"99,6", U"100", U"-20", U"2-", U"1.8.", U","}) {
    CHECK_FALSE(number(no));
  }
  const auto reply = number(U"99,5");
  REQUIRE(reply);
  CHECK(reply->answers == std::vector<std::string>{"99.5"});
}

TEST_CASE("Next keeps its position when other buttons appear and disappear") {
  const auto next_of = [](const app::Canvas& canvas) {
    const auto found = std::ranges::find(canvas.targets(), app::kNextTarget, &app::Target::id);
    REQUIRE(found != canvas.targets().end());
    return found->box;
  };
  Asked without;
  Asked with({.trial = 1, .total = 25, .may_explore_again = true});
  static_cast<void>(without.press(app::Key::digit, 1));
  static_cast<void>(with.press(app::Key::digit, 1));
  const app::Box next = next_of(without.draw());
  CHECK(next.x + next.width / 2.0 == Approx(640.0).margin(1.0));
  CHECK(next_of(with.draw()).x == next.x);
  Drawn pages(session::InstructionStep{{"one", "two"}});
  CHECK(next_of(pages.draw()).x == next.x);
  static_cast<void>(pages.press(app::Key::enter));
  const app::Canvas second = pages.draw();
  CHECK(second.targets().size() == 2);  // Back has come
  CHECK(next_of(second).x == next.x);
}

TEST_CASE("many pictures are as large as any grid allows with a quarter of their side between") {
  const int count = GENERATE(10, 16, 25, 30, 49, 64);
  CAPTURE(count);
  constexpr double kWidth = 1152.0;
  constexpr double kHeight = 384.0;
  constexpr double kBelow = 40.0;
  const std::vector<Vec2> sizes(static_cast<std::size_t>(count), {378.0, 378.0});
  const app::PictureGrid grid =
      app::lay_out_pictures(sizes, {0.0, 0.0, kWidth, kHeight}, 32.0, kBelow);
  const double side = grid.pictures.front().width;
  double largest = 0.0;
  for (int columns = 1; columns <= count; ++columns) {
    const int rows = (count + columns - 1) / columns;
    largest = std::max(largest, std::min(kWidth / (1.25 * columns - 0.25),
                                         (kHeight - rows * kBelow) / (1.25 * rows - 0.25)));
  }
  CHECK(side >= largest - 1e-6);
  for (std::size_t i = 0; i < grid.pictures.size(); ++i) {
    app::Box one = grid.pictures[i];
    one.height += kBelow;
    CHECK(lies_inside(one, {0.0, 0.0, kWidth, kHeight}));
    for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(overlap(one, grid.pictures[j]));
  }
}

TEST_CASE("pictures have their true size if there is room, and are never larger") {
  const std::vector<Vec2> sizes(5, {200.0, 200.0});
  const app::PictureGrid roomy =
      app::lay_out_pictures(sizes, {0.0, 0.0, 1200.0, 400.0}, 20.0, 40.0);
  CHECK(roomy.scale == 1.0);
  CHECK(roomy.pictures[4].width == Approx(200.0));
  const app::PictureGrid tight = app::lay_out_pictures(sizes, {0.0, 0.0, 600.0, 400.0}, 20.0, 40.0);
  CHECK(tight.scale == Approx(0.75));
  for (const app::Box& picture : tight.pictures) {
    CHECK(lies_inside(picture, {0.0, 0.0, 600.0, 400.0}));
    CHECK(picture.width == Approx(150.0));
  }
}

}  // namespace
}  // namespace touchtrial
