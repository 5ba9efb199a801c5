// Checks that everything a participant reads lies on the screen, in both languages and at several
// sizes. The screens are drawn without a window, and the places of texts and buttons are compared.
#include "app/participant/answer_screen.hpp"
#include "app/participant/canvas.hpp"
#include "app/participant/page_layout.hpp"
#include "app/participant/screen.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <imgui.h>

namespace touchtrial {
namespace {

/// Square pictures of one size.
class Squares final : public app::PictureShelf {
 public:
  explicit Squares(double side_mm) : side_mm_(side_mm) {}
  [[nodiscard]] Vec2 size_mm(const std::string& /*label*/) const override {
    return {side_mm_, side_mm_};
  }
  [[nodiscard]] void* texture(const std::string& /*label*/, int /*w*/, int /*h*/) override {
    return nullptr;
  }

 private:
  double side_mm_;
};

/// Dear ImGui without a window or a graphics card.
class Paper {
 public:
  explicit Paper(Vec2 size) : size_(size), context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_);
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().DisplaySize = {static_cast<float>(size.x), static_cast<float>(size.y)};
    fonts_ = app::load_participant_fonts(app::design_unit(size));
    ImGui::GetIO().Fonts->Build();
  }
  ~Paper() { ImGui::DestroyContext(context_); }
  Paper(const Paper&) = delete;
  Paper& operator=(const Paper&) = delete;

  [[nodiscard]] app::Canvas draw(app::Screen& screen) const {
    ImGui::SetCurrentContext(context_);
    ImGui::NewFrame();
    app::Canvas canvas(*ImGui::GetBackgroundDrawList(), fonts_, size_, screen.attention());
    screen.draw(canvas);
    ImGui::EndFrame();
    return canvas;
  }
  [[nodiscard]] Vec2 size() const noexcept { return size_; }

 private:
  Vec2 size_;
  ImGuiContext* context_;
  app::Fonts fonts_;
};

bool lies_inside(const app::Box& inner, const app::Box& outer) {
  constexpr double kRounding = 1.5;
  return inner.x >= outer.x - kRounding && inner.y >= outer.y - kRounding &&
         inner.right() <= outer.right() + kRounding && inner.bottom() <= outer.bottom() + kRounding;
}

bool overlap(const app::Box& a, const app::Box& b) {
  constexpr double kRounding = 1.5;
  return a.x + kRounding < b.right() && b.x + kRounding < a.right() &&
         a.y + kRounding < b.bottom() && b.y + kRounding < a.bottom();
}

/// \return faults of a picture, one line each; empty if there are none
std::string faults_of(const app::Canvas& canvas) {
  std::string faults;
  const app::Box all = {0.0, 0.0, canvas.size().x, canvas.size().y};
  const std::vector<app::PlacedText>& texts = canvas.texts();
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (!lies_inside(texts[i].box, all)) faults += "off the screen: " + texts[i].text + "\n";
    if (!lies_inside(texts[i].box, texts[i].room)) faults += "clipped: " + texts[i].text + "\n";
    for (std::size_t j = 0; j < i; ++j) {
      if (overlap(texts[i].box, texts[j].box)) {
        faults += "'" + texts[i].text + "' lies over '" + texts[j].text + "'\n";
      }
    }
  }
  const std::vector<app::Target>& targets = canvas.targets();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (!lies_inside(targets[i].box, all)) faults += "a button is off the screen\n";
    for (std::size_t j = 0; j < i; ++j) {
      if (overlap(targets[i].box, targets[j].box)) faults += "two buttons overlap\n";
    }
  }
  return faults;
}

app::InputEvent key(app::Key which, int digit = 0) {
  app::InputEvent event;
  event.key = which;
  event.digit = digit;
  return event;
}

design::Question choice(int options) {
  design::Question question{"hand", design::QuestionKind::choice, {}, {}, true};
  question.text = {{"en", "Which hand do you use to hold a toothbrush, or the thing most like it?"},
                   {"de", "Mit welcher Hand halten Sie eine Zahnbürste oder etwas Ähnliches?"}};
  for (int i = 0; i < options; ++i) {
    question.options.push_back({{"en", "mostly the right one, hardly ever the other"},
                                {"de", "meistens die rechte, kaum jemals die andere"}});
  }
  return question;
}

