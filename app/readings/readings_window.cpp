#include "app/readings/readings_window.hpp"

#include "app/readings/plot.hpp"
#include "app/windows/look.hpp"
#include "device/mouse/mouse_device.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

/// The end of the view of devices that name no workspace; it covers the simulated hand's path.
constexpr Vec2 kUnnamedEndMm = {80.0, 80.0};
/// The greatest height that the bar beside the plane shows, mm.
constexpr double kHighestMm = 10.0;
constexpr int kValueTicks = 4;
constexpr float kLeftWidth = 330.0F;
constexpr float kFactsHeight = 200.0F;
constexpr float kStateHeight = 48.0F;

void begin_canvas(Vec2 size, float density) {
  ImGui::StyleColorsLight();
  ImGui::GetStyle().WindowPadding = {12.0F * density, 12.0F * density};
  ImGui::GetStyle().ItemSpacing = {8.0F * density, 8.0F * density};
  ImGui::PushStyleColor(ImGuiCol_WindowBg, 0xFFFAFAFA);
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize(imgui_vec(size));
  ImGui::Begin("readings", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
}

void draw_state(const std::string& phase, float density) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const float height = kStateHeight * density;
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + width, at.y + height}, kBlue);
  ImFont* font = ImGui::GetIO().Fonts->Fonts[kLargeFont];
  const std::string text = phase + ". Space: release the force.";
  ImGui::GetWindowDrawList()->AddText(
      font, font->FontSize, {at.x + 16.0F * density, at.y + (height - font->FontSize) / 2.0F},
      kWhite, text.c_str());
  ImGui::Dummy({width, height});
}

/// A bar from the plane up or down to the stylus.
void draw_height(ImDrawList& list, Vec2 corner, Vec2 size, double height_mm, float density) {
  const double middle = corner.y + size.y / 2.0;
  const double share = std::clamp(height_mm / kHighestMm, -1.0, 1.0);
  const double tip = middle - share * size.y / 2.0;
  list.AddRectFilled(imgui_vec(corner), imgui_vec(corner + size), kWhite);
  list.AddRectFilled(imgui_vec({corner.x, std::min(middle, tip)}),
                     imgui_vec({corner.x + size.x, std::max(middle, tip)}),
                     height_mm < 0.0 ? kVermillion : kBlue);
  list.AddLine(imgui_vec({corner.x, middle}), imgui_vec({corner.x + size.x, middle}), kBlack,
               2.0F * density);
  list.AddRect(imgui_vec(corner), imgui_vec(corner + size), kGrey);
}

std::string buttons_of(std::uint32_t buttons) {
  std::string names;
  for (int i = 0; i < 32; ++i) {
    if ((buttons >> i & 1U) != 0) names += fmt::format("{}{}", names.empty() ? "" : ", ", i);
  }
  return names.empty() ? "none" : names;
}

std::vector<PlotLine> three_lines(const ReadingsHistory& history, Channel first) {
  const auto channel = [&](int i) {
    return history.values(static_cast<Channel>(static_cast<int>(first) + i));
  };
  return {{"x", kBlue, channel(0)}, {"y", kGreen, channel(1)}, {"z", kVermillion, channel(2)}};
}

std::vector<Plot> plots_of(const ReadingsHistory& history, double rate_hz) {
  std::vector<Plot> plots(4);
  plots[0].title = "Position, mm";
  plots[0].lines = three_lines(history, Channel::x);
  plots[0].scale = scale_for(plots[0].lines, {-5.0, 10.0}, kValueTicks);
  plots[1].title = "Force on the hand, N";
  plots[1].lines = three_lines(history, Channel::force_x);
  plots[1].scale = scale_for(plots[1].lines, {-0.2, 0.8}, kValueTicks);
  plots[2].title = "Rate, ticks per second";
  plots[2].lines = {{"over 0.1 s", kBlue, history.rates_hz()}};
  plots[2].scale = scale_for(plots[2].lines, {0.0, 1.2 * rate_hz}, kValueTicks);
  plots[3].title = "Lateness of ticks, µs";
  plots[3].lines = {{"worst between two pictures", kBlue, history.values(Channel::late)}};
  plots[3].scale = decades_for(plots[3].lines, {0.1, 1000.0});
  plots[3].time_labels = true;
  return plots;
}

void draw_plots(const std::vector<Plot>& plots, float height, float density) {
  const float spacing = ImGui::GetStyle().ItemSpacing.y;
  const float labels = ImGui::GetTextLineHeight();
  const auto count = static_cast<float>(plots.size());
  const float each = (height - labels - (count - 1.0F) * spacing) / count;
  for (const Plot& plot : plots) {
    draw_plot(plot, ImGui::GetContentRegionAvail().x, each + (plot.time_labels ? labels : 0.0F),
              density);
  }
}

}  // namespace

