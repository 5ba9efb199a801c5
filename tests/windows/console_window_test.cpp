// The experimenter's window beside the participant's, on a virtual screen.
#include "app/windows/experimenter/experimenter_desk.hpp"
#include "app/windows/experimenter/terminal_face.hpp"
#include "app/windows/participant/participant_window.hpp"
#include "device/servo/servo_control.hpp"
#include "engine/pictures/colour_image.hpp"
#include "support/catch.hpp"
#include "windows/virtual_screen.hpp"

#include <chrono>
#include <functional>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using Kind = session::ExperimenterRequest::Kind;
using Action = app::ExperimenterAction::Kind;

constexpr const char* kTitle = "Touchtrial";
constexpr const char* kConsoleTitle = "Touchtrial console";
/// So long that only a window that hangs fails.
constexpr milliseconds kPatience{300'000};
constexpr int kParticipantWidth = 1280;

session::SessionStatus status(const std::string& stage = "answering") {
  return {.participant = "P07",
          .stage = stage,
          .trial = 7,
          .total = 25,
          .elapsed = std::chrono::seconds(754),
          .device = "Falcon 1, serial 4711",
          .rate_hz = 1000.0,
          .lateness_p99_us = 41.0,
          .interruptions = 1};
}

session::SessionStatus stopped() {
  session::SessionStatus now = status("stopped");
  now.participant_stopped = true;
  now.needs_consent = true;
  return now;
}

app::ParticipantWindowOptions options(app::ExperimenterDesk& desk) {
  app::ParticipantWindowOptions all;
  all.size_px = {kParticipantWidth, 720};
  all.console = &desk;
  return all;
}

/// Both windows side by side, with a hand on mouse and keyboard.
struct Room {
  /// \param place  of the console on a screen of this size
  explicit Room(const std::string& size = "2240x1080",
                std::pair<int, int> place = {kParticipantWidth, 0})
      : screen(VirtualScreen::open(size)), window(options(desk)), corner(place) {
    window.see_pictures({"bark", "cloth"});
  }

  template <typename Session>
  void run(const Session& session) {
    app::run_beside(window, [&] { session(); });
  }

  /// Waits until the console shows the effect of all input.
  void settle() {
    REQUIRE(screen->wait_until_heard(kTitle));
    static_cast<void>(window.console_picture());
  }

  /// Clicks in the experimenter's window and gives it the focus, like a window manager.
  void click(std::pair<int, int> at) {
    screen->focus_window(kConsoleTitle);
    screen->move_pointer(corner.first + at.first, corner.second + at.second);
    screen->press();
    screen->release();
    settle();
  }

  void type(const std::string& keys) {
    screen->type(keys);
    settle();
  }

  /// Waits for the next request.
  std::optional<session::ExperimenterRequest> request() {
    const auto give_up = steady_clock::now() + kPatience;
    while (steady_clock::now() < give_up) {
      if (auto asked = desk.request()) return asked;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return std::nullopt;
  }

  app::ExperimenterDesk desk{true};
  std::unique_ptr<VirtualScreen> screen;
  app::ParticipantWindow window;
  std::pair<int, int> corner;  ///< of the console
};

bool is_vermillion(const engine::Rgb& sample) {
  return sample == engine::Rgb{213, 94, 0};
}

/// The middle of the lowest or of the highest button of that colour.
std::pair<int, int> middle_of_vermillion(const engine::ColourImage& picture, bool is_lowest) {
  int y = is_lowest ? picture.height() - 1 : 0;
  const auto is_in_row = [&picture](int row) {
    for (int x = 0; x < picture.width(); ++x) {
      if (is_vermillion(picture.at(row, x))) return true;
    }
    return false;
  };
  while (y > 0 && y < picture.height() && !is_in_row(y)) y += is_lowest ? -1 : 1;
  if (!is_lowest) {
    while (y < picture.height() && !is_in_row(y)) ++y;
  }
  y += is_lowest ? -6 : 6;
  int first = 0;
  while (!is_vermillion(picture.at(y, first))) ++first;
  int last = picture.width() - 1;
  while (!is_vermillion(picture.at(y, last))) --last;
  return {(first + last) / 2, is_lowest ? y - 6 : y + 12};
}

/// The middle of an action's button, below that of the comfort stop if it is in the second row.
std::pair<int, int> button_of(const engine::ColourImage& picture, Action action) {
  constexpr int kColumns = 4;
  constexpr int kMargin = 20;
  constexpr int kGap = 10;
  constexpr int kRow = 44 + kGap;
  const int width = (picture.width() - 2 * kMargin - (kColumns - 1) * kGap) / kColumns;
  const int index = static_cast<int>(action);
  const int first_row = middle_of_vermillion(picture, false).second;
  return {kMargin + width / 2 + index % kColumns * (width + kGap),
          first_row + index / kColumns * kRow};
}

bool is(const std::optional<session::ExperimenterRequest>& request, Kind kind,
        const std::string& text = "", const std::string& code = "") {
  return request && request->kind == kind && request->text == text && request->code == code;
}

/// What an action changes: what the session is told, and what the experimenter is asked.
std::string effect_of(app::ExperimenterDesk& desk, Action action,
                      const std::function<void()>& act) {
  desk.discard();
  desk.show(status("paused"));  // the end of a pause ends what was asked before
  if (action != Action::resume) desk.show(status());
  const std::string need = action == Action::at_reset ? "reset the arm" : "";
  static_cast<void>(desk.poll(need));
  act();
  std::string effect = std::to_string(static_cast<int>(desk.poll(need)));
  while (const auto request = desk.request()) {
    effect += " " + std::to_string(static_cast<int>(request->kind));
  }
  return effect + desk.view().question.text;
}

TEST_CASE("terminal and window offer every action, to the same effect") {
  Room room;
  std::string keys;
  app::ExperimenterTerminal terminal;
  terminal.key = [&]() -> std::optional<char> {
    return keys.empty() ? std::nullopt : std::optional(std::exchange(keys, "").front());
  };
  terminal.write = [](const std::string&) {};
  const app::TerminalFace face(room.desk, terminal);
  room.run([&] {
    room.desk.show(status());
    const engine::ColourImage picture = room.window.console_picture();
    std::set<std::string> effects;
    for (const auto& [action, key, label] : app::kExperimenterActions) {
      INFO(label);
      const std::string effect =
          effect_of(room.desk, action, [&, action = action] { room.desk.act(action); });
      CHECK(effect_of(room.desk, action, [&, key = key] { keys = key; }) == effect);
      CHECK(effect_of(room.desk, action, [&, action = action] {
              static_cast<void>(room.window.console_picture());
              room.click(button_of(picture, action));
            }) == effect);
      effects.insert(effect);
    }
    CHECK(effects.size() == app::kExperimenterActions.size());
  });
}

TEST_CASE("the window answers the day sheet and spoken answers") {
  Room room;
  room.run([&] {
    const std::vector<session::DaySheetItem> sheet{{"no-a", "A is there"}};
    CHECK_FALSE(room.desk.day_sheet(sheet));
    const engine::ColourImage picture = room.window.console_picture();
    const auto [x, y] = button_of(picture, Action::deviation);
    constexpr int kFirstChoiceBelow = 90;
    room.click({50, y + kFirstChoiceBelow});
    CHECK(room.desk.day_sheet(sheet) == std::vector{session::Tick::done});
  });
}

TEST_CASE("the console lies below the participant's window where there is no room beside it") {
  Room room("1280x1200", {0, 720});
  room.run([&] {
    room.desk.show(status());
    const engine::ColourImage picture = room.window.console_picture();
    CHECK(picture.height() == 480);
    room.click(button_of(picture, Action::pause));
    CHECK(is(room.request(), Kind::pause));
  });
}

TEST_CASE("the console asks again before a session is aborted, and Enter does not do it") {
  Room room;
  room.run([&] {
    room.desk.show(status());
    const engine::ColourImage picture = room.window.console_picture();
    room.click(button_of(picture, Action::abort));
    room.type("i l l Return");
    CHECK_FALSE(room.desk.request());
    room.click(middle_of_vermillion(room.window.console_picture(), true));
    CHECK_FALSE(room.desk.request());
    room.type("i l l Return");
    CHECK(is(room.request(), Kind::abort, "ill"));
  });
}

TEST_CASE("keys over the console are the participant's, except while text is written") {
  Room room;
  room.run([&] {
    room.desk.show(status());
    const engine::ColourImage picture = room.window.console_picture();
    const session::AnswerStep answer{.trial = 7, .total = 25};
    CHECK_FALSE(room.window.show_step(answer));
    CHECK(room.window.wait_until_shown(kPatience));
    room.click(button_of(picture, Action::note));
    room.type("1 2 Return");
    CHECK(is(room.request(), Kind::note, "12"));
    for (int i = 0; i < 20; ++i) CHECK_FALSE(room.window.show_step(answer));
    room.type("2 Return");
    std::optional<session::StepReply> reply;
    const auto give_up = steady_clock::now() + kPatience;
    while (!reply && steady_clock::now() < give_up) reply = room.window.show_step(answer);
    REQUIRE(reply);
    CHECK(position_of(reply->answer) == 1);
  });
}

TEST_CASE("while a plane is on the space bar is a comfort stop even where a note is written") {
  Room room;
  room.run([&] {
    room.desk.show(status("exploring"));
    const engine::ColourImage picture = room.window.console_picture();
    room.click(button_of(picture, Action::note));
    room.type("h o t");
    room.window.show_exploring({0.2, 256, 256});
    CHECK(room.window.wait_until_shown(kPatience));
    device::ServoControl servo;
    room.window.while_exploring(servo);
    CHECK_FALSE(servo.comfort_stop_requested());
    room.screen->type("space");
    const auto give_up = steady_clock::now() + kPatience;
    while (!servo.comfort_stop_requested() && steady_clock::now() < give_up) {
      room.window.while_exploring(servo);
      std::this_thread::sleep_for(milliseconds(1));
    }
    CHECK(servo.comfort_stop_requested());
    room.click(button_of(picture, Action::comfort_stop));
    CHECK(is(room.request(), Kind::comfort_stop));
  });
}

TEST_CASE("the console is the same to the last byte, whatever the participant sees and answers") {
  Room room;
  room.run([&] {
    std::optional<engine::ColourImage> first;
    room.desk.show(status());
    for (const int position : {0, 1}) {
      CHECK_FALSE(room.window.show_step(session::FeedbackStep{0, position}));
      CHECK(room.window.wait_until_shown(kPatience));
      const engine::ColourImage picture = room.window.console_picture();
      if (!first) first = picture;
      CHECK(picture == *first);
    }
  });
}

TEST_CASE("the console shows the participant's stop until it is settled") {
  Room room;
  room.run([&] {
    session::SessionStatus plain = stopped();
    plain.participant_stopped = false;
    room.desk.show(plain);
    const engine::ColourImage before = room.window.console_picture();
    room.desk.show(stopped());
    CHECK(room.window.console_picture() != before);
    room.desk.show(plain);
    CHECK(room.window.console_picture() == before);
  });
}

TEST_CASE("the console marks the levels of the hand at the plane, each another way") {
  using session::HandLevel;
  Room room;
  room.run([&] {
    session::SessionStatus shown = status("exploring");
    room.desk.show(shown);
    std::vector<engine::ColourImage> pictures = {room.window.console_picture()};
    for (const HandLevel force : {HandLevel::low, HandLevel::right, HandLevel::high}) {
      for (const HandLevel speed : {HandLevel::low, HandLevel::right, HandLevel::high}) {
        shown.hand = session::HandLevels{force, speed};
        room.desk.show(shown);
        pictures.push_back(room.window.console_picture());
      }
    }
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) CHECK(pictures[i] != pictures[k]);
    }
  });
}

TEST_CASE("a missing monitor of the console is named") {
  const auto screen = VirtualScreen::open();
  app::ExperimenterDesk desk(true);
  app::ParticipantWindowOptions wanted = options(desk);
  wanted.console_monitor = 2;
  CHECK_THROWS_WITH(app::ParticipantWindow(wanted), holds_text("2") && holds_text("1"));
}

}  // namespace
}  // namespace touchtrial
