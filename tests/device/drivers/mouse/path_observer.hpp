/// \file A simulated observer that sees the pointer's drawn path and names the texture.
#pragma once

#include "core/random.hpp"
#include "device/drivers/mouse/scripted_pointer.hpp"
#include "device/servo/servo.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchtrial {

/// Strokes to and fro along x, as unsteady as a hand; every seed gives another stroke.
class UnsteadyStroke {
 public:
  static constexpr double kDurationS = 4.0;

  explicit UnsteadyStroke(std::uint64_t seed) {
    RandomStream random(seed, "unsteady stroke");
    start_mm_ = {random.uniform(8.0, 16.0), random.uniform(10.0, 40.0)};
    period_s_ = random.uniform(1.6, 2.6);
    for (Wave& wave : waves_) {
      wave = {random.uniform(0.5, 3.0), random.uniform(0.0, 6.28), random.uniform(0.1, 0.5)};
    }
  }

  /// Between the edges of a plane of 50 mm.
  [[nodiscard]] Vec2 at(double time_s) const {
    const double turn = 1.0 - std::cos(2.0 * std::numbers::pi * time_s / period_s_);
    double unsteady_mm = 0.0;
    for (const Wave& wave : waves_) {
      unsteady_mm += wave.reach_mm * std::sin(6.28 * wave.rate_hz * time_s + wave.phase);
    }
    return {start_mm_.x + 14.0 * turn + unsteady_mm, start_mm_.y + 2.0 * turn};
  }

 private:
  struct Wave {
    double rate_hz = 0.0;
    double phase = 0.0;
    double reach_mm = 0.0;
  };
  Vec2 start_mm_;
  double period_s_ = 0.0;
  std::array<Wave, 3> waves_;
};

/// Features of a drawn path that tell textures apart: its displacement from the hand along x, and
/// the wavelengths of that on the plane, in six bands from 1.5 to 12 mm. Logarithms.
using PathFeatures = std::array<double, 7>;

/// One picture of the screen.
struct SeenFrame {
  double hand_mm = 0.0;       ///< the hand's place, which the observer feels
  double displaced_mm = 0.0;  ///< of the drawn stylus from the hand
};

/// Strokes a texture with a pressed pointer: the stylus as a screen draws it, 60 times a second in
/// whole pixels of 0.265 mm, once it has landed.
inline std::vector<SeenFrame> seen_frames(device::ForceSource& texture, std::uint64_t stroke_seed,
                                          const device::MouseOptions& options) {
  constexpr double kPixelMm = 0.265;
  const UnsteadyStroke stroke(stroke_seed);
  device::VirtualClock clock;
  ScriptedPointer pointer(clock, [&](double time_s) {
    return device::PointerState{stroke.at(time_s), true, false, 0};
  });
  device::MouseDevice mouse(pointer, clock, options);
  std::vector<SeenFrame> frames;
  device::DeviceSample sample;
  for (int tick = 0; tick < UnsteadyStroke::kDurationS * 1000; ++tick) {
    clock.wait_until(std::chrono::milliseconds(tick));
    if (mouse.read(sample) != device::DeviceStatus::ok) return {};
    if (mouse.write(texture.force_n(sample)) != device::DeviceStatus::ok) return {};
    if (tick < 500 || tick * 60 / 1000 == (tick - 1) * 60 / 1000) continue;
    const double hand_mm = stroke.at(tick * 1e-3).x;
    const double drawn_mm = kPixelMm * std::round(pointer.shown.position_mm.x / kPixelMm);
    frames.push_back({hand_mm, drawn_mm - hand_mm});
  }
  return frames;
}

/// The power of the displacement at a wavelength on the plane, in a window short enough for the
/// stroke to keep its direction. Source: Hann window, mean removed.
inline double power_at(std::span<const SeenFrame> window, double wavelength_mm) {
  double mean_mm = 0.0;
  for (const SeenFrame& frame : window) mean_mm += frame.displaced_mm;
  mean_mm /= static_cast<double>(window.size());
  std::complex<double> wave;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(window.size());
    const double weight = 1.0 - std::cos(2.0 * std::numbers::pi * part);
    wave += weight * (window[i].displaced_mm - mean_mm) *
            std::polar(1.0, 2.0 * std::numbers::pi * window[i].hand_mm / wavelength_mm);
  }
  return std::norm(wave);
}

