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
constexpr int kSettling = 3;

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
  ImVec2 at{};
  int key = 0;  ///< ImGui's
  bool is_down = false;
  bool with_control = false;
  unsigned int letter = 0;
};

#if IMGUI_VERSION_NUM >= 18700
void notify(ImGuiIO& io, const Event& event) {
  switch (event.kind) {
    case Event::Kind::moved:
      return io.AddMousePosEvent(event.at.x, event.at.y);
    case Event::Kind::button:
      return io.AddMouseButtonEvent(0, event.is_down);
    case Event::Kind::key:
      io.AddKeyEvent(ImGuiMod_Ctrl, event.with_control);
      return io.AddKeyEvent(static_cast<ImGuiKey>(event.key), event.is_down);
    case Event::Kind::letter:
      return io.AddInputCharacter(event.letter);
  }
}
void name_keys(ImGuiIO& /*io*/) {}
#else
void notify(ImGuiIO& io, const Event& event) {
  switch (event.kind) {
    case Event::Kind::moved:
      io.MousePos = event.at;
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
void name_keys(ImGuiIO& io) {
  for (const auto& [glfw, key] : kTextKeys) io.KeyMap[key] = key;
}
#endif

[[noreturn]] void refuse_monitor(int wanted, int count) {
  throw DeviceError("experimenter's window: there is no monitor " + std::to_string(wanted) +
                    "; this machine has " + std::to_string(count) +
                    ": connect another, or choose one of these");
}

/// Limits the window's size.
/// \return the size that it has then
std::pair<int, int> shrink_to(GLFWwindow* window, int width, int height) {
  int own_width = 0;
  int own_height = 0;
  glfwGetWindowSize(window, &own_width, &own_height);
  const std::pair size{std::min(own_width, width), std::min(own_height, height)};
  glfwSetWindowSize(window, size.first, size.second);
  return size;
}

/// Moves the window to the middle of the monitor, and limits its size.
void place(GLFWwindow* window, int wanted) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  if (wanted < 1 || wanted > count) refuse_monitor(wanted, count);
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  glfwGetMonitorWorkarea(monitors[wanted - 1], &x, &y, &width, &height);
  const auto [own_width, own_height] = shrink_to(window, width, height);
  glfwSetWindowPos(window, x + (width - own_width) / 2, y + (height - own_height) / 2);
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
  State(ExperimenterDesk& shared_desk, ConsoleWindowOptions wanted)
      : desk(shared_desk), options(std::move(wanted)), panel(desk) {}

  /// Every change requires a new frame.
  void show(const ExperimenterView& view) override {
    const std::string words =
        status_line(view.status) + view.need + view.question.text + std::to_string(view.questions);
    if (std::exchange(shown, words) != words) redraw();
  }

  static State& of(GLFWwindow* window) {
    return *static_cast<State*>(glfwGetWindowUserPointer(window));
  }

  void open() {
    window = make_window();
    try {
      if (options.monitor) {
        place(window, *options.monitor);
      } else if (const auto& area = options.area) {
        shrink_to(window, area->width, area->height);
        glfwSetWindowPos(window, area->x, area->y);
      }
    } catch (...) {
      glfwDestroyWindow(window);
      throw;
    }
    glfwSetWindowUserPointer(window, this);
    take_callbacks();
    glfwShowWindow(window);
    notify_surface();
    desk.add_face(*this);
  }

  void take_callbacks() {
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
      of(w).take_key(key, action, modifiers);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned int letter) {
      if (of(w).takes_text()) of(w).push({.kind = Event::Kind::letter, .letter = letter});
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
      of(w).push(
          {.kind = Event::Kind::moved, .at = {static_cast<float>(x), static_cast<float>(y)}});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
      if (button != GLFW_MOUSE_BUTTON_LEFT) return;
      of(w).push({.kind = Event::Kind::button, .is_down = action == GLFW_PRESS});
    });
    glfwSetWindowCloseCallback(window,
                               [](GLFWwindow* w) { glfwSetWindowShouldClose(w, GLFW_FALSE); });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).redraw(); });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).notify_surface(); });
    glfwSetWindowPosCallback(window, [](GLFWwindow* w, int, int) { of(w).notify_surface(); });
  }

  [[nodiscard]] bool takes_text() const {
    return is_writing && !options.keyboard_is_participants();
  }

  void take_key(int key, int action, int modifiers) {
    const bool is_release = action == GLFW_RELEASE;
    if (!takes_text() && !is_release) return options.key(key, action, modifiers);
    for (const auto& [glfw, named] : kTextKeys) {
      if (glfw != key) continue;
      // A repeated key is sent as release and press.
      if (action == GLFW_REPEAT) push({.kind = Event::Kind::key, .key = named, .is_down = false});
      push({.kind = Event::Kind::key,
            .key = named,
            .is_down = !is_release,
            .with_control = (modifiers & GLFW_MOD_CONTROL) != 0});
    }
  }

  void push(const Event& event) {
    {
      const std::lock_guard lock(mutex);
      events.push_back(event);
      frames_due = kSettling;
    }
    options.wake();
  }

  void redraw() {
    {
      const std::lock_guard lock(mutex);
      frames_due = kSettling;
    }
    options.wake();
  }

  void notify_surface() {
    Surface now;
    glfwGetWindowSize(window, &now.width, &now.height);
    glfwGetFramebufferSize(window, &now.width_px, &now.height_px);
    // Nothing is drawn while the window is iconified.
    if (now.height_px <= 0) now.width_px = 0;
    now.density = screen_scale(window).density;
    now.density *= enlargement(now);
    {
      const std::lock_guard lock(mutex);
      surface = now;
    }
    redraw();
  }

  /// Processes events up to one button or key, because each needs its own frame: ImGui would defer
  /// further ones to a later frame, when their field may no longer exist.
  void take_events(ImGuiIO& io) {
    const std::lock_guard lock(mutex);
    for (bool is_first = true; !events.empty(); is_first = false) {
      const Event event = events.front();
      const bool is_alone = event.kind == Event::Kind::button || event.kind == Event::Kind::key;
      if (is_alone && !is_first) return;
      events.pop_front();
      notify(io, event);
      if (is_alone) return;
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

  void paint(const Surface& now) {
    ImGui::SetCurrentContext(context);
    fit_fonts(now.density);
    ImGuiIO& io = ImGui::GetIO();
    if (!panel.is_settling()) take_events(io);
    io.DisplaySize = {static_cast<float>(now.width), static_cast<float>(now.height)};
    io.DisplayFramebufferScale = {static_cast<float>(now.width_px) / io.DisplaySize.x,
                                  static_cast<float>(now.height_px) / io.DisplaySize.y};
    io.DeltaTime = 1.0F / 60.0F;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    panel.draw({io.DisplaySize.x, io.DisplaySize.y}, now.density,
               !options.keyboard_is_participants());
    is_writing = panel.is_writing();
    ImGui::Render();
    glViewport(0, 0, now.width_px, now.height_px);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }

  ExperimenterDesk& desk;
  const ConsoleWindowOptions options;
  GLFWwindow* window = nullptr;

  // Shared between threads.
  std::atomic<bool> is_writing{false};
  mutable std::mutex mutex;
  std::condition_variable for_picture;
  std::deque<Event> events;
  Surface surface;
  int frames_due = kSettling;
  bool picture_wanted = false;
  std::optional<engine::ColourImage> picture;

  // Session's thread.
  std::string shown;

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
  name_keys(ImGui::GetIO());
  ImGui_ImplOpenGL3_Init("#version 150");
}

void ConsoleWindow::end_drawing() {
  glfwMakeContextCurrent(state_->window);
  ImGui::SetCurrentContext(state_->context);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(state_->context);
  glfwMakeContextCurrent(nullptr);
}

bool ConsoleWindow::wants_picture() const {
  const std::lock_guard lock(state_->mutex);
  if (state_->surface.width_px <= 0) return false;
  return state_->frames_due > 0 || !state_->events.empty() || state_->picture_wanted ||
         state_->panel.is_settling();
}

void ConsoleWindow::draw() {
  State& s = *state_;
  Surface now;
  {
    const std::lock_guard lock(s.mutex);
    now = s.surface;
    s.frames_due = s.events.empty() ? std::max(0, s.frames_due - 1) : kSettling;
  }
  glfwMakeContextCurrent(s.window);
  s.paint(now);
  {
    const std::lock_guard lock(s.mutex);
    if (s.picture_wanted && s.frames_due == 0) {
      s.picture = drawn_picture(now.width_px, now.height_px);
      s.picture_wanted = false;
      s.for_picture.notify_all();
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
    s.picture_wanted = true;
  }
  s.redraw();
  std::unique_lock lock(s.mutex);
  s.for_picture.wait_for(lock, timeout, [&s] { return s.picture.has_value(); });
  return std::exchange(s.picture, std::nullopt);
}

}  // namespace touchtrial::app
