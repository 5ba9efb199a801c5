#include "analysis/paper/paper_claims.hpp"

#include "core/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::analysis {
namespace {

constexpr double kOrderRounding = 1e-9;

/// The four statistics in one direction, before and after extraction.
struct CellPair {
  engine::GlcmStatistics before;
  engine::GlcmStatistics after;
};
using CellPairs = std::array<CellPair, 4>;

CellPairs pairs_of(const PublishedPicture& picture) {
  CellPairs pairs{};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = {{picture.asm_.original[i], picture.entropy.original[i], 0.0,
                 picture.contrast.original[i], picture.correlation.original[i]},
                {picture.asm_.texture[i], picture.entropy.texture[i], 0.0,
                 picture.contrast.texture[i], picture.correlation.texture[i]}};
  }
  return pairs;
}

template <typename Number>
double mean_over_pairs(const CellPairs& pairs, const Number& number) {
  const double sum =
      std::accumulate(pairs.begin(), pairs.end(), 0.0,
                      [&](double total, const CellPair& pair) { return total + number(pair); });
  return sum / static_cast<double>(pairs.size());
}

double deviation_in(const engine::GlcmStatistics& cell) {
  return implied_deviation(cell.contrast, cell.correlation);
}

/// The range of the deviations over their mean, in percent; 0 if all are 0.
template <typename Number>
double disagreement_of(const CellPairs& pairs, double mean, const Number& deviation) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const CellPair& pair : pairs) {
    low = std::min(low, deviation(pair));
    high = std::max(high, deviation(pair));
  }
  return mean > 0.0 ? 100.0 * (high - low) / mean : 0.0;
}

bool agrees_with_text_in(const CellPair& pair) {
  return pair.after.angular_second_moment > pair.before.angular_second_moment &&
         pair.after.contrast < pair.before.contrast &&
         pair.after.correlation < pair.before.correlation;
}

TableSummary summary_of_pairs(const CellPairs& pairs) {
  TableSummary summary;
  const auto before = [](const CellPair& pair) { return deviation_in(pair.before); };
  const auto after = [](const CellPair& pair) { return deviation_in(pair.after); };
  summary.deviation_before = mean_over_pairs(pairs, before);
  summary.deviation_after = mean_over_pairs(pairs, after);
  summary.disagreement_percent = std::max(disagreement_of(pairs, summary.deviation_before, before),
                                          disagreement_of(pairs, summary.deviation_after, after));
  summary.contrast_ratio = mean_over_pairs(pairs, [](const CellPair& pair) {
    return pair.before.contrast > 0.0 ? pair.after.contrast / pair.before.contrast
                                      : std::numeric_limits<double>::quiet_NaN();
  });
  summary.correlation_after =
      mean_over_pairs(pairs, [](const CellPair& pair) { return pair.after.correlation; });
  summary.contrast_rises = std::all_of(pairs.begin(), pairs.end(), [](const CellPair& pair) {
    return pair.after.contrast > pair.before.contrast;
  });
  summary.asm_rises = std::any_of(pairs.begin(), pairs.end(), [](const CellPair& pair) {
    return pair.after.angular_second_moment > pair.before.angular_second_moment;
  });
  summary.agrees_with_text = std::all_of(pairs.begin(), pairs.end(), agrees_with_text_in);
  return summary;
}

void count_change(CellChanges& changes, double before, double after) {
  ++changes.total;
  if (after > before) ++changes.rising;
  if (after < before) ++changes.falling;
}

template <typename Condition>
int count_pictures(const std::vector<MeasuredPicture>& pictures, const Condition& condition) {
  return static_cast<int>(std::count_if(pictures.begin(), pictures.end(), condition));
}

std::string published_orders() {
  return fmt::format("orders {:g} to {:g}", kPublishedLowestOrder, kPublishedHighestOrder);
}

bool is_published_order(double order) {
  return order >= kPublishedLowestOrder - kOrderRounding &&
         order <= kPublishedHighestOrder + kOrderRounding;
}

