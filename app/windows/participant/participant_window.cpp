#include "app/windows/participant/participant_window.hpp"

#include "app/windows/experimenter/console_window.hpp"
#include "app/windows/look.hpp"
#include "app/windows/participant/exploring_screen.hpp"
#include "app/windows/participant/window_drawing.hpp"
#include "core/errors.hpp"
#include "device/platform/stop_signals.hpp"
#include "device/servo/servo.hpp"
#include "protocols/session/exploration.hpp"
#include "study/languages.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <set>
#include <span>
#include <stdexcept>
#include <thread>

#include <GLFW/glfw3.h>
#include <spdlog/spdlog.h>

namespace touchtrial::app {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr const char* kWindowTitle = "Touchtrial";
/// The longest time for which the session's thread waits for a reply.
constexpr milliseconds kAttention{10};
/// Only a hanging window exceeds this.
constexpr milliseconds kPictureLimit{300'000};
/// Within this time after the plane comes on, Enter does not end the exploration, because it may
/// still be held from the previous screen. Likewise, a second press of the space bar within this
/// time does not stop the force.
constexpr milliseconds kRepeatGuard{500};
// A tone signals a force above the first limit. It is repeated only after the force was below the
// second limit.
constexpr double kPushTooHardN = 2.0;
constexpr double kPushReleasedN = 1.7;
constexpr double kBarsTimeS = 0.06;  ///< time constant of the bars in practice

/// Refuses a window that no monitor can show completely.
void require_room(std::pair<int, int> size_px, std::span<GLFWmonitor*> monitors) {
  std::pair<int, int> largest{0, 0};
  for (GLFWmonitor* monitor : monitors) {
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    if (mode->width >= size_px.first && mode->height >= size_px.second) return;
    if (mode->width * mode->height > largest.first * largest.second) {
      largest = {mode->width, mode->height};
    }
  }
  if (monitors.empty()) return;
  throw DeviceError("window: no monitor holds " + std::to_string(size_px.first) + " x " +
                    std::to_string(size_px.second) + " pixels; the largest has " +
                    std::to_string(largest.first) + " x " + std::to_string(largest.second) +
                    ": give a smaller --window");
}

GLFWmonitor* monitor_of(const ParticipantWindowOptions& options) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  if (options.size_px) {
    require_room(*options.size_px, {monitors, static_cast<std::size_t>(count)});
    return nullptr;
  }
  if (options.monitor < 1 || options.monitor > count) {
    throw DeviceError("window: there is no monitor " + std::to_string(options.monitor) +
                      "; this machine has " + std::to_string(count) +
                      ": give another --monitor, or --window WIDTHxHEIGHT");
  }
  return monitors[options.monitor - 1];
}

/// The letters of all texts and labels of a session. Typed letters are added later.
/// \throws DeviceError if no font has some of them
std::set<char32_t> letters_to_show(const ParticipantWindowOptions& options) {
  const study::SessionPlan& plan = options.session;
  std::vector<std::string> texts;
  for (const auto& [section, parts] : study::texts_of(plan)) {
    for (const auto& [key, text] : parts) texts.push_back(text);
  }
  const auto pages = plan.instructions.find(plan.language);
  if (pages != plan.instructions.end()) {
    texts.insert(texts.end(), pages->second.begin(), pages->second.end());
  }
  const auto add = [&](const study::Translated& text) {
    if (const auto own = text.find(plan.language); own != text.end()) texts.push_back(own->second);
  };
  for (const study::Question& question : plan.closing_questions) {
    add(question.text);
    std::ranges::for_each(question.options, add);
  }
  for (const study::Scale& scale : options.ask.scales()) {
    texts.insert(texts.end(), {scale.text, scale.low, scale.high});
  }
  for (const auto& [label, picture] : options.pictures) texts.push_back(label);
  std::set<char32_t> letters = letters_in(texts);
  require_letters(letters);
  return letters;
}

GLFWwindow* make_window(const ParticipantWindowOptions& options, GLFWmonitor* monitor) {
  hint_opengl_3_2();
  // The experimenter's window sometimes takes the focus.
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
  std::pair<int, int> size = options.size_px.value_or(std::pair(1280, 720));
  if (monitor != nullptr) {
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    size = {mode->width, mode->height};
    glfwWindowHint(GLFW_RED_BITS, mode->redBits);
    glfwWindowHint(GLFW_GREEN_BITS, mode->greenBits);
    glfwWindowHint(GLFW_BLUE_BITS, mode->blueBits);
    glfwWindowHint(GLFW_REFRESH_RATE, mode->refreshRate);
  }
  GLFWwindow* window = glfwCreateWindow(size.first, size.second, kWindowTitle, monitor, nullptr);
  if (window == nullptr) {
    refuse_window("OpenGL 3.2 is needed; install the graphics driver, or Mesa (libgl1-mesa-dri)");
  }
  return window;
}

/// A monitor for the experimenter's window, other than the one that the participant's window fills.
void choose_monitor(GLFWwindow* window, ConsoleWindowOptions& console) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  for (int i = 0; i < count; ++i) {
    if (monitors[i] != glfwGetWindowMonitor(window)) {
      console.monitor = i + 1;
      return;
    }
  }
  spdlog::warn(
      "the participant's window fills the only monitor, and covers the experimenter's; give "
      "--window WIDTHxHEIGHT, or connect another monitor");
}

