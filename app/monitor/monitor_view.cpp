#include "app/monitor/monitor_view.hpp"

#include "app/device_words.hpp"
#include "app/monitor/plot.hpp"
#include "app/windows/look.hpp"
#include "device/mouse/mouse_device.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

/// The end of the square view of devices that name no workspace; it covers the simulated hand's
/// path.
constexpr Vec2 kUnnamedEndMm = {80.0, 80.0};
/// The greatest height that the bar beside the plane shows, mm.
constexpr double kHighestMm = 10.0;

/// The visible part of the plane, and its place on the screen.
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

/// The plane of a mouse has its true size on the screen; other planes fit the view.
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
    // In a device's own frame, y points upwards.
    sight.y_up = true;
    least_mm = {workspace->least_mm.x, workspace->least_mm.y};
    end_mm = {workspace->greatest_mm.x, workspace->greatest_mm.y};
  }
  sight.middle_mm = 0.5 * (least_mm + end_mm);
  sight.mm_per_unit = std::max((end_mm.x - least_mm.x) / size.x, (end_mm.y - least_mm.y) / size.y);
  return sight;
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

void take_pointer(const Sight& sight, Vec2 corner, Vec2 size, MonitorRequests& requests) {
  ImGui::InvisibleButton("plane", imgui_vec(size));
  requests.pressed = ImGui::IsItemActive();
  if (!ImGui::IsMousePosValid()) return;
  // A pointer outside the plane counts as a hand at its edge.
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Vec2 end = corner + size;
  requests.pointer_mm = sight.mm_at({std::clamp(static_cast<double>(mouse.x), corner.x, end.x),
                                     std::clamp(static_cast<double>(mouse.y), corner.y, end.y)});
}

/// Draws the stylus from the front of the plane and its height beside it, at ImGui's cursor. Takes
/// the pointer as the position of a mouse.
/// \param width,height  window units
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
  list.AddRectFilled(at, imgui_vec(corner + size), kWhite);
  list.AddRect(at, imgui_vec(corner + size), kGrey);
  const Vec3 position_mm = picture.newest.sample.position_mm;
  list.PushClipRect(at, imgui_vec(corner + size), true);
  draw_stylus(sight.at(position_mm), position_mm.z < 0.0, picture.running, density);
  list.PopClipRect();
  draw_height(list, corner + Vec2{size.x + gap, 0.0}, {bar, size.y}, position_mm.z, density);
  take_pointer(sight, corner, size, requests);
  const std::string caption = fmt::format("{:.0f} x {:.0f} mm; bar: z, -10 to 10 mm",
                                          size.x * sight.mm_per_unit, size.y * sight.mm_per_unit);
  ImGui::TextColored({0.43F, 0.43F, 0.43F, 1.0F}, "%s", caption.c_str());
}

constexpr int kValueTicks = 4;
constexpr float kLeftWidth = 330.0F;
constexpr float kFactsHeight = 290.0F;

PackedColour colour_of(StateTone tone) {
  switch (tone) {
    case StateTone::running:
      return kGreen;
    case StateTone::waiting:
      return kBlue;
    case StateTone::fault:
      return kVermillion;
    case StateTone::stopped:
      break;
  }
  return kGrey;
}

void draw_state(const StateLine& state, float width, float density) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = 48.0F * density;
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + width, at.y + height},
                                            colour_of(state.tone));
  ImFont* font = ImGui::GetIO().Fonts->Fonts[kLargeFont];
  // A long line is scaled down to fit.
  const float wide = font->CalcTextSizeA(font->FontSize, width * 8.0F, 0.0F, state.text.c_str()).x;
  const float size = font->FontSize * std::min(1.0F, (width - 32.0F * density) / wide);
  ImGui::GetWindowDrawList()->AddText(font, size,
                                      {at.x + 16.0F * density, at.y + (height - size) / 2.0F},
                                      kWhite, state.text.c_str());
  ImGui::Dummy({width, height});
}

bool draw_button(const char* label, bool enabled, float width, float height) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label, {width, height});
  ImGui::EndDisabled();
  return pressed;
}

void draw_controls(const MonitorPicture& picture, float width, float density,
                   MonitorRequests& requests) {
  const float height = 40.0F * density;
  const float half = (width - ImGui::GetStyle().ItemSpacing.x) / 2.0F;
  ImGui::PushStyleColor(ImGuiCol_Button, kVermillion);
  ImGui::PushStyleColor(ImGuiCol_Text, kWhite);
  requests.stop = draw_button("Stop (space)", picture.running, half, height);
  ImGui::PopStyleColor(2);
  ImGui::SameLine();
  requests.resume = draw_button("Resume", !picture.running, half, height);
  if (picture.needs_reset) {
    requests.calibrate = draw_button("The arm is at its reset position", true, width, height);
  }
  bool wall = picture.wall_on;
  const std::string label =
      fmt::format("wall: z = 0, {:.2g} N/mm, at most 1 N", picture.wall_n_per_mm);
  if (ImGui::Checkbox(label.c_str(), &wall)) requests.wall = wall;
}

std::string buttons_of(std::uint32_t buttons) {
  std::string names;
  for (int i = 0; i < 32; ++i) {
    if ((buttons >> i & 1U) != 0) names += fmt::format("{}{}", names.empty() ? "" : ", ", i);
  }
  return names.empty() ? "none" : names;
}

std::string device_name(const device::DeviceInfo& device) {
  std::string name = device.model.empty() ? device.name : device.model;
  if (!device.serial.empty()) name += ", serial " + device.serial;
  return name;
}

