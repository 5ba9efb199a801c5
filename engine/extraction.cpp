#include "engine/extraction.hpp"

#include "engine/cited_textures.hpp"
#include "engine/daub4.hpp"
#include "engine/finite_plane.hpp"
#include "engine/gl_texture.hpp"
#include "engine/kernels/float_extraction.hpp"
#include "engine/order_map.hpp"
#include "engine/phase_scramble.hpp"
#include "engine/tv_gabor/tv_gabor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchtrial::engine {
namespace {

constexpr int kForceNeighbourhood = 3;

/// \param orders  one order, or a plane of orders at half resolution
template <typename Orders>
Plane<double> normalised_texture(const GreyImage& image, const ExtractionOptions& options,
                                 const Orders& orders) {
  Plane<double> texture = gl_texture<double>(image, options.radius, orders);
  apply_norm(options.norm, image, options.radius, orders, texture);
  return texture;
}

std::vector<SubBands> sub_band_levels(const GreyImage& image, int levels) {
  std::vector<SubBands> bands;  // an initializer list would be copied
  bands.push_back(daub4_sub_bands(image));
  while (static_cast<int>(bands.size()) < levels) {
    bands.push_back(daub4_sub_bands(bands.back().ll));
  }
  return bands;
}

/// CSGV at half resolution. Frees the sub-bands as early as possible.
/// \param keep_sub_bands  whether to copy the sub-bands of the first level to `result`
template <typename Real>
Plane<double> half_gradient(const GreyImage& image, const ExtractionOptions& options,
                            bool keep_sub_bands, Extraction<Real>& result) {
  const std::vector<SubBands> levels = sub_band_levels(image, options.levels);
  if (keep_sub_bands) {
    result.sub_band_ll = converted<Real>(levels.front().ll);
    result.sub_band_lh = converted<Real>(levels.front().lh);
    result.sub_band_hl = converted<Real>(levels.front().hl);
    result.sub_band_hh = converted<Real>(levels.front().hh);
  }
  return composite_gradient(levels, options.gradient, options.combine);
}

template <typename Real>
Extraction<Real> adaptive_extraction(const GreyImage& image, const ExtractionOptions& options,
                                     const RequestedPlanes& requested) {
  Extraction<Real> result;
  const Plane<double> gradient = half_gradient(image, options, requested.sub_bands, result);
  if (requested.csgv) result.csgv = doubled<Real>(gradient, image.height(), image.width());
  const Plane<double> orders = order_map(gradient);
  if (requested.order) result.order = doubled<Real>(orders, image.height(), image.width());
  result.texture = options.norm == Norm::additive
                       ? gl_texture<Real>(image, options.radius, orders)
                       : converted<Real>(normalised_texture(image, options, orders));
  return result;
}

template <typename Real>
Extraction<Real> fixed_extraction(const GreyImage& image, const ExtractionOptions& options,
                                  const RequestedPlanes& requested) {
  Extraction<Real> result;
  if (requested.order) {
    result.order = Plane<Real>(image.height(), image.width(), static_cast<Real>(options.order));
  }
  result.texture = converted<Real>(normalised_texture(image, options, options.order));
  return result;
}

template <typename Real>
Extraction<Real> extract_by_tv_gabor(const GreyImage& image, const TvGaborOptions& options,
                                     const RequestedPlanes& requested) {
  TvGaborResult<Real> decomposition = tv_gabor<Real>(image, options);
  Extraction<Real> result;
  result.texture = std::move(decomposition.texture);
  if (requested.cartoon) result.cartoon = std::move(decomposition.cartoon);
  result.components = std::move(decomposition.components);
  result.gap = decomposition.gap;
  result.steps = decomposition.steps;
  result.converged = decomposition.converged;
  return result;
}

template <typename Real>
Extraction<Real> texture_only(Plane<Real> texture) {
  Extraction<Real> result;
  result.texture = std::move(texture);
  return result;
}

template <typename Real>
Extraction<Real> extract_by_method(const GreyImage& image, const ExtractionOptions& options,
                                   const RequestedPlanes& requested) {
  switch (options.method) {
    case Method::fixed:
      return fixed_extraction<Real>(image, options, requested);
    case Method::tv_gabor:
      return extract_by_tv_gabor<Real>(image, options.tv_gabor, requested);
    case Method::gaussian:
      return texture_only<Real>(gaussian_texture<Real>(image, options.sigma_px));
    case Method::median:
      return texture_only<Real>(
          median_texture<Real>(image, options.radius, options.threshold_grey));
    case Method::edge:
      return texture_only<Real>(edge_texture<Real>(image, options.divisor));
    case Method::luminance:
      return texture_only<Real>(luminance_texture<Real>(image));
    case Method::adaptive:
      break;
  }
  return adaptive_extraction<Real>(image, options, requested);
}

/// Tries the kernels, which exist for the default adaptive and fixed methods in single precision.
/// The other code computes in double precision, and tests compare the kernels with it.
/// \return whether a kernel computed the result
bool try_kernel(const GreyImage&, const ExtractionOptions&, const RequestedPlanes&,
                Extraction<double>&) {
  return false;
}
bool try_kernel(const GreyImage& image, const ExtractionOptions& options,
                const RequestedPlanes& requested, Extraction<float>& result) {
  if (options.norm != Norm::additive) return false;
  if (options.method == Method::fixed) {
    extract_fixed(image, options.radius, options.order, requested, result);
    return true;
  }
  const bool is_default_gradient =
      options.gradient == Gradient::sobel && options.combine == Combine::sum && options.levels == 1;
  if (options.method != Method::adaptive || !is_default_gradient) return false;
  extract_adaptive(image, options.radius, requested, result);
  return true;
}

/// Adds requested by-products common to all methods, unless the method computed them.
template <typename Real>
void add_by_products(const GreyImage& image, const RequestedPlanes& requested,
                     Extraction<Real>& result) {
  if (requested.picture && result.picture.empty()) result.picture = texture_picture(result.texture);
  result.force = {};
  if (requested.force) result.force = tangential_force(result.texture, kForceNeighbourhood);
  result.enhanced = requested.enhanced ? converted<Real>(image) : Plane<Real>();
  for (std::size_t i = 0; i < result.enhanced.size(); ++i) {
    result.enhanced.samples()[i] += result.texture.samples()[i];
  }
}

/// The planes that the method must compute: the control provides the others.
RequestedPlanes planes_of_method(const ExtractionOptions& options, RequestedPlanes requested) {
  if (options.control != Control::none) requested.picture = requested.force = false;
  return requested;
}

/// Takes a double for both precisions: in float, 128 + T itself would be rounded, creating false
/// ties.
std::uint8_t rounded_to_grey(double level) {
  return static_cast<std::uint8_t>(std::clamp(std::floor(level + 0.5), 0.0, 255.0));
}

template <typename Real, typename LevelOf>
GreyImage picture_from(const Plane<Real>& texture, LevelOf level_of) {
  GreyImage picture(texture.height(), texture.width());
  std::ranges::transform(texture.samples(), picture.samples().begin(), [&](Real sample) {
    return rounded_to_grey(level_of(static_cast<double>(sample)));
  });
  return picture;
}

template <typename Real>
GreyImage stretched_picture(const Plane<Real>& texture) {
  const auto [min, max] = std::ranges::minmax_element(texture.samples());
  const auto low = static_cast<double>(*min);
  const double range = static_cast<double>(*max) - low;
  if (!(range > 0.0)) return GreyImage(texture.height(), texture.width());
  return picture_from(texture, [=](double sample) { return (sample - low) * 255.0 / range; });
}

}  // namespace