/// The free part of the monitor to the right of the participant's window, or else below it; the
/// participant's window moves into the monitor's corner.
void choose_area(GLFWwindow* window, ConsoleWindowOptions& console) {
  constexpr int kMinWidth = 480;
  constexpr int kMinHeight = 320;
  GLFWmonitor* const shared = glfwGetPrimaryMonitor();
  if (shared == nullptr) return;
  ScreenArea all;
  glfwGetMonitorWorkarea(shared, &all.x, &all.y, &all.width, &all.height);
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window, &width, &height);
  const ScreenArea right = {all.x + width, all.y, all.width - width, all.height};
  const ScreenArea below = {all.x, all.y + height, all.width, all.height - height};
  for (const ScreenArea& area : {right, below}) {
    if (area.width < kMinWidth || area.height < kMinHeight) continue;
    glfwSetWindowPos(window, all.x, all.y);
    console.area = area;
    return;
  }
  spdlog::warn(
      "there is no room for the experimenter's window beside the participant's; give a smaller "
      "--window WIDTHxHEIGHT, or connect another monitor and give --console-monitor");
}

}  // namespace

struct ParticipantWindow::State {
  explicit State(const ParticipantWindowOptions& wanted)
      : options(wanted),
        look{wanted.session.text_scale, wanted.session.high_contrast, letters_to_show(wanted)},
        words(words_of(study::texts_of(wanted.session))),
        monitor(monitor_of(options)),
        window(make_window(options, monitor)),
        shelf(options.pictures, options.pitch_mm) {
    if (wanted.has_several_methods) words.answer_title = words.answer_fits_title;
    context = {&words,
               options.session.language,
               options.session.sight,
               options.pointer != nullptr,
               &shelf,
               &glass,
               options.ask};
    glfwSetWindowUserPointer(window, this);
    take_callbacks();
    notify_surface();
    if (options.console != nullptr) open_console();
    drawing = std::thread(
        [this] { draw_until_ended(window, exchange, glass, shelf, look, console.get()); });
  }

