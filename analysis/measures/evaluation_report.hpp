/// \file The evaluation of images as text and JSON: Table 1 and Fig. 3 of the paper.
#pragma once

#include "engine/evaluation.hpp"

#include <span>
#include <string>

namespace touchtrial::analysis {

struct EvaluatedImage {
  std::string image;  ///< name in reports
  engine::Evaluation evaluation;
};

/// Tables for a terminal, with an explanation of the paper's row "Entropy" and the fixed order that
/// is closest to the adaptive texture.
[[nodiscard]] std::string evaluation_text(std::span<const EvaluatedImage> images);

/// {"images":[{"image","original","adaptive","orders"}]}; "orders" exists only after a sweep.
/// docs/data-dictionary.md explains the numbers.
[[nodiscard]] std::string evaluation_json(std::span<const EvaluatedImage> images);

}  // namespace touchtrial::analysis
