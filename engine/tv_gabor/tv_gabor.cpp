#include "engine/tv_gabor/tv_gabor.hpp"

#include "engine/tv_gabor/domain.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "engine/tv_gabor/spectral_peak.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace touchtrial::engine {
namespace {

bool is_flat(const GreyImage& image) {
  return std::all_of(image.samples().begin(), image.samples().end(),
                     [&](auto sample) { return sample == image.samples().front(); });
}

/// \return all but the cartoon and the components
template <typename Real, typename Precision>
TvGaborResult<Real> result_of(const TvGaborSolver<Precision>& solver, SolverStop stop,
                              const GreyImage& image) {
  const Plane<Precision> texture =
      cropped_from_torus(solver.certificate().texture, image.height(), image.width());
  return {converted<Real>(texture),     {}, {}, solver.certificate().gap, solver.steps(),
          stop == SolverStop::converged};
}

/// Float goes as far as its digits carry, double takes over if that is not far enough: rounding of
/// the texture reaches the multiplier at every step, and shows in the gap of images with large
/// smooth parts, whose gradients are small.
template <typename Real>
TvGaborResult<Real> solved(const GreyImage& image, const TvGaborOptions& options) {
  if constexpr (std::is_same_v<Real, double>) {
    TvGaborSolver<double> solver(image, options);
    return result_of<double>(solver, solver.run(options.max_steps, Patience::unlimited), image);
  } else {
    auto solver = std::make_optional<TvGaborSolver<float>>(image, options);
    const SolverStop stop = solver->run(options.max_steps, Patience::limited);
    if (stop != SolverStop::stalled) return result_of<float>(*solver, stop, image);
    const VectorField<float> z = solver->z();
    const PenaltySchedule schedule = solver->schedule();
    const int steps = solver->steps();
    solver.reset();  // before double's larger planes are there
    TvGaborSolver<double> finisher(image, options, z, schedule, steps);
    return result_of<float>(finisher, finisher.run(options.max_steps, Patience::unlimited), image);
  }
}

/// The options with the components that are meant.
TvGaborOptions resolved(const GreyImage& image, TvGaborOptions options) {
  if (options.automatic) options.components = {strongest_component(image)};
  return options;
}

}  // namespace

template <typename Real>
TvGaborResult<Real> tv_gabor(const GreyImage& image, const TvGaborOptions& options) {
  if (image.empty()) throw std::invalid_argument("tv_gabor: the image is empty");
  TvGaborResult<Real> result;
  if (is_flat(image)) {
    result.texture = Plane<Real>(image.height(), image.width());
  } else {
    TvGaborOptions explicit_options = resolved(image, options);
    result = solved<Real>(image, explicit_options);
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
