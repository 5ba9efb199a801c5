/// \file The pictures of docs/benchmarks.
#pragma once

#include "bench/measure/rows.hpp"
#include "bench/measure/tv_gabor_courses.hpp"

#include <filesystem>
#include <vector>

namespace touchtrial::bench {

/// Draws filters.svg, ms-ssim.svg, sizes.svg and tv-gabor.svg into a folder.
/// \param courses  of four solvers
/// \throws Error without gnuplot
/// \throws FileError if a file cannot be written
void draw_figures(const std::vector<Row>& rows, const std::vector<SolverCourse>& courses,
                  const std::filesystem::path& folder);

}  // namespace touchtrial::bench
