#include "engine/extraction.hpp"

#include "engine/csgv.hpp"
#include "engine/daub4.hpp"
#include "engine/gl_texture.hpp"
#include "engine/order_map.hpp"
#include "engine/tv_gabor/tv_gabor.hpp"

#include <cstddef>
#include <stdexcept>
#include <utility>

namespace touchtrial {
namespace {

template <typename Real>
Extraction<Real> adaptive(const GreyImage& image, int radius, const WantedPlanes& wanted) {
  Extraction<Real> result;
  const SubBands bands = daub4_sub_bands(image);
  if (wanted.sub_bands) {
    result.sub_band_ll = converted<Real>(bands.ll);
    result.sub_band_lh = converted<Real>(bands.lh);
    result.sub_band_hl = converted<Real>(bands.hl);
    result.sub_band_hh = converted<Real>(bands.hh);
  }
  const Plane<double> gradient = composite_gradient(bands);
  if (wanted.csgv) result.csgv = doubled<Real>(gradient, image.height(), image.width());
  const Plane<double> orders = order_map(gradient);
  if (wanted.order) result.order = doubled<Real>(orders, image.height(), image.width());
  result.texture = gl_texture<Real>(image, radius, orders);
  return result;
}

template <typename Real>
Extraction<Real> fixed(const GreyImage& image, int radius, double order,
                       const WantedPlanes& wanted) {
  Extraction<Real> result;
  if (wanted.order) {
    result.order = Plane<Real>(image.height(), image.width(), static_cast<Real>(order));
  }
  result.texture = gl_texture<Real>(image, radius, order);
  return result;
}

template <typename Real>
Extraction<Real> by_tv_gabor(const GreyImage& image, const TvGaborOptions& options,
                             const WantedPlanes& wanted) {
  TvGaborResult<Real> decomposition = tv_gabor<Real>(image, options);
  Extraction<Real> result;
  result.texture = std::move(decomposition.texture);
  if (wanted.cartoon) result.cartoon = std::move(decomposition.cartoon);
  result.gap = decomposition.gap;
  result.steps = decomposition.steps;
  result.converged = decomposition.converged;
  return result;
}

template <typename Real>
Extraction<Real> by_method(const GreyImage& image, const ExtractionOptions& options,
                           const WantedPlanes& wanted) {
  switch (options.method) {
    case Method::fixed:
      return fixed<Real>(image, options.radius, options.order, wanted);
    case Method::tv_gabor:
      return by_tv_gabor<Real>(image, options.tv_gabor, wanted);
    case Method::adaptive:
      break;
  }
  return adaptive<Real>(image, options.radius, wanted);
}

}  // namespace

template <typename Real>
Extraction<Real> extract_texture(const GreyImage& image, const ExtractionOptions& options,
                                 const WantedPlanes& wanted) {
  check_options(options);
  if (image.empty()) throw std::invalid_argument("extract_texture: the image is empty");
  Extraction<Real> result = by_method<Real>(image, options, wanted);
  if (wanted.enhanced) {
    result.enhanced = converted<Real>(image);
    for (std::size_t i = 0; i < image.size(); ++i) {
      result.enhanced.samples()[i] += result.texture.samples()[i];
    }
  }
  return result;
}

template Extraction<float> extract_texture<float>(const GreyImage&, const ExtractionOptions&,
                                                  const WantedPlanes&);
template Extraction<double> extract_texture<double>(const GreyImage&, const ExtractionOptions&,
                                                    const WantedPlanes&);

}  // namespace touchtrial
