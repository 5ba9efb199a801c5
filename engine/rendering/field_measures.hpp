/// \file Strength, steepness and spectrum of a field before gains, from which the models compute
/// gains and statistics. Private to engine/rendering. Source: docs/method.md, "Rendering".
#pragma once

#include "engine/rendering/texture_field.hpp"

#include <span>
#include <vector>

namespace touchtrial::engine {

/// A field's values at a pixel's centre, before gains. Single precision causes an error of 6e-8.
struct FieldSample {
  float height = 0.0F;   ///< T or h after the reconstruction filter, grey levels
  float force_x = 0.0F;  ///< tangential force to the right, grey levels per pixel
  float force_y = 0.0F;  ///< tangential force downwards in the image, grey levels per pixel
};

/// A field at its pixel centres, row-major.
struct SampledView {
  PlaneGeometry geometry;
  std::span<const FieldSample> samples;
};
struct SampledField {
  PlaneGeometry geometry;
  Plane<FieldSample> samples;

  [[nodiscard]] SampledView view() const noexcept { return {geometry, samples.samples()}; }
};

/// Root mean square of |F_T| over all pixels, grey levels per pixel. Exactly 0 only if every force
/// is zero; not finite if a sample is not finite.
[[nodiscard]] double tangential_rms(SampledView field) noexcept;

/// Root mean square of the heights over all pixels, grey levels.
[[nodiscard]] double height_rms(SampledView field) noexcept;

/// Derivatives of the touchdown ramp's factor on F_T by height and depth; zeros: no ramp.
struct RampSlopes {
  double per_grey = 0.0;  ///< c / touchdown_ramp_n
  double per_mm = 0.0;    ///< k / touchdown_ramp_n
};

/// Scale * Frobenius norm of the in-plane Jacobian of F_T at every interior pixel, by central
/// differences over the pitch: grey levels per pixel per mm. With a ramp, the Jacobian includes
/// depth, at the load where its norm is largest. A field with a side below 3 has no interior. In
/// single precision.
[[nodiscard]] std::vector<float> tangential_stiffness(SampledView field, double scale,
                                                      RampSlopes ramp = {});

/// Scale * norm of the heights' gradient at every interior pixel: grey levels per mm.
[[nodiscard]] std::vector<float> height_stiffness(SampledView field, double scale);

/// Factors that equalise fields. Equalise::rms: 1 / rms, or 0 for a flat field; otherwise 1.
/// \param rms  the rms of each field; 0: flat
/// \throws std::invalid_argument if an rms is not finite
[[nodiscard]] std::vector<double> equalising_factors(std::span<const double> rms,
                                                     Equalise equalise);

/// The factor by which an explicit gain multiplies equalising_factors(). Equalise::rms: keeps the
/// mean rms of the fields that are not flat.
[[nodiscard]] double explicit_factor(double gain, std::span<const double> rms, Equalise equalise);

/// The 99th percentile of pooled stiffnesses, or the maximum if the percentile is below a
/// thousandth of it. Then most of the pool is flat, or contains filter residues far from any
/// texture, and the percentile would not limit the stiffness.
/// \param pools  finite values >= 0
[[nodiscard]] double typical_stiffness(std::span<const std::vector<float>> pools);

/// The exact percentile of the union of pools, by linear interpolation between order statistics
/// (NumPy's default); 0 if they are empty. Thread-safe. Cost: about 2 ns per value.
/// \param pools  finite values >= 0
/// \param share  0 .. 1
[[nodiscard]] double percentile(std::span<const std::vector<float>> pools, double share);

/// For each limit, the share of the force's power (both components, means removed) at higher radial
/// spatial frequencies; 0 for a constant force. The plane is treated as periodic. Thread-safe.
/// Cost: two real Fourier transforms.
/// \param field  at least 1 x 1
/// \param limits_cycles_per_px  frequencies that equal a limit within rounding are not above it
[[nodiscard]] std::vector<double> power_shares_above(SampledView field,
                                                     std::span<const double> limits_cycles_per_px);

}  // namespace touchtrial::engine
