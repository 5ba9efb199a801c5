#include "engine/reference/extraction_reference.hpp"

#include "engine/reference/mirror.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace touchtrial::reference {
namespace {

std::array<double, 4> taps(Tap tap) {
  const double s = std::sqrt(3.0);
  const double norm = 4.0 * std::sqrt(2.0);
  const std::array<double, 4> h = {(1 + s) / norm, (3 + s) / norm, (3 - s) / norm, (1 - s) / norm};
  if (tap == Tap::low) return h;
  return {h[3], -h[2], h[1], -h[0]};
}

double sobel_norm(const Plane<double>& band, int y, int x) {
  static constexpr int kSmooth[3] = {1, 2, 1};
  static constexpr int kSlope[3] = {-1, 0, 1};
  double gx = 0.0;
  double gy = 0.0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const double sample = mirrored_sample(band, y + j - 1, x + i - 1);
      gx += kSmooth[j] * kSlope[i] * sample;
      gy += kSlope[j] * kSmooth[i] * sample;
    }
  }
  return std::sqrt(gx * gx + gy * gy);
}

/// The sum over rays and distances of |c_k| (centre - sample) / 8.
double difference_at(const GreyImage& image, int y, int x, double order, int radius) {
  static constexpr int kDirections[8][2] = {{0, 1}, {0, -1}, {1, 0},  {-1, 0},
                                            {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  double sum = 0.0;
  double c = 1.0;
  for (int k = 1; k <= radius; ++k) {
    c *= (k - 1 - order) / k;
    for (const auto& direction : kDirections) {
      const double sample = mirrored_sample(image, y + k * direction[0], x + k * direction[1]);
      sum += std::abs(c) * (image.at(y, x) - sample) / 8.0;
    }
  }
  return sum;
}

using Mask = std::array<std::array<double, 3>, 3>;

/// The mask along x; along y it is transposed.
Mask mask_of(const std::string& gradient) {
  if (gradient == "sobel") return {{{-1, 0, 1}, {-2, 0, 2}, {-1, 0, 1}}};
  if (gradient == "prewitt") return {{{-1, 0, 1}, {-1, 0, 1}, {-1, 0, 1}}};
  return {{{0, 0, 0}, {-0.5, 0, 0.5}, {0, 0, 0}}};
}

Plane<double> gradient_norm(const Plane<double>& plane, const std::string& gradient) {
  const Mask mask = mask_of(gradient);
  Plane<double> norm(plane.height(), plane.width());
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) {
      double gx = 0.0;
      double gy = 0.0;
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t i = 0; i < 3; ++i) {
          const double sample =
              mirrored_sample(plane, y + static_cast<int>(j) - 1, x + static_cast<int>(i) - 1);
          gx += mask[j][i] * sample;
          gy += mask[i][j] * sample;
        }
      }
      norm.at(y, x) = std::sqrt(gx * gx + gy * gy);
    }
  }
  return norm;
}

/// Every sample four times, cropped to the size of the level above.
Plane<double> doubled(const Plane<double>& plane, int height, int width) {
  Plane<double> large(height, width);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) large.at(y, x) = plane.at(y / 2, x / 2);
  }
  return large;
}

/// The gradient norms of the details of this level and of all deeper levels, at this plane's size.
std::vector<Plane<double>> norms_below(const Plane<double>& plane, int levels,
                                       const std::string& gradient) {
  const Plane<double> low = sub_band(plane, Tap::low, Tap::low);
  std::vector<Plane<double>> norms;
  if (levels == 1) {
    norms.push_back(gradient_norm(low, gradient));
  } else {
    norms = norms_below(low, levels - 1, gradient);
  }
  norms.push_back(gradient_norm(sub_band(plane, Tap::low, Tap::high), gradient));
  norms.push_back(gradient_norm(sub_band(plane, Tap::high, Tap::low), gradient));
  norms.push_back(gradient_norm(sub_band(plane, Tap::high, Tap::high), gradient));
  for (Plane<double>& norm : norms) norm = doubled(norm, plane.height(), plane.width());
  return norms;
}

double combined(const std::vector<double>& values, const std::string& combine) {
  double sum = 0.0;
  double squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  if (combine == "sum") return sum;
  return combine == "l2" ? std::sqrt(squares) : *std::max_element(values.begin(), values.end());
}

Plane<double> by_pixels(const GreyImage& image, const std::function<double(int, int)>& value) {
  Plane<double> plane(image.height(), image.width());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) plane.at(y, x) = value(y, x);
  }
  return plane;
}

/// R_k, the mean of the ring at distance k.
double ring_mean(const GreyImage& image, int y, int x, int k) {
  double sum = 0.0;
  for (int dy = -k; dy <= k; dy += k) {
    for (int dx = -k; dx <= k; dx += k) {
      if (dy != 0 || dx != 0) sum += mirrored_sample(image, y + dy, x + dx);
    }
  }
  return sum / 8.0;
}

}  // namespace

