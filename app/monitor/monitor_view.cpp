#include "app/monitor/monitor_view.hpp"

#include "app/monitor/palette.hpp"
#include "app/monitor/plane_view.hpp"
#include "app/monitor/plot.hpp"
#include "app/windows/fonts.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

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
  // A long line is made to fit rather than cut.
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
  bool wall = picture.wall_on;
  if (ImGui::Checkbox("wall: z = 0, 0.4 N/mm, at most 1 N", &wall)) requests.wall = wall;
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
  if (picture.device.visual) line("visual, not blind: demonstration and pilot sessions alone");
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
  // What is said below it needs this much room.
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
