/// \file Computes felt intensities from positions and forces, sample by sample. Source:
/// docs/method.md, "Felt features".
#pragma once

#include "core/plane_geometry.hpp"
#include "core/vec.hpp"
#include "engine/perception/felt_features.hpp"
#include "engine/perception/vibration_threshold.hpp"

#include <array>
#include <memory>
#include <optional>

namespace touchtrial::engine {

/// Samples of a window, and bins of its spectrum without the mean.
inline constexpr int kSenseWindow = 256;
inline constexpr int kSenseBins = kSenseWindow / 2;

struct SenseOptions {
  double rate_hz = 1000.0;     ///< of the samples, > 0
  double threshold_n = 0.002;  ///< intensities far below this are not felt, >= 0
  /// The curve whose threshold at each temporal frequency is the unit of intensity. Without a
  /// curve, intensities are in newtons and threshold_n applies. With a curve, the caller applies
  /// the threshold (`above_threshold`).
  std::optional<ThresholdCurve> curve = {};
  /// Determines the parts of the plane that have separate intensities.
  PlaneGeometry plane{0.2, 500, 500};
};

/// Welch's method in windows of 256 samples (Hann, half overlapped, mean removed). Each window's
/// frequencies are divided by the stroke's speed in it, so that bands are ranges of wavelength on
/// the plane at any speed. A window counts if the hand moves at 20 mm/s or more and has
/// contact (normal force > 0) in three quarters of it. The first half second of contact is ignored,
/// because it describes the landing. A window belongs to the part of the plane at its
/// middle sample; a part without windows has the intensity of the whole plane. The result depends
/// only on the samples. Not thread-safe, but different objects are independent.
class TextureSense {
 public:
  /// \throws std::invalid_argument if an option is out of range
  explicit TextureSense(const SenseOptions& options = {});
  ~TextureSense();
  TextureSense(TextureSense&&) noexcept;
  TextureSense& operator=(TextureSense&&) noexcept;

  /// Resets for another exploration.
  void reset(const PlaneGeometry& plane) noexcept;

  /// Adds the next sample; samples are evenly spaced in time. Real-time safe: no allocation, lock
  /// or exception; about 20 ns on average.
  void feel(const Vec3& position_mm, const Vec3& force_n) noexcept {
    feel(position_mm, force_n, force_n);
  }
  /// The same for another felt vector.
  /// \param force_n  determines contact
  /// \param felt  the vector whose intensities are felt: the force, or the tip's acceleration in
  ///   m/s^2 for a curve
  void feel(const Vec3& position_mm, const Vec3& force_n, const Vec3& felt) noexcept;

  /// The intensities of all samples so far. If no window counts, each is the threshold.
  [[nodiscard]] FeltFeatures features() const noexcept;

  /// One-sided powers of the felt vector by bin, summed over the axes and averaged over windows, in
  /// (m/s^2)^2 or N^2, unweighted. All are 0 if no window counts.
  [[nodiscard]] std::array<double, kSenseBins + 1> mean_powers() const noexcept;

  /// The number of windows counted so far.
  [[nodiscard]] int windows() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::engine
