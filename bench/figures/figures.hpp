/// \file The figures of docs/benchmarks, as scripts for gnuplot.
#pragma once

#include "bench/measure/rows.hpp"
#include "bench/measure/tv_gabor_courses.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::bench {

enum class Format { svg, png };

/// Error against time of the fractional filters on the usual picture, K = 2.
[[nodiscard]] std::string filter_figure(const std::vector<Row>& rows, Format format);
/// The same of MS-SSIM.
[[nodiscard]] std::string ms_ssim_figure(const std::vector<Row>& rows, Format format);
/// Time a pixel of whole extractions against the image's side.
[[nodiscard]] std::string size_figure(const std::vector<Row>& rows, Format format);

/// Error of v and gap of TV-Gabor's solvers over time, side by side.
[[nodiscard]] std::string tv_gabor_figure(const std::vector<SolverCourse>& courses, Format format);

/// Draws all of them into a folder: filters, ms-ssim, sizes and tv-gabor, .svg or
/// .png.
/// \throws Error without gnuplot, FileError if a file cannot be written
void draw_figures(const std::vector<Row>& rows, const std::vector<SolverCourse>& courses,
                  Format format, const std::filesystem::path& folder);

}  // namespace touchtrial::bench