/// The fixed order whose texture's entropy is nearest to the adaptive texture's.
double order_of_entropy(const engine::Evaluation& evaluation) {
  const auto distance = [&](const engine::OrderEvaluation& one) {
    return std::abs(one.entropy - evaluation.adaptive.entropy);
  };
  return std::min_element(evaluation.orders.begin(), evaluation.orders.end(),
                          [&](const auto& a, const auto& b) { return distance(a) < distance(b); })
      ->order;
}

/// The rms of the lowest order's texture divided by the rms of the adaptive texture; 0 if the
/// adaptive texture is flat.
double lowest_order_rms_ratio(const MeasuredPicture& one) {
  return one.adaptive.rms_grey > 0.0 ? one.fixed[0].rms_grey / one.adaptive.rms_grey : 0.0;
}

void add_orders(std::vector<PaperClaim>& claims, const PaperMeasures& measures) {
  const auto& pictures = measures.pictures;
  const int n = static_cast<int>(pictures.size());
  claims.push_back(
      {"weakest", "Fig. 1",
       fmt::format("Of orders {:g} and adaptive, {:g} gives the weakest texture.",
                   fmt::join(kPaperOrders, ", "), kPaperOrders.front()),
       fmt::format("Order {:g} has {} of the adaptive texture's rms.", kPaperOrders.front(),
                   range_over(pictures, 2, lowest_order_rms_ratio)),
       count_pictures(pictures,
                      [](const MeasuredPicture& one) {
                        return one.fixed[0].rms_grey < one.fixed[1].rms_grey &&
                               one.fixed[0].rms_grey < one.fixed[2].rms_grey &&
                               one.fixed[0].rms_grey < one.adaptive.rms_grey;
                      }),
       n});
  claims.push_back(
      {"fine-lost", "Fig. 1", "Higher orders sharpen large textures and lose small ones.",
       fmt::format(
           "The share of the finest sub-bands is {} at order {:g} and {} at {:g}.",
           range_over(pictures, 3,
                      [](const MeasuredPicture& one) { return one.fixed.front().fine_share; }),
           kPaperOrders.front(),
           range_over(pictures, 3,
                      [](const MeasuredPicture& one) { return one.fixed.back().fine_share; }),
           kPaperOrders.back()),
       count_pictures(pictures,
                      [](const MeasuredPicture& one) {
                        return one.fixed[1].fine_share < one.fixed[0].fine_share &&
                               one.fixed[2].fine_share < one.fixed[1].fine_share;
                      }),
       n});
  claims.push_back(
      {"best", "Fig. 1", "The adaptive texture is the best of the four.",
       "The paper defines no measure of a good texture apart from likeness to the adaptive one.", 0,
       0});
  claims.push_back({"entropy-orders", "Fig. 3",
                    "The adaptive texture's entropy is that of " + published_orders() + ".",
                    fmt::format("It is nearest to that of order {}.",
                                range_over(pictures, 2,
                                           [](const MeasuredPicture& one) {
                                             return order_of_entropy(one.evaluation);
                                           })),
                    count_pictures(pictures,
                                   [](const MeasuredPicture& one) {
                                     return is_published_order(order_of_entropy(one.evaluation));
                                   }),
                    n});
  claims.push_back({"likeness-orders", "Fig. 3",
                    "MS-SSIM with the adaptive texture is largest at " + published_orders() + ".",
                    fmt::format("It is largest at order {}, where it is {}.",
                                range_over(pictures, 2,
                                           [](const MeasuredPicture& one) {
                                             return engine::closest_order(one.evaluation).order;
                                           }),
                                range_over(pictures, 4,
                                           [](const MeasuredPicture& one) {
                                             return engine::closest_order(one.evaluation).ms_ssim;
                                           })),
                    count_pictures(pictures,
                                   [](const MeasuredPicture& one) {
                                     return is_published_order(
                                         engine::closest_order(one.evaluation).order);
                                   }),
                    n});
}

