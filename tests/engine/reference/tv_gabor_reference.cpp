#include "engine/reference/tv_gabor_reference.hpp"

#include "engine/reference/mirror.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace touchtrial::reference {
namespace {

constexpr int kRadius = 5;

int torus_length(int n) {
  for (int length = n + 32;; ++length) {
    int rest = length;
    for (const int prime : {2, 3, 5, 7}) {
      while (rest % prime == 0) rest /= prime;
    }
    if (length % 2 == 0 && rest == 1) return length;
  }
}

Plane<double> gabor_patch(const engine::GaborComponent& component) {
  Plane<double> patch(2 * kRadius + 1, 2 * kRadius + 1);
  const double theta = component.direction_deg * std::numbers::pi / 180;
  double sum = 0.0;
  for (int y = -kRadius; y <= kRadius; ++y) {
    for (int x = -kRadius; x <= kRadius; ++x) {
      const double phase = 2 * std::numbers::pi * component.frequency_cycles_per_px *
                           (x * std::cos(theta) + y * std::sin(theta));
      const double value = std::exp(-(x * x + y * y) / (2 * 2.0 * 2.0)) * std::cos(phase);
      patch.at(y + kRadius, x + kRadius) = value;
      sum += value;
    }
  }
  for (double& value : patch.samples()) value -= sum / static_cast<double>(patch.size());
  return patch;
}

double power_at(const Plane<double>& patch, double cycles_y, double cycles_x) {
  std::complex<double> sum = 0.0;
  for (int y = 0; y < patch.height(); ++y) {
    for (int x = 0; x < patch.width(); ++x) {
      sum += std::polar(patch.at(y, x), -2 * std::numbers::pi * (cycles_y * y + cycles_x * x));
    }
  }
  return std::norm(sum);
}

/// sum over x of g(x) g(x + shift): the kernel whose spectrum is |g^|^2.
void add_autocorrelation(const Plane<double>& patch, Plane<double>& kernel) {
  for (int dy = -2 * kRadius; dy <= 2 * kRadius; ++dy) {
    for (int dx = -2 * kRadius; dx <= 2 * kRadius; ++dx) {
      for (int y = 0; y < patch.height(); ++y) {
        for (int x = 0; x < patch.width(); ++x) {
          if (y + dy < 0 || x + dx < 0 || y + dy >= patch.height() || x + dx >= patch.width()) {
            continue;
          }
          kernel.at(dy + 2 * kRadius, dx + 2 * kRadius) +=
              patch.at(y, x) * patch.at(y + dy, x + dx);
        }
      }
    }
  }
}

Plane<double> kernel_of_m(const std::vector<engine::GaborComponent>& components, int height,
                          int width) {
  Plane<double> kernel(4 * kRadius + 1, 4 * kRadius + 1);
  Plane<double> spectrum(height, width);
  for (const engine::GaborComponent& component : components) {
    const Plane<double> patch = gabor_patch(component);
    add_autocorrelation(patch, kernel);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        spectrum.at(y, x) +=
            power_at(patch, static_cast<double>(y) / height, static_cast<double>(x) / width);
      }
    }
  }
  const double largest = *std::max_element(spectrum.samples().begin(), spectrum.samples().end());
  for (double& value : kernel.samples()) value /= largest;
  return kernel;
}

Dual gradient(const Plane<double>& u) {
  Dual g{Plane<double>(u.height(), u.width()), Plane<double>(u.height(), u.width())};
  for (int y = 0; y < u.height(); ++y) {
    for (int x = 0; x < u.width(); ++x) {
      g.x.at(y, x) = u.at(y, (x + 1) % u.width()) - u.at(y, x);
      g.y.at(y, x) = u.at((y + 1) % u.height(), x) - u.at(y, x);
    }
  }
  return g;
}

Plane<double> divergence(const Dual& p) {
  const int height = p.x.height();
  const int width = p.x.width();
  Plane<double> d(height, width);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      d.at(y, x) = p.x.at(y, x) - p.x.at(y, (x + width - 1) % width) + p.y.at(y, x) -
                   p.y.at((y + height - 1) % height, x);
    }
  }
  return d;
}

double inner(const Plane<double>& a, const Plane<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a.samples()[i] * b.samples()[i];
  return sum;
}

double total_variation(const Plane<double>& u) {
  const Dual g = gradient(u);
  double sum = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    sum += std::hypot(g.x.samples()[i], g.y.samples()[i]);
  }
  return sum;
}

