#include "app/windows/look.hpp"

#include <array>
#include <filesystem>
#include <string>

#include <imgui.h>

namespace touchtrial::app {
namespace {

constexpr float kTextHeight = 16.0F;
constexpr float kLargeHeight = 26.0F;

/// Where systems keep a typeface that is legible at small sizes.
constexpr std::array kFaces = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
    "/System/Library/Fonts/Supplemental/Arial.ttf",
    "C:/Windows/Fonts/segoeui.ttf",
};

constexpr std::array kBoldFaces = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf",
    "/usr/share/fonts/TTF/DejaVuSans-Bold.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans-Bold.ttf",
    "/usr/share/fonts/dejavu/DejaVuSans-Bold.ttf",
    "/usr/share/fonts/truetype/liberation/LiberationSans-Bold.ttf",
    "/usr/share/fonts/truetype/noto/NotoSans-Bold.ttf",
    "/System/Library/Fonts/Supplemental/Arial Bold.ttf",
    "C:/Windows/Fonts/segoeuib.ttf",
};

/// Latin, Greek, Cyrillic; dashes and quotation marks; arrows; mathematical signs.
constexpr std::array<ImWchar, 9> kLetters = {0x0020, 0x052F, 0x2010, 0x203A, 0x2190,
                                             0x2193, 0x2200, 0x2265, 0};

template <typename Faces>
std::string installed(const Faces& faces) {
  std::error_code unreadable;
  for (const char* face : faces) {
    if (std::filesystem::is_regular_file(face, unreadable)) return face;
  }
  return "";
}

/// ImGui's own typeface.
ImFont* add_own(float height) {
  ImFontConfig own;
  own.SizePixels = height;
  return ImGui::GetIO().Fonts->AddFontDefault(&own);
}

}  // namespace

void load_fonts(float density) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  const std::string face = installed(kFaces);
  for (const float height : {kTextHeight * density, kLargeHeight * density}) {
    if (!face.empty() && atlas.AddFontFromFileTTF(face.c_str(), height) != nullptr) continue;
    add_own(height);
  }
}

ImFont* add_font(float height, FontWeight weight) {
  std::string face = weight == FontWeight::bold ? installed(kBoldFaces) : "";
  if (face.empty()) face = installed(kFaces);
  if (face.empty()) return add_own(height);
  ImFontConfig options;
  options.OversampleH = 1;  // enough for large letters, and keeps the atlas small
  ImFont* font =
      ImGui::GetIO().Fonts->AddFontFromFileTTF(face.c_str(), height, &options, kLetters.data());
  return font != nullptr ? font : add_own(height);
}

ImVec2 imgui_vec(Vec2 point) noexcept {
  return {static_cast<float>(point.x), static_cast<float>(point.y)};
}

std::mutex& imgui_turn() {
  static std::mutex turn;
  return turn;
}

void draw_stylus(Vec2 at, bool pressed, bool is_live, float density) {
  const ImU32 colour = is_live ? IM_COL32(0, 70, 130, 255) : IM_COL32(130, 130, 130, 255);
  const ImVec2 centre = imgui_vec(at);
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
