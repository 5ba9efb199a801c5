#include "engine/tv_gabor/domain.hpp"

#include "engine/symmetric_extension.hpp"

#include <algorithm>

namespace touchtrial::engine {
namespace {

bool has_no_prime_factor_above_7(int n) {
  for (const int prime : {2, 3, 5, 7}) {
    while (n % prime == 0) n /= prime;
  }
  return n == 1;
}

}  // namespace

int torus_length(int n) {
  int length = n + 2 * kTorusMargin;
  length += length % 2;
  while (!has_no_prime_factor_above_7(length)) length += 2;
  return length;
}

template <typename Real>
Plane<Real> extended_to_torus(const GreyImage& image) {
  Plane<Real> torus(torus_length(image.height()), torus_length(image.width()));
  for (int y = 0; y < torus.height(); ++y) {
    const auto from = image.row(symmetric_index(y - kTorusMargin, image.height()));
    const auto to = torus.row(y);
    for (int x = 0; x < torus.width(); ++x) {
      to[x] = static_cast<Real>(from[symmetric_index(x - kTorusMargin, image.width())]);
    }
  }
  return torus;
}

template <typename Real>
Plane<Real> cropped_from_torus(const Plane<Real>& torus, int height, int width) {
  Plane<Real> image(height, width);
  for (int y = 0; y < height; ++y) {
    const auto from = torus.row(y + kTorusMargin).subspan(kTorusMargin, width);
    std::copy(from.begin(), from.end(), image.row(y).begin());
  }
  return image;
}

template Plane<float> extended_to_torus<float>(const GreyImage&);
template Plane<double> extended_to_torus<double>(const GreyImage&);
template Plane<float> cropped_from_torus<float>(const Plane<float>&, int, int);
template Plane<double> cropped_from_torus<double>(const Plane<double>&, int, int);

}  // namespace touchtrial::engine
