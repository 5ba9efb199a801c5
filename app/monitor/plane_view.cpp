#include "app/monitor/plane_view.hpp"

#include "app/monitor/palette.hpp"
#include "app/windows/stylus_mark.hpp"
#include "device/mouse/driver.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

/// A square that holds what the simulated hand strokes, where a device names no workspace.
constexpr Vec2 kUnnamedEndMm = {80.0, 80.0};
/// Heights that the bar beside the plane shows, mm.
constexpr double kHighestMm = 10.0;

/// Which part of the plane is seen, and where.
struct Sight {
  Vec2 middle_mm;
  Vec2 middle_at;  ///< window units
  double mm_per_unit = 1.0;
  bool y_up = false;

  [[nodiscard]] Vec2 at(Vec3 position_mm) const {
    const Vec2 from = Vec2{position_mm.x, position_mm.y} - middle_mm;
    return middle_at + (1.0 / mm_per_unit) * Vec2{from.x, y_up ? -from.y : from.y};
  }
  [[nodiscard]] Vec2 mm_at(Vec2 at) const {
    const Vec2 from = mm_per_unit * (at - middle_at);
    return middle_mm + Vec2{from.x, y_up ? -from.y : from.y};
  }
};

/// A mouse's plane is as large on the screen as it is; that of others fits the view.
Sight sight_of(const MonitorPicture& picture, const GlfwWindow& window, Vec2 corner, Vec2 size) {
  Sight sight;
  sight.middle_at = corner + 0.5 * size;
  if (picture.device.name == device::kMouseDriver) {
    sight.mm_per_unit = window.mm_per_unit();
    sight.middle_mm = 0.5 * sight.mm_per_unit * size;
    return sight;
  }
  Vec2 least_mm;
  Vec2 end_mm = kUnnamedEndMm;
  if (const auto& workspace = picture.device.workspace) {
    // The device's own frame has y upwards.
    sight.y_up = true;
    least_mm = {workspace->least_mm.x, workspace->least_mm.y};
    end_mm = {workspace->greatest_mm.x, workspace->greatest_mm.y};
  }
  sight.middle_mm = 0.5 * (least_mm + end_mm);
  sight.mm_per_unit = std::max((end_mm.x - least_mm.x) / size.x, (end_mm.y - least_mm.y) / size.y);
  return sight;
}

ImVec2 to_imgui(Vec2 point) {
  return {static_cast<float>(point.x), static_cast<float>(point.y)};
}

/// A bar from the plane up or down to the stylus.
void draw_height(ImDrawList& list, Vec2 corner, Vec2 size, double height_mm, float density) {
  const double middle = corner.y + size.y / 2.0;
  const double share = std::clamp(height_mm / kHighestMm, -1.0, 1.0);
  const double tip = middle - share * size.y / 2.0;
  list.AddRectFilled(to_imgui(corner), to_imgui(corner + size), kWhite);
  list.AddRectFilled(to_imgui({corner.x, std::min(middle, tip)}),
                     to_imgui({corner.x + size.x, std::max(middle, tip)}),
                     height_mm < 0.0 ? kVermillion : kBlue);
  list.AddLine(to_imgui({corner.x, middle}), to_imgui({corner.x + size.x, middle}), kBlack,
               2.0F * density);
  list.AddRect(to_imgui(corner), to_imgui(corner + size), kGrey);
}

void take_pointer(const Sight& sight, Vec2 corner, Vec2 size, MonitorRequests& requests) {
  ImGui::InvisibleButton("plane", to_imgui(size));
  requests.pressed = ImGui::IsItemActive();
  if (!ImGui::IsMousePosValid()) return;
  // A pointer on the controls is a hand at the plane's edge.
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Vec2 end = corner + size;
  requests.pointer_mm = sight.mm_at({std::clamp(static_cast<double>(mouse.x), corner.x, end.x),
                                     std::clamp(static_cast<double>(mouse.y), corner.y, end.y)});
}

}  // namespace

void draw_plane(const MonitorPicture& picture, const GlfwWindow& window, float width, float height,
                MonitorRequests& requests) {
  const float density = window.density();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const Vec2 corner = {at.x, at.y};
  const double bar = 18.0 * static_cast<double>(density);
  const double gap = 10.0 * static_cast<double>(density);
  const Vec2 size = {static_cast<double>(width) - bar - gap, static_cast<double>(height)};
  const Sight sight = sight_of(picture, window, corner, size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, to_imgui(corner + size), kWhite);
  list.AddRect(at, to_imgui(corner + size), kGrey);
  const Vec3 position_mm = picture.newest.sample.position_mm;
  list.PushClipRect(at, to_imgui(corner + size), true);
  draw_stylus(sight.at(position_mm), position_mm.z < 0.0, picture.running, density);
  list.PopClipRect();
  draw_height(list, corner + Vec2{size.x + gap, 0.0}, {bar, size.y}, position_mm.z, density);
  take_pointer(sight, corner, size, requests);
  const std::string caption = fmt::format("{:.0f} x {:.0f} mm; bar: z, -10 to 10 mm",
                                          size.x * sight.mm_per_unit, size.y * sight.mm_per_unit);
  ImGui::TextColored({0.43F, 0.43F, 0.43F, 1.0F}, "%s", caption.c_str());
}

}  // namespace touchtrial::app
