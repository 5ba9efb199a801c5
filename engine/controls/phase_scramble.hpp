/// \file A texture without its structure: the control that tells whether a method's structure is
/// felt, or its spectrum alone. Source: docs/method.md, "Controls".
#pragma once

#include "core/plane.hpp"

#include <cstdint>

namespace touchtrial::engine {

/// Keeps the mean and the amplitude of every frequency of the texture, and replaces the phases by
/// those of white noise. Rms and power spectrum stay to rounding; extremes may grow. A flat texture
/// comes back as it is.
/// \param texture  T, grey levels, at least 1 x 1
/// \param seed  of the noise; the same seed and size give the same phases
/// Computed in double whatever Real, which is float or double. Thread-safe.
/// Cost: three real Fourier transforms; 20 bytes a pixel while it runs.
template <typename Real>
[[nodiscard]] Plane<Real> phase_scrambled(const Plane<Real>& texture, std::uint64_t seed);

}  // namespace touchtrial::engine
