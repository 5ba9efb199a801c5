/// \file Small pictures in rows and columns, combined into one picture.
#pragma once

#include "analysis/report/page/document.hpp"
#include "core/bytes.hpp"
#include "engine/pictures/force_arrows.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A grid of PNG files.
struct Tiles {
  std::vector<std::string> titles;  ///< of the columns
  std::vector<std::string> labels;  ///< of the rows; empty: none
  std::vector<std::vector<Bytes>> cells;
  int side_px = 104;  ///< of a cell, in CSS pixels
};

/// \param id,caption,alt  of the picture
[[nodiscard]] Picture picture_of_tiles(std::string id, std::string caption, std::string alt,
                                       const Tiles& tiles);

/// The middle of a patch.
/// \param side_px  maximum width and height
[[nodiscard]] engine::ArrowPatch middle_of_patch(engine::ArrowPatch patch, int side_px);

}  // namespace touchtrial::analysis
