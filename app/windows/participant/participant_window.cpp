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
/// How long the session's thread waits for a reply at most.
constexpr milliseconds kReplyTimeout{10};
/// Only a hanging window exceeds this.
constexpr milliseconds kPictureTimeout{300'000};
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
  throw DeviceError("window: no monitor has room for " + std::to_string(size_px.first) + " x " +
                    std::to_string(size_px.second) + " pixels; the largest has " +
                    std::to_string(largest.first) + " x " + std::to_string(largest.second) +
                    ": choose a smaller --window");
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
/// \throws DeviceError if some are missing from all fonts
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
    const auto translation = text.find(plan.language);
    if (translation != text.end()) texts.push_back(translation->second);
  };
  for (const study::Question& question : plan.closing_questions) {
    add(question.text);
    std::ranges::for_each(question.options, add);
  }
  for (const study::Scale& scale : options.trial_question.scales()) {
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

/// Puts the experimenter's window on a monitor that the participant's window does not fill.
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

/// Moves the participant's window to the monitor's corner, and puts the experimenter's to the right
/// of it, otherwise below it.
void choose_area(GLFWwindow* window, ConsoleWindowOptions& console) {
  constexpr int kMinWidth = 480;
  constexpr int kMinHeight = 320;
  GLFWmonitor* const primary = glfwGetPrimaryMonitor();
  if (primary == nullptr) return;
  ScreenArea work_area;
  glfwGetMonitorWorkarea(primary, &work_area.x, &work_area.y, &work_area.width, &work_area.height);
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window, &width, &height);
  const ScreenArea right = {work_area.x + width, work_area.y, work_area.width - width,
                            work_area.height};
  const ScreenArea below = {work_area.x, work_area.y + height, work_area.width,
                            work_area.height - height};
  for (const ScreenArea& area : {right, below}) {
    if (area.width < kMinWidth || area.height < kMinHeight) continue;
    glfwSetWindowPos(window, work_area.x, work_area.y);
    console.area = area;
    return;
  }
  spdlog::warn(
      "there is no room for the experimenter's window beside the participant's; choose a smaller "
      "--window WIDTHxHEIGHT, or connect another monitor and set --console-monitor");
}

}  // namespace

struct ParticipantWindow::State {
  explicit State(const ParticipantWindowOptions& window_options)
      : options(window_options),
        look{options.session.text_scale, options.session.high_contrast, letters_to_show(options)},
        words(words_of(study::texts_of(options.session))),
        monitor(monitor_of(options)),
        window(make_window(options, monitor)),
        shelf(options.pictures, options.pitch_mm) {
    if (options.has_several_methods) words.answer_title = words.answer_fits_title;
    context = {&words, options.session.language, options.session.sight, options.pointer != nullptr,
               &shelf, &physical_scale,          options.trial_question};
    glfwSetWindowUserPointer(window, this);
    set_callbacks();
    notify_surface();
    if (options.console != nullptr) open_console();
    drawing = std::thread(
        [this] { draw_until_ended(window, exchange, physical_scale, shelf, look, console.get()); });
  }

