#include "app/stages/drawn_console.hpp"

#include "app/windows/look.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <imgui.h>

namespace touchtrial {
namespace {

constexpr Vec2 kSize{920.0, 640.0};
constexpr int kColumns = 4;
constexpr double kGap = 10.0;

/// The box of what is drawn in the button's colour; letters do not count.
struct Area {
  double left = std::numeric_limits<double>::max();
  double top = std::numeric_limits<double>::max();
  double right = 0.0;
  double bottom = 0.0;
};

Area comfort_stop_button() {
  const ImVec2 plain = ImGui::GetIO().Fonts->TexUvWhitePixel;
  Area area;
  const ImDrawData* const drawn = ImGui::GetDrawData();
  for (int i = 0; i < drawn->CmdListsCount; ++i) {
    for (const ImDrawVert& corner : drawn->CmdLists[i]->VtxBuffer) {
      if (corner.col != app::kVermillion || corner.uv.x != plain.x) continue;
      area.left = std::min(area.left, static_cast<double>(corner.pos.x));
      area.top = std::min(area.top, static_cast<double>(corner.pos.y));
      area.right = std::max(area.right, static_cast<double>(corner.pos.x));
      area.bottom = std::max(area.bottom, static_cast<double>(corner.pos.y));
    }
  }
  if (area.right == 0.0) throw std::runtime_error("the console draws no comfort stop");
  return area;
}

}  // namespace

DrawnConsole::DrawnConsole(app::ExperimenterDesk& desk)
    : context_(ImGui::CreateContext()), panel_(desk) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {static_cast<float>(kSize.x), static_cast<float>(kSize.y)};
  app::load_fonts(1.0F);
  io.Fonts->Build();
}

DrawnConsole::~DrawnConsole() {
  ImGui::DestroyContext(context_);
}

void DrawnConsole::draw(bool is_down) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DeltaTime = 1.0F / 60.0F;
  io.MousePos = {static_cast<float>(at_.x), static_cast<float>(at_.y)};
  io.MouseDown[0] = is_down;
  ImGui::NewFrame();
  panel_.draw(kSize, 1.0F, true);
  ImGui::Render();
}

void DrawnConsole::click(app::ExperimenterAction::Kind what) {
  draw(false);
  draw(false);
  constexpr auto kStop = static_cast<int>(app::ExperimenterAction::Kind::comfort_stop);
  const Area stop = comfort_stop_button();
  const double across = stop.right - stop.left + kGap;
  const double down = stop.bottom - stop.top + kGap;
  const int index = static_cast<int>(what);
  const int row = index / kColumns;
  at_ = {(stop.left + stop.right) / 2.0 + (index % kColumns - kStop) * across,
         (stop.top + stop.bottom) / 2.0 + row * down};
  for (const bool is_down : {false, true, false, false}) draw(is_down);
}

}  // namespace touchtrial