const design::Questionnaire& questions() {
  static const design::Questionnaire all = {
      "closing",
      {choice(5),
       choice(9),
       {"age", design::QuestionKind::number, {{"en", "Age?"}, {"de", "Alter?"}}, {}},
       {"strategy",
        design::QuestionKind::text,
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
                              .of = 25,
                              .time_is_up = true,
                              .may_explore_again = true,
                              .confidence_levels = 9},
          session::AnswerStep{.trial = 2, .of = 5, .practice = true},
          session::AnswerStep{
              .trial = 2, .of = 25, .time_is_up = true, .sight = design::Sight::blindfold},
          session::FeedbackStep{0, 1},
          session::FeedbackStep{1, 1},
          session::BreakStep{10, 25},
          session::PauseStep{},
          session::EndStep{}};
}

/// Checks all pages of a screen, with and without choices.
void check_all_pages(const Paper& paper, app::Screen& screen) {
  for (int page = 0; page < 12 && !screen.is_done(); ++page) {
    CHECK(faults_of(paper.draw(screen)) == "");
    static_cast<void>(screen.take(key(app::Key::digit, 2)));
    CHECK(faults_of(paper.draw(screen)) == "");
    static_cast<void>(screen.take(key(app::Key::digit, 1)));
    CHECK(faults_of(paper.draw(screen)) == "");
    static_cast<void>(screen.take(key(app::Key::enter)));
  }
}

TEST_CASE("everything on every screen can be read, in both languages and at all sizes") {
  const Vec2 size = GENERATE(Vec2{1280.0, 720.0}, Vec2{1920.0, 1080.0}, Vec2{3840.0, 2160.0},
                             Vec2{1280.0, 1024.0}, Vec2{3440.0, 1440.0});
  const std::string language = GENERATE("en", "de");
  const double side_mm = GENERATE(25.0, 51.2, 100.0);
  const bool knows = side_mm < 100.0;
  CAPTURE(size.x, language, side_mm);
  const Paper paper(size);
  Squares shelf(side_mm);
  const app::Glass glass = {size.x > 2000.0 ? 0.16 : 0.27, knows};
  for (const std::size_t count : {2U, 5U, 9U}) {
    const app::ScreenContext context = {.words = &app::words_in(language),
                                        .language = language,
                                        .mouse = count == 5U,
                                        .shelf = &shelf,
                                        .glass = &glass};
    const std::vector<std::string> labels(count, "corrugated cardboard");
    for (const session::Step& step : steps_of_a_session()) {
      CAPTURE(step.index(), count);
      check_all_pages(paper, *app::screen_for(step, context, labels));
    }
  }
}

struct Asked {
  explicit Asked(const session::AnswerStep& step = {.trial = 1, .of = 25}, int count = 5)
      : screen(step, {.words = &app::words_in("en"), .shelf = &shelf, .glass = &glass},
               std::vector<std::string>(static_cast<std::size_t>(count), "x")) {
    static_cast<void>(paper.draw(screen));
  }
  std::optional<session::StepReply> press(app::Key which, int digit = 0) {
    std::optional<session::StepReply> reply = screen.take(key(which, digit));
    static_cast<void>(paper.draw(screen));
    return reply;
  }

  Paper paper{{1280.0, 720.0}};
  Squares shelf{51.2};
  app::Glass glass{0.27, true};
  app::AnswerScreen screen;
};

TEST_CASE("an answer needs a choice and Next; Enter alone does not answer") {
  Asked asked;
  CHECK_FALSE(asked.press(app::Key::enter));
  CHECK_FALSE(asked.press(app::Key::digit, 3));
  const auto reply = asked.press(app::Key::enter);
  REQUIRE(reply);
  CHECK(reply->position == 2);
  CHECK_FALSE(reply->first_position);
}

TEST_CASE("an answer can be changed once, and the reply holds both choices") {
  Asked asked;
  static_cast<void>(asked.press(app::Key::digit, 3));
  static_cast<void>(asked.press(app::Key::digit, 3));
  static_cast<void>(asked.press(app::Key::digit, 5));
  static_cast<void>(asked.press(app::Key::digit, 1));
  const auto reply = asked.press(app::Key::enter);
  REQUIRE(reply);
  CHECK(reply->position == 4);
  CHECK(reply->first_position == 2);
  CHECK_FALSE(asked.press(app::Key::enter));
}

TEST_CASE("keys beyond the pictures choose nothing") {
  Asked asked;
  static_cast<void>(asked.press(app::Key::digit, 6));
  static_cast<void>(asked.press(app::Key::digit, 0));
  CHECK_FALSE(asked.press(app::Key::enter));
}

TEST_CASE("arrows go from picture to picture, and down to Next") {
  Asked asked;
  static_cast<void>(asked.press(app::Key::right));
  static_cast<void>(asked.press(app::Key::right));
  static_cast<void>(asked.press(app::Key::right));
  static_cast<void>(asked.press(app::Key::left));
  CHECK(asked.screen.attention().focus == 1);
  static_cast<void>(asked.press(app::Key::enter));
  CHECK(asked.screen.attention().focus == app::kNextTarget);
  const auto reply = asked.press(app::Key::enter);
  REQUIRE(reply);
  CHECK(reply->position == 1);
}

TEST_CASE("confidence is asked after the answer, whose time is when Next was pressed") {
  Asked asked({.trial = 1, .of = 25, .confidence_levels = 4});
  static_cast<void>(asked.press(app::Key::digit, 2));
  app::InputEvent next = key(app::Key::enter);
  next.at = app::InputEvent::Time(std::chrono::seconds(5));
  CHECK_FALSE(asked.screen.take(next));
  static_cast<void>(asked.paper.draw(asked.screen));
  CHECK_FALSE(asked.press(app::Key::enter));
  static_cast<void>(asked.press(app::Key::digit, 5));
  static_cast<void>(asked.press(app::Key::digit, 4));
  app::InputEvent last = key(app::Key::enter);
  last.at = app::InputEvent::Time(std::chrono::seconds(9));
  const auto reply = asked.screen.take(last);
  REQUIRE(reply);
  CHECK(reply->position == 1);
  CHECK(reply->confidence == 4);
  CHECK(reply->at == next.at);
}

TEST_CASE("a picture and Next can be clicked; releasing the button elsewhere is not a click") {
  Asked asked;
  const auto click = [&](int id, Vec2 slip) {
    const auto targets = asked.paper.draw(asked.screen).targets();
    const auto found = std::find_if(targets.begin(), targets.end(),
                                    [id](const app::Target& t) { return t.id == id; });
    REQUIRE(found != targets.end());
    app::InputEvent event;
    event.position = {found->box.x + 5.0, found->box.y + 5.0};
    event.kind = app::InputEvent::Kind::pressed;
    static_cast<void>(asked.screen.take(event));
    event.kind = app::InputEvent::Kind::released;
    event.position = event.position + slip;
    return asked.screen.take(event);
  };
  CHECK_FALSE(click(4, {0.0, 0.0}));
  CHECK_FALSE(click(app::kNextTarget, {0.0, -300.0}));
  const auto reply = click(app::kNextTarget, {0.0, 0.0});
  REQUIRE(reply);
  CHECK(reply->position == 4);
}

TEST_CASE("feeling again is offered only if the step allows it") {
  Asked without;
  Asked with({.trial = 1, .of = 25, .may_explore_again = true});
  CHECK(without.paper.draw(without.screen).targets().size() == 5);
  CHECK(with.paper.draw(with.screen).targets().size() == 6);
  static_cast<void>(with.press(app::Key::back_tab));
  const auto reply = with.press(app::Key::enter);
  REQUIRE(reply);
  CHECK(reply->explore_again);
}

TEST_CASE("a questionnaire can be answered with keys, and optional questions can be skipped") {
  const Paper paper({1280.0, 720.0});
  Squares shelf(51.2);
  const app::Glass glass;
  const app::ScreenContext context = {
      .words = &app::words_in("de"), .language = "de", .shelf = &shelf, .glass = &glass};
  const auto screen = app::screen_for(session::QuestionStep{&questions()}, context, {});
  const auto press = [&](app::Key which, int digit = 0) {
    static_cast<void>(paper.draw(*screen));
    return screen->take(key(which, digit));
  };
  const auto write = [&](char32_t letter) {
    app::InputEvent event;
    event.kind = app::InputEvent::Kind::letter;
    event.letter = letter;
    CHECK_FALSE(screen->take(event));
  };
  CHECK_FALSE(press(app::Key::enter));  // it must be answered
  CHECK_FALSE(press(app::Key::digit, 5));
  CHECK_FALSE(press(app::Key::enter));
  CHECK_FALSE(press(app::Key::digit, 9));
  CHECK_FALSE(press(app::Key::digit, 1));
  CHECK_FALSE(press(app::Key::enter));
  for (const char32_t letter : U"2x3,5") {
    if (letter != 0) write(letter);
  }
  CHECK_FALSE(press(app::Key::enter));
  for (const char32_t letter : U"Rüe") {
    if (letter != 0) write(letter);
  }
  CHECK_FALSE(press(app::Key::left));
  write(U'h');
  CHECK_FALSE(press(app::Key::remove));
  CHECK_FALSE(press(app::Key::backspace));
  const auto reply = press(app::Key::enter);
  REQUIRE(reply);
  CHECK(reply->answers == std::vector<std::string>{"4", "0", "23.5", "Rü"});
}

TEST_CASE("pictures have their true size if there is room, and are never larger") {
  const std::vector<Vec2> sizes(5, {200.0, 200.0});
  const app::PictureGrid roomy =
      app::lay_out_pictures(sizes, {0.0, 0.0, 1200.0, 400.0}, 20.0, 40.0);
  CHECK(roomy.shown == 1.0);
  CHECK(roomy.pictures[4].width == Approx(200.0));
  const app::PictureGrid tight = app::lay_out_pictures(sizes, {0.0, 0.0, 600.0, 400.0}, 20.0, 40.0);
  CHECK(tight.shown == Approx(0.75));
  for (const app::Box& picture : tight.pictures) {
    CHECK(lies_inside(picture, {0.0, 0.0, 600.0, 400.0}));
    CHECK(picture.width == Approx(150.0));
  }
}

}  // namespace
}  // namespace touchtrial