  ~State() {
    exchange.end();
    drawing.join();
    if (options.pointer != nullptr) options.pointer->publish({{}, false, true, 0});
    glfwSetMonitorCallback(nullptr);
    current_window = nullptr;
    glfwDestroyWindow(window);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void open_console() {
    ConsoleWindowOptions console_options;
    console_options.monitor = options.console_monitor;
    if (!console_options.monitor) {
      (monitor != nullptr ? choose_monitor : choose_area)(window, console_options);
    }
    console_options.keyboard_is_participants = [this] {
      return exploring || is_interval_announced;
    };
    console_options.key = [this](int key, int action, int modifiers) {
      handle_key(event_of_key(key, action, modifiers));
    };
    console_options.wake = [this] { exchange.wake(); };
    console = std::make_unique<ConsoleWindow>(*options.console, console_options);
  }

  static State& state_of(GLFWwindow* window) {
    return *static_cast<State*>(glfwGetWindowUserPointer(window));
  }

  void set_callbacks() {
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
      state_of(w).handle_key(event_of_key(key, action, modifiers));
      state_of(w).handle_paging_key(key, action);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned int letter) {
      InputEvent event = event_now(InputEvent::Kind::letter);
      event.letter = letter;
      state_of(w).handle(event);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
      state_of(w).handle_pointer(InputEvent::Kind::moved, {x, y});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
      if (button != GLFW_MOUSE_BUTTON_LEFT) return;
      state_of(w).handle_pointer(
          action == GLFW_PRESS ? InputEvent::Kind::pressed : InputEvent::Kind::released,
          state_of(w).pointer_position);
    });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { state_of(w).end(WindowEnd::closed); });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { state_of(w).exchange.redraw(); });
    glfwSetFramebufferSizeCallback(window,
                                   [](GLFWwindow* w, int, int) { state_of(w).notify_surface(); });
    glfwSetWindowPosCallback(window, [](GLFWwindow* w, int, int) { state_of(w).notify_surface(); });
    current_window = this;
    glfwSetMonitorCallback([](GLFWmonitor* changed, int change) {
      if (current_window != nullptr && change == GLFW_DISCONNECTED &&
          changed == current_window->monitor) {
        current_window->end(WindowEnd::monitor_lost);
      }
    });
  }

  static InputEvent event_now(InputEvent::Kind kind) {
    InputEvent event;
    event.kind = kind;
    event.at = Clock::now();
    return event;
  }

  /// Handles an event of keyboard, mouse or gamepad.
  void handle(const InputEvent& event) {
    const bool is_space = event.kind == InputEvent::Kind::key && event.key == Key::space;
    if (is_space && (exploring || is_interval_announced)) return handle_stop_key(event.at);
    if (!exploring) {
      if (is_space) last_space_time = event.at.time_since_epoch();
      return exchange.push(event);
    }
    if (event.kind == InputEvent::Kind::key && event.key == Key::enter && !has_clock &&
        event.at - Clock::time_point(plane_start_time) > kRepeatGuard) {
      finish_requested = true;
    }
  }

  void handle_stop_key(Clock::time_point press_time) {
    // Only one press is ignored, because a person who wants to stop presses again.
    const Clock::time_point previous_press{last_space_time.exchange(Clock::duration{})};
    if (press_time - previous_press > kRepeatGuard) comfort_stop_requested = true;
  }

  void handle_key(const InputEvent& event) {
    if (event.key != Key::none) handle(event);
  }

  void handle_paging_key(int key, int action) {
    if (!options.turn_page || action != GLFW_PRESS) return;
    if (key == GLFW_KEY_PAGE_DOWN) options.turn_page(1);
    if (key == GLFW_KEY_PAGE_UP) options.turn_page(-1);
    if (key == GLFW_KEY_ESCAPE) options.turn_page(0);
  }

  void handle_pointer(InputEvent::Kind kind, Vec2 position) {
    pointer_position = position;
    if (kind == InputEvent::Kind::pressed) pressed = true;
    if (kind == InputEvent::Kind::released) pressed = false;
    publish_pointer();
    InputEvent event = event_now(kind);
    event.position = position;
    handle(event);
  }

  /// Called regularly, because the mouse device interprets silence as a hanging window.
  void publish_pointer() {
    if (options.pointer == nullptr) return;
    const WindowSurface surface = exchange.surface();
    const PlaneGeometry shown_plane = current_plane();
    device::PointerState state;
    if (exploring && shown_plane.width_px > 0) {
      const PlaneOnScreen on_screen =
          place_plane(surface.size, {shown_plane.width_mm(), shown_plane.height_mm()},
                      surface.physical_scale.mm_per_unit);
      state.position_mm = on_screen.mm_per_unit * (pointer_position - on_screen.corner);
      state.pressed = pressed;
    }
    options.pointer->publish(state);
  }

  [[nodiscard]] PlaneGeometry current_plane() {
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
    surface.physical_scale = {scale.mm_per_unit, scale.is_known};
    surface.refresh_hz = scale.refresh_hz;
    exchange.set_surface(surface);
  }

  void end(WindowEnd reason) noexcept {
    int unset = -1;
    end_reason.compare_exchange_strong(unset, static_cast<int>(reason));
  }

  /// Takes the focus back while a plane is on, because the participant must be able to stop it.
  void check_focus() {
    constexpr milliseconds kPollInterval{50};
    constexpr milliseconds kFocusRequestInterval{200};
    const Clock::time_point now = Clock::now();
    if (now - focus_checked_at < kPollInterval) return;
    focus_checked_at = now;
    const bool is_focused =
        glfwGetWindowAttrib(window, GLFW_FOCUSED) != 0 || (console && console->has_focus());
    if (is_focused) {
      had_focus = true;
      focus_lost_at = Clock::duration{};
      return;
    }
    if (!had_focus) return;
    if (focus_lost_at.load() == Clock::duration{}) focus_lost_at = now.time_since_epoch();
    if (!exploring) return;
    focus_lost_while_exploring = true;
    if (now - focus_requested_at < kFocusRequestInterval) return;
    focus_requested_at = now;
    glfwFocusWindow(window);
  }

  /// Hides the pointer while a plane is on: it would show where a mouse user's hand is.
  void hide_pointer() {
    const bool is_hidden = exploring || is_interval_announced;
    if (is_hidden == pointer_hidden) return;
    pointer_hidden = is_hidden;
    glfwSetInputMode(window, GLFW_CURSOR, is_hidden ? GLFW_CURSOR_HIDDEN : GLFW_CURSOR_NORMAL);
  }

  void switch_to(const session::Step& next) {
    std::shared_ptr<Screen> previous_screen;
    if (suspended_step && is_same_step(suspended_step->first, next))
      previous_screen = suspended_step->second;
    const bool is_pause = std::holds_alternative<session::PauseStep>(next);
    if (is_pause && step && !has_reply) {
      suspended_step = {*step, screen};
    } else if (!is_pause) {
      suspended_step.reset();
    }
    screen = previous_screen ? previous_screen : screen_for(next, context, labels);
    step = next;
    has_reply = false;
    if (const auto* const ready = std::get_if<session::ReadyStep>(&next))
      practice = ready->practice;
    if (const auto* const interval_step = std::get_if<session::IntervalStep>(&next))
      begin_pause(*interval_step);
    exchange.show(screen);
    const auto* const notice = std::get_if<session::NoticeStep>(&next);
    if (notice != nullptr && notice->what == session::NoticeStep::What::stopped) play(Cue::stopped);
  }

  /// A stop after the end of a plane stops the next plane of the trial.
  void begin_pause(const session::IntervalStep& next) {
    if (next.interval == 1) comfort_stop_requested = false;
    practice = next.practice;
    paused_at = Clock::now();
  }

  [[nodiscard]] bool is_pause_over() const {
    return is_interval_announced &&
           (comfort_stop_requested || Clock::now() - paused_at >= options.interval_pause);
  }

  /// Plays the tone for the start of a plane.
  void play_start_tone() noexcept {
    constexpr Cue kStartTones[] = {Cue::first_begins, Cue::second_begins, Cue::third_begins};
    if (interval) {
      play(kStartTones[std::clamp(interval->interval, 1, 3) - 1]);
    } else if (options.session.sight == study::Sight::blindfold) {
      play(Cue::plane_on);
    }
  }

  /// Plays the tone for the end of a plane; a comfort stop has its own tone.
  void play_end_tone(const session::Step& next) noexcept {
    const auto* const notice = std::get_if<session::NoticeStep>(&next);
    const bool is_stopped = notice != nullptr && notice->what == session::NoticeStep::What::stopped;
    if (interval) {
      if (!is_stopped) play(Cue::interval_over);
    } else if (options.session.sight == study::Sight::blindfold) {
      play(Cue::plane_off);
    }
  }

  /// The conditions under which a plane's clock runs; null: no clock.
  [[nodiscard]] const study::TimedContact* clock() const noexcept {
    return std::get_if<study::TimedContact>(&options.trial_question.exploring);
  }

  /// Measures how long the hand has explored an interval as instructed.
  void update_progress(double press_n, double seconds, Vec2 step_mm) noexcept {
    if (!has_lifted && !interval->hand_off) return;
    constexpr double kSmoothS = 0.005;  ///< positions have steps
    const double share = std::min(1.0, seconds / kSmoothS);
    velocity_mm_s = velocity_mm_s + share * ((1.0 / seconds) * step_mm - velocity_mm_s);
    const study::HandRange& range = clock()->range;
    const double speed_mm_s = norm(velocity_mm_s);
    const bool is_as_instructed =
        interval->hand_off ||
        (press_n >= range.lightest_n && press_n <= range.strongest_n &&
         speed_mm_s >= range.slowest_mm_s && speed_mm_s <= range.fastest_mm_s);
    if (!is_as_instructed) return;
    explored_s += seconds;
    explored_steps = static_cast<int>(kExploredSteps * explored_s / clock()->seconds);
  }

  [[nodiscard]] engine::ColourImage require_picture(
      std::optional<engine::ColourImage> picture) const {
    exchange.check();
    if (!picture) throw DeviceError("window: no picture was drawn; check the graphics driver");
    return std::move(*picture);
  }

  [[nodiscard]] bool has_enough_touch() const noexcept {
    constexpr double kRounding = 1e-9;
    const study::MinTouch& min = options.min_touch;
    return contact_s >= min.contact_s - kRounding && contact_path_mm >= min.path_mm - kRounding;
  }

  void play(Cue cue) noexcept {
    if (options.cues != nullptr) options.cues->play(cue);
  }

  ParticipantWindowOptions options;
  ScreenLook look;
  Words words;
  GlfwLibrary library;
  GLFWmonitor* monitor;  ///< null: a window
  GLFWwindow* window;
  PhysicalScale physical_scale;  ///< belongs to the drawing thread
  GlPictureShelf shelf;
  ScreenContext context;
  WindowExchange exchange;
  std::unique_ptr<ConsoleWindow> console;
  static inline State* current_window =
      nullptr;  ///< for GLFW's monitor callback, which has no user data

  // Main thread.
  Vec2 pointer_position;
  bool pointer_hidden = false;
  bool had_focus = false;
  Clock::time_point focus_checked_at{};
  Clock::time_point focus_requested_at{};
  Gamepads gamepads;

  // Between threads.
  std::atomic<int> end_reason{-1};
  std::atomic<bool> exploring{false};
  std::atomic<bool> is_interval_announced{false};  ///< instead of a plane of the trial
  std::atomic<bool> has_clock{false};              ///< the plane ends by itself
  std::atomic<int> explored_steps{0};  ///< progress of the interval, in steps of its bar
  std::atomic<Clock::duration>
      focus_lost_at{};  ///< when another program took the focus; 0: none has
  std::atomic<bool> focus_lost_while_exploring{false};
  std::atomic<bool> comfort_stop_requested{false};
  std::atomic<bool> finish_requested{false};
  std::atomic<bool> has_touched{false};  ///< whether the touch reaches the required minimum
  std::atomic<bool> shows_touch_request{false};
  std::atomic<bool> pressed{false};  ///< the mouse button
  std::atomic<Clock::duration> plane_start_time{};
  std::atomic<Clock::duration> last_space_time{};  ///< time of the last press on a screen
  std::mutex plane_mutex;
  PlaneGeometry plane;
  HandReadings hand_readings;

  // Session's thread.
  std::vector<std::string> labels;
  std::optional<session::Step> step;
  std::shared_ptr<Screen> screen;
  std::optional<std::pair<session::Step, std::shared_ptr<Screen>>> suspended_step;
  bool has_reply = false;
  bool practice = false;
  Clock::time_point paused_at{};
  int shown_steps = 0;

  // The servo's listener. It measures only the hand, so that the hint on the screen does not depend
  // on the texture (decision 54).
  double contact_s = 0.0;
  double contact_path_mm = 0.0;
  std::optional<device::ServoSample> last_sample;
  bool is_too_hard = false;
  std::optional<session::IntervalStep> interval;  ///< step of the plane; set before it comes on
  std::atomic<bool> has_lifted{false};  ///< whether the hand was lifted since the announcement
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
    if (key != Key::space || s.exploring || s.is_interval_announced) s.handle(event);
  });
  s.hide_pointer();
  s.publish_pointer();
  s.check_focus();
  if (device::StopOnSignals::stop_requested()) s.end(WindowEnd::signal);
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

