#include "engine/order_map.hpp"

#include "engine/kernels/strips.hpp"
#include "engine/symmetric_extension.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace touchtrial::engine {
namespace {

/// Image pixels per sample of its bands and CSGV.
constexpr int kPixelsPerSample = 4;

/// Combines a row of slopes with a row of the result, where each slope covers 2^level samples.
void combine_row(std::span<const double> slopes, int level, Combine combine,
                 std::span<double> result) {
  for (std::size_t x = 0; x < result.size(); ++x) {
    const double slope = slopes[x >> static_cast<unsigned>(level)];
    switch (combine) {
      case Combine::sum:
        result[x] += slope;
        break;
      case Combine::l2:
        result[x] += slope * slope;
        break;
      case Combine::max:
        result[x] = std::max(result[x], slope);
        break;
    }
  }
}

/// Combines the slopes of successive bands.
class Composite {
 public:
  Composite(int height, int width, Gradient gradient, Combine combine)
      : result_(height, width), gradient_(gradient), combine_(combine) {}

  /// \param level  number of doublings from the band's to the result's resolution
  void add(const Plane<double>& band, int level) {
    for_each_strip(band.height(), kPixelsPerSample * band.width(), [&](Rows strip) {
      GradientRows gradient(band, gradient_);
      for (int y = strip.first; y < strip.last; ++y) {
        const std::span<const double> slopes = gradient.row(y);
        const int end = std::min((y + 1) << level, result_.height());
        for (int i = y << level; i < end; ++i) combine_row(slopes, level, combine_, result_.row(i));
      }
    });
  }

  [[nodiscard]] Plane<double> finish() && {
    if (combine_ == Combine::l2) {
      for_each_strip(result_.height(), kPixelsPerSample * result_.width(), [this](Rows strip) {
        for (int y = strip.first; y < strip.last; ++y) {
          for (double& sample : result_.row(y)) sample = std::sqrt(sample);
        }
      });
    }
    return std::move(result_);
  }

 private:
  Plane<double> result_;
  Gradient gradient_;
  Combine combine_;
};

double order_at(double csgv, double max_csgv) {
  if (csgv < kFlatBelowCsgv) return 0.0;
  if (csgv <= kSteepAboveCsgv) return csgv / (3.0 * max_csgv) + 0.666;
  return csgv / (2.0 * max_csgv) + 0.499;
}

}  // namespace

template <typename Sample>
GradientRows<Sample>::GradientRows(const Plane<Sample>& plane, Gradient gradient)
    : plane_(plane),
      gradient_(gradient),
      smooth_(static_cast<std::size_t>(plane.width()) + 2),
      slope_(smooth_.size()),
      norms_(static_cast<std::size_t>(plane.width())) {}

template <typename Sample>
void GradientRows<Sample>::filter_columns(int y) {
  const auto above = plane_.row(symmetric_index(y - 1, plane_.height()));
  const auto middle = plane_.row(y);
  const auto below = plane_.row(symmetric_index(y + 1, plane_.height()));
  const double weight = gradient_ == Gradient::sobel ? 2.0 : 1.0;
  for (int x = 0; x < plane_.width(); ++x) {
    smooth(x) =
        gradient_ == Gradient::central ? middle[x] : above[x] + weight * middle[x] + below[x];
    slope(x) = below[x] - above[x];
  }
  mirror_ends(&smooth(0), plane_.width(), 1);
  mirror_ends(&slope(0), plane_.width(), 1);
}

template <typename Sample>
std::span<const double> GradientRows<Sample>::row(int y) {
  filter_columns(y);
  const double weight = gradient_ == Gradient::sobel ? 2.0 : 1.0;
  for (int x = 0; x < plane_.width(); ++x) {
    double gx = smooth(x + 1) - smooth(x - 1);
    double gy = slope(x - 1) + weight * slope(x) + slope(x + 1);
    if (gradient_ == Gradient::central) {
      gx *= 0.5;
      gy = 0.5 * slope(x);
    }
    norms_[static_cast<std::size_t>(x)] = std::sqrt(gx * gx + gy * gy);
  }
  return norms_;
}

template class GradientRows<std::uint8_t>;
template class GradientRows<double>;

Plane<double> composite_gradient(std::span<const SubBands> levels, Gradient gradient,
                                 Combine combine) {
  const Plane<double>& first_level = levels.front().ll;
  Composite composite(first_level.height(), first_level.width(), gradient, combine);
  composite.add(levels.back().ll, static_cast<int>(levels.size()) - 1);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto level = static_cast<int>(i);
    composite.add(levels[i].lh, level);
    composite.add(levels[i].hl, level);
    composite.add(levels[i].hh, level);
  }
  return std::move(composite).finish();
}

Plane<double> composite_gradient(const SubBands& bands) {
  return composite_gradient({&bands, 1}, Gradient::sobel, Combine::sum);
}

Plane<double> order_map(const Plane<double>& csgv) {
  const double max_csgv = std::ranges::max(csgv.samples());
  Plane<double> orders(csgv.height(), csgv.width());
  for_each_strip(csgv.height(), kPixelsPerSample * csgv.width(), [&](Rows strip) {
    for (int y = strip.first; y < strip.last; ++y) {
      std::ranges::transform(csgv.row(y), orders.row(y).begin(),
                             [max_csgv](double value) { return order_at(value, max_csgv); });
    }
  });
  return orders;
}

template <typename Real>
Plane<Real> doubled(const Plane<double>& half, int height, int width) {
  Plane<Real> full(height, width);
  for (int y = 0; y < height; ++y) {
    const auto half_row = half.row(y / 2);
    const auto full_row = full.row(y);
    for (int x = 0; x < width; ++x) full_row[x] = static_cast<Real>(half_row[x / 2]);
  }
  return full;
}

template Plane<float> doubled<float>(const Plane<double>&, int, int);
template Plane<double> doubled<double>(const Plane<double>&, int, int);

}  // namespace touchtrial::engine
