/// \file From what a hand felt, sample by sample, to a few felt intensities.
/// Sees positions and forces alone. Source: docs/method.md, "Felt features".
#pragma once

#include "core/plane_geometry.hpp"
#include "core/vec.hpp"
#include "engine/perception/felt_features.hpp"

#include <memory>

namespace touchtrial::engine {

struct SenseOptions {
  double rate_hz = 1000.0;     ///< of the samples, > 0
  double threshold_n = 0.002;  ///< intensities well below are felt as none, >= 0
  /// Extent of the plane, for telling its parts; known to whoever explores it.
  PlaneGeometry plane{0.2, 500, 500};
};

/// Welch's method in windows of 256 samples (Hann, half overlapped, mean removed). Frequencies are
/// divided by the stroke's speed in each window, so that bands are of wavelengths on the plane
/// whatever the speed; a window counts if the hand moved at 20 mm/s or more and had contact
/// (normal force > 0) in three quarters of it. The first half second of contact is left out: it
/// tells of the landing. A window belongs to the part of the plane where its middle lies; a part
/// without any is felt like the whole. A function of the samples alone. Not thread-safe; different
/// objects may be used at the same time.
class TextureSense {
 public:
  /// \throws std::invalid_argument if an option is out of range
  explicit TextureSense(const SenseOptions& options = {});
  ~TextureSense();
  TextureSense(TextureSense&&) noexcept;
  TextureSense& operator=(TextureSense&&) noexcept;

  /// Forgets everything felt, for another exploration of a plane.
  void reset(const PlaneGeometry& plane) noexcept;

  /// Takes the next sample; samples are evenly spaced in time. No allocation, lock or exception.
  /// Cost: some 20 ns, averaged over a window.
  void feel(Vec3 position_mm, Vec3 force_n) noexcept;

  /// What the samples so far amount to. Without a window that counts, every intensity is the
  /// threshold.
  [[nodiscard]] FeltFeatures features() const noexcept;

  /// Windows that counted so far.
  [[nodiscard]] int windows() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace touchtrial::engine