/// The nearest point with |p| <= 1 at one place.
void project(double& x, double& y) {
  const double norm = std::max(1.0, std::hypot(x, y));
  x /= norm;
  y /= norm;
}

}  // namespace

TvGabor::TvGabor(const GreyImage& image, const engine::TvGaborOptions& options)
    : height_(image.height()),
      width_(image.width()),
      lambda_(options.lambda),
      f_(torus_length(height_), torus_length(width_)),
      kernel_(kernel_of_m(options.components, f_.height(), f_.width())) {
  for (int y = 0; y < f_.height(); ++y) {
    for (int x = 0; x < f_.width(); ++x) f_.at(y, x) = mirrored_sample(image, y - 16, x - 16);
  }
}

Plane<double> TvGabor::apply_m(const Plane<double>& plane) const {
  const int height = plane.height();
  const int width = plane.width();
  const int reach = 2 * kRadius;
  Plane<double> wrapped(height, width + 2 * reach);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < wrapped.width(); ++x) {
      wrapped.at(y, x) = plane.at(y, (x - reach + width) % width);
    }
  }
  Plane<double> result(height, width);
  for (int y = 0; y < height; ++y) {
    const auto to = result.row(y);
    for (int dy = -reach; dy <= reach; ++dy) {
      const auto from = wrapped.row((y + dy + height) % height);
      for (int dx = -reach; dx <= reach; ++dx) {
        const double weight = kernel_.at(dy + reach, dx + reach);
        for (int x = 0; x < width; ++x) to[x] += weight * from[x + dx + reach];
      }
    }
  }
  return result;
}

Plane<double> TvGabor::texture(const Dual& p) const {
  Plane<double> v = apply_m(divergence(p));
  for (double& value : v.samples()) value /= lambda_;
  return v;
}

double TvGabor::primal(const Dual& p) const {
  const Plane<double> v = texture(p);
  Plane<double> u = f_;
  for (std::size_t i = 0; i < u.size(); ++i) u.samples()[i] -= v.samples()[i];
  const Plane<double> d = divergence(p);
  return total_variation(u) + inner(d, apply_m(d)) / (2 * lambda_);
}

double TvGabor::dual(const Dual& p) const {
  const Plane<double> d = divergence(p);
  return inner(f_, d) - inner(d, apply_m(d)) / (2 * lambda_);
}

Dual TvGabor::ascent(const Dual& p) const {
  Plane<double> inside = apply_m(divergence(p));
  for (std::size_t i = 0; i < inside.size(); ++i) {
    inside.samples()[i] -= lambda_ * f_.samples()[i];
  }
  return gradient(inside);
}

Dual TvGabor::fixed_point(int steps) const {
  const Plane<double> zero(f_.height(), f_.width());
  Dual p{zero, zero};
  for (int step = 0; step < steps; ++step) {
    const Dual w = ascent(p);
    for (std::size_t i = 0; i < zero.size(); ++i) {
      const double x = w.x.samples()[i] / 8;
      const double y = w.y.samples()[i] / 8;
      const double divisor = 1 + std::hypot(x, y);
      p.x.samples()[i] = (p.x.samples()[i] + x) / divisor;
      p.y.samples()[i] = (p.y.samples()[i] + y) / divisor;
    }
  }
  return p;
}

Dual TvGabor::fista(int steps) const {
  const Plane<double> zero(f_.height(), f_.width());
  Dual p{zero, zero};
  Dual ahead = p;
  double t = 1.0;
  for (int step = 0; step < steps; ++step) {
    const Dual w = ascent(ahead);
    const double next_t = (1 + std::sqrt(1 + 4 * t * t)) / 2;
    for (std::size_t i = 0; i < zero.size(); ++i) {
      double x = ahead.x.samples()[i] + w.x.samples()[i] / 8;
      double y = ahead.y.samples()[i] + w.y.samples()[i] / 8;
      project(x, y);
      ahead.x.samples()[i] = x + (t - 1) / next_t * (x - p.x.samples()[i]);
      ahead.y.samples()[i] = y + (t - 1) / next_t * (y - p.y.samples()[i]);
      p.x.samples()[i] = x;
      p.y.samples()[i] = y;
    }
    t = next_t;
  }
  return p;
}

Plane<double> TvGabor::cropped(const Plane<double>& torus) const {
  Plane<double> image(height_, width_);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) image.at(y, x) = torus.at(y + 16, x + 16);
  }
  return image;
}

}  // namespace touchtrial::reference
