#include "app/participant/window_drawing.hpp"

#include "app/experimenter/console_window.hpp"
#include "app/windows/gl_picture.hpp"
#include "app/windows/imgui_turn.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <thread>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// A picture now and then even if nothing changes: some systems lose what is hidden.
constexpr milliseconds kIdle{500};

ImVec2 to_imgui(Vec2 point) {
  return {static_cast<float>(point.x), static_cast<float>(point.y)};
}

bool is_transition(const InputEvent& event) {
  return event.kind != InputEvent::Kind::moved && event.kind != InputEvent::Kind::letter;
}

/// OpenGL and ImGui of one window, for as long as its thread draws.
class Drawing {
 public:
  Drawing(GLFWwindow* window, WindowExchange& exchange, Glass& glass, GlPictureShelf& shelf,
          ConsoleWindow* console)
      : window_(window), exchange_(exchange), glass_(glass), shelf_(shelf), console_(console) {
    if (console_ != nullptr) console_->begin_drawing();
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    const std::lock_guard turn(imgui_turn());
    ImGuiContext* const others = ImGui::GetCurrentContext();
    context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(context_);
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplOpenGL3_Init("#version 150");
    ImGui::SetCurrentContext(others);
  }
  ~Drawing() {
    {
      const std::lock_guard turn(imgui_turn());
      ImGuiContext* const others = ImGui::GetCurrentContext();
      ImGui::SetCurrentContext(context_);
      shelf_.clear();
      ImGui_ImplOpenGL3_Shutdown();
      ImGui::SetCurrentContext(others == context_ ? nullptr : others);
      ImGui::DestroyContext(context_);
    }
    glfwMakeContextCurrent(nullptr);
    if (console_ != nullptr) console_->end_drawing();
  }
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  void run() {
    for (;;) {
      WindowExchange::Work work = exchange_.wait_for_work(patience());
      if (work.ending) return;
      waiting_.insert(waiting_.end(), work.events.begin(), work.events.end());
      glass_ = work.surface.glass;
      if (work.screen != screen_) begin(work.screen);
      take_events();
      if (is_due(work)) frame(work);
      draw_console();
    }
  }

 private:
  [[nodiscard]] milliseconds patience() const {
    if (!waiting_.empty()) return milliseconds(0);
    if (console_ != nullptr && console_->wants_picture()) return milliseconds(0);
    return screen_ && screen_->is_alive() ? milliseconds(0) : kIdle;
  }

  /// Not for what the console alone has to show.
  [[nodiscard]] bool is_due(const WindowExchange::Work& work) const {
    if (work.surface.width_px <= 0 || work.surface.height_px <= 0) return false;
    return work.is_new || !waiting_.empty() || !is_shown_ || (screen_ && screen_->is_alive()) ||
           Clock::now() - drawn_at_ >= kIdle;
  }

  void draw_console() {
    if (console_ == nullptr || !console_->wants_picture()) return;
    console_->draw();
    glfwMakeContextCurrent(window_);
  }

  void begin(std::shared_ptr<Screen> screen) {
    screen_ = std::move(screen);
    is_shown_ = false;
  }

  /// Up to the first key or button; what came before the screen was on the glass is not for it.
  void take_events() {
    while (!waiting_.empty()) {
      const InputEvent event = waiting_.front();
      if (!is_shown_ && is_transition(event)) {
        // What comes later is for it: that is seen once it is shown.
        if (screen_) return;
      }
      waiting_.pop_front();
      if (!screen_) continue;
      if (event.kind != InputEvent::Kind::moved && event.at < shown_at_) continue;
      if (const auto reply = screen_->take(event)) exchange_.replied(screen_, *reply);
      if (is_transition(event)) return;
    }
  }

  void frame(const WindowExchange::Work& work) {
    const Clock::time_point began = Clock::now();
    draw(work.surface);
    if (work.picture_wanted) {
      exchange_.keep(drawn_picture(work.surface.width_px, work.surface.height_px));
    }
    glfwSwapBuffers(window_);
    drawn_at_ = Clock::now();
    if (!is_shown_) shown_at_ = drawn_at_;
    is_shown_ = true;
    exchange_.shown(screen_, !waiting_.empty());
    // Where nothing paces the screen.
    if (screen_ && screen_->is_alive()) {
      const std::chrono::duration<double> each(0.9 / std::max(work.surface.refresh_hz, 30.0));
      std::this_thread::sleep_until(began + std::chrono::duration_cast<Clock::duration>(each));
    }
  }

  void draw(const WindowSurface& surface) {
    const std::lock_guard turn(imgui_turn());
    ImGuiContext* const others = ImGui::GetCurrentContext();
    ImGui::SetCurrentContext(context_);
    fit_fonts(surface);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = to_imgui(surface.size);
    io.DisplayFramebufferScale =
        to_imgui({surface.width_px / surface.size.x, surface.height_px / surface.size.y});
    shelf_.set_density(surface.width_px / surface.size.x);
    io.DeltaTime = 1.0F / 60.0F;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    paint(surface);
    ImGui::Render();
    glViewport(0, 0, surface.width_px, surface.height_px);
    glClearColor(0.91F, 0.92F, 0.93F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    ImGui::SetCurrentContext(others);
  }

  /// Letters are made for the size at which they are seen.
  void fit_fonts(const WindowSurface& surface) {
    const double unit = design_unit(surface.size);
    if (unit == unit_) return;
    if (unit_ > 0.0) ImGui_ImplOpenGL3_DestroyFontsTexture();
    fonts_ = load_participant_fonts(unit);
    if (unit_ > 0.0) ImGui_ImplOpenGL3_CreateFontsTexture();
    unit_ = unit;
  }

  void paint(const WindowSurface& surface) {
    ImGui::SetNextWindowPos({0.0F, 0.0F});
    ImGui::SetNextWindowSize(to_imgui(surface.size));
    // Padding would cut a rim off what is drawn.
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    ImGui::Begin("screen", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoInputs);
    ImGui::PopStyleVar(2);
    Canvas canvas(*ImGui::GetWindowDrawList(), fonts_, surface.size,
                  screen_ ? screen_->attention() : Attention{});
    if (screen_) screen_->draw(canvas);
    ImGui::End();
  }

  GLFWwindow* window_;
  WindowExchange& exchange_;
  Glass& glass_;
  GlPictureShelf& shelf_;
  ConsoleWindow* console_;
  ImGuiContext* context_ = nullptr;
  Fonts fonts_;
  double unit_ = 0.0;
  std::shared_ptr<Screen> screen_;
  bool is_shown_ = false;
  Clock::time_point shown_at_{};
  Clock::time_point drawn_at_{};
  std::deque<InputEvent> waiting_;
};

}  // namespace

void draw_until_ended(GLFWwindow* window, WindowExchange& exchange, Glass& glass,
                      GlPictureShelf& shelf, ConsoleWindow* console) {
  try {
    Drawing(window, exchange, glass, shelf, console).run();
  } catch (...) {
    exchange.failed(std::current_exception());
  }
}

}  // namespace touchtrial::app
