#include "app/windows/experimenter/console_window.hpp"

#include "app/windows/experimenter/console_panel.hpp"
#include "app/windows/experimenter/status_words.hpp"
#include "app/windows/glfw_support.hpp"
#include "app/windows/look.hpp"
#include "core/errors.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

constexpr const char* kTitle = "Touchtrial console";
constexpr int kWindowWidth = 920;
constexpr int kWindowHeight = 640;
/// After this number of frames, ImGui's layout is stable.
constexpr int kSettlingFrames = 3;

/// The editing keys of a line of text in GLFW and in ImGui.
constexpr std::array<std::pair<int, int>, 11> kTextKeys = {{
    {GLFW_KEY_ENTER, ImGuiKey_Enter},
    {GLFW_KEY_KP_ENTER, ImGuiKey_Enter},
    {GLFW_KEY_ESCAPE, ImGuiKey_Escape},
    {GLFW_KEY_TAB, ImGuiKey_Tab},
    {GLFW_KEY_BACKSPACE, ImGuiKey_Backspace},
    {GLFW_KEY_DELETE, ImGuiKey_Delete},
    {GLFW_KEY_LEFT, ImGuiKey_LeftArrow},
    {GLFW_KEY_RIGHT, ImGuiKey_RightArrow},
    {GLFW_KEY_HOME, ImGuiKey_Home},
    {GLFW_KEY_END, ImGuiKey_End},
    {GLFW_KEY_A, ImGuiKey_A},
}};

struct Event {
  enum class Kind { moved, button, key, letter };
  Kind kind{};
  ImVec2 position{};
  int key = 0;  ///< ImGui's
  bool is_down = false;
  bool with_control = false;
  unsigned int letter = 0;
};

#if IMGUI_VERSION_NUM >= 18700
void add_event(ImGuiIO& io, const Event& event) {
  switch (event.kind) {
    case Event::Kind::moved:
      return io.AddMousePosEvent(event.position.x, event.position.y);
    case Event::Kind::button:
      return io.AddMouseButtonEvent(0, event.is_down);
    case Event::Kind::key:
      io.AddKeyEvent(ImGuiMod_Ctrl, event.with_control);
      return io.AddKeyEvent(static_cast<ImGuiKey>(event.key), event.is_down);
    case Event::Kind::letter:
      return io.AddInputCharacter(event.letter);
  }
}
void map_keys(ImGuiIO& /*io*/) {}
#else
void add_event(ImGuiIO& io, const Event& event) {
  switch (event.kind) {
    case Event::Kind::moved:
      io.MousePos = event.position;
      return;
    case Event::Kind::button:
      io.MouseDown[0] = event.is_down;
      return;
    case Event::Kind::key:
      io.KeyCtrl = event.with_control;
      io.KeysDown[event.key] = event.is_down;
      return;
    case Event::Kind::letter:
      return io.AddInputCharacter(event.letter);
  }
}
/// Maps each of ImGui's keys to its own number.
void map_keys(ImGuiIO& io) {
  for (const auto& [glfw, key] : kTextKeys) io.KeyMap[key] = key;
}
#endif

[[noreturn]] void refuse_monitor(int number, int count) {
  throw DeviceError("experimenter's window: there is no monitor " + std::to_string(number) +
                    "; this machine has " + std::to_string(count) +
                    ": connect another monitor, or choose one of these");
}

/// Limits the window's size.
/// \return the resulting size
std::pair<int, int> limit_size(GLFWwindow* window, int width, int height) {
  int old_width = 0;
  int old_height = 0;
  glfwGetWindowSize(window, &old_width, &old_height);
  const std::pair size{std::min(old_width, width), std::min(old_height, height)};
  glfwSetWindowSize(window, size.first, size.second);
  return size;
}

/// Moves the window to the middle of the monitor, and limits its size.
void centre_on_monitor(GLFWwindow* window, int number) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  if (number < 1 || number > count) refuse_monitor(number, count);
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  glfwGetMonitorWorkarea(monitors[number - 1], &x, &y, &width, &height);
  const auto [new_width, new_height] = limit_size(window, width, height);
  glfwSetWindowPos(window, x + (width - new_width) / 2, y + (height - new_height) / 2);
}

GLFWwindow* make_window() {
  glfwDefaultWindowHints();
  hint_opengl_3_2();
  // Does not take the focus from the participant's window.
  glfwWindowHint(GLFW_FOCUSED, GLFW_FALSE);
  glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  GLFWwindow* const window =
      glfwCreateWindow(kWindowWidth, kWindowHeight, kTitle, nullptr, nullptr);
  if (window == nullptr) {
    throw DeviceError(
        "experimenter's window: OpenGL 3.2 is needed; install the graphics driver, or Mesa "
        "(libgl1-mesa-dri)");
  }
  return window;
}

