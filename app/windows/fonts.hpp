/// \file The letters of all windows.
#pragma once

struct ImFont;

namespace touchtrial::app {

/// Two sizes of one face in Dear ImGui's current context: text first, then what is read from afar.
/// DejaVu Sans or a face like it where one is installed, else ImGui's own, enlarged.
/// \param density  window units for each at 96 per inch, >= 1
void load_fonts(float density);

enum class FontWeight { regular, bold };

/// One more size of the same face, with the letters of Latin, Greek and Cyrillic scripts.
/// \param height  window units, > 0
ImFont* add_font(float height, FontWeight weight);

/// Index of the larger size in ImGui's list of fonts; the usual one is 0.
inline constexpr int kLargeFont = 1;

}  // namespace touchtrial::app
