#include "analysis/paper/paper_measures.hpp"

#include "engine/daub4.hpp"
#include "engine/extraction.hpp"
#include "engine/metrics/ssim.hpp"

#include <cmath>

namespace touchtrial::analysis {
namespace {

double power_of(const Plane<double>& plane) {
  double sum = 0.0;
  for (const double sample : plane.samples()) sum += sample * sample;
  return sum;
}

TextureStrength strength_of(const Plane<double>& texture) {
  const double power = power_of(texture);
  if (power == 0.0) return {};
  const engine::SubBands bands = engine::daub4_sub_bands(texture);
  const double fine = power_of(bands.lh) + power_of(bands.hl) + power_of(bands.hh);
  return {std::sqrt(power / static_cast<double>(texture.size())),
          fine / (fine + power_of(bands.ll))};
}

Plane<double> extracted_texture(const GreyImage& image, const engine::ExtractionOptions& options) {
  return engine::extract_texture<double>(image, options).texture;
}

engine::GlcmTable table_of_reading(const GreyImage& image, const TableReading& reading) {
  engine::ExtractionOptions options;
  options.norm = reading.norm;
  options.radius = reading.radius;
  return engine::glcm_statistics(
      engine::texture_picture(extracted_texture(image, options), reading.mapping));
}

MeasuredPicture measures_of_picture(const PaperPicture& picture,
                                    const std::function<void()>& step) {
  MeasuredPicture measures{.name = picture.name,
                           .evaluation = engine::evaluate_image(picture.image, true, step)};
  for (std::size_t i = 0; i < kPaperOrders.size(); ++i) {
    engine::ExtractionOptions options;
    options.method = engine::Method::fixed;
    options.order = kPaperOrders[i];
    measures.fixed[i] = strength_of(extracted_texture(picture.image, options));
  }
  measures.adaptive = strength_of(extracted_texture(picture.image, {}));
  for (std::size_t i = 0; i < kTableReadings.size(); ++i) {
    measures.readings[i] = table_of_reading(picture.image, kTableReadings[i]);
  }
  return measures;
}

MethodMeasures measures_of_methods(const PaperPicture& picture) {
  engine::ExtractionOptions options;
  options.method = engine::Method::tv_gabor;
  const Plane<double> adaptive = extracted_texture(picture.image, {});
  const Plane<double> tv_gabor = extracted_texture(picture.image, options);
  return {
      picture.name, strength_of(adaptive), strength_of(tv_gabor),
      engine::ms_ssim<double>(engine::texture_picture(adaptive), engine::texture_picture(tv_gabor))
          .unit};
}

}  // namespace

PaperMeasures measure_for_paper(std::span<const PaperPicture> pictures,
                                std::span<const PaperPicture> compared,
                                const PaperProgress& progress) {
  const int steps = static_cast<int>(pictures.size()) * (engine::kSweptOrders + 1) +
                    static_cast<int>(compared.size());
  int finished = 0;
  const auto step = [&] {
    ++finished;
    if (progress) progress(finished, steps);
  };
  PaperMeasures measures;
  for (const PaperPicture& one : pictures) {
    measures.pictures.push_back(measures_of_picture(one, step));
    step();
  }
  for (const PaperPicture& one : compared) {
    measures.compared.push_back(measures_of_methods(one));
    step();
  }
  return measures;
}

double implied_deviation(double contrast, double correlation) {
  return correlation < 1.0 ? std::sqrt(contrast / (2.0 * (1.0 - correlation))) : 0.0;
}

}  // namespace touchtrial::analysis
