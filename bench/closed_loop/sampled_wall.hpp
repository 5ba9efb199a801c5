/// \file How much damping a hand needs so that a virtual wall, computed in samples, gives it no
/// energy: three ways to the passivity bound of Colgate and Schenkel (1997).
/// Source: docs/benchmarks/closed-loop.md.
#pragma once

namespace touchtrial::bench {

/// A spring and a damper that are computed every T and held until the next sample:
/// F_k = -(K x_k + B (x_k - x_{k-1}) / T).
struct SampledWall {
  double stiffness_n_per_m = 0.0;  ///< K, > 0
  double damping_n_s_per_m = 0.0;  ///< B, of either sign
  double period_s = 0.001;         ///< T, > 0
};

/// K T / 2 + |B|: with more physical damping than this the wall is passive under every motion.
[[nodiscard]] double passivity_bound(const SampledWall& wall) noexcept;

/// The greatest T/2 / (1 - cos wT) * Re{(1 - exp(-jwT)) H(exp(jwT))} over frequencies up to
/// Nyquist's, by evaluating H(z) = K + B (z - 1) / (T z). \param frequencies  > 0
[[nodiscard]] double damping_by_frequency(const SampledWall& wall, int frequencies = 20'000);

/// The greatest ratio of the energy that the wall gives to the integral of v^2, over triangular
/// motions that turn at samples, from every sample (the Nyquist frequency) to every 1,024th. Of all
/// motions through given samples a straight one loses least to physical damping. The wall's work is
/// added up sample by sample in the time domain.
[[nodiscard]] double damping_by_energy(const SampledWall& wall);

/// The least physical damping under which a mass pressed on the wall comes to rest, by bisection.
/// Between samples the mass moves by the exact solution of its equation of motion under the held
/// force. A heavy mass (K T^2 much less than it) moves slowly against the samples; then the limit
/// is K T / 2 - B: such a mass is not the worst that a wall may meet, and B helps it.
[[nodiscard]] double damping_for_rest(const SampledWall& wall, double mass_kg);

}  // namespace touchtrial::bench