  ~State() {
    exchange.end();
    drawing.join();
    if (options.pointer != nullptr) options.pointer->publish({{}, false, true, 0});
    glfwSetMonitorCallback(nullptr);
    newest = nullptr;
    glfwDestroyWindow(window);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void open_console() {
    ConsoleWindowOptions wanted;
    wanted.monitor = options.console_monitor;
    if (!wanted.monitor) (monitor != nullptr ? choose_monitor : choose_area)(window, wanted);
    wanted.keyboard_is_participants = [this] { return exploring || between; };
    wanted.key = [this](int key, int action, int modifiers) {
      take_key(event_of_key(key, action, modifiers));
    };
    wanted.wake = [this] { exchange.wake(); };
    console = std::make_unique<ConsoleWindow>(*options.console, wanted);
  }

  static State& of(GLFWwindow* window) {
    return *static_cast<State*>(glfwGetWindowUserPointer(window));
  }

  void take_callbacks() {
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
      of(w).take_key(event_of_key(key, action, modifiers));
      of(w).take_turn(key, action);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned int letter) {
      InputEvent event = event_now(InputEvent::Kind::letter);
      event.letter = letter;
      of(w).take(event);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
      of(w).take_pointer(InputEvent::Kind::moved, {x, y});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
      if (button != GLFW_MOUSE_BUTTON_LEFT) return;
      of(w).take_pointer(
          action == GLFW_PRESS ? InputEvent::Kind::pressed : InputEvent::Kind::released,
          of(w).pointer_at);
    });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { of(w).leave(WindowEnd::closed); });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).exchange.redraw(); });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).notify_surface(); });
    glfwSetWindowPosCallback(window, [](GLFWwindow* w, int, int) { of(w).notify_surface(); });
    newest = this;
    glfwSetMonitorCallback([](GLFWmonitor* changed, int what) {
      if (newest != nullptr && what == GLFW_DISCONNECTED && changed == newest->monitor) {
        newest->leave(WindowEnd::monitor_lost);
      }
    });
  }

  static InputEvent event_now(InputEvent::Kind kind) {
    InputEvent event;
    event.kind = kind;
    event.at = Clock::now();
    return event;
  }

  /// Handles the events of keyboards, mouse and gamepads.
  void take(const InputEvent& event) {
    const bool is_space = event.kind == InputEvent::Kind::key && event.key == Key::space;
    if (is_space && (exploring || between)) return take_stop(event.at);
    if (!exploring) {
      if (is_space) space_on_screen = event.at.time_since_epoch();
      return exchange.push(event);
    }
    if (event.kind == InputEvent::Kind::key && event.key == Key::enter && !has_clock &&
        event.at - Clock::time_point(plane_on) > kRepeatGuard) {
      finish_asked = true;
    }
  }

  void take_stop(Clock::time_point at) {
    // Only one press is ignored, because a person who wants to stop presses again.
    const Clock::time_point before{space_on_screen.exchange(Clock::duration{})};
    if (at - before > kRepeatGuard) comfort_asked = true;
  }

  void take_key(const InputEvent& event) {
    if (event.key != Key::none) take(event);
  }

  void take_turn(int key, int action) {
    if (!options.turn || action != GLFW_PRESS) return;
    if (key == GLFW_KEY_PAGE_DOWN) options.turn(1);
    if (key == GLFW_KEY_PAGE_UP) options.turn(-1);
    if (key == GLFW_KEY_ESCAPE) options.turn(0);
  }

  void take_pointer(InputEvent::Kind kind, Vec2 position) {
    pointer_at = position;
    if (kind == InputEvent::Kind::pressed) pressed = true;
    if (kind == InputEvent::Kind::released) pressed = false;
    publish_pointer();
    InputEvent event = event_now(kind);
    event.position = position;
    take(event);
  }

  /// Called regularly as a sign of life for the mouse device.
  void publish_pointer() {
    if (options.pointer == nullptr) return;
    const WindowSurface surface = exchange.surface();
    const PlaneGeometry now = newest_plane();
    device::PointerState state;
    if (exploring && now.width_px > 0) {
      const PlaneOnScreen placed =
          place_plane(surface.size, {now.width_mm(), now.height_mm()}, surface.glass.mm_per_unit);
      state.position_mm = placed.mm_per_unit * (pointer_at - placed.corner);
      state.pressed = pressed;
    }
    options.pointer->publish(state);
  }

  [[nodiscard]] PlaneGeometry newest_plane() {
    const std::lock_guard lock(plane_mutex);
    return plane;
  }

  void notify_surface() {
    WindowSurface surface;
    int width = 0;
    int height = 0;
    glfwGetWindowSize(window, &width, &height);
    surface.size = {1.0 * std::max(width, 1), 1.0 * std::max(height, 1)};
    glfwGetFramebufferSize(window, &surface.width_px, &surface.height_px);
    const ScreenScale scale = screen_scale(window);
    surface.glass = {scale.mm_per_unit, scale.is_known};
    surface.refresh_hz = scale.refresh_hz;
    exchange.set_surface(surface);
  }

  void leave(WindowEnd why) noexcept {
    int nobody = -1;
    end_reason.compare_exchange_strong(nobody, static_cast<int>(why));
  }

  /// A plane must not stay on if the participant cannot stop it.
  void look_at_focus() {
    constexpr milliseconds kPollInterval{50};
    constexpr milliseconds kFocusRequestInterval{200};
    const Clock::time_point now = Clock::now();
    if (now - focus_checked < kPollInterval) return;
    focus_checked = now;
    const bool focused =
        glfwGetWindowAttrib(window, GLFW_FOCUSED) != 0 || (console && console->has_focus());
    if (focused) {
      had_focus = true;
      lost_at = Clock::duration{};
      return;
    }
    if (!had_focus) return;
    if (lost_at.load() == Clock::duration{}) lost_at = now.time_since_epoch();
    if (!exploring) return;
    lost_at_plane = true;
    if (now - asked_for_focus < kFocusRequestInterval) return;
    asked_for_focus = now;
    glfwFocusWindow(window);
  }

  /// Hides the pointer while a plane is on: it would show where a mouse user's hand is.
  void hide_pointer() {
    const bool hide = exploring || between;
    if (hide == pointer_hidden) return;
    pointer_hidden = hide;
    glfwSetInputMode(window, GLFW_CURSOR, hide ? GLFW_CURSOR_HIDDEN : GLFW_CURSOR_NORMAL);
  }

  void switch_to(const session::Step& next) {
    std::shared_ptr<Screen> made;
    if (suspended && is_same_step(suspended->first, next)) made = suspended->second;
    const bool pauses = std::holds_alternative<session::PauseStep>(next);
    if (pauses && step && !replied) {
      suspended = {*step, screen};
    } else if (!pauses) {
      suspended.reset();
    }
    screen = made ? made : screen_for(next, context, labels);
    step = next;
    replied = false;
    if (const auto* const ready = std::get_if<session::ReadyStep>(&next))
      practice = ready->practice;
    if (const auto* const announced = std::get_if<session::IntervalStep>(&next))
      begin_pause(*announced);
    exchange.show(screen);
    const auto* const notice = std::get_if<session::NoticeStep>(&next);
    if (notice != nullptr && notice->what == session::NoticeStep::What::stopped) cue(Cue::stopped);
  }

  /// A stop after the end of a plane stops the next plane of the trial.
  void begin_pause(const session::IntervalStep& next) {
    if (next.interval == 1) comfort_asked = false;
    practice = next.practice;
    paused_at = Clock::now();
  }

  [[nodiscard]] bool is_pause_over() const {
    return between && (comfort_asked || Clock::now() - paused_at >= options.interval_pause);
  }

  /// The tone for the beginning of a plane.
  void mark_session_start() noexcept {
    constexpr Cue kBegins[] = {Cue::first_begins, Cue::second_begins, Cue::third_begins};
    if (interval) {
      cue(kBegins[std::clamp(interval->interval, 1, 3) - 1]);
    } else if (options.session.sight == study::Sight::blindfold) {
      cue(Cue::plane_on);
    }
  }

  /// The tone for its end; a comfort stop has its own tone.
  void mark_session_end(const session::Step& next) noexcept {
    const auto* const notice = std::get_if<session::NoticeStep>(&next);
    const bool is_stopped = notice != nullptr && notice->what == session::NoticeStep::What::stopped;
    if (interval) {
      if (!is_stopped) cue(Cue::interval_over);
    } else if (options.session.sight == study::Sight::blindfold) {
      cue(Cue::plane_off);
    }
  }

  /// The conditions under which a plane's clock runs; null: no clock.
  [[nodiscard]] const study::InContact* clock() const noexcept {
    return std::get_if<study::InContact>(&options.ask.exploring);
  }

  /// Counts how long the hand has explored an interval as instructed.
  void count_explored(double press_n, double seconds, Vec2 way_mm) noexcept {
    if (!has_lifted && !interval->hand_off) return;
    constexpr double kSmoothS = 0.005;  ///< positions have steps
    const double share = std::min(1.0, seconds / kSmoothS);
    velocity_mm_s = velocity_mm_s + share * ((1.0 / seconds) * way_mm - velocity_mm_s);
    const study::HandRange& range = clock()->range;
    const double speed_mm_s = norm(velocity_mm_s);
    const bool counts = interval->hand_off ||
                        (press_n >= range.lightest_n && press_n <= range.strongest_n &&
                         speed_mm_s >= range.slowest_mm_s && speed_mm_s <= range.fastest_mm_s);
    if (!counts) return;
    explored_s += seconds;
    explored = static_cast<int>(kExploredSteps * explored_s / clock()->seconds);
  }

  [[nodiscard]] engine::ColourImage existing(std::optional<engine::ColourImage> picture) const {
    exchange.check();
    if (!picture) throw DeviceError("window: no picture was drawn; check the graphics driver");
    return std::move(*picture);
  }

  [[nodiscard]] bool touches_enough() const noexcept {
    constexpr double kRounding = 1e-9;
    const study::MinTouch& min = options.min_touch;
    return at_plane_s >= min.contact_s - kRounding && along_plane_mm >= min.path_mm - kRounding;
  }

  void cue(Cue which) noexcept {
    if (options.cues != nullptr) options.cues->tone(which);
  }

  ParticipantWindowOptions options;
  ScreenLook look;
  Words words;
  GlfwLibrary library;
  GLFWmonitor* monitor;  ///< null: a window
  GLFWwindow* window;
  Glass glass;  ///< belongs to the drawing thread
  GlPictureShelf shelf;
  ScreenContext context;
  WindowExchange exchange;
  std::unique_ptr<ConsoleWindow> console;
  static inline State* newest = nullptr;  ///< for GLFW's monitor callback, which has no user data

  // Main thread.
  Vec2 pointer_at;
  bool pointer_hidden = false;
  bool had_focus = false;
  Clock::time_point focus_checked{};
  Clock::time_point asked_for_focus{};
  Gamepads gamepads;

  // Between threads.
  std::atomic<int> end_reason{-1};
  std::atomic<bool> exploring{false};
  std::atomic<bool> between{false};        ///< the next of a trial's planes is announced
  std::atomic<bool> has_clock{false};      ///< the plane ends by itself
  std::atomic<int> explored{0};            ///< of the interval, in steps of its bar
  std::atomic<Clock::duration> lost_at{};  ///< when another program got the focus; 0: it has not
  std::atomic<bool> lost_at_plane{false};
  std::atomic<bool> comfort_asked{false};
  std::atomic<bool> finish_asked{false};
  std::atomic<bool> has_touched{false};  ///< as the options require
  std::atomic<bool> asks_for_touch{false};
  std::atomic<bool> pressed{false};
  std::atomic<Clock::duration> plane_on{};
  std::atomic<Clock::duration> space_on_screen{};  ///< time of the last press on a screen
  std::mutex plane_mutex;
  PlaneGeometry plane;
  FeltNow felt;

  // Session's thread.
  std::vector<std::string> labels;
  std::optional<session::Step> step;
  std::shared_ptr<Screen> screen;
  std::optional<std::pair<session::Step, std::shared_ptr<Screen>>> suspended;
  bool replied = false;
  bool practice = false;
  Clock::time_point paused_at{};
  int explored_shown = 0;

  // The servo's listener. It counts only what the hand did, so that the hint on the screen is the
  // same for every texture (decision 54).
  double at_plane_s = 0.0;
  double along_plane_mm = 0.0;
  std::optional<device::ServoSample> last_felt;
  bool is_too_hard = false;
  std::optional<session::IntervalStep> interval;  ///< of the plane; set before it comes on
  std::atomic<bool> has_lifted{false};            ///< since the plane was announced
  bool lifted_shown = false;
  Vec2 velocity_mm_s;
  double explored_s = 0.0;

  std::thread drawing;
};