inline PathFeatures features_of(std::span<const SeenFrame> frames) {
  constexpr std::size_t kWindow = 32;
  constexpr int kWavelengthsInBand = 4;
  PathFeatures features{};
  for (const SeenFrame& frame : frames) features[0] += frame.displaced_mm * frame.displaced_mm;
  for (std::size_t from = 0; from + kWindow <= frames.size(); from += kWindow / 2) {
    for (int i = 0; i < 6 * kWavelengthsInBand; ++i) {
      const double wavelength_mm = 1.5 * std::pow(8.0, (i + 0.5) / (6 * kWavelengthsInBand));
      features[1 + static_cast<std::size_t>(i / kWavelengthsInBand)] +=
          power_at(frames.subspan(from, kWindow), wavelength_mm);
    }
  }
  for (double& feature : features) feature = std::log(feature + 1e-6);
  return features;
}

/// \return the observer's features of one stroke over a texture
inline PathFeatures seen_features(device::ForceSource& texture, std::uint64_t stroke_seed,
                                  const device::MouseOptions& options = {}) {
  return features_of(seen_frames(texture, stroke_seed, options));
}

/// Means and common spread of the features of each texture.
class PathObserver {
 public:
  /// \param seen  for each texture the features of as many strokes
  explicit PathObserver(const std::vector<std::vector<PathFeatures>>& seen) {
    PathFeatures squares{};
    double strokes = 0.0;
    for (const auto& of_texture : seen) {
      means_.push_back(mean_of(of_texture));
      for (const PathFeatures& one : of_texture) {
        for (std::size_t i = 0; i < one.size(); ++i) {
          squares[i] += (one[i] - means_.back()[i]) * (one[i] - means_.back()[i]);
        }
        strokes += 1.0;
      }
    }
    for (std::size_t i = 0; i < squares.size(); ++i) spread_[i] = std::sqrt(squares[i] / strokes);
  }

  /// \return the index of the texture nearest to these features
  [[nodiscard]] std::size_t name(const PathFeatures& features) const {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t texture = 0; texture < means_.size(); ++texture) {
      double distance = 0.0;
      for (std::size_t i = 0; i < features.size(); ++i) {
        distance += std::pow((features[i] - means_[texture][i]) / (spread_[i] + 1e-9), 2.0);
      }
      if (distance < least) best = texture;
      least = std::min(least, distance);
    }
    return best;
  }

 private:
  static PathFeatures mean_of(const std::vector<PathFeatures>& all) {
    PathFeatures mean{};
    for (const PathFeatures& one : all) {
      for (std::size_t i = 0; i < mean.size(); ++i) {
        mean[i] += one[i] / static_cast<double>(all.size());
      }
    }
    return mean;
  }

  std::vector<PathFeatures> means_;
  PathFeatures spread_{};
};

/// Makes a fresh force source for a presentation of texture `index`.
using TextureMaker = std::function<std::unique_ptr<device::ForceSource>(std::size_t index)>;

/// The textures for an observer, and the seed of the first stroke over each.
struct Presentations {
  TextureMaker make;
  std::uint64_t first_stroke = 0;
};

/// The same strokes go over each texture.
/// \return the share of strokes that an observer names correctly after learning from as many others
inline double share_named_rightly(std::size_t textures, int strokes, const Presentations& to_learn,
                                  const Presentations& to_name,
                                  const device::MouseOptions& options = {}) {
  const auto features_over = [&](const Presentations& shown, std::size_t texture, int stroke) {
    return seen_features(*shown.make(texture),
                         shown.first_stroke + static_cast<std::uint64_t>(stroke), options);
  };
  std::vector<std::vector<PathFeatures>> learned(textures);
  for (std::size_t texture = 0; texture < textures; ++texture) {
    for (int stroke = 0; stroke < strokes; ++stroke) {
      learned[texture].push_back(features_over(to_learn, texture, stroke));
    }
  }
  const PathObserver observer(learned);
  int right = 0;
  for (std::size_t texture = 0; texture < textures; ++texture) {
    for (int stroke = 0; stroke < strokes; ++stroke) {
      right += observer.name(features_over(to_name, texture, stroke)) == texture;
    }
  }
  return right / static_cast<double>(strokes * static_cast<int>(textures));
}

/// The same with the strokes over which the device's settings were chosen.
inline double share_named_rightly(std::size_t textures, int strokes, const TextureMaker& make,
                                  const device::MouseOptions& options = {}) {
  return share_named_rightly(textures, strokes, {make, 1000}, {make, 9000}, options);
}

}  // namespace touchtrial
