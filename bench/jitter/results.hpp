/// \file The measurements of servo_jitter as a table, as JSON and as a picture.
#pragma once

#include "bench/jitter/measurement.hpp"

#include <filesystem>
#include <span>
#include <string>

namespace touchtrial::bench::jitter {

/// The processor's name on Linux and its logical cores: "Xeon .., 2 logical cores". On other
/// systems the name is unknown.
[[nodiscard]] std::string this_processor();

/// Which quantity the histograms hold.
enum class Measured { lateness, service };

/// A table for a terminal or a Markdown page. The processor is above it; below it are the reasons
/// why a run obtained less than it requested.
[[nodiscard]] std::string results_text(Measured what, std::span<const Measurement> measurements);

/// {"processor", "measured": "lateness" | "service", "measurements": [{"rate_hz", "policy", "load",
/// "obtained": {"policy", "priority", "memory_locked", "reason"}, "ticks", "overruns",
/// "rate_had_hz", "p50_us", "p99_us", "p999_us", "worst_us", "dropped", "written_samples", "end"}]}
[[nodiscard]] std::string results_json(Measured what, std::span<const Measurement> measurements);

/// A gnuplot script with one panel for each rate, which holds the histograms of its measurements.
/// \param picture  a file name that ends in .svg or .png
/// \throws UsageError if it ends in anything else
[[nodiscard]] std::string histogram_script(Measured what, std::span<const Measurement> measurements,
                                           const std::filesystem::path& picture);

}  // namespace touchtrial::bench::jitter