ParticipantWindow::ParticipantWindow(const ParticipantWindowOptions& options)
    : state_(std::make_unique<State>(options)) {}

ParticipantWindow::~ParticipantWindow() = default;

void ParticipantWindow::pump(milliseconds timeout) {
  State& s = *state_;
  glfwWaitEventsTimeout(std::chrono::duration<double>(timeout).count());
  s.gamepads.poll([&s](Key key, InputEvent::Kind kind) {
    InputEvent event = State::event_now(kind);
    event.key = key;
    // B stops forces but chooses nothing.
    if (key != Key::space || s.exploring || s.between) s.take(event);
  });
  s.hide_pointer();
  s.publish_pointer();
  s.look_at_focus();
  if (device::StopOnSignals::asked()) s.leave(WindowEnd::signal);
}

void ParticipantWindow::check() const {
  state_->exchange.check();
}

ScreenScale ParticipantWindow::screen() const {
  return screen_scale(state_->window);
}

void ParticipantWindow::see_pictures(const std::vector<std::string>& labels) {
  state_->labels = labels;
}

std::optional<session::StepReply> ParticipantWindow::attend(const session::Step& step) {
  State& s = *state_;
  s.exchange.check();
  s.between = std::holds_alternative<session::IntervalStep>(step);
  if (s.exploring.exchange(false)) s.mark_session_end(step);
  if (end_reason()) {
    std::this_thread::sleep_for(kAttention);
    return std::nullopt;
  }
  if (!s.step || s.replied || !is_same_step(*s.step, step)) s.switch_to(step);
  std::optional<session::StepReply> reply = s.exchange.reply(*s.screen, kAttention);
  if (s.is_pause_over()) reply = session::StepReply{};
  s.replied = reply.has_value();
  return reply;
}

