/// \file The measures of the source paper, for any pictures and their textures. Source:
/// docs/method.md; paper Figs. 1 and 3, Tables 1 and 3.
#pragma once

#include "engine/evaluation.hpp"
#include "engine/extraction_options.hpp"

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// A picture and its name in reports.
struct PaperPicture {
  std::string name;
  GreyImage image;
};

/// The fixed orders of the paper's Fig. 1.
inline constexpr std::array<double, 3> kPaperOrders = {0.3, 0.55, 0.7};

struct TextureStrength {
  double rms_grey = 0.0;    ///< root mean square of T, grey levels
  double fine_share = 0.0;  ///< share of its power in the finest sub-bands lh, hl and hh; 0 if flat
};

/// One reading of the details that the paper does not specify.
struct TableReading {
  const char* words;  ///< description in reports
  engine::Norm norm = engine::Norm::additive;
  int radius = 2;
  engine::Mapping mapping = engine::Mapping::offset;
};

/// First the method as docs/method.md defines it, then other readings.
inline constexpr std::array<TableReading, 6> kTableReadings = {
    {{"as defined"},
     {"mask of radius 8", engine::Norm::additive, 8},
     {"mask divided by its sum", engine::Norm::sum},
     {"plain mask, which keeps shading", engine::Norm::none},
     {"magnitude of the texture", engine::Norm::additive, 2, engine::Mapping::abs},
     {"texture stretched to 0 .. 255", engine::Norm::additive, 2, engine::Mapping::stretch}}};

inline constexpr std::size_t kReadingAsDefined = 0;
inline constexpr std::size_t kReadingBySum = 2;

/// The measures of one picture.
struct MeasuredPicture {
  std::string name;
  engine::Evaluation evaluation;  ///< with the sweep of fixed orders
  std::array<TextureStrength, kPaperOrders.size()> fixed{};
  TextureStrength adaptive{};
  std::array<engine::GlcmTable, kTableReadings.size()> readings{};  ///< of the adaptive texture
};

/// The textures of two methods on one picture.
struct MethodMeasures {
  std::string name;
  TextureStrength adaptive{};
  TextureStrength tv_gabor{};
  double ms_ssim = 0.0;  ///< between the two texture pictures, exponents 1
};

struct PaperMeasures {
  std::vector<MeasuredPicture> pictures;
  std::vector<MethodMeasures> compared;
};

/// Called after each step with the number of finished steps and their total.
using PaperProgress = std::function<void(int finished, int total)>;

/// Measures pictures in double precision.
/// \param pictures  for Figs. 1 and 3 and Table 1
/// \param compared  for Table 3; may be the same pictures
/// \throws std::invalid_argument if a side of a picture is below engine::kMsSsimSmallestSide
[[nodiscard]] PaperMeasures measure_for_paper(std::span<const PaperPicture> pictures,
                                              std::span<const PaperPicture> compared,
                                              const PaperProgress& progress = {});

/// The standard deviation of the grey levels, implied by contrast and correlation of one direction:
/// contrast = 2 sd^2 (1 - correlation).
/// \return in grey levels; 0 if the correlation is 1
[[nodiscard]] double implied_deviation(double contrast, double correlation);

}  // namespace touchtrial::analysis
