#include "app/windows/participant/window_drawing.hpp"

#include "app/windows/experimenter/console_window.hpp"
#include "app/windows/glfw_support.hpp"
#include "app/windows/look.hpp"
#include "engine/pictures/colour_image.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <thread>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace touchtrial::app {

void WindowExchange::show(std::shared_ptr<Screen> screen) {
  const std::lock_guard lock(mutex_);
  screen_ = std::move(screen);
  reply_.reset();
  reply_screen_.reset();
  // A screen must be drawn again before it counts as shown again.
  shown_screen_.reset();
  is_dirty_ = true;
  drawing_condition_.notify_all();
}

std::optional<session::StepReply> WindowExchange::reply(const Screen& screen,
                                                        std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  result_condition_.wait_for(lock, timeout,
                             [&] { return reply_screen_.get() == &screen || failure_; });
  if (reply_screen_.get() != &screen) return std::nullopt;
  reply_screen_.reset();
  return std::exchange(reply_, std::nullopt);
}

void WindowExchange::push(const InputEvent& event) {
  const std::lock_guard lock(mutex_);
  events_.push_back(event);
  has_shown_events_ = false;
  drawing_condition_.notify_all();
}

void WindowExchange::set_surface(const WindowSurface& surface) {
  const std::lock_guard lock(mutex_);
  surface_ = surface;
  is_dirty_ = true;
  drawing_condition_.notify_all();
}

void WindowExchange::redraw() {
  const std::lock_guard lock(mutex_);
  is_dirty_ = true;
  drawing_condition_.notify_all();
}

void WindowExchange::end() {
  const std::lock_guard lock(mutex_);
  is_ending_ = true;
  drawing_condition_.notify_all();
  result_condition_.notify_all();
}

WindowExchange::Work WindowExchange::wait_for_work(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  const auto is_new = [this] {
    return is_dirty_ || is_ending_ || picture_requested_ || !events_.empty();
  };
  drawing_condition_.wait_for(lock, timeout, [&] { return is_woken_ || is_new(); });
  const bool has_work = is_new();
  is_woken_ = false;
  is_dirty_ = false;
  return {screen_, surface_, std::exchange(events_, {}), picture_requested_, is_ending_, has_work};
}

void WindowExchange::wake() {
  const std::lock_guard lock(mutex_);
  is_woken_ = true;
  drawing_condition_.notify_all();
}

void WindowExchange::mark_shown(const std::shared_ptr<Screen>& screen, bool events_left) {
  const std::lock_guard lock(mutex_);
  shown_screen_ = screen;
  has_shown_events_ = !events_left && events_.empty();
  result_condition_.notify_all();
}

void WindowExchange::set_reply(const std::shared_ptr<Screen>& screen,
                               const session::StepReply& reply) {
  const std::lock_guard lock(mutex_);
  if (screen != screen_) return;  // the session has moved on
  reply_screen_ = screen;
  reply_ = reply;
  result_condition_.notify_all();
}

void WindowExchange::set_picture(engine::ColourImage picture) {
  const std::lock_guard lock(mutex_);
  picture_ = std::move(picture);
  picture_requested_ = false;
  result_condition_.notify_all();
}

void WindowExchange::set_failure(std::exception_ptr failure) {
  const std::lock_guard lock(mutex_);
  failure_ = std::move(failure);
  result_condition_.notify_all();
}

WindowSurface WindowExchange::surface() const {
  const std::lock_guard lock(mutex_);
  return surface_;
}

bool WindowExchange::wait_until_shown(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  return result_condition_.wait_for(lock, timeout, [this] {
    return shown_screen_ == screen_ && has_shown_events_ && events_.empty();
  });
}

std::optional<engine::ColourImage> WindowExchange::picture(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  picture_.reset();
  picture_requested_ = true;
  drawing_condition_.notify_all();
  result_condition_.wait_for(lock, timeout, [this] { return picture_.has_value() || failure_; });
  return std::exchange(picture_, std::nullopt);
}

void WindowExchange::check() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

namespace {

// Since OpenGL 1.2; missing in some systems' gl.h.
constexpr GLint kClampToEdge = 0x812F;

void upload(const GreyImage& image) {
  std::vector<std::uint8_t> pixels;
  pixels.reserve(image.size() * 4);
  for (const std::uint8_t grey : image.samples())
    pixels.insert(pixels.end(), {grey, grey, grey, 255});
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, kClampToEdge);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, kClampToEdge);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, image.width(), image.height(), 0, GL_RGBA,
               GL_UNSIGNED_BYTE, pixels.data());
}

}  // namespace

