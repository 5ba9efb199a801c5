#include "engine/tv_gabor/problem.hpp"

#include "engine/tv_gabor/domain.hpp"
#include "engine/tv_gabor/gabor_spectrum.hpp"
#include "engine/tv_gabor/vector_field.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

namespace touchtrial::engine {

template <typename Real>
TvGaborProblem<Real> tv_gabor_problem(const GreyImage& image, const TvGaborOptions& options) {
  const int height = torus_length(image.height());
  const int width = torus_length(image.width());
  return {extended_to_torus<Real>(image),
          converted<Real>(gabor_spectrum(options.components, height, width)), options.lambda};
}

template <typename Real>
double mean_gradient(const Plane<Real>& torus) {
  std::vector<Real> along_x(static_cast<std::size_t>(torus.width())), along_y(along_x.size());
  double sum = 0.0;
  for (int y = 0; y < torus.height(); ++y) {
    const int below = y + 1 == torus.height() ? 0 : y + 1;
    gradient_of_row<Real>(torus.row(y), torus.row(below), along_x, along_y);
    for (std::size_t x = 0; x < along_x.size(); ++x) sum += std::hypot(along_x[x], along_y[x]);
  }
  return sum / static_cast<double>(torus.size());
}

template TvGaborProblem<float> tv_gabor_problem<float>(const GreyImage&, const TvGaborOptions&);
template TvGaborProblem<double> tv_gabor_problem<double>(const GreyImage&, const TvGaborOptions&);
template double mean_gradient(const Plane<float>&);
template double mean_gradient(const Plane<double>&);

}  // namespace touchtrial::engine
