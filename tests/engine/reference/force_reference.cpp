#include "engine/reference/force_reference.hpp"

#include "core/vec.hpp"

#include <cmath>

namespace touchtrial::reference {
namespace {

bool is_inside(const Plane<double>& surface, int y, int x) {
  return y >= 0 && x >= 0 && y < surface.height() && x < surface.width();
}

/// |G_i - G_j| / d along the unit vector from the brighter to the darker pixel.
Vec2 pair_force(double here, double there, int dy, int dx) {
  const double distance = std::sqrt(static_cast<double>(dx * dx + dy * dy));
  const double magnitude = std::abs(here - there) / distance;
  const Vec2 towards_neighbour = {dx / distance, dy / distance};
  return here > there ? magnitude * towards_neighbour : (-magnitude) * towards_neighbour;
}

}  // namespace

engine::ForceField<double> tangential_force(const Plane<double>& surface, int neighbourhood) {
  const int reach = (neighbourhood - 1) / 2;
  engine::ForceField<double> force{Plane<double>(surface.height(), surface.width()),
                                   Plane<double>(surface.height(), surface.width())};
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      Vec2 sum;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          if ((dx == 0 && dy == 0) || !is_inside(surface, y + dy, x + dx)) continue;
          sum = sum + pair_force(surface.at(y, x), surface.at(y + dy, x + dx), dy, dx);
        }
      }
      force.x.at(y, x) = sum.x;
      force.y.at(y, x) = sum.y;
    }
  }
  return force;
}

}  // namespace touchtrial::reference