std::optional<session::StepReply> ParticipantWindow::show_step(const session::Step& step) {
  State& s = *state_;
  s.exchange.check();
  s.is_interval_announced = std::holds_alternative<session::IntervalStep>(step);
  if (s.exploring.exchange(false)) s.play_end_tone(step);
  if (end_reason()) {
    std::this_thread::sleep_for(kReplyTimeout);
    return std::nullopt;
  }
  if (!s.step || s.has_reply || !is_same_step(*s.step, step)) s.switch_to(step);
  std::optional<session::StepReply> reply = s.exchange.reply(*s.screen, kReplyTimeout);
  if (s.is_pause_over()) reply = session::StepReply{};
  s.has_reply = reply.has_value();
  return reply;
}

std::optional<session::StepReply> ParticipantWindow::show_step(
    const std::shared_ptr<Screen>& screen) {
  State& s = *state_;
  s.exchange.check();
  if (s.screen != screen) {
    s.screen = screen;
    s.step.reset();
    s.exchange.show(screen);
  }
  if (!end_reason()) return s.exchange.reply(*screen, kReplyTimeout);
  std::this_thread::sleep_for(kReplyTimeout);
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
  const bool is_repeated = s.step && std::holds_alternative<session::AnswerStep>(*s.step);
  if (!is_repeated) s.contact_s = s.contact_path_mm = 0.0;
  s.has_touched = s.has_enough_touch();
  s.shows_touch_request = false;
  const auto* const interval = s.step ? std::get_if<session::IntervalStep>(&*s.step) : nullptr;
  s.interval =
      interval != nullptr && s.clock() != nullptr ? std::optional(*interval) : std::nullopt;
  s.has_clock = s.interval.has_value();
  s.has_lifted = s.lifted_shown = false;
  s.velocity_mm_s = {};
  s.explored_s = 0.0;
  s.explored_steps = s.shown_steps = 0;
  s.step.reset();
  s.suspended_step.reset();
  s.last_sample.reset();
  s.is_too_hard = false;
  s.hand_readings.force_n = 0.0F;
  s.hand_readings.speed_mm_s = 0.0F;
  const ExploringView view{s.practice ? &s.hand_readings : nullptr,
                           s.options.pointer,
                           &s.pressed,
                           &s.shows_touch_request,
                           plane,
                           s.interval,
                           &s.explored_steps,
                           &s.has_lifted};
  s.screen = std::make_shared<ExploringScreen>(view, s.context);
  s.exchange.show(s.screen);
  if (!s.is_interval_announced) s.comfort_stop_requested = false;
  s.finish_requested = false;
  s.plane_start_time = Clock::now().time_since_epoch();
  s.exploring = true;
  s.is_interval_announced = false;
  glfwPostEmptyEvent();
  s.play_start_tone();
}

