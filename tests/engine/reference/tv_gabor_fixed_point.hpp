/// \file TV-Gabor by a slower solver on the dual, which shares the engine's transforms but not its
/// iteration: the baseline to beat. Source: docs/method.md, "TV-Gabor"; A. Chambolle, "An algorithm
/// for total variation minimization and applications", 2004.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"

namespace touchtrial::reference {

/// v after some steps of the semi-implicit fixed point, tau = 1/8, in grey levels.
/// \param image  neither flat nor empty
/// \param options  gap and max_steps have no effect
[[nodiscard]] Plane<float> tv_gabor_fixed_point(const GreyImage& image,
                                                const engine::TvGaborOptions& options, int steps);

}  // namespace touchtrial::reference
