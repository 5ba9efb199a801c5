/// \file The makers of the default pictures, one for each label.
#pragma once

#include "core/plane.hpp"
#include "stimuli/specimen.hpp"

namespace touchtrial::stimuli {

/// Each makes a square picture of `size_px` pixels a side. The features of a texture have the same
/// size in a picture of any size; objects grow with the picture.
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
/// One grey everywhere, for any specimen.
[[nodiscard]] GreyImage make_flat(const Specimen& specimen, int size_px);

}  // namespace touchtrial::stimuli