void add_change(std::vector<PaperClaim>& claims, const PaperMeasures& measures, std::string id,
                const std::string& statement, const PaperStatistic& statistic, bool rises) {
  const CellChanges measured = measured_changes(measures, statistic);
  const char* verb = rises ? "rises" : "falls";
  const int agreeing = rises ? measured.rising : measured.falling;
  std::string published_text = "The paper does not compute it";
  if (statistic.published != nullptr) {
    const CellChanges published = published_changes(statistic);
    published_text = fmt::format("It {} in {} of the paper's {} cells", verb,
                                 rises ? published.rising : published.falling, published.total);
  }
  claims.push_back(
      {std::move(id), "Table 1", statement,
       fmt::format("{}, and in {} of {} here.", published_text, agreeing, measured.total), agreeing,
       measured.total});
  if (statistic.published == nullptr) {
    claims.back().measured = fmt::format("{}; it {} in {} of {} cells here.", published_text, verb,
                                         agreeing, measured.total);
  }
}

/// A sentence about the widths of exact intervals of the reported accuracies.
std::string exact_widths() {
  constexpr int kTrials = kPublishedPeople * kPublishedTrialsOfClass;
  double low = 1.0;
  double high = 0.0;
  for (const int percent : kPublishedPercents) {
    const Interval interval = clopper_pearson_interval({kTrials, percent * kTrials / 100});
    low = std::min(low, interval.high - interval.low);
    high = std::max(high, interval.high - interval.low);
  }
  return fmt::format(
      "With {} presentations of each, exact 95 % intervals are {:.0f} to {:.0f} points wide, and "
      "wider if people differ.",
      kTrials, 100.0 * low, 100.0 * high);
}

TableSummary summary_of_measures(const MeasuredPicture& one) {
  return summary_of(one.evaluation.original.glcm, one.evaluation.adaptive.glcm);
}

void add_table(std::vector<PaperClaim>& claims, const PaperMeasures& measures) {
  const auto& pictures = measures.pictures;
  const int n = static_cast<int>(pictures.size());
  add_change(claims, measures, "asm", "ASM rises by extraction.", kPaperStatistics[0], true);
  add_change(claims, measures, "energy", "\"Entropy\" (which is sqrt(ASM)) rises by extraction.",
             kPaperStatistics[1], true);
  add_change(claims, measures, "entropy",
             "Entropy, as a measure of randomness, rises by extraction.", kPaperStatistics[4],
             true);
  add_change(claims, measures, "contrast", "Contrast falls by extraction.", kPaperStatistics[2],
             false);
  add_change(claims, measures, "correlation", "Correlation falls by extraction.",
             kPaperStatistics[3], false);
  claims.push_back(
      {"third-picture", "Table 1",
       fmt::format("Its picture {}: contrast rises, ASM does not.", kPublishedContradiction + 1),
       fmt::format("Contrast is {} times the original's.",
                   range_over(pictures, 2,
                              [](const MeasuredPicture& one) {
                                return summary_of_measures(one).contrast_ratio;
                              })),
       count_pictures(pictures,
                      [](const MeasuredPicture& one) {
                        const TableSummary summary = summary_of_measures(one);
                        return summary.contrast_rises && !summary.asm_rises;
                      }),
       n});
  claims.push_back(
      {"correlation-level", "Table 1",
       fmt::format("Correlations of textures have means over the directions of {:.2f} and more.",
                   published_least_correlation()),
       fmt::format("Means are {}.", range_over(pictures, 3,
                                               [](const MeasuredPicture& one) {
                                                 return summary_of_measures(one).correlation_after;
                                               })),
       count_pictures(pictures,
                      [](const MeasuredPicture& one) {
                        return summary_of_measures(one).correlation_after >=
                               published_least_correlation();
                      }),
       n});
}

}  // namespace

