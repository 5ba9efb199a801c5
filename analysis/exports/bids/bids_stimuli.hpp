/// \file The study's images in a BIDS dataset. Private to exports.
#pragma once

#include "analysis/exports/dataset.hpp"
#include "analysis/exports/export_folder.hpp"

#include <string>
#include <vector>

namespace touchtrial::analysis {

/// The name of an image below stimuli/: the numbers of its class and of the image, from 1, with the
/// letters and digits of the class between them, for example "01-bark-01.png".
[[nodiscard]] std::string stimulus_name(const design::Study& study, int class_index, int exemplar);

/// Copies of every image.
/// \throws FileError if an image is missing
[[nodiscard]] std::vector<ExportFile> stimulus_files(const design::Study& study);

}  // namespace touchtrial::analysis
