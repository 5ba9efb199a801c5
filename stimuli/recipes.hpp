/// \file The functions that draw the default pictures, one per label.
#pragma once

#include "core/plane.hpp"
#include "stimuli/specimen.hpp"

namespace touchtrial::stimuli {

/// Each draws a square picture with a side of `size_px` pixels. Texture features do not depend on
/// that size; objects scale with it.
[[nodiscard]] GreyImage make_bark(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_cloth(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_pebbles(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_straw(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_brick(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_basket(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_leaf(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_shell(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_log(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_wicker(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_venation(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_ribs(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_endgrain(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_sand(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_leather(const Specimen& specimen, int size_px);
[[nodiscard]] GreyImage make_cork(const Specimen& specimen, int size_px);
/// Uniform grey, for any specimen.
[[nodiscard]] GreyImage make_flat(const Specimen& specimen, int size_px);

}  // namespace touchtrial::stimuli
