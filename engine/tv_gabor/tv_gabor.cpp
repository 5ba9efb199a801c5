#include "engine/tv_gabor/tv_gabor.hpp"

#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/solver.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace touchtrial::engine {
namespace {

/// Frequency range of components, cycles per pixel. Lower frequencies are shading, higher ones
/// mostly the pixel grid.
constexpr double kLowestPeakFrequency = 0.04;
constexpr double kHighestPeakFrequency = 0.45;

/// The size from which all cores are used.
constexpr std::size_t kMinPixelsParallel = std::size_t{1} << 20U;

/// sin^2(pi (n + 0.5) / N).
std::vector<double> hann_window(int length) {
  std::vector<double> window(static_cast<std::size_t>(length));
  for (int n = 0; n < length; ++n) {
    const double s = std::sin(std::numbers::pi * (n + 0.5) / length);
    window[static_cast<std::size_t>(n)] = s * s;
  }
  return window;
}

void fill_windowed(const GreyImage& image, std::span<double> plane) {
  const double mean = std::accumulate(image.samples().begin(), image.samples().end(), 0.0) /
                      static_cast<double>(image.size());
  const std::vector<double> along_y = hann_window(image.height());
  const std::vector<double> along_x = hann_window(image.width());
  std::size_t i = 0;
  for (const double weight_y : along_y) {
    for (const double weight_x : along_x) {
      plane[i] = weight_y * weight_x * (image.samples()[i] - mean);
      ++i;
    }
  }
}

GaborComponent component_at(double frequency_x, double frequency_y) {
  const double degrees = std::atan2(frequency_y, frequency_x) * 180.0 / std::numbers::pi;
  return {std::hypot(frequency_x, frequency_y), degrees < 0.0 ? degrees + 180.0 : degrees};
}

bool has_peak_frequency(const GaborComponent& component) {
  return component.frequency_cycles_per_px >= kLowestPeakFrequency &&
         component.frequency_cycles_per_px <= kHighestPeakFrequency;
}

/// The result without cartoon and components.
template <typename Real, typename Precision>
TvGaborResult<Real> result_of(const TvGaborSolver<Precision>& solver, SolverStop stop) {
  return {converted<Real>(solver.texture()), {}, {}, solver.gap(), solver.steps(),
          stop == SolverStop::converged};
}

/// Solves in float as far as its precision allows, then continues in double. The texture's rounding
/// enters the multiplier at every step, and limits the gap for images with large smooth parts,
/// where gradients are small.
template <typename Real>
TvGaborResult<Real> solve(const GreyImage& image, const TvGaborOptions& options) {
  const int jobs = image.size() >= kMinPixelsParallel ? 0 : 1;
  if constexpr (std::is_same_v<Real, double>) {
    TvGaborSolver<double> solver(image, options, jobs);
    return result_of<double>(solver, solver.run(options.max_steps, Patience::unlimited));
  } else {
    auto solver = std::make_optional<TvGaborSolver<float>>(image, options, jobs);
    const SolverStop stop = solver->run(options.max_steps, Patience::limited);
    if (stop != SolverStop::stalled) return result_of<float>(*solver, stop);
    const TvGaborState<float> state = solver->state();
    solver.reset();  // frees memory for the larger planes in double
    TvGaborSolver<double> double_solver(image, options, jobs, state);
    return result_of<float>(double_solver,
                            double_solver.run(options.max_steps, Patience::unlimited));
  }
}

}  // namespace

GaborComponent strongest_component(const GreyImage& image) {
  if (image.empty()) throw std::invalid_argument("strongest_component: the image is empty");
  const int height = image.height();
  const int width = image.width();
  RealFft<double> fft(height, width);
  fill_windowed(image, fft.plane());
  fft.forward();
  std::optional<GaborComponent> strongest;
  double max_power = -1.0;
  std::size_t i = 0;
  for (int y = 0; y < height; ++y) {
    const double frequency_y = static_cast<double>(2 * y <= height ? y : y - height) / height;
    for (int x = 0; x <= width / 2; ++x, ++i) {
      const GaborComponent component = component_at(static_cast<double>(x) / width, frequency_y);
      const double power = std::norm(fft.spectrum()[i]);
      if (!has_peak_frequency(component) || power <= max_power) continue;
      max_power = power;
      strongest = component;
    }
  }
  if (!strongest) {
    throw std::invalid_argument("components: auto needs an image of 3 px or more, not " +
                                std::to_string(width) + " x " + std::to_string(height));
  }
  return *strongest;
}

template <typename Real>
TvGaborResult<Real> tv_gabor(const GreyImage& image, const TvGaborOptions& options) {
  if (image.empty()) throw std::invalid_argument("tv_gabor: the image is empty");
  TvGaborResult<Real> result;
  if (is_flat(image)) {
    result.texture = Plane<Real>(image.height(), image.width());
  } else {
    TvGaborOptions explicit_options = options;
    if (options.automatic) explicit_options.components = {strongest_component(image)};
    result = solve<Real>(image, explicit_options);
    result.components = std::move(explicit_options.components);
  }
  result.cartoon = converted<Real>(image);
  for (std::size_t i = 0; i < image.size(); ++i) {
    result.cartoon.samples()[i] -= result.texture.samples()[i];
  }
  return result;
}

template TvGaborResult<float> tv_gabor<float>(const GreyImage&, const TvGaborOptions&);
template TvGaborResult<double> tv_gabor<double>(const GreyImage&, const TvGaborOptions&);

}  // namespace touchtrial::engine
