#include "app/windows/pointer_window.hpp"

#include "app/windows/look.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

constexpr const char* kTitle = "Touchtrial: pilot with a mouse, visual and not blind";
constexpr const char* kHint = "Hold the left button to touch the plane. Space: stop.";
constexpr double kMarginUnits = 40.0;
constexpr double kHintUnits = 40.0;  ///< two lines
/// After this number of frames without news of the stylus, no servo is running.
constexpr int kFramesUntilStale = 30;

constexpr ImU32 kSurround = IM_COL32(214, 214, 214, 255);
constexpr ImU32 kPlane = IM_COL32(244, 244, 244, 255);
constexpr ImU32 kEdge = IM_COL32(120, 120, 120, 255);
constexpr ImU32 kText = IM_COL32(60, 60, 60, 255);

/// The size that shows the plane at 96 units per inch; the scale of the window is known only later.
WindowOptions options_for(Vec2 plane_mm) {
  const auto units = [](double mm) { return static_cast<int>(std::ceil(mm * 96.0 / 25.4)); };
  return {kTitle, std::max(640, units(plane_mm.x) + static_cast<int>(2 * kMarginUnits)),
          units(plane_mm.y) + static_cast<int>(2 * kMarginUnits + kHintUnits), true};
}

/// An empty ImGui window that fills the system's window.
void begin_canvas(Vec2 size) {
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize(imgui_vec(size));
  // Padding would clip a margin of the drawing.
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0F);
  ImGui::Begin("canvas", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoInputs);
  ImGui::PopStyleVar(2);
}

/// \return the height of the line
double draw_centred(ImDrawList& list, Vec2 top, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const Vec2 at = {std::round(top.x - static_cast<double>(size.x) / 2.0), std::round(top.y)};
  list.AddText(imgui_vec(at), kText, text.c_str());
  return static_cast<double>(size.y);
}

}  // namespace

PointerWindow::PointerWindow(device::PointerExchange& exchange, Vec2 plane_mm)
    : exchange_(exchange), plane_mm_(plane_mm), window_(options_for(plane_mm)) {
  window_.on_pointer([this](const WindowPointer& pointer) { publish(pointer); });
  window_.on_stop_key([this] { stop_asked_ = true; });
  place_plane();
}

PointerWindow::~PointerWindow() {
  window_.on_pointer({});
  exchange_.publish({{}, false, true, 0});
}

void PointerWindow::publish(const WindowPointer& pointer) {
  pointer_ = pointer;
  exchange_.publish({mm_per_unit_ * (pointer.position - corner_), pointer.pressed, false, 0});
}

void PointerWindow::place_plane() {
  const Vec2 size = window_.size();
  const double density = window_.density();
  const Vec2 room = {size.x - 2.0 * kMarginUnits * density,
                     size.y - (2.0 * kMarginUnits + kHintUnits) * density};
  const double least =
      std::max(plane_mm_.x / std::max(room.x, 1.0), plane_mm_.y / std::max(room.y, 1.0));
  mm_per_unit_ = std::max(window_.mm_per_unit(), least);
  const Vec2 drawn = (1.0 / mm_per_unit_) * plane_mm_;
  corner_ = {(size.x - drawn.x) / 2.0, (size.y - kHintUnits * density - drawn.y) / 2.0};
}

void PointerWindow::draw_frame() {
  window_.begin_frame();
  place_plane();
  const Vec2 size = window_.size();
  begin_canvas(size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({0.0F, 0.0F}, imgui_vec(size), kSurround);
  const Vec2 end = corner_ + (1.0 / mm_per_unit_) * plane_mm_;
  list.AddRectFilled(imgui_vec(corner_), imgui_vec(end), kPlane);
  list.AddRect(imgui_vec(corner_), imgui_vec(end), kEdge);
  const double density = window_.density();
  const Vec2 below = {size.x / 2.0, end.y + 20.0 * density};
  const double line = draw_centred(list, below, kHint);
  draw_centred(list, below + Vec2{0.0, line + 4.0 * density}, scale_in_words());
  draw_pointer();
  ImGui::End();
  window_.end_frame();
}

void PointerWindow::draw_pointer() {
  const device::StylusState stylus = exchange_.stylus();
  frames_without_news_ = stylus.sequence == shown_ ? frames_without_news_ + 1 : 0;
  shown_ = stylus.sequence;
  const bool is_live = shown_ > 0 && frames_without_news_ < kFramesUntilStale;
  const Vec2 at = corner_ + (1.0 / mm_per_unit_) * stylus.position_mm;
  draw_stylus(is_live ? at : pointer_.position, pointer_.pressed, is_live, window_.density());
}

std::string PointerWindow::scale_in_words() const {
  const double shrunk = mm_per_unit_ / window_.mm_per_unit();
  std::string scale = "true size";
  if (!window_.scale_is_known()) {
    scale = "true size unknown: measure the screen with touchtrial screen calibrate";
  } else if (shrunk >= 1.005) {
    scale = fmt::format("shown at 1 : {:.2f} to fit the screen", shrunk);
  }
  return fmt::format("{:.0f} x {:.0f} mm, {}", plane_mm_.x, plane_mm_.y, scale);
}

}  // namespace touchtrial::app
