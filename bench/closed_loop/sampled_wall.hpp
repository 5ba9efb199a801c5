/// \file What a hand and a device must dissipate for a sampled virtual wall to be passive: the bounds
/// of Colgate and Schenkel (1997) with delay, and of Abbott and Okamura (2005) for readings in
/// whole steps, each beside ways to find it that do not use it. Source:
/// docs/benchmarks/closed-loop.md.
#pragma once

namespace touchtrial::bench {

/// A spring and a damper whose force is computed at every sample and held for one period:
/// F_k = -(K x_{k-d} + B v_{k-d}).
struct SampledWall {
  double stiffness_n_per_m = 0.0;  ///< K, > 0
  double damping_n_s_per_m = 0.0;  ///< B, of either sign
  double period_s = 0.001;         ///< T, > 0
  int delay_ticks = 0;             ///< d, beside the hold, >= 0: t_d = d T
  /// The velocity v is the slope of the line through this many newest samples, 2 to 32; 2: their
  /// difference.
  int velocity_readings = 2;
  double step_mm = 0.0;  ///< D: x is in whole steps; 0: exact
};

/// K (T / 2 + t_d) + |B|, N s/m: with more physical damping than this, the wall is passive under
/// every motion. For B = 0, or without delay, and for a difference as velocity, also not with less.
[[nodiscard]] double passivity_bound(const SampledWall& wall) noexcept;

/// The maximum of T/2 / (1 - cos wT) * Re{(1 - exp(-jwT)) H(exp(jwT))} over frequencies up to the
/// Nyquist frequency: the damping that a wall needs, N s/m, of which `passivity_bound` is a bound.
/// H(z) = (K + B V(z)) z^-d; V is the velocity's estimator.
/// \param frequencies  how many frequencies to evaluate, > 0
[[nodiscard]] double damping_by_frequency(const SampledWall& wall, int frequencies = 20'000);

/// The maximum ratio of the energy that the wall supplies to the integral of v^2, N s/m, over
/// triangular motions that turn at every sample (the Nyquist frequency) to every 1,024th sample. Of
/// all motions through the same samples, a straight one loses least energy to physical damping. The
/// wall's work is summed sample by sample in the time domain.
[[nodiscard]] double damping_by_energy(const SampledWall& wall);

/// K D / 2, N: with this much Coulomb friction, and the damping of `passivity_bound`, a wall that
/// is read in steps is passive under every motion.
[[nodiscard]] double friction_bound(const SampledWall& wall) noexcept;

/// The least Coulomb friction, N, with which a modelled device comes to rest on the wall under any
/// of a few pushes between two steps, by bisection.
/// \param mass_kg  > 0
/// \param damping_n_s_per_m  physical, >= 0
[[nodiscard]] double friction_for_rest(const SampledWall& wall, double mass_kg,
                                       double damping_n_s_per_m);

/// How a modelled device moves in the end, on the wall and without Coulomb friction.
struct LimitCycle {
  double mm_s = 0.0;  ///< rms
  double mm = 0.0;    ///< from one end to the other
};
[[nodiscard]] LimitCycle limit_cycle(const SampledWall& wall, double mass_kg,
                                     double damping_n_s_per_m);

}  // namespace touchtrial::bench
