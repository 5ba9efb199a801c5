/// \file The figures of the source paper, drawn for any pictures.
#pragma once

#include "analysis/paper/paper_measures.hpp"
#include "analysis/report/figures/figure.hpp"
#include "analysis/report/page/document.hpp"

#include <span>

namespace touchtrial::analysis {

/// Maximum side of the shown part of a picture.
inline constexpr int kShownSide_px = 100;

/// Figs. 1 and 4 and the two tables of pictures, as SVG with embedded PNG pictures and labels.
struct PaperPictures {
  Picture orders;   ///< Fig. 1, Table 2: the middle of each picture, and of its textures
  Picture forces;   ///< Fig. 4: the first picture
  Picture methods;  ///< Table 3: whole pictures, and the middle of their textures
};

/// Extracts the textures and draws them.
/// \param pictures  at least one
/// \throws std::invalid_argument if a picture is empty
[[nodiscard]] PaperPictures paper_pictures(std::span<const PaperPicture> pictures,
                                           std::span<const PaperPicture> compared);

/// Fig. 3: entropy and MS-SSIM over the fixed order.
[[nodiscard]] Figure order_figure(std::span<const MeasuredPicture> pictures);

}  // namespace touchtrial::analysis
