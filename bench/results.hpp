/// \file The results of the benchmark: what was measured on which machine, as JSON and as the
/// contents of docs/benchmarks.
#pragma once

#include "bench/goals/goal.hpp"
#include "bench/measure/rows.hpp"
#include "bench/measure/tv_gabor_courses.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::bench {

/// Where the results were taken.
struct Machine {
  std::string processor;  ///< its name and instruction set, for instance "Xeon .. (AVX-512)"
  std::string compiler;
  std::string opencv;  ///< version
  std::string date;    ///< UTC, "2026-11-20"
};

[[nodiscard]] Machine this_machine();

/// Everything that was measured.
struct Results {
  std::vector<GoalResult> goals;
  std::vector<Row> rows;
  std::vector<SolverCourse> courses;  ///< of TV-Gabor, on the usual picture; not part of the JSON
};

/// {"processor", .., "goals": [{"goal", "ours_us", "peer_us", "ratio", "of_bound", "target",
/// "error", "met", ..}], "rows": [{"work", "who", "input", "size_px", "radius", "us", "error",
/// ..}]}. Numbers that were not taken are null.
[[nodiscard]] std::string results_json(const Machine& machine, const Results& measured);

/// On which processor results were taken.
/// \param json  of results_json()
/// \throws Error if it is not such JSON
[[nodiscard]] std::string processor_of(std::string_view json);

/// Replaces everything between the lines <!-- NAME --> and <!-- end of NAME --> of a Markdown page.
/// \throws Error if the page lacks one of these lines, or has them in the wrong order
[[nodiscard]] std::string with_section(const std::string& page, const std::string& name,
                                       const std::string& content);

/// Writes the table of goals into README.md, the pictures, and results.json.
/// \param folder  the folder of README.md
/// \throws Error without gnuplot, or if README.md lacks its section
/// \throws FileError if a file cannot be read or written
void publish(const Machine& machine, const Results& results, const std::filesystem::path& folder);

}  // namespace touchtrial::bench
