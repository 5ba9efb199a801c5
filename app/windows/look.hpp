/// \file What all windows share of Dear ImGui: fonts, colours, the mark of the stylus, and the turn
/// to draw.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <mutex>

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
inline constexpr PackedColour kGreen = 0xFF739E00;       ///< 0 158 115
inline constexpr PackedColour kBlack = 0xFF202020;
inline constexpr PackedColour kWhite = 0xFFFFFFFF;
inline constexpr PackedColour kGrey = 0xFF6E6E6E;
inline constexpr PackedColour kPale = 0xFFE4E4E4;
///@}

/// Loads two sizes of one typeface into ImGui's current context: text, then large text that is read
/// from a distance. The typeface is DejaVu Sans or a similar one that is installed, else ImGui's
/// own, enlarged.
/// \param density  as GlfwWindow::density, >= 1
void load_fonts(float density);

/// The index of the large text in ImGui's list of fonts; that of the text is 0.
inline constexpr int kLargeFont = 1;

enum class FontWeight { regular, bold };

/// Loads one more size of the same typeface, with Latin, Greek and Cyrillic letters.
/// \param height  window units, > 0
ImFont* add_font(float height, FontWeight weight);

/// Draws the stylus into ImGui's current window: a ring, which is filled while the stylus is
/// pressed, and grey where nobody moves it.
/// \param at  window units
/// \param density  as GlfwWindow::density
void draw_stylus(Vec2 at, bool pressed, bool is_live, float density);

[[nodiscard]] ImVec2 imgui_vec(Vec2 point) noexcept;

/// Where two threads draw, each holds this from setting ImGui's context until rendering ends,
/// because ImGui keeps its current context in one variable of the program. Not held while a thread
/// waits for its screen.
[[nodiscard]] std::mutex& imgui_turn();

}  // namespace touchtrial::app
