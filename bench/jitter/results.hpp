/// \file Measurements as a table, as JSON and as a picture.
#pragma once

#include "bench/jitter/measurement.hpp"

#include <filesystem>
#include <span>
#include <string>

namespace touchtrial::bench::jitter {

/// Which of the two was measured.
enum class Measured { lateness, service };

/// A table for a terminal and for a page of Markdown, with the processor above it and, below, why
/// less was obtained than asked for.
[[nodiscard]] std::string results_text(Measured what, std::span<const Measurement> measurements);

/// {"processor", "measured": "lateness" | "service", "measurements": [{"rate_hz", "policy", "load",
/// "obtained": {"policy", "priority", "memory_locked", "reason"}, "ticks", "overruns",
/// "rate_had_hz", "p50_us", "p99_us", "p999_us", "worst_us", "dropped", "written_samples", "end"}]}
[[nodiscard]] std::string results_json(Measured what, std::span<const Measurement> measurements);

/// A gnuplot script: for each rate a panel with the histograms of its measurements.
/// \param picture  its name ends in .svg or .png
/// \throws UsageError if it ends in anything else
[[nodiscard]] std::string histogram_script(Measured what, std::span<const Measurement> measurements,
                                           const std::filesystem::path& picture);

}  // namespace touchtrial::bench::jitter
