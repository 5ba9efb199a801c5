/// \file Symmetric extension by its definition: i mod 2n, mirrored if it is >= n.
#pragma once

#include "core/plane.hpp"

namespace touchtrial::reference {

inline int mirrored(int i, int n) {
  const int wrapped = ((i % (2 * n)) + 2 * n) % (2 * n);
  return wrapped >= n ? 2 * n - 1 - wrapped : wrapped;
}

/// The sample of the endlessly mirrored plane.
template <typename Sample>
double mirrored_sample(const Plane<Sample>& plane, int y, int x) {
  return static_cast<double>(plane.at(mirrored(y, plane.height()), mirrored(x, plane.width())));
}

}  // namespace touchtrial::reference
