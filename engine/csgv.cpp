#include "engine/csgv.hpp"

#include "engine/gradient_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace touchtrial::engine {
namespace {

/// Takes the slopes of one row of a band into a row of the result, each sample standing for
/// 2^level of them.
void take_row(std::span<const double> slopes, int level, Combine combine, std::span<double> to) {
  for (std::size_t x = 0; x < to.size(); ++x) {
    const double slope = slopes[x >> static_cast<unsigned>(level)];
    switch (combine) {
      case Combine::sum:
        to[x] += slope;
        break;
      case Combine::l2:
        to[x] += slope * slope;
        break;
      case Combine::max:
        to[x] = std::max(to[x], slope);
        break;
    }
  }
}

class Composite {
 public:
  Composite(int height, int width, Gradient gradient, Combine combine)
      : result_(height, width), gradient_(gradient), combine_(combine) {}

  /// \param level  how many doublings the band is away from the result
  void take(const Plane<double>& band, int level) {
    GradientRows gradient(band, gradient_);
    for (int y = 0; y < band.height(); ++y) {
      const std::span<const double> slopes = gradient.row(y);
      const int end = std::min((y + 1) << level, result_.height());
      for (int i = y << level; i < end; ++i) take_row(slopes, level, combine_, result_.row(i));
    }
  }

  [[nodiscard]] Plane<double> finish() && {
    if (combine_ == Combine::l2) {
      for (double& sample : result_.samples()) sample = std::sqrt(sample);
    }
    return std::move(result_);
  }

 private:
  Plane<double> result_;
  Gradient gradient_;
  Combine combine_;
};

}  // namespace

Plane<double> composite_gradient(std::span<const SubBands> levels, Gradient gradient,
                                 Combine combine) {
  const Plane<double>& first = levels.front().ll;
  Composite composite(first.height(), first.width(), gradient, combine);
  composite.take(levels.back().ll, static_cast<int>(levels.size()) - 1);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto level = static_cast<int>(i);
    composite.take(levels[i].lh, level);
    composite.take(levels[i].hl, level);
    composite.take(levels[i].hh, level);
  }
  return std::move(composite).finish();
}

Plane<double> composite_gradient(const SubBands& bands) {
  return composite_gradient({&bands, 1}, Gradient::sobel, Combine::sum);
}

template <typename Real>
Plane<Real> doubled(const Plane<double>& half, int height, int width) {
  Plane<Real> full(height, width);
  for (int y = 0; y < height; ++y) {
    const auto from = half.row(y / 2);
    const auto to = full.row(y);
    for (int x = 0; x < width; ++x) to[x] = static_cast<Real>(from[x / 2]);
  }
  return full;
}

template Plane<float> doubled<float>(const Plane<double>&, int, int);
template Plane<double> doubled<double>(const Plane<double>&, int, int);

}  // namespace touchtrial::engine
