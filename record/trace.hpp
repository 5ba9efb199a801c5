/// \file Position and force samples of one trial, and their compact form.
#pragma once

#include "core/bytes.hpp"
#include "core/vec.hpp"

#include <cstddef>
#include <vector>

namespace touchtrial::record {

struct TraceSample {
  Vec3 position_mm;
  Vec3 force_n;  ///< as sent to the device
};

/// Samples at equal intervals, from plane-on.
struct Trace {
  double rate_hz = 1000.0;
  std::vector<TraceSample> samples;
};

/// Quantises a trace (positions to 1 um, forces to 1/4096 N), takes differences, and compresses
/// them with zstd level 1. The result is not encrypted.
/// \throws StoreError if a sample is not finite or exceeds 10 m or 100 N
[[nodiscard]] Bytes encode_trace(const Trace& trace);

/// Restores a trace from the bytes of encode_trace.
/// \throws StoreError if the bytes are not a trace, are truncated, or state an impossible length
[[nodiscard]] Trace decode_trace(ByteView bytes);

/// The padding under which traces are sealed, in bytes. It depends only on the number of samples in
/// steps of kPaddingStep, so that the size of a stored trace reveals neither roughness nor the
/// seconds of exploration. Source: docs/decisions/0054-what-a-trial-shows.md.
[[nodiscard]] std::size_t trace_padding(std::size_t sample_count);

/// Ten seconds at the servo's rate.
inline constexpr std::size_t kPaddingStep = 10'000;

}  // namespace touchtrial::record