std::optional<session::StepReply> ParticipantWindow::attend(const std::shared_ptr<Screen>& screen) {
  State& s = *state_;
  s.exchange.check();
  if (s.screen != screen) {
    s.screen = screen;
    s.step.reset();
    s.exchange.show(screen);
  }
  if (!end_reason()) return s.exchange.reply(*screen, kAttention);
  std::this_thread::sleep_for(kAttention);
  return std::nullopt;
}

device::HapticDevice& ParticipantWindow::begin_exploring(const PlaneGeometry& plane) {
  if (!state_->options.device) throw std::logic_error("ParticipantWindow: no device to explore");
  show_exploring(plane);
  return state_->options.device();
}

void ParticipantWindow::show_exploring(const PlaneGeometry& plane) {
  State& s = *state_;
  {
    const std::lock_guard lock(s.plane_mutex);
    s.plane = plane;
  }
  const bool again = s.step && std::holds_alternative<session::AnswerStep>(*s.step);
  if (!again) s.at_plane_s = s.along_plane_mm = 0.0;
  s.has_touched = s.touches_enough();
  s.asks_for_touch = false;
  const auto* const interval = s.step ? std::get_if<session::IntervalStep>(&*s.step) : nullptr;
  s.interval =
      interval != nullptr && s.clock() != nullptr ? std::optional(*interval) : std::nullopt;
  s.has_clock = s.interval.has_value();
  s.has_lifted = s.lifted_shown = false;
  s.velocity_mm_s = {};
  s.explored_s = 0.0;
  s.explored = s.explored_shown = 0;
  s.step.reset();
  s.suspended.reset();
  s.last_felt.reset();
  s.is_too_hard = false;
  s.felt.force_n = 0.0F;
  s.felt.speed_mm_s = 0.0F;
  const ExploringView view{s.practice ? &s.felt : nullptr,
                           s.options.pointer,
                           &s.pressed,
                           &s.asks_for_touch,
                           plane,
                           s.interval,
                           &s.explored,
                           &s.has_lifted};
  s.screen = std::make_shared<ExploringScreen>(view, s.context);
  s.exchange.show(s.screen);
  if (!s.between) s.comfort_asked = false;
  s.finish_asked = false;
  s.plane_on = Clock::now().time_since_epoch();
  s.exploring = true;
  s.between = false;
  glfwPostEmptyEvent();
  s.mark_session_start();
}

