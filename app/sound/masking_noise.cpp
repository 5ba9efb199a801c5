#include "app/sound/masking_noise.hpp"

#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace touchtrial::app {
namespace {

constexpr int kOctaves = 16;
constexpr std::size_t kSamples = std::size_t{1} << 18;

/// The slowest row takes four steps in a loop.
std::vector<double> sum_of_steps(RandomStream& random) {
  std::vector<double> sum(kSamples);
  for (int octave = 0; octave <= kOctaves; ++octave) {
    const std::size_t hold = std::size_t{1} << octave;
    for (std::size_t first = 0; first < kSamples; first += hold) {
      const double step = random.uniform(-1.0, 1.0);
      for (std::size_t i = first; i < first + hold; ++i) sum[i] += step;
    }
  }
  return sum;
}

}  // namespace

std::vector<float> masking_noise(double level_dbfs, std::uint64_t seed) {
  RandomStream random(seed, "masking noise");
  const std::vector<double> sum = sum_of_steps(random);
  double mean = 0.0;
  for (const double value : sum) mean += value;
  mean /= static_cast<double>(kSamples);
  double power = 0.0;
  for (const double value : sum) power += (value - mean) * (value - mean);
  const double rms = std::sqrt(power / static_cast<double>(kSamples));
  const double wanted = std::pow(10.0, std::min(level_dbfs, kHighestMaskingDbfs) / 20.0);
  std::vector<float> noise(kSamples);
  for (std::size_t i = 0; i < kSamples; ++i) {
    noise[i] = static_cast<float>((sum[i] - mean) * wanted / rms);
  }
  return noise;
}

}  // namespace touchtrial::app
