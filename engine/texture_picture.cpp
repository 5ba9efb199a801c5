#include "engine/extraction.hpp"
#include "engine/finite_plane.hpp"
#include "engine/kernels/field_rows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace touchtrial::engine {
namespace {

constexpr int kMidGrey = 128;

/// In double for either precision: float would round 128 + T on to ties.
std::uint8_t rounded_to_grey(double level) {
  return static_cast<std::uint8_t>(std::clamp(std::floor(level + 0.5), 0.0, 255.0));
}

template <typename Real, typename LevelOf>
GreyImage picture_by(const Plane<Real>& texture, LevelOf level_of) {
  GreyImage picture(texture.height(), texture.width());
  std::transform(
      texture.samples().begin(), texture.samples().end(), picture.samples().begin(),
      [&](Real sample) { return rounded_to_grey(level_of(static_cast<double>(sample))); });
  return picture;
}

GreyImage offset_picture(const Plane<double>& texture) {
  return picture_by(texture, [](double sample) { return kMidGrey + sample; });
}

GreyImage offset_picture(const Plane<float>& texture) {
  GreyImage picture(texture.height(), texture.width());
  for (int y = 0; y < texture.height(); ++y) {
    picture_row(texture.row(y).data(), texture.width(), picture.row(y).data());
  }
  return picture;
}

template <typename Real>
GreyImage stretched(const Plane<Real>& texture) {
  const auto [least, most] =
      std::minmax_element(texture.samples().begin(), texture.samples().end());
  const auto low = static_cast<double>(*least);
  const double range = static_cast<double>(*most) - low;
  if (!(range > 0.0)) return GreyImage(texture.height(), texture.width());
  return picture_by(texture, [=](double sample) { return (sample - low) * 255.0 / range; });
}

template <typename Real>
void check(const Plane<Real>& texture, const std::string& caller) {
  if (texture.empty()) throw std::invalid_argument(caller + ": the texture is empty");
  require_finite(texture, caller, "texture");
}

}  // namespace

template <typename Real>
GreyImage texture_picture(const Plane<Real>& texture, Mapping mapping) {
  check(texture, "texture_picture");
  switch (mapping) {
    case Mapping::abs:
      return picture_by(texture, [](double sample) { return std::abs(sample); });
    case Mapping::stretch:
      return stretched(texture);
    case Mapping::offset:
      break;
  }
  return offset_picture(texture);
}

template <typename Real>
Plane<Real> texture_surface(const Plane<Real>& texture) {
  check(texture, "texture_surface");
  Plane<Real> surface = texture;
  for (Real& sample : surface.samples()) sample += kMidGrey;
  return surface;
}

template GreyImage texture_picture<float>(const Plane<float>&, Mapping);
template GreyImage texture_picture<double>(const Plane<double>&, Mapping);
template Plane<float> texture_surface<float>(const Plane<float>&);
template Plane<double> texture_surface<double>(const Plane<double>&);

}  // namespace touchtrial::engine
