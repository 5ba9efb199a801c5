#include "app/windows/glfw_window.hpp"

#include "app/windows/glfw_support.hpp"
#include "app/windows/look.hpp"

#include <algorithm>
#include <stdexcept>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

/// The share of a frame's time that is spent waiting for events; the screen paces the rest, where
/// it can.
constexpr double kShareForEvents = 0.8;

/// The requested size at this density, limited to the screen.
std::pair<int, int> size_on_screen(const WindowOptions& options, float density) {
  int width = static_cast<int>(static_cast<float>(options.width_px) * density);
  int height = static_cast<int>(static_cast<float>(options.height_px) * density);
  int x = 0;
  int y = 0;
  int most_wide = 0;
  int most_high = 0;
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
    glfwGetMonitorWorkarea(monitor, &x, &y, &most_wide, &most_high);
  }
  if (most_wide > 0) width = std::min(width, most_wide);
  if (most_high > 0) height = std::min(height, most_high);
  return {std::max(width, 1), std::max(height, 1)};
}

GLFWwindow* make_window(const WindowOptions& options) {
  hint_opengl_3_2();
  const auto [width, height] = size_on_screen(options, primary_density());
  GLFWwindow* window = glfwCreateWindow(width, height, options.title.c_str(), nullptr, nullptr);
  if (window == nullptr) {
    refuse_window("OpenGL 3.2 is needed; install the graphics driver, or Mesa (libgl1-mesa-dri)");
  }
  return window;
}

}  // namespace

struct GlfwWindow::State {
  explicit State(const WindowOptions& options) : window(make_window(options)) {
    glfwMakeContextCurrent(window);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window, this);
    // ImGui's backend forwards events to a callback that was set before it.
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
      if (key == GLFW_KEY_SPACE && action == GLFW_PRESS) tell_stop(w);
    });
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    scale = screen_scale(window);
    load_fonts(scale.density);
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 150");
  }
  ~State() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  static void tell_stop(GLFWwindow* window) {
    const auto* state = static_cast<State*>(glfwGetWindowUserPointer(window));
    if (state->stop_listener) state->stop_listener();
  }

  void take_events() {
    const double due_s = frame_began_s + kShareForEvents / scale.refresh_hz;
    glfwPollEvents();
    for (double left_s = due_s - glfwGetTime(); left_s > 0.0; left_s = due_s - glfwGetTime()) {
      glfwWaitEventsTimeout(left_s);
    }
    frame_began_s = glfwGetTime();
  }

  GlfwLibrary library;
  GLFWwindow* window;
  ScreenScale scale;
  std::function<void()> stop_listener;
  double frame_began_s = 0.0;
  bool keeps_pictures = false;
  engine::ColourImage picture;
};

GlfwWindow::GlfwWindow(const WindowOptions& options) : state_(std::make_unique<State>(options)) {}
GlfwWindow::~GlfwWindow() = default;

void GlfwWindow::on_stop_key(std::function<void()> listener) {
  state_->stop_listener = std::move(listener);
}

void GlfwWindow::begin_frame() {
  state_->take_events();
  state_->scale = screen_scale(state_->window);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void GlfwWindow::end_frame() {
  ImGui::Render();
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(state_->window, &width, &height);
  glViewport(0, 0, width, height);
  glClearColor(1.0F, 1.0F, 1.0F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (state_->keeps_pictures) state_->picture = drawn_picture(width, height);
  glfwSwapBuffers(state_->window);
}

bool GlfwWindow::close_asked() const {
  return glfwWindowShouldClose(state_->window) == GLFW_TRUE;
}

Vec2 GlfwWindow::size() const {
  int width = 0;
  int height = 0;
  glfwGetWindowSize(state_->window, &width, &height);
  return {static_cast<double>(width), static_cast<double>(height)};
}

double GlfwWindow::mm_per_unit() const {
  return state_->scale.mm_per_unit;
}

bool GlfwWindow::scale_is_known() const {
  return state_->scale.is_known;
}

float GlfwWindow::density() const {
  return state_->scale.density;
}

void GlfwWindow::keep_pictures() {
  state_->keeps_pictures = true;
}

const engine::ColourImage& GlfwWindow::picture() {
  if (state_->picture.empty()) throw std::logic_error("GlfwWindow: no picture was kept");
  return state_->picture;
}

}  // namespace touchtrial::app
