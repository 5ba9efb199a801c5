#include "app/windows/stylus_mark.hpp"

#include <imgui.h>

namespace touchtrial::app {

void draw_stylus(Vec2 at, bool pressed, bool is_live, float density) {
  constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255);
  const ImU32 colour = is_live ? IM_COL32(0, 70, 130, 255) : IM_COL32(130, 130, 130, 255);
  const ImVec2 centre(static_cast<float>(at.x), static_cast<float>(at.y));
  const float radius = 8.0F * density;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled(centre, radius + 2.0F * density, kWhite, 32);
  if (pressed) {
    list.AddCircleFilled(centre, radius, colour, 32);
  } else {
    list.AddCircle(centre, radius - density, colour, 32, 3.0F * density);
  }
}

}  // namespace touchtrial::app
