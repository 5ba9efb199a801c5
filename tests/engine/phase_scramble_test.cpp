#include "engine/phase_scramble.hpp"

#include "core/random.hpp"
#include "engine/example_images.hpp"
#include "engine/extraction.hpp"
#include "engine/plane_comparison.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <string>

namespace touchtrial {
namespace {

Plane<double> texture_of(Size size) {
  return engine::extract_texture<double>(cloth_image(size), {}).texture;
}

/// The mean of the k-th power of the deviation from the mean.
double moment(const Plane<double>& plane, int k) {
  const double mean = mean_of(plane);
  double sum = 0.0;
  for (const double sample : plane.samples()) sum += std::pow(sample - mean, k);
  return sum / static_cast<double>(plane.size());
}

double correlation(const Plane<double>& a, const Plane<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a.samples()[i] - mean_of(a)) * (b.samples()[i] - mean_of(b));
  }
  return sum / static_cast<double>(a.size()) / std::sqrt(moment(a, 2) * moment(b, 2));
}

/// The amplitude at one frequency, by the definition of the transform.
double amplitude(const Plane<double>& plane, int row, int column) {
  std::complex<double> sum;
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) {
      const double turns = static_cast<double>(row) * y / plane.height() +
                           static_cast<double>(column) * x / plane.width();
      sum += plane.at(y, x) * std::polar(1.0, -2.0 * std::numbers::pi * turns);
    }
  }
  return std::abs(sum);
}

/// One mark on a flat ground: an image with a strong structure.
GreyImage marked_image() {
  GreyImage image = flat_image({64, 64}, 100);
  for (int y = 20; y < 28; ++y) {
    for (int x = 30; x < 40; ++x) image.at(y, x) = 180;
  }
  return image;
}

engine::ExtractionOptions scrambled_by(engine::Method method, std::uint64_t seed) {
  return {.method = method, .control = engine::Control::phase_scrambled, .control_seed = seed};
}

}  // namespace

TEST_CASE("phase-scrambled keeps every amplitude, whatever the size") {
  for (const Size size :
       {Size{1, 2}, Size{2, 1}, Size{3, 3}, Size{4, 6}, Size{7, 10}, Size{12, 5}}) {
    INFO(size.height << " x " << size.width);
    const Plane<double> texture = converted<double>(noise_image(size));
    const Plane<double> scrambled = engine::phase_scrambled(texture, 5);
    double worst = 0.0;
    for (int row = 0; row < size.height; ++row) {
      for (int column = 0; column < size.width; ++column) {
        const double difference =
            amplitude(scrambled, row, column) - amplitude(texture, row, column);
        worst = std::max(worst, std::abs(difference));
      }
    }
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("phase-scrambled keeps mean and rms to rounding") {
  for (const Size size : {Size{1, 17}, Size{31, 1}, Size{40, 50}, Size{51, 63}}) {
    INFO(size.height << " x " << size.width);
    const Plane<double> texture = converted<double>(noise_image(size));
    const Plane<double> scrambled = engine::phase_scrambled(texture, 9);
    CHECK(mean_of(scrambled) == Approx(mean_of(texture)).epsilon(1e-13));
    CHECK(moment(scrambled, 2) == Approx(moment(texture, 2)).epsilon(1e-12));
  }
}

TEST_CASE("phase-scrambled destroys the structure") {
  const Plane<double> texture = engine::extract_texture<double>(marked_image(), {}).texture;
  const Plane<double> scrambled = engine::phase_scrambled(texture, 3);
  CHECK(std::abs(correlation(texture, scrambled)) < 0.1);
  CHECK(moment(texture, 4) / std::pow(moment(texture, 2), 2) > 20.0);
  CHECK(moment(scrambled, 4) / std::pow(moment(scrambled, 2), 2) == Approx(3.0).margin(0.5));
}

TEST_CASE("phase-scrambled keeps a flat texture exactly") {
  for (const double level : {0.0, -0.1, 55.0}) {
    const Plane<double> flat(6, 9, level);
    CHECK(engine::phase_scrambled(flat, 1) == flat);
  }
  const Plane<float> pixel(1, 1, 3.5F);
  CHECK(engine::phase_scrambled(pixel, 1) == pixel);
}

TEST_CASE("the seed determines the phases") {
  const Plane<double> texture = texture_of({24, 33});
  CHECK(engine::phase_scrambled(texture, 1) == engine::phase_scrambled(texture, 1));
  const Plane<double> noise = converted<double>(noise_image({40, 50}));
  CHECK(std::abs(correlation(engine::phase_scrambled(noise, 1),
                             engine::phase_scrambled(noise, 2))) < 0.1);
}

TEST_CASE("phase-scrambled in single precision agrees with double") {
  const Plane<double> texture = texture_of({40, 31});
  const Plane<float> single = engine::phase_scrambled(converted<float>(texture), 7);
  CHECK(largest_difference(single, engine::phase_scrambled(texture, 7)) < 1e-4);
}

TEST_CASE("an extraction's control is made from the texture of any method") {
  const GreyImage image = cloth_image({30, 42});
  for (const std::string& name : engine::method_names()) {
    INFO(name);
    const engine::Method method = *engine::method_from_name(name);
    engine::ExtractionOptions plain{.method = method};
    const Plane<double> texture = engine::extract_texture<double>(image, plain).texture;
    const auto control = engine::extract_texture<double>(image, scrambled_by(method, 11));
    CHECK(control.texture == engine::phase_scrambled(texture, 11));
    const auto single = engine::extract_texture<float>(image, scrambled_by(method, 11));
    CHECK(largest_difference(single.texture, control.texture) < 0.05);
  }
}

TEST_CASE("picture, force and enhanced image of an extraction are those of its control") {
  const GreyImage image = cloth_image({30, 42});
  const engine::ExtractionOptions options = scrambled_by(engine::Method::adaptive, 2);
  engine::Extraction<float> result =
      engine::extract_texture<float>(image, {}, engine::RequestedPlanes::all());
  const Plane<float> order = result.order;
  engine::extract_texture_into(image, options, engine::RequestedPlanes::all(), result);
  CHECK(result.picture == engine::texture_picture(result.texture));
  CHECK(result.force.x == engine::tangential_force(result.texture, 3).x);
  CHECK(result.enhanced.at(4, 5) == static_cast<float>(image.at(4, 5)) + result.texture.at(4, 5));
  CHECK(result.order == order);
}

}  // namespace touchtrial
