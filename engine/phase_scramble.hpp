/// \file A control stimulus: a texture without its structure. It tests whether participants feel
/// the structure of a method's texture or only its spectrum. Source: docs/method.md, "Controls".
#pragma once

#include "core/plane.hpp"

#include <cstdint>

namespace touchtrial::engine {

/// Keeps the mean and the amplitude of every frequency of the texture, and replaces the phases by
/// the phases of white noise. Rms and power spectrum stay the same to rounding; extremes may grow.
/// A flat texture is returned unchanged.
/// \param texture  T, grey levels, at least 1 x 1
/// \param seed  of the noise; equal seeds and sizes give equal phases
/// Computes in double; Real is float or double. Thread-safe.
/// Cost: three real Fourier transforms, and 20 bytes per pixel while it runs.
template <typename Real>
[[nodiscard]] Plane<Real> phase_scrambled(const Plane<Real>& texture, std::uint64_t seed);

}  // namespace touchtrial::engine