void ParticipantWindow::exploring(device::ServoControl& servo) {
  State& s = *state_;
  s.exchange.check();  // throws if the window does not respond
  if (end_reason()) servo.emergency_stop();
  if (s.comfort_asked) servo.comfort_stop();
  if (s.finish_asked && s.has_touched) servo.finish();
  const bool asks = !s.has_touched && (s.finish_asked.exchange(false) || s.asks_for_touch);
  const int explored = s.explored;
  const bool lifted = s.has_lifted;
  const bool grew = std::exchange(s.explored_shown, explored) != explored ||
                    std::exchange(s.lifted_shown, lifted) != lifted;
  if (s.asks_for_touch.exchange(asks) != asks || grew) s.exchange.redraw();
}

void ParticipantWindow::feel(const device::ServoSample& sample) noexcept {
  State& s = *state_;
  // In an interval only the hand's force, because a texture's would distinguish the planes.
  const double press_n = s.options.stiffness_n_per_mm * std::max(0.0, -sample.position_mm.z);
  const double force_n = s.interval ? press_n : norm(sample.force_n);
  if (sample.position_mm.z > study::kLiftedMm) s.has_lifted = true;
  if (force_n > kPushTooHardN && !s.is_too_hard) s.cue(Cue::too_hard);
  s.is_too_hard = force_n > (s.is_too_hard ? kPushReleasedN : kPushTooHardN);
  if (s.last_felt && sample.tick > s.last_felt->tick) {
    const double seconds = static_cast<double>(sample.tick - s.last_felt->tick) / s.options.rate_hz;
    const Vec3 way = sample.position_mm - s.last_felt->position_mm;
    const double way_mm = std::hypot(way.x, way.y);
    const double speed = way_mm / seconds;
    const bool at_plane = sample.position_mm.z <= session::kLandingHeightMm;
    if (at_plane && s.last_felt->position_mm.z <= session::kLandingHeightMm) {
      s.at_plane_s += seconds;
      s.along_plane_mm += way_mm;
      if (!s.has_touched) s.has_touched = s.touches_enough();
    }
    if (s.interval) s.count_explored(press_n, seconds, {way.x, way.y});
    const auto share = static_cast<float>(std::min(1.0, seconds / kBarsTimeS));
    const auto follow = [share](std::atomic<float>& shown, double now) {
      const float before = shown;
      shown = before + share * (static_cast<float>(now) - before);
    };
    follow(s.felt.force_n, force_n);
    follow(s.felt.speed_mm_s, speed);
  }
  s.last_felt = sample;
}