struct Surface {
  int width = 1;  ///< window units
  int height = 1;
  int width_px = 0;
  int height_px = 0;
  float density = 1.0F;
};

/// The factor by which letters grow with the window: in steps of a quarter, because each step
/// renders the fonts again.
float enlargement(const Surface& surface) {
  const float room =
      std::min(static_cast<float>(surface.width) / (kWindowWidth * surface.density),
               static_cast<float>(surface.height) / (kWindowHeight * surface.density));
  return std::clamp(std::floor(4.0F * room) / 4.0F, 1.0F, 3.0F);
}

}  // namespace

struct ConsoleWindow::State final : ExperimenterFace {
  State(ExperimenterDesk& shared_desk, ConsoleWindowOptions window_options)
      : desk(shared_desk), options(std::move(window_options)), panel(desk) {}

  /// Requests a new frame after every change.
  void show(const ExperimenterView& view) override {
    const std::string words = status_line(view.status) + view.need + view.question.text +
                              std::to_string(view.question_number);
    if (std::exchange(shown_text, words) != words) redraw();
  }

  static State& state_of(GLFWwindow* window) {
    return *static_cast<State*>(glfwGetWindowUserPointer(window));
  }

  void open() {
    window = make_window();
    try {
      if (options.monitor) {
        centre_on_monitor(window, *options.monitor);
      } else if (const auto& area = options.area) {
        limit_size(window, area->width, area->height);
        glfwSetWindowPos(window, area->x, area->y);
      }
    } catch (...) {
      glfwDestroyWindow(window);
      throw;
    }
    glfwSetWindowUserPointer(window, this);
    set_callbacks();
    glfwShowWindow(window);
    notify_surface();
    desk.add_face(*this);
  }

  void set_callbacks() {
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
      state_of(w).handle_key(key, action, modifiers);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned int letter) {
      if (state_of(w).accepts_text())
        state_of(w).push({.kind = Event::Kind::letter, .letter = letter});
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
      state_of(w).push(
          {.kind = Event::Kind::moved, .position = {static_cast<float>(x), static_cast<float>(y)}});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
      if (button != GLFW_MOUSE_BUTTON_LEFT) return;
      state_of(w).push({.kind = Event::Kind::button, .is_down = action == GLFW_PRESS});
    });
    glfwSetWindowCloseCallback(window,
                               [](GLFWwindow* w) { glfwSetWindowShouldClose(w, GLFW_FALSE); });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { state_of(w).redraw(); });
    glfwSetFramebufferSizeCallback(window,
                                   [](GLFWwindow* w, int, int) { state_of(w).notify_surface(); });
    glfwSetWindowPosCallback(window, [](GLFWwindow* w, int, int) { state_of(w).notify_surface(); });
  }

  [[nodiscard]] bool accepts_text() const {
    return is_typing && !options.keyboard_is_participants();
  }

  void handle_key(int key, int action, int modifiers) {
    const bool is_release = action == GLFW_RELEASE;
    if (!accepts_text() && !is_release) return options.key(key, action, modifiers);
    for (const auto& [glfw, imgui_key] : kTextKeys) {
      if (glfw != key) continue;
      // A repeated key is sent as release and press.
      if (action == GLFW_REPEAT)
        push({.kind = Event::Kind::key, .key = imgui_key, .is_down = false});
      push({.kind = Event::Kind::key,
            .key = imgui_key,
            .is_down = !is_release,
            .with_control = (modifiers & GLFW_MOD_CONTROL) != 0});
    }
  }

  void push(const Event& event) {
    {
      const std::lock_guard lock(mutex);
      events.push_back(event);
      frames_due = kSettlingFrames;
    }
    options.wake();
  }

  void redraw() {
    {
      const std::lock_guard lock(mutex);
      frames_due = kSettlingFrames;
    }
    options.wake();
  }

  void notify_surface() {
    Surface current;
    glfwGetWindowSize(window, &current.width, &current.height);
    glfwGetFramebufferSize(window, &current.width_px, &current.height_px);
    // Nothing is drawn while the window is iconified.
    if (current.height_px <= 0) current.width_px = 0;
    current.density = screen_scale(window).density;
    current.density *= enlargement(current);
    {
      const std::lock_guard lock(mutex);
      surface = current;
    }
    redraw();
  }

  /// Processes events up to one button or key, because each needs its own frame: ImGui would defer
  /// further ones to a later frame, when their field may no longer exist.
  void process_events(ImGuiIO& io) {
    const std::lock_guard lock(mutex);
    for (bool is_first = true; !events.empty(); is_first = false) {
      const Event event = events.front();
      const bool needs_own_frame =
          event.kind == Event::Kind::button || event.kind == Event::Kind::key;
      if (needs_own_frame && !is_first) return;
      events.pop_front();
      add_event(io, event);
      if (needs_own_frame) return;
    }
  }

  void fit_fonts(float density) {
    if (density == fonts_density) return;
    if (fonts_density > 0.0F) {
      ImGui_ImplOpenGL3_DestroyFontsTexture();
      ImGui::GetIO().Fonts->Clear();
    }
    load_fonts(density);
    if (fonts_density > 0.0F) ImGui_ImplOpenGL3_CreateFontsTexture();
    fonts_density = density;
  }

  void paint(const Surface& current) {
    ImGui::SetCurrentContext(context);
    fit_fonts(current.density);
    ImGuiIO& io = ImGui::GetIO();
    if (!panel.is_focus_pending()) process_events(io);
    io.DisplaySize = {static_cast<float>(current.width), static_cast<float>(current.height)};
    io.DisplayFramebufferScale = {static_cast<float>(current.width_px) / io.DisplaySize.x,
                                  static_cast<float>(current.height_px) / io.DisplaySize.y};
    io.DeltaTime = 1.0F / 60.0F;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    panel.draw({io.DisplaySize.x, io.DisplaySize.y}, current.density,
               !options.keyboard_is_participants());
    is_typing = panel.is_typing();
    ImGui::Render();
    glViewport(0, 0, current.width_px, current.height_px);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }

  ExperimenterDesk& desk;
  const ConsoleWindowOptions options;
  GLFWwindow* window = nullptr;

  // Shared between threads.
  std::atomic<bool> is_typing{false};
  mutable std::mutex mutex;
  std::condition_variable picture_ready;
  std::deque<Event> events;
  Surface surface;
  int frames_due = kSettlingFrames;
  bool picture_requested = false;
  std::optional<engine::ColourImage> picture;

  // Session's thread.
  std::string shown_text;

  // Drawing thread.
  ImGuiContext* context = nullptr;
  float fonts_density = 0.0F;
  ConsolePanel panel;
};