std::string verdict_of(const PaperClaim& claim) {
  if (claim.total == 0) return "cannot be tested";
  if (claim.agreeing == claim.total) return "agrees";
  if (claim.agreeing == 0) return "differs";
  return fmt::format("agrees in {} of {}", claim.agreeing, claim.total);
}

CellChanges published_changes(const PaperStatistic& statistic) {
  CellChanges changes;
  if (statistic.published == nullptr) return changes;
  for (const PublishedPicture& picture : kPublishedTable) {
    const PublishedRow& row = picture.*statistic.published;
    for (std::size_t i = 0; i < row.original.size(); ++i) {
      count_change(changes, row.original[i], row.texture[i]);
    }
  }
  return changes;
}

CellChanges measured_changes(const PaperMeasures& measures, const PaperStatistic& statistic) {
  CellChanges changes;
  for (const MeasuredPicture& one : measures.pictures) {
    for (std::size_t i = 0; i < engine::kGlcmOffsets.size(); ++i) {
      count_change(changes, one.evaluation.original.glcm[i].*statistic.measured,
                   one.evaluation.adaptive.glcm[i].*statistic.measured);
    }
  }
  return changes;
}

Proportion published_roots() {
  Proportion roots;
  const auto count = [&](const PublishedCells& moments, const PublishedCells& entropies) {
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const double min_root = std::sqrt(moments[i] - kPublishedAsmRounding);
      const double max_root = std::sqrt(moments[i] + kPublishedAsmRounding);
      roots.add(entropies[i] >= min_root - kPublishedEntropyRounding &&
                entropies[i] <= max_root + kPublishedEntropyRounding);
    }
  };
  for (const PublishedPicture& picture : kPublishedTable) {
    count(picture.asm_.original, picture.entropy.original);
    count(picture.asm_.texture, picture.entropy.texture);
  }
  return roots;
}

TableSummary summary_of(const PublishedPicture& picture) {
  return summary_of_pairs(pairs_of(picture));
}

TableSummary summary_of(const engine::GlcmTable& original, const engine::GlcmTable& texture) {
  CellPairs pairs{};
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {original[i], texture[i]};
  return summary_of_pairs(pairs);
}

double published_least_correlation() {
  double smallest = 1.0;
  for (const PublishedPicture& picture : kPublishedTable) {
    smallest = std::min(smallest, summary_of(picture).correlation_after);
  }
  return smallest;
}

bool is_like_contradiction(const TableSummary& summary) {
  return summary.contrast_rises && !summary.asm_rises &&
         summary.correlation_after >= published_least_correlation();
}

std::string range_over(const std::vector<MeasuredPicture>& pictures, int decimals,
                       const std::function<double(const MeasuredPicture&)>& number) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const MeasuredPicture& one : pictures) {
    low = std::min(low, number(one));
    high = std::max(high, number(one));
  }
  if (low > high) return "-";
  const std::string low_text = fmt::format("{:.{}f}", low, decimals);
  const std::string high_text = fmt::format("{:.{}f}", high, decimals);
  return low_text == high_text ? low_text : low_text + " to " + high_text;
}

std::vector<PaperClaim> paper_claims(const PaperMeasures& measures) {
  std::vector<PaperClaim> claims;
  add_orders(claims, measures);
  add_table(claims, measures);
  claims.push_back({"accuracies", "Fig. 6",
                    fmt::format("People name the textures in {} % of presentations.",
                                listed(kPublishedPercents, " and ",
                                       [](int percent) { return std::to_string(percent); })),
                    exact_widths() + " No person has been tested with this program.", 0, 0});
  claims.push_back(
      {"decibel", "Conclusions",
       fmt::format("The average accuracy is {} dB above TV-Gabor's.", kPublishedDecibel),
       "No person has been tested; the text gives neither accuracies nor numbers of "
       "people and trials for it.",
       0, 0});
  return claims;
}

}  // namespace touchtrial::analysis