template <typename Sample>
Plane<double> sub_band(const Plane<Sample>& plane, Tap along_x, Tap along_y) {
  const auto filter_x = taps(along_x);
  const auto filter_y = taps(along_y);
  Plane<double> band((plane.height() + 1) / 2, (plane.width() + 1) / 2);
  for (int y = 0; y < band.height(); ++y) {
    for (int x = 0; x < band.width(); ++x) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          band.at(y, x) += filter_y[static_cast<std::size_t>(j)] *
                           filter_x[static_cast<std::size_t>(i)] *
                           mirrored_sample(plane, 2 * y + j, 2 * x + i);
        }
      }
    }
  }
  return band;
}

template Plane<double> sub_band<std::uint8_t>(const GreyImage&, Tap, Tap);
template Plane<double> sub_band<double>(const Plane<double>&, Tap, Tap);

Plane<double> csgv(const GreyImage& image) {
  const std::vector<Plane<double>> bands = {
      sub_band(image, Tap::low, Tap::low), sub_band(image, Tap::low, Tap::high),
      sub_band(image, Tap::high, Tap::low), sub_band(image, Tap::high, Tap::high)};
  Plane<double> sum(image.height(), image.width());
  for (int y = 0; y < sum.height(); ++y) {
    for (int x = 0; x < sum.width(); ++x) {
      for (const Plane<double>& band : bands) sum.at(y, x) += sobel_norm(band, y / 2, x / 2);
    }
  }
  return sum;
}

Plane<double> order_map(const Plane<double>& csgv) {
  double largest = 0.0;
  for (const double value : csgv.samples()) largest = value > largest ? value : largest;
  Plane<double> orders(csgv.height(), csgv.width());
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const double value = csgv.samples()[i];
    if (value >= 2.0 && value <= 128.0) orders.samples()[i] = value / (3.0 * largest) + 0.666;
    if (value > 128.0) orders.samples()[i] = value / (2.0 * largest) + 0.499;
  }
  return orders;
}

Plane<double> texture(const GreyImage& image, const Plane<double>& orders, int radius) {
  Plane<double> result(image.height(), image.width());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      result.at(y, x) = difference_at(image, y, x, orders.at(y, x), radius);
    }
  }
  return result;
}

Plane<double> csgv(const GreyImage& image, int levels, const std::string& gradient,
                   const std::string& combine) {
  const std::vector<Plane<double>> norms = norms_below(converted<double>(image), levels, gradient);
  return by_pixels(image, [&](int y, int x) {
    std::vector<double> values;
    for (const Plane<double>& norm : norms) values.push_back(norm.at(y, x));
    return combined(values, combine);
  });
}

Plane<double> texture(const GreyImage& image, const Plane<double>& orders, int radius,
                      const std::string& norm) {
  double mean = 0.0;
  for (const std::uint8_t sample : image.samples()) mean += sample;
  mean /= static_cast<double>(image.size());
  return by_pixels(image, [&](int y, int x) {
    const double v = orders.at(y, x);
    double c = 1.0;
    double weight_sum = 1.0;
    double mask = image.at(y, x);
    for (int k = 1; k <= radius; ++k) {
      c *= (k - 1 - v) / k;
      weight_sum *= 1.0 - v / k;
      mask += c * ring_mean(image, y, x, k);
    }
    if (norm == "sum") return mask / weight_sum - image.at(y, x);
    return norm == "none" ? mask - weight_sum * mean : mask - weight_sum * image.at(y, x);
  });
}

Plane<double> gaussian_texture(const GreyImage& image, double sigma_px) {
  const int reach = static_cast<int>(std::ceil(9.0 * sigma_px));
  return by_pixels(image, [&](int y, int x) {
    double sum = 0.0;
    double weights = 0.0;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const double weight = std::exp(-(dx * dx + dy * dy) / (2.0 * sigma_px * sigma_px));
        sum += weight * mirrored_sample(image, y + dy, x + dx);
        weights += weight;
      }
    }
    return image.at(y, x) - sum / weights;
  });
}

Plane<double> median_texture(const GreyImage& image, int radius, double threshold) {
  return by_pixels(image, [&](int y, int x) {
    std::vector<double> window;
    for (int dy = -radius; dy <= radius; ++dy) {
      for (int dx = -radius; dx <= radius; ++dx) {
        window.push_back(mirrored_sample(image, y + dy, x + dx));
      }
    }
    std::sort(window.begin(), window.end());
    const double difference = image.at(y, x) - window[window.size() / 2];
    return std::abs(difference) > threshold ? difference : 0.0;
  });
}

Plane<double> edge_texture(const GreyImage& image, double divisor) {
  const Plane<double> norm = gradient_norm(converted<double>(image), "sobel");
  return by_pixels(image, [&](int y, int x) { return std::min(127.0, norm.at(y, x) / divisor); });
}

}  // namespace touchtrial::reference
