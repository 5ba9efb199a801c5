#include "engine/csgv.hpp"

#include "engine/symmetric_extension.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace touchtrial {
namespace {

/// A row with one mirrored sample before and after it.
class FramedRow {
 public:
  explicit FramedRow(int width) : samples_(static_cast<std::size_t>(width) + 2) {}

  [[nodiscard]] double& operator[](int x) { return samples_[static_cast<std::size_t>(x + 1)]; }
  void mirror_ends() {
    samples_.front() = samples_[1];
    samples_.back() = samples_[samples_.size() - 2];
  }

 private:
  std::vector<double> samples_;
};

/// Adds the norm of the Sobel gradient of one sub-band. Differences come before sums, so that
/// equal neighbours give exactly zero.
void add_sobel_norm(const Plane<double>& band, Plane<double>& sum) {
  const int width = band.width();
  FramedRow smooth(width);  // [1 2 1] along y
  FramedRow slope(width);   // [-1 0 1] along y
  for (int y = 0; y < band.height(); ++y) {
    const auto above = band.row(symmetric_index(y - 1, band.height()));
    const auto row = band.row(y);
    const auto below = band.row(symmetric_index(y + 1, band.height()));
    for (int x = 0; x < width; ++x) {
      smooth[x] = above[x] + 2.0 * row[x] + below[x];
      slope[x] = below[x] - above[x];
    }
    smooth.mirror_ends();
    slope.mirror_ends();
    const auto to = sum.row(y);
    for (int x = 0; x < width; ++x) {
      const double gx = smooth[x + 1] - smooth[x - 1];
      const double gy = slope[x - 1] + 2.0 * slope[x] + slope[x + 1];
      to[x] += std::sqrt(gx * gx + gy * gy);
    }
  }
}

}  // namespace

Plane<double> composite_gradient(const SubBands& bands) {
  Plane<double> sum(bands.ll.height(), bands.ll.width());
  for (const Plane<double>* band : {&bands.ll, &bands.lh, &bands.hl, &bands.hh}) {
    add_sobel_norm(*band, sum);
  }
  return sum;
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

}  // namespace touchtrial
