/// \file The spectrum of M, the operator that says which oscillations count as texture.
/// Source: docs/method.md, "TV-Gabor".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"

#include <span>

namespace touchtrial::engine {

/// Sum over the components of |g^|^2, scaled so that its maximum is 1, where g is an 11 x 11 even
/// Gabor patch of standard deviation 2 px minus its own mean. Non-negative by construction, and
/// zero at frequency zero.
/// \param components  at least one, each with a frequency in (0, 0.5] and a finite direction
/// \param height,width  of the torus, >= 11
/// \return height x (width / 2 + 1), in the layout of RealFft's spectrum
[[nodiscard]] Plane<double> gabor_spectrum(std::span<const GaborComponent> components, int height,
                                           int width);

}  // namespace touchtrial::engine
