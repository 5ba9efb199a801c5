#include "engine/cited_textures.hpp"

#include "engine/gaussian_filter.hpp"
#include "engine/gradient_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace touchtrial::engine {
namespace {

constexpr int kReferenceGrey = 128;
constexpr double kStrongestEdge = 127.0;  // 255 in the picture

}  // namespace

template <typename Real>
Plane<Real> gaussian_texture(const GreyImage& image, double sigma_px) {
  Plane<Real> texture(image.height(), image.width());
  GaussianRows smooth(image, sigma_px);
  for (int y = 0; y < image.height(); ++y) {
    const std::span<const double> levels = smooth.row(y);
    std::transform(image.row(y).begin(), image.row(y).end(), levels.begin(), texture.row(y).begin(),
                   [](std::uint8_t grey, double level) { return static_cast<Real>(grey - level); });
  }
  return texture;
}

template <typename Real>
Plane<Real> edge_texture(const GreyImage& image, double divisor) {
  Plane<Real> texture(image.height(), image.width());
  GradientRows gradient(image, Gradient::sobel);
  for (int y = 0; y < image.height(); ++y) {
    const std::span<const double> norms = gradient.row(y);
    std::transform(norms.begin(), norms.end(), texture.row(y).begin(), [divisor](double norm) {
      return static_cast<Real>(std::min(kStrongestEdge, norm / divisor));
    });
  }
  return texture;
}

template <typename Real>
Plane<Real> luminance_texture(const GreyImage& image) {
  Plane<Real> texture(image.height(), image.width());
  std::ranges::transform(image.samples(), texture.samples().begin(), [](std::uint8_t grey) {
    return static_cast<Real>(grey - kReferenceGrey);
  });
  return texture;
}

template Plane<float> gaussian_texture<float>(const GreyImage&, double);
template Plane<double> gaussian_texture<double>(const GreyImage&, double);
template Plane<float> edge_texture<float>(const GreyImage&, double);
template Plane<double> edge_texture<double>(const GreyImage&, double);
template Plane<float> luminance_texture<float>(const GreyImage&);
template Plane<double> luminance_texture<double>(const GreyImage&);

}  // namespace touchtrial::engine
