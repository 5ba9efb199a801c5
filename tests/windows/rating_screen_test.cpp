// The screen on which participants rate: by keys, by mouse, and where everything lies.
#include "app/texts/study_texts.hpp"
#include "app/windows/look.hpp"
#include "core/answer.hpp"
#include "study/study.hpp"
#include "support/catch.hpp"
#include "windows/drawn_screen.hpp"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>

namespace touchtrial {
namespace {

using Kind = app::InputEvent::Kind;
using Values = std::vector<double>;

/// \param points  0: a line
study::Scale scale_of(int points) {
  return {.id = "scale",
          .text = "How rough did the surface feel to you?",
          .low = "not rough at all",
          .high = "as rough as can be",
          .points = points};
}

session::AnswerStep rated(const std::vector<int>& points) {
  study::RatingQuestion rate{.title = "rate_title", .scales = {}};
  for (const int count : points) rate.scales.push_back(scale_of(count));
  return {.trial = 1, .total = 25, .question = rate, .picture = "bark"};
}

/// A participant before the screen.
struct Rating : Drawn {
  explicit Rating(const session::AnswerStep& step) : Drawn(step) { static_cast<void>(draw()); }

  /// \return the ratings, if the screen goes on
  std::optional<Values> enter() {
    const auto reply = press(app::Key::enter);
    return reply ? std::optional(std::get<RatingAnswer>(reply->answer).values) : std::nullopt;
  }
  void press_with_shift(app::Key which) {
    app::InputEvent event = key(which);
    event.shift = true;
    CHECK_FALSE(screen->handle(event));
    static_cast<void>(draw());
  }
  std::optional<session::StepReply> mouse(Kind kind, Vec2 position) {
    auto reply = screen->handle({.kind = kind, .position = position});
    static_cast<void>(draw());
    return reply;
  }
  std::optional<session::StepReply> click(Vec2 position) {
    CHECK_FALSE(mouse(Kind::pressed, position));
    return mouse(Kind::released, position);
  }
  /// The box of a target, in the order in which targets are drawn.
  [[nodiscard]] app::Box target(std::size_t index) { return draw().targets().at(index).box; }
  [[nodiscard]] bool can_resume() {
    return std::ranges::count(draw().targets(), app::kNextTarget, &app::Target::id) > 0;
  }
  /// Whether anything between heading and buttons has the colour of a marker.
  [[nodiscard]] bool has_marker() {
    static_cast<void>(draw());
    return std::ranges::any_of(ImGui::GetBackgroundDrawList()->VtxBuffer, [](const auto& vertex) {
      return vertex.col == app::tone::kAccent && vertex.pos.y > 100.0F && vertex.pos.y < 590.0F;
    });
  }
};

Vec2 middle_of(const app::Box& box) {
  return {box.x + box.width / 2.0, box.y + box.height / 2.0};
}

TEST_CASE("nothing is marked before the participant has marked it") {
  Rating rating(rated({GENERATE(0, 7)}));
  CHECK_FALSE(rating.has_marker());
  CHECK_FALSE(rating.can_resume());
  CHECK_FALSE(rating.enter());
  CHECK_FALSE(rating.press(app::Key::space));
  static_cast<void>(rating.mouse(Kind::moved, middle_of(rating.target(0))));
  CHECK_FALSE(rating.can_resume());
  static_cast<void>(rating.press(app::Key::right));
  CHECK(rating.has_marker());
  CHECK(rating.can_resume());
}

TEST_CASE("keys mark a line in its middle, then move by hundredths, or by tenths with Shift") {
  Rating rating(rated({0}));
  static_cast<void>(rating.press(GENERATE(app::Key::left, app::Key::right)));
  SECTION("the middle") {
    CHECK(rating.enter() == Values{0.5});
  }
  SECTION("steps") {
    static_cast<void>(rating.press(app::Key::right));
    rating.press_with_shift(app::Key::left);
    app::InputEvent held = key(app::Key::left);
    held.kind = Kind::repeat;
    CHECK_FALSE(rating.screen->handle(held));
    CHECK(rating.enter() == Values{0.4});
  }
  SECTION("the ends") {
    for (int i = 0; i < 7; ++i) rating.press_with_shift(app::Key::left);
    static_cast<void>(rating.press(app::Key::right));
    static_cast<void>(rating.press(app::Key::left));
    CHECK(rating.enter() == Values{0.0});
  }
  SECTION("a digit means nothing") {
    static_cast<void>(rating.press(app::Key::digit, 1));
    CHECK(rating.enter() == Values{0.5});
  }
}

TEST_CASE("the mouse marks a line where it is pressed, and draws the mark to the ends") {
  Rating rating(rated({0}));
  const app::Box line = rating.target(0);
  const Vec2 middle = middle_of(line);
  CHECK_FALSE(rating.click({middle.x, 20.0}));
  CHECK_FALSE(rating.can_resume());
  CHECK_FALSE(rating.mouse(Kind::pressed, middle));
  CHECK(rating.has_marker());
  SECTION("where it was pressed") {
    CHECK_FALSE(rating.mouse(Kind::released, middle));
    CHECK(rating.enter() == Values{0.5});
  }
  SECTION("drawn to the left, beyond the end") {
    CHECK_FALSE(rating.mouse(Kind::moved, {1.0, middle.y - 200.0}));
    CHECK_FALSE(rating.mouse(Kind::released, {1.0, middle.y - 200.0}));
    CHECK(rating.enter() == Values{0.0});
  }
  SECTION("drawn to the right, beyond the end; the mouse no longer counts once it is released") {
    CHECK_FALSE(rating.mouse(Kind::moved, {1279.0, middle.y}));
    CHECK_FALSE(rating.mouse(Kind::released, {1279.0, middle.y}));
    CHECK_FALSE(rating.mouse(Kind::moved, middle));
    CHECK(rating.enter() == Values{1.0});
  }
  SECTION("a third of the way, rounded to thousandths") {
    CHECK_FALSE(rating.mouse(Kind::moved, {line.x + line.width / 3.0, middle.y}));
    CHECK_FALSE(rating.mouse(Kind::released, {line.x + line.width / 3.0, middle.y}));
    const double value = rating.enter().value().at(0);
    CHECK(value == Approx(0.33).margin(0.02));
    CHECK(value == std::round(1000.0 * value) / 1000.0);
  }
  SECTION("and a click on Next is when the answer was given") {
    CHECK_FALSE(rating.mouse(Kind::released, middle));
    const Vec2 next = middle_of(rating.target(1));
    CHECK_FALSE(rating.mouse(Kind::pressed, next));
    app::InputEvent last{.kind = Kind::released, .position = next};
    last.at = app::InputEvent::Time(std::chrono::seconds(9));
    const auto reply = rating.screen->handle(last);
    REQUIRE(reply);
    CHECK(ratings_of(reply->answer) == Values{0.5});
    CHECK(reply->at == last.at);
    CHECK_FALSE(reply->explore_again);
  }
}

TEST_CASE("a scale of numbers is answered by digits, arrows or clicks, and may be changed") {
  Rating rating(rated({7}));
  const auto shown = rating.draw();
  for (const char* number : {"1", "4", "7"}) CHECK(shows(shown, number));
  SECTION("digits") {
    static_cast<void>(rating.press(app::Key::digit, 8));
    static_cast<void>(rating.press(app::Key::digit, 0));
    CHECK_FALSE(rating.enter());
    static_cast<void>(rating.press(app::Key::digit, 2));
    static_cast<void>(rating.press(app::Key::digit, 7));
    CHECK(rating.enter() == Values{7.0});
  }
  SECTION("arrows") {
    static_cast<void>(rating.press(app::Key::left));
    static_cast<void>(rating.press(app::Key::right));
    CHECK(rating.enter() == Values{5.0});
  }
  SECTION("arrows end at the last number") {
    for (int i = 0; i < 9; ++i) static_cast<void>(rating.press(app::Key::right));
    CHECK(rating.enter() == Values{7.0});
  }
  SECTION("clicks") {
    CHECK_FALSE(rating.click(middle_of(rating.target(2))));
    CHECK_FALSE(rating.click(middle_of(rating.target(0))));
    CHECK(rating.enter() == Values{1.0});
  }
}

TEST_CASE("Next waits for all scales; Enter goes to those that are left") {
  Rating rating(rated({0, 5, 0}));
  static_cast<void>(rating.press(app::Key::right));
  CHECK_FALSE(rating.enter());
  static_cast<void>(rating.press(app::Key::digit, 6));
  CHECK_FALSE(rating.enter());
  static_cast<void>(rating.press(app::Key::digit, 4));
  CHECK_FALSE(rating.enter());
  CHECK_FALSE(rating.can_resume());
  static_cast<void>(rating.press(app::Key::left));
  CHECK(rating.can_resume());
  SECTION("then to Next") {
    CHECK(rating.enter() == Values{0.5, 4.0, 0.5});
  }
  SECTION("after a change") {
    static_cast<void>(rating.press(app::Key::up));
    static_cast<void>(rating.press(app::Key::digit, 1));
    static_cast<void>(rating.press(app::Key::up));
    static_cast<void>(rating.press(app::Key::up));
    static_cast<void>(rating.press(app::Key::right));
    static_cast<void>(rating.press(app::Key::tab));
    static_cast<void>(rating.press(app::Key::down));
    static_cast<void>(rating.press(app::Key::left));
    CHECK(rating.enter() == Values{0.51, 1.0, 0.49});
  }
  SECTION("which has a place after the scales") {
    static_cast<void>(rating.press(app::Key::down));
    CHECK(rating.screen->attention().focus == app::kNextTarget);
    static_cast<void>(rating.press(app::Key::right));
    CHECK(rating.enter() == Values{0.5, 4.0, 0.5});
  }
  SECTION("with the keys at the scale that the mouse was at") {
    static_cast<void>(rating.press(app::Key::down));
    CHECK_FALSE(rating.click(middle_of(rating.target(0))));
    static_cast<void>(rating.press(app::Key::right));
    CHECK(rating.enter() == Values{0.51, 4.0, 0.5});
  }
}

TEST_CASE("the texture can be felt again before it is rated, only if the step allows it") {
  session::AnswerStep step = rated({0});
  Rating without(step);
  static_cast<void>(without.press(app::Key::tab));
  CHECK_FALSE(without.press(app::Key::enter));
  step.may_explore_again = true;
  Rating with(step);
  static_cast<void>(with.press(app::Key::tab));
  const auto reply = with.press(app::Key::enter);
  REQUIRE(reply);
  CHECK(reply->explore_again);
}

TEST_CASE("the picture is shown in true size, however many scales there are") {
  for (const std::size_t count : {1U, 3U, 6U}) {
    CAPTURE(count);
    Rating rating(rated(std::vector<int>(count, 0)));
    const app::Canvas canvas = rating.draw();
    CHECK(shows(canvas, "10 mm of the surface"));
    CHECK(shows(canvas, "in true size"));
  }
  session::AnswerStep step = rated({0});
  step.picture.clear();
  CHECK_FALSE(shows(Rating(step).draw(), "10 mm"));
}

/// Scales that differ in what they need room for.
std::vector<std::vector<int>> scales_to_lay_out() {
  return {{0}, {11}, {0, 7}, {0, 0, 0}, {11, 11, 11, 0, 0, 0}};
}

TEST_CASE("everything on the screen of ratings can be read, in all languages and at all sizes") {
  const Vec2 size = GENERATE(Vec2{1280.0, 720.0}, Vec2{1920.0, 1080.0}, Vec2{3840.0, 2160.0},
                             Vec2{1280.0, 1024.0}, Vec2{3440.0, 1440.0});
  const std::string language = GENERATE("en", "de", "es", "fr", "ja", "zh");
  const double side_mm = GENERATE(25.0, 51.2, 100.0);
  const double text_scale = GENERATE(1.0, study::kMaxTextScale);
  const bool time_is_up = GENERATE(false, true);
  CAPTURE(size.x, language, side_mm, text_scale, time_is_up);
  const Paper paper(size, text_scale, app::letters_in(all_texts(language)));
  Squares shelf(side_mm);
  const app::PhysicalScale physical_scale = {size.x > 2000.0 ? 0.16 : 0.27, side_mm < 100.0};
  const app::ScreenContext context = {.words = &words_in(language),
                                      .language = language,
                                      .shelf = &shelf,
                                      .physical_scale = &physical_scale};
  for (const std::vector<int>& points : scales_to_lay_out()) {
    CAPTURE(points.size());
    session::AnswerStep step = rated(points);
    step.practice = !time_is_up;
    step.time_is_up = time_is_up;
    step.may_explore_again = !time_is_up;
    const auto screen = app::screen_for(step, context, {});
    CHECK(faults_of(paper.draw(*screen)) == "");
    for (std::size_t i = 0; i < points.size(); ++i) {
      CHECK_FALSE(screen->handle(key(app::Key::right)));
      CHECK(faults_of(paper.draw(*screen)) == "");
      CHECK(screen->handle(key(app::Key::enter)).has_value() == (i + 1 == points.size()));
    }
  }
}

study::Study study_of_ratings(const std::string& language) {
  study::Study study =
      study::load_study(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config/realism.json");
  study.session.language = language;
  return study;
}

TEST_CASE("instructions and notices of ratings can be read, in all languages") {
  const std::string language = GENERATE("en", "de", "es", "fr", "ja", "zh");
  const double text_scale = GENERATE(1.0, study::kMaxTextScale);
  CAPTURE(language, text_scale);
  const study::Study study = study_of_ratings(language);
  const session::SessionTexts texts = app::session_texts(study);
  const Paper paper({1280.0, 720.0}, text_scale, app::letters_in(all_texts(language)));
  Squares shelf(50.0);
  const app::PhysicalScale physical_scale = {0.27, true};
  const app::ScreenContext context = {.words = &words_in(language),
                                      .language = language,
                                      .shelf = &shelf,
                                      .physical_scale = &physical_scale,
                                      .trial_question = {.question = rated({0}).question}};
  const std::vector<session::Step> steps = {
      session::InstructionStep{texts.instructions}, session::PracticeStep{1},
      session::NoticeStep{session::NoticeStep::What::practice_over}};
  for (const session::Step& step : steps) {
    const auto screen = app::screen_for(step, context, {});
    while (!screen->is_done()) {
      CHECK(faults_of(paper.draw(*screen)) == "");
      static_cast<void>(screen->handle(key(app::Key::enter)));
    }
  }
  const app::Words& words = words_in(language);
  CHECK(shows(paper.draw(*app::screen_for(steps[1], context, {})), words.practice_text_rating));
  CHECK(
      shows(paper.draw(*app::screen_for(steps[2], context, {})), words.practice_over_text_rating));
}

TEST_CASE("instructions for ratings mention pictures and scales, but no right answer") {
  const study::Study study = study_of_ratings("en");
  std::string text;
  for (const std::string& page : app::session_texts(study).instructions) text += page + "\n";
  for (const char* part : {"60", "picture", "scale"}) {
    INFO(part);
    CHECK(text.find(part) != std::string::npos);
  }
  for (const char* part : {"{", "choose", "choice"}) {
    INFO(part);
    CHECK(text.find(part) == std::string::npos);
  }
}

}  // namespace
}  // namespace touchtrial
