/// \file Statements of the source paper, checked against measures of pictures. Agreement is always
/// computed from the measures.
#pragma once

#include "analysis/paper/paper_measures.hpp"
#include "analysis/paper/published.hpp"
#include "analysis/statistics/proportion.hpp"

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::analysis {

/// A statement of the paper, and the number of measured pictures or cells that agree with it.
struct PaperClaim {
  std::string id;
  std::string where;      ///< "Fig. 3"
  std::string statement;  ///< the statement, rephrased
  std::string measured;   ///< what was measured
  int agreeing = 0;       ///< pictures or cells that agree
  int total = 0;          ///< tested pictures or cells; 0 if none can test the statement
};

/// "agrees", "agrees in 3 of 5", "differs" or "cannot be tested"
[[nodiscard]] std::string verdict_of(const PaperClaim& claim);

/// A statistic of Table 1, as published and as measured here.
struct PaperStatistic {
  std::string_view name;
  PublishedRow PublishedPicture::*published = nullptr;  ///< null: not in the paper
  double engine::GlcmStatistics::*measured = nullptr;
  int decimals = 0;
};

inline constexpr std::array<PaperStatistic, 5> kPaperStatistics = {
    {{"ASM", &PublishedPicture::asm_, &engine::GlcmStatistics::angular_second_moment, 5},
     {"\"Entropy\", sqrt(ASM)", &PublishedPicture::entropy, &engine::GlcmStatistics::energy, 4},
     {"contrast", &PublishedPicture::contrast, &engine::GlcmStatistics::contrast, 2},
     {"correlation", &PublishedPicture::correlation, &engine::GlcmStatistics::correlation, 3},
     {"true entropy, nats", nullptr, &engine::GlcmStatistics::entropy, 3}}};

/// How extraction changes a statistic, over the cells of a table.
struct CellChanges {
  int rising = 0;
  int falling = 0;
  int total = 0;  ///< number of cells
};

/// \return zeros if the paper does not report the statistic
[[nodiscard]] CellChanges published_changes(const PaperStatistic& statistic);
[[nodiscard]] CellChanges measured_changes(const PaperMeasures& measures,
                                           const PaperStatistic& statistic);

/// The number of "Entropy" cells of the paper that equal the root of its ASM, within rounding.
[[nodiscard]] Proportion published_roots();

/// A summary of one picture of Table 1; numbers are means over the directions.
struct TableSummary {
  double deviation_before = 0.0;  ///< implied_deviation() of grey levels
  double deviation_after = 0.0;
  /// The largest relative difference, in percent, between the deviations that the four directions
  /// imply, before or after; small if contrast and correlation are consistent.
  double disagreement_percent = 0.0;
  double contrast_ratio = 0.0;  ///< after over before; NaN if there was no contrast
  double correlation_after = 0.0;
  bool contrast_rises = false;  ///< in every direction
  bool asm_rises = false;       ///< in any direction
  /// ASM rises, contrast falls and correlation falls, in every direction.
  bool agrees_with_text = false;
};

[[nodiscard]] TableSummary summary_of(const PublishedPicture& picture);
[[nodiscard]] TableSummary summary_of(const engine::GlcmTable& original,
                                      const engine::GlcmTable& texture);

/// The smallest mean correlation over directions among the textures of the paper's table.
[[nodiscard]] double published_least_correlation();

/// Whether a texture's table resembles the picture that contradicts the paper's text: contrast
/// rises in every direction, ASM in none, and the mean correlation is at least the paper's
/// smallest.
[[nodiscard]] bool is_like_contradiction(const TableSummary& summary);

/// The smallest and the largest value of a number over pictures, for example "0.02 to 0.18"; "-"
/// without finite values.
[[nodiscard]] std::string range_over(const std::vector<MeasuredPicture>& pictures, int decimals,
                                     const std::function<double(const MeasuredPicture&)>& number);

/// Every statement, in the order of the paper.
[[nodiscard]] std::vector<PaperClaim> paper_claims(const PaperMeasures& measures);

}  // namespace touchtrial::analysis