template <typename Real>
void apply_control(const ExtractionOptions& options, Plane<Real>& texture) {
  if (options.control == Control::none) return;
  texture = phase_scrambled(texture, options.control_seed);
}

template <typename Real>
void extract_texture_into(const GreyImage& image, const ExtractionOptions& options,
                          const RequestedPlanes& requested, Extraction<Real>& result) {
  check_options(options);
  if (image.empty()) throw std::invalid_argument("extract_texture: the image is empty");
  const RequestedPlanes method_planes = planes_of_method(options, requested);
  if (!try_kernel(image, options, method_planes, result)) {
    result = extract_by_method<Real>(image, options, method_planes);
  }
  apply_control(options, result.texture);
  add_by_products(image, requested, result);
}

template <typename Real>
Extraction<Real> extract_texture(const GreyImage& image, const ExtractionOptions& options,
                                 const RequestedPlanes& requested) {
  Extraction<Real> result;
  extract_texture_into(image, options, requested, result);
  return result;
}

template <typename Real>
GreyImage texture_picture(const Plane<Real>& texture, Mapping mapping) {
  if (texture.empty()) throw std::invalid_argument("texture_picture: the texture is empty");
  require_finite(texture, "texture_picture", "texture");
  switch (mapping) {
    case Mapping::abs:
      return picture_from(texture, [](double sample) { return std::abs(sample); });
    case Mapping::stretch:
      return stretched_picture(texture);
    case Mapping::offset:
      break;
  }
  return picture_from(texture, [](double sample) { return 128.0 + sample; });
}

template void apply_control<float>(const ExtractionOptions&, Plane<float>&);
template void apply_control<double>(const ExtractionOptions&, Plane<double>&);
template void extract_texture_into<float>(const GreyImage&, const ExtractionOptions&,
                                          const RequestedPlanes&, Extraction<float>&);
template void extract_texture_into<double>(const GreyImage&, const ExtractionOptions&,
                                           const RequestedPlanes&, Extraction<double>&);
template Extraction<float> extract_texture<float>(const GreyImage&, const ExtractionOptions&,
                                                  const RequestedPlanes&);
template Extraction<double> extract_texture<double>(const GreyImage&, const ExtractionOptions&,
                                                    const RequestedPlanes&);
template GreyImage texture_picture<float>(const Plane<float>&, Mapping);
template GreyImage texture_picture<double>(const Plane<double>&, Mapping);

}  // namespace touchtrial::engine
