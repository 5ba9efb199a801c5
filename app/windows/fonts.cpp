#include "app/windows/fonts.hpp"

#include <array>
#include <filesystem>
#include <string>

#include <imgui.h>

namespace touchtrial::app {
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
  options.OversampleH = 1;  // large letters need no more, and the atlas stays small
  ImFont* font =
      ImGui::GetIO().Fonts->AddFontFromFileTTF(face.c_str(), height, &options, kLetters.data());
  return font != nullptr ? font : add_own(height);
}

}  // namespace touchtrial::app
