/// \file The study's images in a BIDS dataset. Private to exports.
#pragma once

#include "analysis/exports/dataset.hpp"
#include "analysis/exports/export_folder.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// What an image is called below stimuli/: its class and image by number, from 1, and the class's
/// letters and digits: "01-bark-01.png".
[[nodiscard]] std::string stimulus_name(const design::Study& study, int class_index, int exemplar);

/// Copies of every image. \throws FileError if one is missing
[[nodiscard]] std::vector<ExportFile> stimulus_files(const design::Study& study);

}  // namespace touchtrial::analysis
