/// \file Planes that are used again.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::engine {

/// Gives the plane a shape; its samples are then whatever they were, or zero.
template <typename Sample>
void reshape(Plane<Sample>& plane, int height, int width) {
  if (plane.height() != height || plane.width() != width) plane = Plane<Sample>(height, width);
}

/// The same where the plane is wanted; else empties it.
template <typename Sample>
void reshape_if(bool wanted, Plane<Sample>& plane, int height, int width) {
  if (wanted) {
    reshape(plane, height, width);
  } else {
    plane = {};
  }
}

}  // namespace touchtrial::engine