void GlPictureShelf::clear() {
  for (const auto& [label, texture] : textures_) glDeleteTextures(1, &texture.name);
  textures_.clear();
}

Vec2 GlPictureShelf::size_mm(const std::string& label) const {
  constexpr double kBlankMm = 40.0;
  const auto entry = pictures_.find(label);
  if (entry == pictures_.end() || entry->second.empty()) return {kBlankMm, kBlankMm};
  return {pitch_mm_ * entry->second.width(), pitch_mm_ * entry->second.height()};
}

void* GlPictureShelf::texture(const std::string& label, int width, int height) {
  const auto entry = pictures_.find(label);
  if (entry == pictures_.end() || entry->second.empty()) return nullptr;
  const int columns = std::max(1, static_cast<int>(std::lround(width * density_)));
  const int rows = std::max(1, static_cast<int>(std::lround(height * density_)));
  Texture& texture = textures_[label];
  if (texture.name == 0) glGenTextures(1, &texture.name);
  if (texture.width != columns || texture.height != rows) {
    glBindTexture(GL_TEXTURE_2D, texture.name);
    upload(engine::resized(entry->second, rows, columns));
    texture.width = columns;
    texture.height = rows;
  }
  // ImGui's renderer takes texture names as pointers.
  return reinterpret_cast<void*>(static_cast<std::intptr_t>(texture.name));
}

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// The time between frames without changes. They are drawn because some systems lose the content of
/// hidden windows.
constexpr milliseconds kIdleInterval{500};

bool is_transition(const InputEvent& event) {
  return event.kind != InputEvent::Kind::moved && event.kind != InputEvent::Kind::letter;
}

/// OpenGL and ImGui for one window, while its thread draws.
class Drawing {
 public:
  Drawing(GLFWwindow* window, WindowExchange& exchange, PhysicalScale& physical_scale,
          GlPictureShelf& shelf, const ScreenLook& look, ConsoleWindow* console)
      : window_(window),
        exchange_(exchange),
        physical_scale_(physical_scale),
        shelf_(shelf),
        look_(look),
        letters_(look.letters),
        console_(console) {
    if (console_ != nullptr) console_->begin_drawing();
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(context_);
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplOpenGL3_Init("#version 150");
  }
  ~Drawing() {
    ImGui::SetCurrentContext(context_);
    shelf_.clear();
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext(context_);
    glfwMakeContextCurrent(nullptr);
    if (console_ != nullptr) console_->end_drawing();
  }
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  void run() {
    for (;;) {
      WindowExchange::Work work = exchange_.wait_for_work(timeout());
      if (work.ending) return;
      pending_events_.insert(pending_events_.end(), work.events.begin(), work.events.end());
      physical_scale_ = work.surface.physical_scale;
      if (work.screen != screen_) set_screen(work.screen);
      pass_events();
      if (is_due(work)) draw_frame(work);
      draw_console();
    }
  }

 private:
  [[nodiscard]] milliseconds timeout() const {
    if (!pending_events_.empty()) return milliseconds(0);
    if (console_ != nullptr && console_->needs_frame()) return milliseconds(0);
    return screen_ && screen_->is_animated() ? milliseconds(0) : kIdleInterval;
  }

  /// Whether the window needs a new frame, apart from the console.
  [[nodiscard]] bool is_due(const WindowExchange::Work& work) const {
    if (work.surface.width_px <= 0 || work.surface.height_px <= 0) return false;
    return work.is_new || has_input_ || !pending_events_.empty() || !is_shown_ ||
           (screen_ && screen_->is_animated()) || Clock::now() - drawn_at_ >= kIdleInterval;
  }

  void draw_console() {
    if (console_ == nullptr || !console_->needs_frame()) return;
    console_->draw();
    glfwMakeContextCurrent(window_);
  }

  void set_screen(std::shared_ptr<Screen> screen) {
    screen_ = std::move(screen);
    is_shown_ = false;
  }

  /// Passes events to the screen, up to the first key or button. An event from before the screen
  /// was visible is dropped.
  void pass_events() {
    while (!pending_events_.empty()) {
      const InputEvent event = pending_events_.front();
      // Whether an event came before the screen is known only once the screen is shown. Letters may
      // have enabled a button.
      if ((!is_shown_ || has_letters_) && screen_ && is_transition(event)) return;
      pending_events_.pop_front();
      if (!screen_) continue;
      if (event.kind != InputEvent::Kind::moved && event.at < shown_at_) continue;
      has_input_ = true;
      if (const auto reply = screen_->handle(event)) exchange_.set_reply(screen_, *reply);
      if (is_transition(event)) return;
      has_letters_ = has_letters_ || event.kind == InputEvent::Kind::letter;
    }
  }

