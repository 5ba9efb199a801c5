#include "app/windows/fonts.hpp"

#include <array>
#include <filesystem>
#include <string>

#include <imgui.h>

namespace touchtrial {
namespace {

constexpr float kTextHeight = 16.0F;
constexpr float kLargeHeight = 26.0F;

/// Where systems keep a face that is legible at small sizes.
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

std::string installed_face() {
  std::error_code unreadable;
  for (const char* face : kFaces) {
    if (std::filesystem::is_regular_file(face, unreadable)) return face;
  }
  return "";
}

}  // namespace

void load_fonts(float density) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  const std::string face = installed_face();
  for (const float height : {kTextHeight * density, kLargeHeight * density}) {
    if (!face.empty() && atlas.AddFontFromFileTTF(face.c_str(), height) != nullptr) continue;
    ImFontConfig own;
    own.SizePixels = height;
    atlas.AddFontDefault(&own);
  }
}

}  // namespace touchtrial