std::optional<WindowEnd> ParticipantWindow::end_reason() const noexcept {
  const int why = state_->end_reason;
  if (why < 0) return std::nullopt;
  return static_cast<WindowEnd>(why);
}

milliseconds ParticipantWindow::out_of_reach() const noexcept {
  const Clock::duration lost = state_->lost_at;
  if (lost == Clock::duration{}) return {};
  return std::chrono::duration_cast<milliseconds>(Clock::now().time_since_epoch() - lost);
}

bool ParticipantWindow::take_out_of_reach() noexcept {
  return state_->lost_at_plane.exchange(false);
}

bool ParticipantWindow::is_exploring() const noexcept {
  return state_->exploring;
}

bool ParticipantWindow::is_answering() const noexcept {
  return state_->step && std::holds_alternative<session::AnswerStep>(*state_->step);
}

void ParticipantWindow::close() noexcept {
  state_->leave(WindowEnd::closed);
}

void ParticipantWindow::inject(const InputEvent& event) {
  state_->take(event);
}

bool ParticipantWindow::wait_until_shown(milliseconds timeout) {
  return state_->exchange.wait_until_shown(timeout);
}

engine::ColourImage ParticipantWindow::picture() {
  return state_->existing(state_->exchange.picture(kPictureLimit));
}

engine::ColourImage ParticipantWindow::console_picture() {
  if (!state_->console) throw std::logic_error("ParticipantWindow: no experimenter's window");
  return state_->existing(state_->console->picture(kPictureLimit));
}

void run_beside(ParticipantWindow& window, const std::function<void()>& session) {
  std::exception_ptr failure;
  std::atomic<bool> ended{false};
  std::thread thread([&] {
    try {
      session();
    } catch (...) {
      failure = std::current_exception();
    }
    ended = true;
    glfwPostEmptyEvent();
  });
  constexpr milliseconds kPollInterval{4};
  try {
    while (!ended) window.pump(kPollInterval);
  } catch (...) {
    window.close();  // makes the session end
    thread.join();
    throw;
  }
  thread.join();
  if (failure) std::rethrow_exception(failure);
  window.check();
}

}  // namespace touchtrial::app