  void draw_frame(const WindowExchange::Work& work) {
    const Clock::time_point start = Clock::now();
    draw(work.surface);
    if (work.picture_requested) {
      exchange_.set_picture(capture_frame(work.surface.width_px, work.surface.height_px));
    }
    glfwSwapBuffers(window_);
    drawn_at_ = Clock::now();
    if (!is_shown_) shown_at_ = drawn_at_;
    is_shown_ = true;
    has_letters_ = has_input_ = false;
    exchange_.mark_shown(screen_, !pending_events_.empty());
    // Limits the frame rate if the system does not.
    if (screen_ && screen_->is_animated()) {
      const std::chrono::duration<double> frame_time(0.9 / std::max(work.surface.refresh_hz, 30.0));
      std::this_thread::sleep_until(start +
                                    std::chrono::duration_cast<Clock::duration>(frame_time));
    }
  }

  void draw(const WindowSurface& surface) {
    ImGui::SetCurrentContext(context_);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = imgui_vec(surface.size);
    io.DisplayFramebufferScale =
        imgui_vec({surface.width_px / surface.size.x, surface.height_px / surface.size.y});
    shelf_.set_density(surface.width_px / surface.size.x);
    io.DeltaTime = 1.0F / 60.0F;
    // Typed letters may be missing in the fonts; the frame is then drawn again.
    do {
      fit_fonts(surface);
      ImGui_ImplOpenGL3_NewFrame();
      ImGui::NewFrame();
      paint(surface);
      ImGui::Render();
    } while (!has_all_letters_);
    glViewport(0, 0, surface.width_px, surface.height_px);
    glClearColor(0.91F, 0.92F, 0.93F, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }

  /// Renders the fonts for the size at which they are shown.
  void fit_fonts(const WindowSurface& surface) {
    const double unit = look_.text_scale * design_unit(surface.size);
    if (unit == unit_ && has_all_letters_) return;
    if (unit_ > 0.0) ImGui_ImplOpenGL3_DestroyFontsTexture();
    fonts_ = load_participant_fonts(unit, letters_);
    if (unit_ > 0.0) ImGui_ImplOpenGL3_CreateFontsTexture();
    unit_ = unit;
  }

  void paint(const WindowSurface& surface) {
    ImGui::SetNextWindowPos({0.0F, 0.0F});
    ImGui::SetNextWindowSize(imgui_vec(surface.size));
    // Padding would cut off the edges.
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
    ImGui::Begin("screen", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoInputs);
    ImGui::PopStyleVar(2);
    Canvas canvas(*ImGui::GetWindowDrawList(), fonts_, surface.size,
                  screen_ ? screen_->attention() : Attention{}, look_.high_contrast);
    if (screen_) screen_->draw(canvas);
    ImGui::End();
    const std::size_t old_count = letters_.size();
    letters_.insert(canvas.missing_letters().begin(), canvas.missing_letters().end());
    has_all_letters_ = letters_.size() == old_count;
  }

  GLFWwindow* window_;
  WindowExchange& exchange_;
  PhysicalScale& physical_scale_;
  GlPictureShelf& shelf_;
  const ScreenLook& look_;
  std::set<char32_t>
      letters_;  ///< letters requested from the fonts, including those that no typeface has
  bool has_all_letters_ = true;
  ConsoleWindow* console_;
  ImGuiContext* context_ = nullptr;
  Fonts fonts_;
  double unit_ = 0.0;
  std::shared_ptr<Screen> screen_;
  bool is_shown_ = false;
  bool has_input_ = false;    ///< events since the last frame
  bool has_letters_ = false;  ///< whether these events contain letters
  Clock::time_point shown_at_{};
  Clock::time_point drawn_at_{};
  std::deque<InputEvent> pending_events_;
};

}  // namespace

void draw_until_ended(GLFWwindow* window, WindowExchange& exchange, PhysicalScale& physical_scale,
                      GlPictureShelf& shelf, const ScreenLook& look, ConsoleWindow* console) {
  try {
    Drawing(window, exchange, physical_scale, shelf, look, console).run();
  } catch (...) {
    exchange.set_failure(std::current_exception());
  }
}

}  // namespace touchtrial::app