void draw_facts(const MonitorPicture& picture) {
  const device::ServoState& now = picture.newest;
  const auto vector = [](Vec3 v, const char* format) {
    return fmt::format(fmt::runtime(format), v.x, v.y, v.z);
  };
  ImGui::PushTextWrapPos(0.0F);
  const auto line = [](const std::string& text) { ImGui::TextUnformatted(text.c_str()); };
  line(device_name(picture.device));
  if (picture.device.visual) line("visual, not blind: for demonstration and pilot sessions only");
  line("position  " + vector(now.sample.position_mm, "{:.1f}  {:.1f}  {:.1f} mm"));
  line("force  " + vector(now.force_n, "{:.2f}  {:.2f}  {:.2f} N"));
  line(fmt::format("speed  {:.0f} mm/s", norm(now.sample.velocity_mm_s)));
  line("buttons down  " + buttons_of(now.sample.buttons));
  for (const std::string& note : picture.notes) line(note);
  ImGui::PopTextWrapPos();
}

std::vector<PlotLine> three_lines(const MonitorHistory& history, Channel first) {
  const auto channel = [&](int i) {
    return history.values(static_cast<Channel>(static_cast<int>(first) + i));
  };
  return {{"x", kBlue, channel(0)}, {"y", kGreen, channel(1)}, {"z", kVermillion, channel(2)}};
}

std::vector<Plot> plots_of(const MonitorPicture& picture) {
  const MonitorHistory& history = *picture.history;
  std::vector<Plot> plots(4);
  plots[0].title = "Position, mm";
  plots[0].lines = three_lines(history, Channel::x);
  plots[0].scale = scale_for(plots[0].lines, {-5.0, 10.0}, kValueTicks);
  plots[1].title = "Force on the hand, N";
  plots[1].lines = three_lines(history, Channel::force_x);
  plots[1].scale = scale_for(plots[1].lines, {-0.2, 0.8}, kValueTicks);
  plots[2].title = "Rate, ticks per second";
  plots[2].lines = {{"over 0.1 s", kBlue, history.rates_hz()}};
  plots[2].scale = scale_for(plots[2].lines, {0.0, 1.2 * picture.rate_hz}, kValueTicks);
  plots[3].title = "Lateness of ticks, µs";
  plots[3].lines = {{"worst between two pictures", kBlue, history.lateness_us()}};
  plots[3].scale = decades_for(plots[3].lines, {0.1, 1000.0});
  plots[3].time_labels = true;
  return plots;
}

void draw_plots(const MonitorPicture& picture, float width, float height, float density) {
  const std::vector<Plot> plots = plots_of(picture);
  const float spacing = ImGui::GetStyle().ItemSpacing.y;
  const float labels = ImGui::GetTextLineHeight();
  const auto count = static_cast<float>(plots.size());
  const float each = (height - labels - (count - 1.0F) * spacing) / count;
  for (const Plot& plot : plots) {
    draw_plot(plot, width, each + (plot.time_labels ? labels : 0.0F), density);
  }
}

void begin_canvas(Vec2 size, float density) {
  ImGui::StyleColorsLight();
  ImGui::GetStyle().WindowPadding = {12.0F * density, 12.0F * density};
  ImGui::GetStyle().ItemSpacing = {8.0F * density, 8.0F * density};
  ImGui::GetStyle().FrameRounding = 3.0F * density;
  ImGui::PushStyleColor(ImGuiCol_WindowBg, 0xFFFAFAFA);
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize({static_cast<float>(size.x), static_cast<float>(size.y)});
  ImGui::Begin("monitor", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
}

}  // namespace

StateLine state_line(const MonitoredState& state) {
  if (state.ended && state.ended->end == device::ServoEnd::fault) {
    return {StateTone::fault, "Fault: " + fault_in_words(*state.ended) + ". Force is zero."};
  }
  if (state.ended) {
    const bool by_person = state.ended->end == device::ServoEnd::comfort_stop;
    return {StateTone::stopped,
            by_person ? "Stopped. Force is zero." : "Ended: the hand has stopped. Force is zero."};
  }
  if (state.readiness != device::DeviceReadiness::ready) {
    return {StateTone::waiting, "Waiting: " + readiness_in_words(state.readiness) + "."};
  }
  if (!state.ready) return {StateTone::waiting, "Waiting: the device is not ready. Force is zero."};
  if (!state.wall_on) return {StateTone::running, "Running without force."};
  if (state.wall_waits) {
    return {StateTone::running, "Running. The wall waits until the stylus is in front of it."};
  }
  return {StateTone::running, "Running, wall on."};
}

MonitorRequests draw_monitor(GlfwWindow& window, const MonitorPicture& picture) {
  const float density = window.density();
  MonitorRequests requests;
  begin_canvas(window.size(), density);
  draw_state(picture.state, ImGui::GetContentRegionAvail().x, density);
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float left = std::min(kLeftWidth * density, room.x * 0.4F);
  ImGui::BeginChild("controls", {left, room.y});
  const float inside = ImGui::GetContentRegionAvail().x;
  draw_controls(picture, inside, density, requests);
  // The facts below the plane need the rest of the height.
  const float plane = room.y - (90.0F + kFactsHeight) * density;
  draw_plane(picture, window, inside,
             std::clamp(plane, 120.0F * density, std::max(inside, 120.0F * density)), requests);
  draw_facts(picture);
  ImGui::EndChild();
  ImGui::SameLine(0.0F, 20.0F * density);
  ImGui::BeginChild("plots", {0.0F, room.y});
  draw_plots(picture, ImGui::GetContentRegionAvail().x, room.y, density);
  ImGui::EndChild();
  ImGui::End();
  ImGui::PopStyleColor();
  return requests;
}

}  // namespace touchtrial::app
