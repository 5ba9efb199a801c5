/// \file Colours that people tell apart whatever their colour vision. Source: Okabe and Ito, "Color
/// universal design", 2008.
#pragma once

#include <cstdint>

namespace touchtrial::app {

/// As ImGui packs them: 0xAABBGGRR.
using PackedColour = std::uint32_t;

inline constexpr PackedColour kBlue = 0xFFB27200;        ///< 0 114 178
inline constexpr PackedColour kVermillion = 0xFF005ED5;  ///< 213 94 0
inline constexpr PackedColour kGreen = 0xFF739E00;       ///< 0 158 115
inline constexpr PackedColour kBlack = 0xFF202020;
inline constexpr PackedColour kWhite = 0xFFFFFFFF;
inline constexpr PackedColour kGrey = 0xFF6E6E6E;
inline constexpr PackedColour kPale = 0xFFE4E4E4;

}  // namespace touchtrial::app