void ParticipantWindow::while_exploring(device::ServoControl& servo) {
  State& s = *state_;
  s.exchange.check();  // throws if the window does not respond
  if (end_reason()) servo.emergency_stop();
  if (s.comfort_stop_requested) servo.comfort_stop();
  if (s.finish_requested && s.has_touched) servo.finish();
  const bool shows_request =
      !s.has_touched && (s.finish_requested.exchange(false) || s.shows_touch_request);
  const int explored_steps = s.explored_steps;
  const bool is_lifted = s.has_lifted;
  const bool has_progress = std::exchange(s.shown_steps, explored_steps) != explored_steps ||
                            std::exchange(s.lifted_shown, is_lifted) != is_lifted;
  if (s.shows_touch_request.exchange(shows_request) != shows_request || has_progress)
    s.exchange.redraw();
}

void ParticipantWindow::feel(const device::ServoSample& sample) noexcept {
  State& s = *state_;
  // In an interval, only the hand's force counts: the texture's would distinguish the planes.
  const double press_n = s.options.stiffness_n_per_mm * std::max(0.0, -sample.position_mm.z);
  const double force_n = s.interval ? press_n : norm(sample.force_n);
  if (sample.position_mm.z > study::kLiftedMm) s.has_lifted = true;
  if (force_n > kPushTooHardN && !s.is_too_hard) s.play(Cue::too_hard);
  s.is_too_hard = force_n > (s.is_too_hard ? kPushReleasedN : kPushTooHardN);
  if (s.last_sample && sample.tick > s.last_sample->tick) {
    const double seconds =
        static_cast<double>(sample.tick - s.last_sample->tick) / s.options.rate_hz;
    const Vec3 step = sample.position_mm - s.last_sample->position_mm;
    const double step_mm = std::hypot(step.x, step.y);
    const double speed = step_mm / seconds;
    const bool is_at_plane = sample.position_mm.z <= session::kLandingHeightMm;
    if (is_at_plane && s.last_sample->position_mm.z <= session::kLandingHeightMm) {
      s.contact_s += seconds;
      s.contact_path_mm += step_mm;
      if (!s.has_touched) s.has_touched = s.has_enough_touch();
    }
    if (s.interval) s.update_progress(press_n, seconds, {step.x, step.y});
    const auto share = static_cast<float>(std::min(1.0, seconds / kBarsTimeS));
    const auto smooth = [share](std::atomic<float>& average, double value) {
      const float old_value = average;
      average = old_value + share * (static_cast<float>(value) - old_value);
    };
    smooth(s.hand_readings.force_n, force_n);
    smooth(s.hand_readings.speed_mm_s, speed);
  }
  s.last_sample = sample;
}