ConsoleWindow::ConsoleWindow(ExperimenterDesk& desk, const ConsoleWindowOptions& options)
    : state_(std::make_unique<State>(desk, options)) {
  state_->open();
}

ConsoleWindow::~ConsoleWindow() {
  state_->desk.remove_face(*state_);
  glfwDestroyWindow(state_->window);
}

void ConsoleWindow::begin_drawing() {
  glfwMakeContextCurrent(state_->window);
  // No vertical sync here, because it would delay the participant's window.
  glfwSwapInterval(0);
  state_->context = ImGui::CreateContext();
  ImGui::SetCurrentContext(state_->context);
  ImGui::GetIO().IniFilename = nullptr;
  map_keys(ImGui::GetIO());
  ImGui_ImplOpenGL3_Init("#version 150");
}

void ConsoleWindow::end_drawing() {
  glfwMakeContextCurrent(state_->window);
  ImGui::SetCurrentContext(state_->context);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(state_->context);
  glfwMakeContextCurrent(nullptr);
}

bool ConsoleWindow::needs_frame() const {
  const std::lock_guard lock(state_->mutex);
  if (state_->surface.width_px <= 0) return false;
  return state_->frames_due > 0 || !state_->events.empty() || state_->picture_requested ||
         state_->panel.is_focus_pending();
}

void ConsoleWindow::draw() {
  State& s = *state_;
  Surface current;
  {
    const std::lock_guard lock(s.mutex);
    current = s.surface;
    s.frames_due = s.events.empty() ? std::max(0, s.frames_due - 1) : kSettlingFrames;
  }
  glfwMakeContextCurrent(s.window);
  s.paint(current);
  {
    const std::lock_guard lock(s.mutex);
    if (s.picture_requested && s.frames_due == 0) {
      s.picture = capture_frame(current.width_px, current.height_px);
      s.picture_requested = false;
      s.picture_ready.notify_all();
    }
  }
  glfwSwapBuffers(s.window);
}

bool ConsoleWindow::has_focus() const {
  return glfwGetWindowAttrib(state_->window, GLFW_FOCUSED) != 0;
}

std::optional<engine::ColourImage> ConsoleWindow::picture(std::chrono::milliseconds timeout) {
  State& s = *state_;
  {
    const std::lock_guard lock(s.mutex);
    s.picture.reset();
    s.picture_requested = true;
  }
  s.redraw();
  std::unique_lock lock(s.mutex);
  s.picture_ready.wait_for(lock, timeout, [&s] { return s.picture.has_value(); });
  return std::exchange(s.picture, std::nullopt);
}

}  // namespace touchtrial::app
