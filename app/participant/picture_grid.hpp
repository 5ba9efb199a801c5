/// \file Pictures of the originals beside each other, in true size where there is room.
#pragma once

#include "app/participant/canvas.hpp"
#include "app/participant/screen.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

/// Where pictures lie, and how large they are.
struct PictureGrid {
  std::vector<Box> pictures;
  double shown = 1.0;  ///< of their true size, at most 1
};

/// Rows that leave the pictures largest; of equals the fewest rows.
/// \param sizes  in window units, true to scale
/// \param below  window units that each picture needs below it
[[nodiscard]] PictureGrid lay_out_pictures(const std::vector<Vec2>& sizes, const Box& area,
                                           double gap, double below);

/// A bar of 10 mm of the pictures' scale, and what that scale is.
void draw_scale_bar(Canvas& canvas, const Box& room, const ScreenContext& context, double shown);

}  // namespace touchtrial::app
