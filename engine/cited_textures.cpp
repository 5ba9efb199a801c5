#include "engine/cited_textures.hpp"

#include "engine/gaussian_filter.hpp"
#include "engine/gradient_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace touchtrial {
namespace {

constexpr double kMidGrey = 128.0;
constexpr double kStrongestEdge = 127.0;  // 255 in the picture

}  // namespace

Plane<double> gaussian_texture(const GreyImage& image, double sigma_px) {
  Plane<double> texture = gaussian_filtered(converted<double>(image), sigma_px);
  for (std::size_t i = 0; i < texture.size(); ++i) {
    texture.samples()[i] = image.samples()[i] - texture.samples()[i];
  }
  return texture;
}

Plane<double> edge_texture(const GreyImage& image, double divisor) {
  const Plane<double> plane = converted<double>(image);
  Plane<double> texture(image.height(), image.width());
  GradientRows gradient(plane, Gradient::sobel);
  for (int y = 0; y < image.height(); ++y) {
    const std::span<const double> norms = gradient.row(y);
    std::transform(norms.begin(), norms.end(), texture.row(y).begin(),
                   [divisor](double norm) { return std::min(kStrongestEdge, norm / divisor); });
  }
  return texture;
}

Plane<double> luminance_texture(const GreyImage& image) {
  Plane<double> texture = converted<double>(image);
  for (double& sample : texture.samples()) sample -= kMidGrey;
  return texture;
}

}  // namespace touchtrial
