#include "engine/stability/extreme_cases.hpp"

#include "engine/gl_texture.hpp"

#include <cmath>
#include <utility>

namespace touchtrial {
namespace {

using namespace engine;

constexpr double kGreyRange = 255.0;

GreyImage bright_pixel(Size size, int y, int x) {
  GreyImage image(size.height, size.width);
  image.at(y, x) = 255;
  return image;
}

/// A bound, plus a margin for rounding.
double with_rounding(double bound) {
  return bound * (1.0 + 1e-6);
}

ExtractionCase adaptive_case(int radius, Gradient gradient, Combine combine, int levels) {
  ExtractionOptions options{
      .radius = radius, .gradient = gradient, .combine = combine, .levels = levels};
  return {"adaptive, radius " + std::to_string(radius) + ", levels " + std::to_string(levels) +
              ", " + std::string(name_in(kGradientNames, gradient)) + ", " +
              std::string(name_in(kCombineNames, combine)),
          options, kGreyRange};
}

ExtractionCase fixed_case(double order, int radius, Norm norm) {
  ExtractionOptions options{
      .method = Method::fixed, .radius = radius, .order = order, .norm = norm};
  const double sum = gl_weight_sum(order, radius);
  const double additive = kGreyRange * (1.0 - sum);
  const double bound = norm == Norm::additive ? additive
                       : norm == Norm::sum    ? additive / sum
                                              : additive + kGreyRange * sum;
  return {"fixed, order " + std::to_string(order) + ", radius " + std::to_string(radius) + ", " +
              std::string(name_in(kNormNames, norm)),
          options, with_rounding(bound) + 1e-6};
}

void add_adaptive(std::vector<ExtractionCase>& cases) {
  for (const int radius : {1, 2, 7, ExtractionOptions::kMaxRadius}) {
    cases.push_back(adaptive_case(radius, Gradient::sobel, Combine::sum, 1));
  }
  for (const Gradient gradient : {Gradient::sobel, Gradient::prewitt, Gradient::central}) {
    for (const Combine combine : {Combine::sum, Combine::l2, Combine::max}) {
      cases.push_back(adaptive_case(2, gradient, combine, 3));
    }
  }
  ExtractionCase unnormed = adaptive_case(2, Gradient::sobel, Combine::sum, 1);
  unnormed.name += ", none";
  unnormed.options.norm = Norm::none;
  unnormed.largest_texture = with_rounding(2.0 * kGreyRange);
  cases.push_back(std::move(unnormed));
}

void add_fixed(std::vector<ExtractionCase>& cases) {
  for (const double order : {0.0, 1e-300, 0.5, 0.999, std::nextafter(1.0, 0.0)}) {
    for (const int radius : {1, 2, ExtractionOptions::kMaxRadius}) {
      for (const Norm norm : {Norm::additive, Norm::sum, Norm::none}) {
        cases.push_back(fixed_case(order, radius, norm));
      }
    }
  }
}

void add_cited(std::vector<ExtractionCase>& cases) {
  for (const double sigma_px : {1e-9, 2.0, ExtractionOptions::kMaxSigma_px}) {
    ExtractionOptions options{.method = Method::gaussian, .sigma_px = sigma_px};
    cases.push_back(
        {"gaussian, sigma " + std::to_string(sigma_px), options, with_rounding(kGreyRange)});
  }
  for (const double threshold_grey : {0.0, 4.0, 255.0}) {
    ExtractionOptions options{.method = Method::median,
                              .radius = threshold_grey == 0.0 ? ExtractionOptions::kMaxRadius : 2,
                              .threshold_grey = threshold_grey};
    cases.push_back({"median, threshold " + std::to_string(threshold_grey), options, kGreyRange});
  }
  for (const double divisor :
       {ExtractionOptions::kMinDivisor, 4.0, ExtractionOptions::kMaxDivisor}) {
    ExtractionOptions options{.method = Method::edge, .divisor = divisor};
    cases.push_back({"edge, divisor " + std::to_string(divisor), options, 127.0});
  }
  ExtractionOptions options{.method = Method::luminance};
  cases.push_back({"luminance", options, 128.0});
}

}  // namespace

const std::vector<Size>& extreme_sizes() {
  static const std::vector<Size> sizes = {{1, 1}, {1, 9}, {9, 1}, {2, 2}, {3, 5}, {33, 35}};
  return sizes;
}

std::vector<NamedImage> extreme_images(Size size) {
  return {{"black", flat_image(size, 0)},
          {"mid-grey", flat_image(size, 128)},
          {"white", flat_image(size, 255)},
          {"checkerboard", checkerboard(size)},
          {"impulse", bright_pixel(size, size.height / 2, size.width / 2)},
          {"bright corner", bright_pixel(size, 0, size.width - 1)},
          {"step", step_image(size, 0, 255)},
          {"ramp of slope 1", ramp_image(size, 1)},
          {"ramp of slope 4", ramp_image(size, 4)},
          {"noise", noise_image(size)},
          {"speckle", speckle_image(size)}};
}

const std::vector<ExtractionCase>& extraction_cases() {
  static const std::vector<ExtractionCase> cases = [] {
    std::vector<ExtractionCase> all;
    add_adaptive(all);
    add_fixed(all);
    add_cited(all);
    return all;
  }();
  return cases;
}

bool has_kernel(const ExtractionCase& extraction) {
  const ExtractionOptions& options = extraction.options;
  if (options.norm != Norm::additive) return false;
  return options.method == Method::fixed ||
         (options.method == Method::adaptive && options.levels == 1);
}

GreyImage rescaled(const GreyImage& image, int divisor, int offset) {
  GreyImage result = image;
  for (std::uint8_t& sample : result.samples()) {
    sample = static_cast<std::uint8_t>(sample / divisor + offset);
  }
  return result;
}

}  // namespace touchtrial
