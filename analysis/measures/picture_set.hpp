/// \file Measures of single pictures and of the similarity between pictures. Definitions:
/// docs/stimuli.md, "Measures".
#pragma once

#include "core/plane.hpp"
#include "engine/extraction_options.hpp"
#include "engine/metrics/glcm.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A picture to measure.
struct LabelledPicture {
  std::string set;    ///< each set is measured separately
  std::string label;  ///< the picture's class in the set
  std::string name;   ///< for reports
  GreyImage image;
};

/// The measures of one picture.
struct PictureMeasures {
  std::string set, label, name;
  double mean = 0.0;                  ///< of grey levels
  double deviation = 0.0;             ///< standard deviation of grey levels
  double slope = 0.0;                 ///< spectrum_slope() of the picture
  engine::GlcmStatistics original{};  ///< mean over the four directions
  engine::GlcmStatistics texture{};   ///< the same for the texture picture
  double force_rms_n = 0.0;           ///< tangential force, with the gain of the first set
  double renderable_share = 0.0;      ///< share of tangential force power at wavelengths >= 1 mm
};

/// Mean MS-SSIM (unit exponents) over pairs of pictures.
struct PairMean {
  int pairs = 0;
  double mean = 0.0;  ///< 0 without a pair
};

/// The similarity of pictures within a class and between classes.
struct Similarity {
  PairMean original_within, original_between;
  PairMean texture_within, texture_between;
};

struct SetMeasures {
  std::string set;
  int classes = 0;
  int pictures = 0;
  /// Empty if any picture is too small for MS-SSIM.
  std::optional<Similarity> similarity;
};

struct MeasuredPictures {
  double tangential_gain_n = 0.0;
  std::vector<PictureMeasures> pictures;  ///< in the order given
  std::vector<SetMeasures> sets;          ///< by first appearance
};

/// Measures pictures under a method and rendering. All use the gain of the first picture's set,
/// from the stiffness budget or the rendering options. `equalise` is ignored, because it would hide
/// the differences. Pictures of different sizes are compared over their common top left corner.
/// Thread-safe. A pair of 500 x 500 pictures takes about 20 ms.
/// \param progress  called after each pair with the number of pairs done and their total; may be
///   empty
/// \throws std::invalid_argument if there is no picture, or one is below kSlopeSmallestSide
[[nodiscard]] MeasuredPictures measure_pictures(
    std::span<const LabelledPicture> pictures, const engine::ExtractionOptions& method,
    engine::RenderingOptions rendering,
    const std::function<void(int finished, int total)>& progress = {});

/// Tables for a terminal.
[[nodiscard]] std::string measures_text(const MeasuredPictures& measured);
/// docs/stimuli.md, "Measures", explains the keys.
[[nodiscard]] std::string measures_json(const MeasuredPictures& measured);

}  // namespace touchtrial::analysis
