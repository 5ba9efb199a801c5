#include "engine/extraction.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial {
namespace {

constexpr int kMidGrey = 128;

/// In double for either precision: float would round 128 + T on to ties.
std::uint8_t rounded_to_grey(double texture) {
  const double level = std::floor(kMidGrey + texture + 0.5);
  return static_cast<std::uint8_t>(std::fmin(std::fmax(level, 0.0), 255.0));  // NaN becomes 0
}

template <typename Real>
void refuse_empty(const Plane<Real>& texture) {
  if (texture.empty()) throw std::invalid_argument("the texture is empty");
}

}  // namespace

template <typename Real>
GreyImage texture_picture(const Plane<Real>& texture) {
  refuse_empty(texture);
  GreyImage picture(texture.height(), texture.width());
  std::transform(texture.samples().begin(), texture.samples().end(), picture.samples().begin(),
                 [](Real sample) { return rounded_to_grey(sample); });
  return picture;
}

template <typename Real>
Plane<Real> texture_surface(const Plane<Real>& texture) {
  refuse_empty(texture);
  Plane<Real> surface = texture;
  for (Real& sample : surface.samples()) sample += kMidGrey;
  return surface;
}

template GreyImage texture_picture<float>(const Plane<float>&);
template GreyImage texture_picture<double>(const Plane<double>&);
template Plane<float> texture_surface<float>(const Plane<float>&);
template Plane<double> texture_surface<double>(const Plane<double>&);

}  // namespace touchtrial
