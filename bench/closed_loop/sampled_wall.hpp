/// \file The physical damping with which a sampled virtual wall is passive: three ways to the bound
/// of Colgate and Schenkel (1997).
/// Source: docs/benchmarks/closed-loop.md.
#pragma once

namespace touchtrial::bench {

/// A spring and a damper whose force is computed every T and held until the next sample:
/// F_k = -(K x_k + B (x_k - x_{k-1}) / T).
struct SampledWall {
  double stiffness_n_per_m = 0.0;  ///< K, > 0
  double damping_n_s_per_m = 0.0;  ///< B, of either sign
  double period_s = 0.001;         ///< T, > 0
};

/// K T / 2 + |B|: with more physical damping than this, the wall is passive under every motion.
[[nodiscard]] double passivity_bound(const SampledWall& wall) noexcept;

/// The maximum of T/2 / (1 - cos wT) * Re{(1 - exp(-jwT)) H(exp(jwT))} over frequencies up to the
/// Nyquist frequency, with H(z) = K + B (z - 1) / (T z).
/// \param frequencies  how many frequencies to evaluate, > 0
[[nodiscard]] double damping_by_frequency(const SampledWall& wall, int frequencies = 20'000);

/// The maximum ratio of the energy that the wall supplies to the integral of v^2, over triangular
/// motions that turn at every sample (the Nyquist frequency) to every 1,024th sample. Of all
/// motions through the same samples, a straight one loses least energy to physical damping. The
/// wall's work is summed sample by sample in the time domain.
[[nodiscard]] double damping_by_energy(const SampledWall& wall);

/// The least physical damping with which a mass that is pressed on the wall comes to rest, by
/// bisection. Between samples the mass follows the exact solution of its equation of motion under
/// the held force. A heavy mass (m much greater than K T^2) moves little between samples, and the
/// limit is K T / 2 - B: this is not the worst case for a wall, and its damping B helps.
[[nodiscard]] double damping_for_rest(const SampledWall& wall, double mass_kg);

}  // namespace touchtrial::bench
