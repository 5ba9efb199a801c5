/// \file The shared Dear ImGui code of all windows: fonts, colours, and the mark of the stylus.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

struct ImFont;
struct ImVec2;

namespace touchtrial::app {

/// A colour as ImGui packs it: 0xAABBGGRR.
using PackedColour = std::uint32_t;

/// \name Colours that are distinct with any colour vision
/// Source: Okabe and Ito, "Color universal design", 2008.
///@{
inline constexpr PackedColour kBlue = 0xFFB27200;        ///< 0 114 178
inline constexpr PackedColour kVermillion = 0xFF005ED5;  ///< 213 94 0
inline constexpr PackedColour kWhite = 0xFFFFFFFF;
inline constexpr PackedColour kGrey = 0xFF6E6E6E;
inline constexpr PackedColour kPale = 0xFFE4E4E4;
///@}

/// Loads two sizes of one typeface into ImGui's current context: text, and large text for reading
/// from a distance. The typeface is DejaVu Sans or a similar installed one, otherwise ImGui's
/// built-in one, enlarged.
/// \param density  as ScreenScale::density, >= 1
void load_fonts(float density);

/// The index of the large text in ImGui's list of fonts; the normal text has index 0.
inline constexpr int kLargeFont = 1;

enum class FontWeight { regular, bold };

struct FontSize {
  float height = 0.0F;  ///< window units, > 0
  FontWeight weight = FontWeight::regular;
};

/// Replaces the fonts of ImGui's current context with sizes of the same typeface. They contain the
/// letters of Western European languages, and those requested letters that an installed typeface
/// has, Chinese and Japanese ones from Droid Sans Fallback or similar. Loading few letters keeps
/// the fonts' texture small.
/// \return one font for each size
std::vector<ImFont*> load_letters(std::span<const FontSize> sizes,
                                  const std::set<char32_t>& letters);

/// \param texts  UTF-8
/// \return their letters, without blanks and control characters
[[nodiscard]] std::set<char32_t> letters_in(const std::vector<std::string>& texts);

/// \throws DeviceError that lists the letters missing from all installed typefaces, and the remedy
void require_letters(const std::set<char32_t>& letters);

/// Draws the stylus into ImGui's current window: a ring, which is filled while it is pressed.
/// \param position  window units
/// \param density  as ScreenScale::density
void draw_stylus(Vec2 position, bool is_pressed, float density);

[[nodiscard]] ImVec2 imgui_vec(Vec2 point) noexcept;

}  // namespace touchtrial::app
