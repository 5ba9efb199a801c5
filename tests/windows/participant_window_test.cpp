// The participant's window on a virtual screen, driven by real key and mouse events.
#include "app/windows/participant/participant_window.hpp"

#include "device/servo/servo.hpp"
#include "device/servo/servo_control.hpp"
#include "engine/pictures/colour_image.hpp"
#include "stimuli/generator.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"
#include "windows/virtual_screen.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <optional>
#include <thread>
#include <vector>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr const char* kTitle = "Touchtrial";
/// So long that only a window that hangs exceeds it.
constexpr milliseconds kPatience{300'000};
constexpr PlaneGeometry kPlane = {0.2, 256, 256};
const std::vector<std::string> kLabels = {"bark", "cloth", "pebbles", "straw", "brick"};

/// Pictures of a study, made once.
const std::map<std::string, GreyImage>& pictures() {
  static const std::map<std::string, GreyImage> made = [] {
    std::map<std::string, GreyImage> all;
    for (const std::string& label : kLabels) {
      all[label] = stimuli::generate_stimulus(label, stimuli::kDefaultStimuliSeed, 256, 1);
    }
    return all;
  }();
  return made;
}

app::ParticipantWindowOptions options(int width = 1280, int height = 720) {
  app::ParticipantWindowOptions all;
  all.size_px = {width, height};
  all.pictures = pictures();
  return all;
}

/// A window on a virtual screen, whose keys and mouse a session's thread can use.
struct Sitting {
  explicit Sitting(const app::ParticipantWindowOptions& wanted = options(),
                   const char* size = "1280x720")
      : screen(VirtualScreen::open(size)), window(wanted) {
    window.see_pictures(kLabels);
  }

  /// Runs `session` on a thread of its own.
  template <typename Session>
  void run(const Session& session) {
    app::run_beside(window, [&] { session(); });
  }

  /// Waits until a step is visible; session's thread.
  void show(const session::Step& step) {
    CHECK_FALSE(window.show_step(step));
    CHECK(window.wait_until_shown(kPatience));
  }
  /// Waits until the window shows the effect of all events.
  void settle() {
    REQUIRE(screen->wait_until_heard(kTitle));
    CHECK(window.wait_until_shown(kPatience));
  }
  void type(const std::string& keys) {
    screen->type(keys);
    settle();
  }
  void click(int x, int y) {
    screen->move_pointer(x, y);
    screen->press();
    screen->release();
    settle();
  }
  /// Attends until there is a reply or the window is gone.
  std::optional<session::StepReply> reply_to(const session::Step& step) {
    const auto give_up = steady_clock::now() + kPatience;
    while (steady_clock::now() < give_up && !window.end_reason()) {
      if (const auto reply = window.show_step(step)) return reply;
    }
    return std::nullopt;
  }
  /// Types once a step is visible.
  /// \return the reply
  std::optional<session::StepReply> answer(const session::Step& step, const std::string& keys) {
    show(step);
    screen->type(keys);
    return reply_to(step);
  }

  std::unique_ptr<VirtualScreen> screen;
  app::ParticipantWindow window;
};

session::AnswerStep answer_step(int trial = 1) {
  return {.trial = trial, .total = 25};
}

class CountedCues final : public app::Cues {
 public:
  void play(app::Cue cue) noexcept override {
    if (cue == app::Cue::too_hard) ++too_hard;
    if (cue == app::Cue::stopped) ++stopped;
    if (cue == app::Cue::first_begins) mark(1);
    if (cue == app::Cue::second_begins) mark(2);
    if (cue == app::Cue::interval_over) mark(9);
  }
  void mark(int digit) noexcept { marks = (10 * marks + digit) % 10'000; }

  std::atomic<int> too_hard{0};
  std::atomic<int> stopped{0};
  std::atomic<int> marks{0};  ///< the last four, of intervals, a digit each; 9: the end
};

TEST_CASE("replies to 25 trials hold the choices made by keys, with times after the keys") {
  Sitting sitting;
  sitting.run([&] {
    for (int trial = 1; trial <= 25; ++trial) {
      const session::ReadyStep ready{trial, 25, false};
      CHECK(sitting.answer(ready, trial % 2 == 0 ? "space" : "Return"));
      sitting.window.show_exploring(kPlane);
      const int choice = (trial * 7) % 5;
      const bool changes = trial % 4 == 0;
      const std::string first = changes ? std::to_string((choice + 2) % 5 + 1) + " " : "";
      const std::string pad = trial % 3 == 0 ? "KP_" : "";
      const auto before = steady_clock::now();
      const auto reply =
          sitting.answer(answer_step(trial), first + pad + std::to_string(choice + 1) + " Return");
      REQUIRE(reply);
      CHECK(position_of(reply->answer) == choice);
      CHECK(first_position_of(reply->answer).has_value() == changes);
      REQUIRE(reply->at);
      CHECK(*reply->at > before);
      CHECK(*reply->at < steady_clock::now());
    }
    CHECK(sitting.answer(session::EndStep{}, "Return"));
  });
}

TEST_CASE("a picture and Next are clicked with a real mouse") {
  Sitting sitting;
  sitting.run([&] {
    const session::AnswerStep step = answer_step();
    sitting.show(step);
    // The middle picture of five, then the button below.
    sitting.click(640, 320);
    sitting.click(640, 640);
    const auto reply = sitting.reply_to(step);
    REQUIRE(reply);
    CHECK(position_of(reply->answer) == 2);
  });
}

TEST_CASE("a key that was pressed before a screen was shown does nothing on it") {
  Sitting sitting;
  sitting.run([&] {
    sitting.show(session::ReadyStep{1, 25, false});
    sitting.type("Return Return Return");
    CHECK(sitting.reply_to(session::ReadyStep{1, 25, false}));
    sitting.show(session::BreakStep{1, 25});
    for (int i = 0; i < 10; ++i) CHECK_FALSE(sitting.window.show_step(session::BreakStep{1, 25}));
  });
}

TEST_CASE("neither Escape nor the keys of a preview do anything in a session") {
  Sitting sitting;
  sitting.run([&] {
    sitting.show(session::ReadyStep{1, 25, false});
    sitting.type("Escape Next Prior");
    for (int i = 0; i < 20; ++i)
      CHECK_FALSE(sitting.window.show_step(session::ReadyStep{1, 25, false}));
    CHECK_FALSE(sitting.window.end_reason());
  });
}

TEST_CASE("a choice is still there after a pause") {
  Sitting sitting;
  sitting.run([&] {
    sitting.show(answer_step());
    sitting.type("4");
    sitting.show(session::PauseStep{});
    sitting.type("2 Return");
    for (int i = 0; i < 20; ++i) CHECK_FALSE(sitting.window.show_step(session::PauseStep{}));
    const auto reply = sitting.answer(answer_step(), "Return");
    REQUIRE(reply);
    CHECK(position_of(reply->answer) == 3);
    CHECK_FALSE(first_position_of(reply->answer));
  });
}

TEST_CASE("while a plane is on the space bar stops the force and Enter ends the exploration") {
  Sitting sitting;
  const bool stops = GENERATE(true, false);
  sitting.run([&] {
    sitting.show(session::ReadyStep{1, 25, false});
    sitting.window.show_exploring(kPlane);
    CHECK(sitting.window.wait_until_shown(kPatience));
    std::this_thread::sleep_for(milliseconds(600));
    device::ServoControl servo;
    sitting.window.while_exploring(servo);
    CHECK_FALSE(servo.finish_requested());
    sitting.screen->type(stops ? "space" : "Return");
    const auto give_up = steady_clock::now() + kPatience;
    while (!servo.comfort_stop_requested() && !servo.finish_requested() &&
           steady_clock::now() < give_up) {
      sitting.window.while_exploring(servo);
      std::this_thread::sleep_for(milliseconds(1));
    }
    CHECK(servo.comfort_stop_requested() == stops);
    CHECK(servo.finish_requested() == !stops);
  });
}

TEST_CASE("a double press of the space bar to continue does not stop the force") {
  Sitting sitting;
  sitting.run([&] {
    sitting.show(session::ReadyStep{1, 25, false});
    app::InputEvent space;
    space.key = app::Key::space;
    const auto begun = steady_clock::now();
    const auto press_after = [&](int ms) {
      space.at = begun + milliseconds(ms);
      sitting.window.inject(space);
      device::ServoControl servo;
      sitting.window.while_exploring(servo);
      return servo.comfort_stop_requested();
    };
    space.at = begun;
    sitting.window.inject(space);
    REQUIRE(sitting.reply_to(session::ReadyStep{1, 25, false}));
    sitting.window.show_exploring(kPlane);
    CHECK_FALSE(press_after(200));
    CHECK(press_after(300));  // somebody wants to stop
    // The next trial begins without a second press.
    sitting.show(session::ReadyStep{2, 25, false});
    space.at = begun + milliseconds(10'000);
    sitting.window.inject(space);
    sitting.window.show_exploring(kPlane);
    CHECK(press_after(10'501));
  });
}

TEST_CASE(
    "a window that is closed while a force is on stops it at once and gives no more replies") {
  Sitting sitting;
  sitting.run([&] {
    sitting.window.show_exploring(kPlane);
    sitting.window.close();
    device::ServoControl servo;
    sitting.window.while_exploring(servo);
    CHECK(servo.emergency_stop_requested());
    CHECK(sitting.window.end_reason() == app::WindowEnd::closed);
    CHECK_FALSE(sitting.window.show_step(answer_step()));
  });
}

/// Passes on the samples of a texture with this force.
void feel_texture(app::ParticipantWindow& window, double force_n) {
  for (int tick = 0; tick < 2000; ++tick) {
    device::ServoSample sample{.position_mm = {0.1 * tick, 20.0 * force_n, -0.1},
                               .force_n = {0.3 * force_n, 0.0, force_n},
                               .tick = tick};
    window.feel(sample);
  }
}

TEST_CASE("Enter does not answer before the surface was felt, and the screen says so") {
  app::ParticipantWindowOptions wanted = options();
  wanted.min_touch = {.contact_s = 0.5, .path_mm = 25.0};
  Sitting sitting(wanted);
  sitting.run([&] {
    sitting.show(session::ReadyStep{1, 25, false});
    sitting.window.show_exploring(kPlane);
    CHECK(sitting.window.wait_until_shown(kPatience));
    std::this_thread::sleep_for(milliseconds(600));
    const auto has_text = [&] {
      const engine::ColourImage picture = sitting.window.picture();
      const auto samples = picture.samples();
      return std::ranges::any_of(
          samples, [&](const engine::Rgb& sample) { return sample != samples.front(); });
    };
    CHECK_FALSE(has_text());
    device::ServoControl servo;
    const auto press_enter = [&] {
      sitting.screen->type("Return");
      sitting.settle();
      sitting.window.while_exploring(servo);
    };
    press_enter();
    CHECK_FALSE(servo.finish_requested());
    CHECK(has_text());
    const auto feel = [&](int from, int to, double z_mm) {
      for (int tick = from; tick < to; ++tick) {
        device::ServoSample sample;
        sample.tick = tick;
        sample.position_mm = {0.1 * tick, 20.0, z_mm};
        sitting.window.feel(sample);
      }
      sitting.window.while_exploring(servo);
    };
    feel(0, 2000, 3.1);  // above the plane
    feel(2000, 2500, -0.1);
    CHECK(has_text());
    press_enter();
    CHECK_FALSE(servo.finish_requested());
    feel(2500, 2502, -0.1);  // half a second
    CHECK_FALSE(has_text());
    CHECK_FALSE(servo.finish_requested());
    press_enter();
    CHECK(servo.finish_requested());
    // Going back to the same surface needs no more; the next surface does.
    sitting.show(answer_step(1));
    sitting.window.show_exploring(kPlane);
    std::this_thread::sleep_for(milliseconds(600));
    servo.clear_requests();
    press_enter();
    CHECK(servo.finish_requested());
    sitting.show(answer_step(1));
    sitting.show(session::ReadyStep{2, 25, false});
    sitting.window.show_exploring(kPlane);
    std::this_thread::sleep_for(milliseconds(600));
    servo.clear_requests();
    press_enter();
    CHECK_FALSE(servo.finish_requested());
  });
}

TEST_CASE("the exploring screen does not depend on what is felt, to the last byte") {
  Sitting sitting;
  sitting.run([&] {
    std::optional<engine::ColourImage> first;
    for (int trial = 1; trial <= 5; ++trial) {
      sitting.show(session::ReadyStep{trial, 25, false});
      sitting.window.show_exploring(kPlane);
      feel_texture(sitting.window, 0.4 * trial);
      sitting.screen->move_pointer(100 * trial, 60 * trial);
      sitting.settle();
      const engine::ColourImage picture = sitting.window.picture();
      if (!first) first = picture;
      CHECK(picture == *first);
      const auto samples = picture.samples();
      // There is no cursor, edge or text.
      CHECK(std::all_of(samples.begin(), samples.end(),
                        [&](const engine::Rgb& sample) { return sample == samples.front(); }));
    }
  });
}

app::ParticipantWindowOptions with_intervals() {
  app::ParticipantWindowOptions wanted = options();
  wanted.trial_question = {.exploring = study::TimedContact{},
                           .planes = 2,
                           .question = study::ChoiceQuestion{"threshold_texture", {}}};
  wanted.stiffness_n_per_mm = 0.4;
  wanted.interval_pause = milliseconds(300);
  wanted.min_touch = {.contact_s = 0.5, .path_mm = 25.0};
  return wanted;
}

session::IntervalStep interval_step(int interval) {
  return {.trial = 1, .interval = interval, .total = 2};
}

TEST_CASE("the announcement of a plane is shown for a moment, and ends by itself") {
  CountedCues cues;
  app::ParticipantWindowOptions wanted = with_intervals();
  wanted.cues = &cues;
  Sitting sitting(wanted);
  sitting.run([&] {
    for (int interval = 1; interval <= 2; ++interval) {
      const auto begun = steady_clock::now();
      sitting.show(interval_step(interval));
      sitting.screen->type("Return 1");
      CHECK(sitting.reply_to(interval_step(interval)));
      CHECK(steady_clock::now() - begun >= milliseconds(300));
      sitting.window.show_exploring(kPlane);
    }
    CHECK_FALSE(sitting.window.show_step(answer_step()));
    CHECK(cues.marks == 1929);
  });
}

TEST_CASE("Enter does not end a plane of several, and the space bar stops") {
  Sitting sitting(with_intervals());
  sitting.run([&] {
    CHECK(sitting.reply_to(interval_step(1)));
    sitting.window.show_exploring(kPlane);
    feel_texture(sitting.window, 0.9);
    CHECK(sitting.window.wait_until_shown(kPatience));
    std::this_thread::sleep_for(milliseconds(600));
    device::ServoControl servo;
    sitting.screen->type("Return");
    sitting.settle();
    for (int i = 0; i < 20; ++i) sitting.window.while_exploring(servo);
    CHECK_FALSE(servo.finish_requested());
    CHECK_FALSE(servo.comfort_stop_requested());
    sitting.screen->type("space");
    sitting.settle();
    sitting.window.while_exploring(servo);
    CHECK(servo.comfort_stop_requested());
    // A trial with one plane ends as ever.
    CHECK_FALSE(sitting.window.show_step(session::ReadyStep{2, 25, false}));
    sitting.window.show_exploring(kPlane);
    feel_texture(sitting.window, 0.9);
    std::this_thread::sleep_for(milliseconds(600));
    servo.clear_requests();
    sitting.screen->type("Return");
    sitting.settle();
    sitting.window.while_exploring(servo);
    CHECK(servo.finish_requested());
  });
}

TEST_CASE("a space bar between two planes stops the second as soon as it is on") {
  app::ParticipantWindowOptions wanted = with_intervals();
  wanted.interval_pause = kPatience;
  Sitting sitting(wanted);
  sitting.run([&] {
    app::InputEvent space;
    space.key = app::Key::space;
    sitting.show(session::ReadyStep{1, 25, false});
    const auto begun = steady_clock::now();
    const auto press_after = [&](int ms) {
      space.at = begun + milliseconds(ms);
      sitting.window.inject(space);
    };
    const auto is_stopped = [&] {
      sitting.window.show_exploring(kPlane);
      device::ServoControl servo;
      sitting.window.while_exploring(servo);
      return servo.comfort_stop_requested();
    };
    // Pressed twice to go on: the second press is forgiven.
    press_after(0);
    REQUIRE(sitting.reply_to(session::ReadyStep{1, 25, false}));
    CHECK_FALSE(sitting.window.show_step(interval_step(1)));
    press_after(200);
    CHECK_FALSE(sitting.window.show_step(interval_step(1)));
    CHECK_FALSE(is_stopped());
    // The next one is meant.
    CHECK_FALSE(sitting.window.show_step(interval_step(2)));
    press_after(10'000);
    CHECK(sitting.window.show_step(interval_step(2)));
    CHECK(is_stopped());
    // It does not reach another trial.
    CHECK_FALSE(sitting.window.show_step(interval_step(1)));
    CHECK_FALSE(is_stopped());
  });
}

TEST_CASE("a comfort stop has its own tone in place of that of an interval's end") {
  CountedCues cues;
  app::ParticipantWindowOptions wanted = with_intervals();
  wanted.cues = &cues;
  Sitting sitting(wanted);
  sitting.run([&] {
    CHECK(sitting.reply_to(interval_step(1)));
    sitting.window.show_exploring(kPlane);
    sitting.show({session::NoticeStep{session::NoticeStep::What::stopped, 1, false}});
    CHECK(cues.marks == 1);
    CHECK(cues.stopped == 1);
  });
}

/// A hand that has lifted off and strokes at 100 mm/s for so long, and what answers it.
void stroke(app::ParticipantWindow& window, double seconds, double depth_mm, Vec3 force_n) {
  for (int tick = 0; tick < static_cast<int>(1000.0 * seconds); ++tick) {
    device::ServoSample sample{.position_mm = {0.1 * tick, 20.0, tick == 0 ? 2.0 : -depth_mm},
                               .force_n = force_n,
                               .tick = tick};
    window.feel(sample);
  }
}

TEST_CASE("the screen of an interval depends on the hand alone, and so does the tone") {
  CountedCues cues;
  app::ParticipantWindowOptions wanted = with_intervals();
  wanted.cues = &cues;
  Sitting sitting(wanted);
  sitting.run([&] {
    const auto picture_after = [&](double seconds, double depth_mm, Vec3 force_n) {
      CHECK(sitting.reply_to(interval_step(1)));
      sitting.window.show_exploring(kPlane);
      stroke(sitting.window, seconds, depth_mm, force_n);
      device::ServoControl servo;
      sitting.window.while_exploring(servo);
      CHECK(sitting.window.wait_until_shown(kPatience));
      return sitting.window.picture();
    };
    const engine::ColourImage smooth = picture_after(1.0, 2.0, {0.0, 0.0, 0.8});
    CHECK(picture_after(1.0, 2.0, {1.5, 1.5, 3.0}) == smooth);
    CHECK(cues.too_hard == 0);
    const engine::ColourImage none = picture_after(0.01, 2.0, {});
    CHECK(none != smooth);
    CHECK(picture_after(2.0, 2.0, {}) != smooth);  // it grows
    CHECK(picture_after(1.0, 0.2, {}) == none);    // too lightly: it stands still
    CHECK(picture_after(1.0, 7.0, {}) == none);    // too hard
    CHECK(cues.too_hard == 1);
  });
}

TEST_CASE("a force above 2 N sounds a tone once, until it has been lower") {
  CountedCues cues;
  app::ParticipantWindowOptions wanted = options();
  wanted.cues = &cues;
  Sitting sitting(wanted);
  feel_texture(sitting.window, 1.5);
  CHECK(cues.too_hard == 0);
  feel_texture(sitting.window, 2.5);
  CHECK(cues.too_hard == 1);
  feel_texture(sitting.window, 1.0);
  feel_texture(sitting.window, 2.5);
  CHECK(cues.too_hard == 2);
}

TEST_CASE("where textures are made by several methods, the question is which picture fits best") {
  const auto asked_with = [](bool several, const std::string& title) {
    app::ParticipantWindowOptions wanted = options();
    wanted.has_several_methods = several;
    if (!title.empty()) wanted.session.texts["en"]["screens"]["answer_title"] = title;
    Sitting sitting(wanted);
    engine::ColourImage picture;
    sitting.run([&] {
      sitting.show(answer_step());
      picture = sitting.window.picture();
    });
    return picture;
  };
  const engine::ColourImage fits = asked_with(true, "");
  CHECK(fits == asked_with(false, "Which picture fits best?"));
  CHECK(fits != asked_with(false, ""));
}

TEST_CASE("without a display the window says what to do about it") {
  const EnvironmentVariable display("DISPLAY", nullptr);
  const EnvironmentVariable wayland("WAYLAND_DISPLAY", nullptr);
  CHECK_THROWS_WITH(app::ParticipantWindow(options()), holds_text("DISPLAY"));
}

TEST_CASE("a monitor's stated size is used only if it can be true") {
  CHECK(app::stated_mm_per_unit(508, 1920) == Approx(0.26458).epsilon(1e-4));
  CHECK(app::stated_mm_per_unit(160, 1920) == Approx(0.0833).epsilon(1e-3));
  for (const auto& [size_mm, width] : {std::pair(0, 1920), {16, 1920}, {1600, 800}}) {
    CHECK(app::stated_mm_per_unit(size_mm, width) == 0.0);
  }
}

TEST_CASE("the system's default size of a monitor is recognised") {
  CHECK(app::is_default_size(508, 1920));
  CHECK(app::is_default_size(339, 1280));
  CHECK_FALSE(app::is_default_size(509, 1920));  // 23 inches
  CHECK_FALSE(app::is_default_size(598, 3840));  // 27 inches
}

TEST_CASE("an error names a missing monitor, and how many there are") {
  const auto screen = VirtualScreen::open();
  app::ParticipantWindowOptions wanted = options();
  wanted.size_px.reset();
  wanted.monitor = 3;
  CHECK_THROWS_WITH(app::ParticipantWindow(wanted), holds_text("3") && holds_text("1"));
}

TEST_CASE("the window fills the requested monitor") {
  app::ParticipantWindowOptions wanted = options();
  wanted.size_px.reset();
  Sitting sitting(wanted, "1920x1080");
  sitting.run([&] {
    sitting.show(answer_step());
    const engine::ColourImage picture = sitting.window.picture();
    CHECK(picture.width() == 1920);
    CHECK(picture.height() == 1080);
  });
}

TEST_CASE("a window takes the keyboard back while a plane is on, and says that it was lost") {
  Sitting room;
  room.run([&] {
    room.show(answer_step());
    room.settle();
    CHECK(room.window.time_without_focus() == milliseconds{0});
    room.window.show_exploring(kPlane);
    const auto give_up = steady_clock::now() + kPatience;
    const auto waits = [&](const auto& done) {
      while (!done() && steady_clock::now() < give_up) {
        std::this_thread::sleep_for(milliseconds(20));
      }
      CHECK(done());
    };
    bool is_lost = false;
    waits([&] {
      if (!is_lost) room.screen->take_focus();
      return is_lost = is_lost || room.window.take_focus_loss();
    });
    waits([&] { return room.window.time_without_focus() == milliseconds{0}; });
    CHECK_FALSE(room.window.end_reason());
  });
}

}  // namespace
}  // namespace touchtrial