std::optional<WindowEnd> ParticipantWindow::end_reason() const noexcept {
  const int reason = state_->end_reason;
  if (reason < 0) return std::nullopt;
  return static_cast<WindowEnd>(reason);
}

milliseconds ParticipantWindow::time_without_focus() const noexcept {
  const Clock::duration lost_at = state_->focus_lost_at;
  if (lost_at == Clock::duration{}) return {};
  return std::chrono::duration_cast<milliseconds>(Clock::now().time_since_epoch() - lost_at);
}

bool ParticipantWindow::take_focus_loss() noexcept {
  return state_->focus_lost_while_exploring.exchange(false);
}

bool ParticipantWindow::is_exploring() const noexcept {
  return state_->exploring;
}

bool ParticipantWindow::is_answering() const noexcept {
  return state_->step && std::holds_alternative<session::AnswerStep>(*state_->step);
}

void ParticipantWindow::close() noexcept {
  state_->end(WindowEnd::closed);
}

void ParticipantWindow::inject(const InputEvent& event) {
  state_->handle(event);
}

bool ParticipantWindow::wait_until_shown(milliseconds timeout) {
  return state_->exchange.wait_until_shown(timeout);
}

engine::ColourImage ParticipantWindow::picture() {
  return state_->require_picture(state_->exchange.picture(kPictureTimeout));
}

engine::ColourImage ParticipantWindow::console_picture() {
  if (!state_->console) throw std::logic_error("ParticipantWindow: no experimenter's window");
  return state_->require_picture(state_->console->picture(kPictureTimeout));
}

void run_beside(ParticipantWindow& window, const std::function<void()>& session) {
  std::exception_ptr failure;
  std::atomic<bool> is_ended{false};
  std::thread thread([&] {
    try {
      session();
    } catch (...) {
      failure = std::current_exception();
    }
    is_ended = true;
    glfwPostEmptyEvent();
  });
  constexpr milliseconds kPollInterval{4};
  try {
    while (!is_ended) window.pump(kPollInterval);
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
