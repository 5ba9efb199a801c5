#include "engine/force_field.hpp"

#include "engine/finite_plane.hpp"
#include "engine/kernels/strips.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>

namespace touchtrial::engine {
namespace {

/// Adds the forces from the existing neighbours at (dy, dx) to one row of forces.
template <typename Real>
void add_neighbours(std::span<const Real> row, std::span<const Real> neighbours, int dy, int dx,
                    std::span<Real> force_x, std::span<Real> force_y) {
  const double squared_distance = double{1} * dx * dx + double{1} * dy * dy;
  const auto weight_x = static_cast<Real>(dx / squared_distance);
  const auto weight_y = static_cast<Real>(dy / squared_distance);
  const int width = static_cast<int>(row.size());
  const int end = std::min(width, width - dx);
  for (int x = std::max(0, -dx); x < end; ++x) {
    const Real difference = row[x] - neighbours[x + dx];
    force_x[x] += difference * weight_x;
    force_y[x] += difference * weight_y;
  }
}

}  // namespace

template <typename Real>
ForceField<Real> tangential_force(const Plane<Real>& surface, int neighbourhood) {
  if (surface.empty()) throw std::invalid_argument("tangential_force: the surface is empty");
  if (neighbourhood < 3 || neighbourhood % 2 == 0) {
    throw std::invalid_argument("neighbourhood: must be odd and at least 3");
  }
  require_finite(surface, "tangential_force", "surface");
  const int reach_y = std::min(neighbourhood / 2, surface.height() - 1);
  const int reach_x = std::min(neighbourhood / 2, surface.width() - 1);
  ForceField<Real> force{Plane<Real>(surface.height(), surface.width()),
                         Plane<Real>(surface.height(), surface.width())};
  for_each_strip(surface.height(), surface.width(), [&](Rows strip) {
    for (int y = strip.first; y < strip.last; ++y) {
      const int first = std::max(-reach_y, -y);
      const int last = std::min(reach_y, surface.height() - 1 - y);
      for (int dy = first; dy <= last; ++dy) {
        for (int dx = -reach_x; dx <= reach_x; ++dx) {
          if (dx == 0 && dy == 0) continue;
          add_neighbours<Real>(surface.row(y), surface.row(y + dy), dy, dx, force.x.row(y),
                               force.y.row(y));
        }
      }
    }
  });
  return force;
}

template ForceField<float> tangential_force<float>(const Plane<float>&, int);
template ForceField<double> tangential_force<double>(const Plane<double>&, int);

}  // namespace touchtrial::engine