ReadingsWindow::ReadingsWindow(device::PointerExchange& exchange)
    : exchange_(exchange), window_({"Touchtrial: device test", 1200, 800}) {
  window_.on_stop_key([this] { stop_asked_ = true; });
}

ReadingsWindow::~ReadingsWindow() {
  exchange_.publish({{}, false, true, 0});
}

void ReadingsWindow::draw(const LiveReadings& now, const ReadingsHistory& history) {
  const float density = window_.density();
  window_.begin_frame();
  begin_canvas(window_.size(), density);
  draw_state(now.phase, density);
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float left = std::min(kLeftWidth * density, room.x * 0.4F);
  ImGui::BeginChild("plane", {left, room.y});
  // The facts below the plane need the rest of the height.
  draw_plane(now, {left, std::max(room.y - kFactsHeight * density, 120.0F * density)});
  draw_facts(now);
  ImGui::EndChild();
  ImGui::SameLine(0.0F, 20.0F * density);
  ImGui::BeginChild("plots", {0.0F, room.y});
  draw_plots(plots_of(history, now.rate_hz), room.y, density);
  ImGui::EndChild();
  ImGui::End();
  ImGui::PopStyleColor();
  window_.end_frame();
}

/// The plane of a mouse has its true size on the screen; other planes fit the view.
void ReadingsWindow::draw_plane(const LiveReadings& now, Vec2 size) {
  const float density = window_.density();
  const double bar = 18.0 * static_cast<double>(density);
  const ImVec2 cursor = ImGui::GetCursorScreenPos();
  const Vec2 corner = {cursor.x, cursor.y};
  const Vec2 view = {size.x - 1.5 * bar, size.y};
  const bool is_mouse = now.device.name == device::kMouseDriver;
  Vec2 least_mm;
  Vec2 end_mm = kUnnamedEndMm;
  if (const auto& workspace = now.device.workspace) {
    least_mm = {workspace->least_mm.x, workspace->least_mm.y};
    end_mm = {workspace->greatest_mm.x, workspace->greatest_mm.y};
  }
  const Vec2 span_mm = end_mm - least_mm;
  mm_per_unit_ =
      is_mouse ? window_.mm_per_unit() : std::max(span_mm.x / view.x, span_mm.y / view.y);
  origin_ = is_mouse ? corner : corner + 0.5 * view - (0.5 / mm_per_unit_) * (least_mm + end_mm);
  const Vec3 position_mm = now.newest.sample.position_mm;
  // In a device's own frame, y points upwards.
  const double y_mm = now.device.workspace ? least_mm.y + end_mm.y - position_mm.y : position_mm.y;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(imgui_vec(corner), imgui_vec(corner + view), kWhite);
  list.AddRect(imgui_vec(corner), imgui_vec(corner + view), kGrey);
  list.PushClipRect(imgui_vec(corner), imgui_vec(corner + view), true);
  draw_stylus(at({position_mm.x, y_mm}), position_mm.z < 0.0, true, density);
  list.PopClipRect();
  draw_height(list, corner + Vec2{view.x + 0.5 * bar, 0.0}, {bar, view.y}, position_mm.z, density);
  ImGui::InvisibleButton("plane", imgui_vec(view));
  const bool is_pressed = ImGui::IsItemActive();
  if (!ImGui::IsMousePosValid()) return;
  // A pointer outside the plane counts as a hand at its edge.
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Vec2 pointer = {std::clamp(static_cast<double>(mouse.x), corner.x, corner.x + view.x),
                        std::clamp(static_cast<double>(mouse.y), corner.y, corner.y + view.y)};
  exchange_.publish({mm_per_unit_ * (pointer - origin_), is_pressed, false, 0});
}

void ReadingsWindow::draw_facts(const LiveReadings& now) const {
  const device::DeviceInfo& device = now.device;
  const Vec3 p = now.newest.sample.position_mm;
  const Vec3 f = now.newest.force_n;
  std::string text = device.model.empty() ? device.name : device.model;
  if (!device.serial.empty()) text += ", serial " + device.serial;
  text += fmt::format("\nposition  {:.1f}  {:.1f}  {:.1f} mm\nforce  {:.2f}  {:.2f}  {:.2f} N\n",
                      p.x, p.y, p.z, f.x, f.y, f.z);
  text += fmt::format("speed  {:.0f} mm/s\nbuttons down  {}", norm(now.newest.sample.velocity_mm_s),
                      buttons_of(now.newest.sample.buttons));
  if (device.visual) text += "\nvisual, not blind: hold the left button to touch the plane";
  if (device.visual && !window_.scale_is_known()) {
    text += "\ntrue size unknown: measure the screen with touchtrial screen calibrate";
  }
  ImGui::PushTextWrapPos(0.0F);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
}

}  // namespace touchtrial::app
