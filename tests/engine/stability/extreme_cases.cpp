#include "engine/stability/extreme_cases.hpp"

#include "engine/gl_texture.hpp"

#include <cmath>
#include <utility>

namespace touchtrial {
namespace {

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

ExtractionCase adaptive_case(int radius, engine::Gradient gradient, engine::Combine combine,
                             int levels) {
  engine::ExtractionOptions options;
  options.radius = radius;
  options.gradient = gradient;
  options.combine = combine;
  options.levels = levels;
  return {"adaptive, radius " + std::to_string(radius) + ", levels " + std::to_string(levels) +
              ", " + std::string(name_in(engine::kGradientNames, gradient)) + ", " +
              std::string(name_in(engine::kCombineNames, combine)),
          options, kGreyRange};
}

ExtractionCase fixed_case(double order, int radius, engine::Norm norm) {
  engine::ExtractionOptions options;
  options.method = engine::Method::fixed;
  options.order = order;
  options.radius = radius;
  options.norm = norm;
  const double sum = engine::gl_weight_sum(order, radius);
  const double additive = kGreyRange * (1.0 - sum);
  const double bound = norm == engine::Norm::additive ? additive
                       : norm == engine::Norm::sum    ? additive / sum
                                                      : additive + kGreyRange * sum;
  return {"fixed, order " + std::to_string(order) + ", radius " + std::to_string(radius) + ", " +
              std::string(name_in(engine::kNormNames, norm)),
          options, with_rounding(bound) + 1e-6};
}

void add_adaptive(std::vector<ExtractionCase>& cases) {
  for (const int radius : {1, 2, 7, engine::ExtractionOptions::kMaxRadius}) {
    cases.push_back(adaptive_case(radius, engine::Gradient::sobel, engine::Combine::sum, 1));
  }
  for (const engine::Gradient gradient :
       {engine::Gradient::sobel, engine::Gradient::prewitt, engine::Gradient::central}) {
    for (const engine::Combine combine :
         {engine::Combine::sum, engine::Combine::l2, engine::Combine::max}) {
      cases.push_back(adaptive_case(2, gradient, combine, 3));
    }
  }
  ExtractionCase unnormed = adaptive_case(2, engine::Gradient::sobel, engine::Combine::sum, 1);
  unnormed.name += ", none";
  unnormed.options.norm = engine::Norm::none;
  unnormed.largest_texture = with_rounding(2.0 * kGreyRange);
  cases.push_back(std::move(unnormed));
}

void add_fixed(std::vector<ExtractionCase>& cases) {
  for (const double order : {0.0, 1e-300, 0.5, 0.999, std::nextafter(1.0, 0.0)}) {
    for (const int radius : {1, 2, engine::ExtractionOptions::kMaxRadius}) {
      for (const engine::Norm norm :
           {engine::Norm::additive, engine::Norm::sum, engine::Norm::none}) {
        cases.push_back(fixed_case(order, radius, norm));
      }
    }
  }
}

void add_cited(std::vector<ExtractionCase>& cases) {
  for (const double sigma_px : {1e-9, 2.0, engine::ExtractionOptions::kMaxSigma_px}) {
    engine::ExtractionOptions options;
    options.method = engine::Method::gaussian;
    options.sigma_px = sigma_px;
    cases.push_back(
        {"gaussian, sigma " + std::to_string(sigma_px), options, with_rounding(kGreyRange)});
  }
  for (const double threshold_grey : {0.0, 4.0, 255.0}) {
    engine::ExtractionOptions options;
    options.method = engine::Method::median;
    options.threshold_grey = threshold_grey;
    options.radius = threshold_grey == 0.0 ? engine::ExtractionOptions::kMaxRadius : 2;
    cases.push_back({"median, threshold " + std::to_string(threshold_grey), options, kGreyRange});
  }
  for (const double divisor :
       {engine::ExtractionOptions::kMinDivisor, 4.0, engine::ExtractionOptions::kMaxDivisor}) {
    engine::ExtractionOptions options;
    options.method = engine::Method::edge;
    options.divisor = divisor;
    cases.push_back({"edge, divisor " + std::to_string(divisor), options, 127.0});
  }
  engine::ExtractionOptions options;
  options.method = engine::Method::luminance;
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
  const engine::ExtractionOptions& options = extraction.options;
  if (options.norm != engine::Norm::additive) return false;
  return options.method == engine::Method::fixed ||
         (options.method == engine::Method::adaptive && options.levels == 1);
}

GreyImage rescaled(const GreyImage& image, int divisor, int offset) {
  GreyImage result = image;
  for (std::uint8_t& sample : result.samples()) {
    sample = static_cast<std::uint8_t>(sample / divisor + offset);
  }
  return result;
}

}  // namespace touchtrial
