#include "app/windows/look.hpp"

#include "app/windows/text_flow.hpp"
#include "core/errors.hpp"

#include <array>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>

namespace touchtrial::app {
namespace {

constexpr float kTextHeight = 16.0F;
constexpr float kLargeHeight = 26.0F;
/// Ideographs look small beside Latin letters of the same nominal height.
constexpr float kEastAsianScale = 1.1F;

/// Paths of a typeface that is legible at small sizes, by system.
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

/// Paths of a typeface with Chinese and Japanese letters, by system.
constexpr std::array kEastAsianFaces = {
    "/usr/share/fonts/truetype/droid/DroidSansFallbackFull.ttf",
    "/usr/share/fonts/droid/DroidSansFallbackFull.ttf",
    "/usr/share/fonts/google-droid-sans-fonts/DroidSansFallbackFull.ttf",
    "/usr/share/fonts/truetype/wqy/wqy-microhei.ttc",
    "/System/Library/Fonts/Hiragino Sans GB.ttc",
    "C:/Windows/Fonts/msyh.ttc",
};

/// Western European letters; dashes and quotation marks.
constexpr std::array<ImWchar, 5> kLetters = {0x0020, 0x00FF, 0x2010, 0x203A, 0};

template <typename Faces>
std::string first_installed(const Faces& faces) {
  std::error_code unreadable;
  for (const char* face : faces) {
    if (std::filesystem::is_regular_file(face, unreadable)) return face;
  }
  return "";
}

/// Adds ImGui's built-in typeface.
ImFont* add_builtin_font(ImFontAtlas& atlas, float height) {
  ImFontConfig options;
  options.SizePixels = height;
  return atlas.AddFontDefault(&options);
}

/// The glyphs to load; must outlive the building of the atlas.
struct GlyphRanges {
  ImVector<ImWchar> ranges;
  bool east_asian = false;
};

ImFont* add_font(ImFontAtlas& atlas, const FontSize& size, const GlyphRanges& glyphs) {
  std::string face = size.weight == FontWeight::bold ? first_installed(kBoldFaces) : "";
  if (face.empty()) face = first_installed(kFaces);
  ImFontConfig options;
  options.OversampleH = 1;  // enough for large letters; keeps the atlas small
  ImFont* font = face.empty() ? nullptr
                              : atlas.AddFontFromFileTTF(face.c_str(), size.height, &options,
                                                         glyphs.ranges.Data);
  if (font == nullptr) font = add_builtin_font(atlas, size.height);
  const std::string east_asian_face = glyphs.east_asian ? first_installed(kEastAsianFaces) : "";
  if (east_asian_face.empty()) return font;
  options.MergeMode = true;  // adds only letters that the first typeface lacks
  atlas.AddFontFromFileTTF(east_asian_face.c_str(), std::round(kEastAsianScale * size.height),
                           &options, glyphs.ranges.Data);
  return font;
}

GlyphRanges glyph_ranges_for(const std::set<char32_t>& letters) {
  GlyphRanges glyphs;
  ImFontGlyphRangesBuilder builder;
  builder.AddRanges(kLetters.data());
  for (const char32_t letter : letters) {
    if (letter <= IM_UNICODE_CODEPOINT_MAX) builder.AddChar(static_cast<ImWchar>(letter));
    glyphs.east_asian = glyphs.east_asian || is_east_asian(letter);
  }
  builder.BuildRanges(&glyphs.ranges);
  return glyphs;
}

}  // namespace

void load_fonts(float density) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  const std::string face = first_installed(kFaces);
  for (const float height : {kTextHeight * density, kLargeHeight * density}) {
    if (!face.empty() && atlas.AddFontFromFileTTF(face.c_str(), height) != nullptr) continue;
    add_builtin_font(atlas, height);
  }
}

std::vector<ImFont*> load_letters(std::span<const FontSize> sizes,
                                  const std::set<char32_t>& letters) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  const GlyphRanges glyphs = glyph_ranges_for(letters);
  std::vector<ImFont*> fonts;
  for (const FontSize& size : sizes) fonts.push_back(add_font(atlas, size, glyphs));
  atlas.Build();
  return fonts;
}

std::set<char32_t> letters_in(const std::vector<std::string>& texts) {
  std::set<char32_t> letters;
  for (const std::string& text : texts) {
    for (const char32_t letter : code_points(text)) {
      if (letter > U' ') letters.insert(letter);
    }
  }
  return letters;
}

void require_letters(const std::set<char32_t>& letters) {
  constexpr float kAnyHeight = 13.0F;
  constexpr int kMaxNamed = 8;
  ImFontAtlas atlas;
  const GlyphRanges glyphs = glyph_ranges_for(letters);
  const ImFont* const font = add_font(atlas, {kAnyHeight, FontWeight::regular}, glyphs);
  atlas.Build();
  std::string missing;
  int count = 0;
  for (const char32_t letter : letters) {
    const bool is_available = letter <= IM_UNICODE_CODEPOINT_MAX &&
                              font->FindGlyphNoFallback(static_cast<ImWchar>(letter)) != nullptr;
    if (is_available) continue;
    if (++count <= kMaxNamed) missing += fmt::format(" U+{:04X}", static_cast<unsigned>(letter));
  }
  if (count == 0) return;
  if (count > kMaxNamed) missing += fmt::format(" and {} more", count - kMaxNamed);
  throw DeviceError(
      "window: no installed font has these letters of the participant's texts:" + missing +
      "; for Chinese and Japanese `sudo apt install fonts-droid-fallback`, for other "
      "letters `sudo apt install fonts-dejavu-core`");
}

ImVec2 imgui_vec(Vec2 point) noexcept {
  return {static_cast<float>(point.x), static_cast<float>(point.y)};
}

void draw_stylus(Vec2 position, bool is_pressed, float density) {
  constexpr ImU32 colour = IM_COL32(0, 70, 130, 255);
  const ImVec2 centre = imgui_vec(position);
  const float radius = 8.0F * density;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled(centre, radius + 2.0F * density, kWhite, 32);
  if (is_pressed) {
    list.AddCircleFilled(centre, radius, colour, 32);
  } else {
    list.AddCircle(centre, radius - density, colour, 32, 3.0F * density);
  }
}

}  // namespace touchtrial::app
