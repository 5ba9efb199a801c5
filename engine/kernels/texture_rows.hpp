/// \file Converts texture rows to picture rows and finds the largest sample, vectorised for every
/// target.
#pragma once

#include <cstdint>
#include <span>

namespace touchtrial::engine {

/// clamp(floor(128 + T + 0.5), 0, 255), exactly, for any floats; NaN gives 0.
/// \param width  >= 0; exactly this many samples are read and written
void picture_row(const float* texture, int width, std::uint8_t* picture);

/// The largest of the samples; not finite if any of them is not.
/// \param samples  at least one
[[nodiscard]] float highest_sample(std::span<const float> samples);

}  // namespace touchtrial::engine
