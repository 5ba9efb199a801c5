/// \file The evaluation of images for readers and programs: paper Table 1 and
/// Fig. 3.
#pragma once

#include "engine/evaluation/evaluation.hpp"

#include <span>
#include <string>

namespace touchtrial::analysis {

struct EvaluatedImage {
  std::string image;  ///< the name to report it by
  engine::Evaluation evaluation;
};

/// Tables for a terminal, with what the paper's row "Entropy" is, and how close
/// the adaptive texture is to the best fixed order.
[[nodiscard]] std::string evaluation_text(std::span<const EvaluatedImage> images);

/// {"images":[{"image","original","adaptive","orders"}]}; "orders" is there
/// after a sweep only. docs/data-dictionary.md explains the figures.
[[nodiscard]] std::string evaluation_json(std::span<const EvaluatedImage> images);

/// A gnuplot script that prints a PNG: entropy and MS-SSIM over the fixed
/// order, in a colour for each image. \pre every image was swept
[[nodiscard]] std::string order_sweep_script(std::span<const EvaluatedImage> images);

}  // namespace touchtrial::analysis
