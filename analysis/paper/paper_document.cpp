#include "analysis/paper/paper_document.hpp"

#include "analysis/paper/paper_claims.hpp"
#include "analysis/paper/paper_intervals.hpp"
#include "analysis/paper/published.hpp"
#include "analysis/report/page/wording.hpp"
#include "analysis/report/text_figures.hpp"
#include "analysis/statistics/proportion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

constexpr std::array<double, 3> kSpreads = {0.0, 0.10, 0.20};
/// Table 3: presentations per person and method if four pictures are felt five times each.
constexpr int kTrialsPerMethod = 4 * kPublishedTrialsOfClass;

/// Deviations of one picture that differ by less agree within the paper's rounding.
constexpr double kAgreement_percent = 1.0;

std::string decimal(double number, int decimals) {
  return std::isfinite(number) ? fmt::format("{:.{}f}", number, decimals) : "-";
}

std::string percent_range(const Interval& interval) {
  return fmt::format("{:.1f} to {:.1f}", 100.0 * interval.low, 100.0 * interval.high);
}

std::string picture_number(std::size_t index) {
  return fmt::format("paper {}", index + 1);
}

Section agreement_section(const PaperMeasures& measures, const std::string& source) {
  Table table{.id = "paper-claims",
              .caption = "What the paper states, and what was found here",
              .columns = {{"in the paper", Align::left},
                          {"statement", Align::left},
                          {"found", Align::left},
                          {"verdict", Align::left}}};
  for (const PaperClaim& claim : paper_claims(measures)) {
    table.rows.push_back({claim.where, claim.statement, claim.measured, {verdict_of(claim), true}});
  }
  table.notes = {
      {"A verdict counts pictures, or cells of Table 1 (one statistic of one picture in "
       "one direction)."}};
  return {"agreement",
          "What agrees and what does not",
          {CitedText{fmt::format(
               "The paper is \"Haptic Texture Rendering of 2D Image Based on Adaptive Fractional "
               "Differential Method\". Its measurements are repeated here on {}, with the method "
               "as docs/method.md defines it.",
               source)},
           CitedText{
               "The paper does not name the images that it took from the Brodatz database, so its "
               "numbers cannot be compared cell by cell. What can be compared is the direction "
               "of each change, and ranges. Its text states no numbers for Figs. 1, 3 and 7, and "
               "Figs. 2 and 5 are a diagram and a photograph. In what follows, \"Fig. 1\" and "
               "\"Table 1\" are the paper's."},
           std::move(table)}};
}

Section figure_1_section(const PaperMeasures& measures, const PaperPictures& pictures) {
  Table table{.id = "paper-strength",
              .caption =
                  "Strength of textures (rms of T, grey levels), and the share of their "
                  "power in the finest sub-bands",
              .columns = {{"picture", Align::left}}};
  for (const double order : kPaperOrders) {
    table.columns.push_back({fmt::format("rms, {:g}", order)});
  }
  table.columns.push_back({"rms, adaptive"});
  for (const double order : kPaperOrders) {
    table.columns.push_back({fmt::format("fine share, {:g}", order)});
  }
  table.columns.push_back({"fine share, adaptive"});
  for (const MeasuredPicture& one : measures.pictures) {
    std::vector<Cell> row = {one.name};
    for (const TextureStrength& fixed : one.fixed) row.emplace_back(decimal(fixed.rms_grey, 2));
    row.emplace_back(decimal(one.adaptive.rms_grey, 2));
    for (const TextureStrength& fixed : one.fixed) row.emplace_back(decimal(fixed.fine_share, 3));
    row.emplace_back(decimal(one.adaptive.fine_share, 3));
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      {"Fine share: the power of the texture's sub-bands LH, HL and HH over that of all "
       "four, of one level of the transform of the paper's Eq. 1."}};
  return {"figure-1",
          "Figure 1 and Table 2: textures",
          {CitedText{
               "The paper shows five pictures and their textures of three fixed orders and of the "
               "adaptive method, and judges them by eye. The table has numbers for two of its "
               "observations."},
           pictures.orders, std::move(table)}};
}

const engine::OrderEvaluation& evaluation_nearest(const engine::Evaluation& evaluation,
                                                  double order) {
  return *std::min_element(evaluation.orders.begin(), evaluation.orders.end(),
                           [&](const auto& a, const auto& b) {
                             return std::abs(a.order - order) < std::abs(b.order - order);
                           });
}

Section figure_3_section(const PaperMeasures& measures, const Picture& sweep) {
  constexpr std::array<double, 4> kShownOrders = {0.3, 0.5, 0.7, 0.95};
  Table table{.id = "paper-sweep",
              .caption = "MS-SSIM of the textures of fixed orders with the adaptive texture",
              .columns = {{"picture", Align::left},
                          {"entropy, adaptive, nats"},
                          {"most alike: order"},
                          {"its entropy"},
                          {"its MS-SSIM"}}};
  for (const double order : kShownOrders) table.columns.push_back({fmt::format("at {:g}", order)});
  double min_ms_ssim = 1.0;
  for (const MeasuredPicture& one : measures.pictures) {
    const engine::OrderEvaluation& closest = engine::closest_order(one.evaluation);
    min_ms_ssim = std::min(min_ms_ssim, closest.ms_ssim);
    std::vector<Cell> row = {one.name, decimal(one.evaluation.adaptive.entropy, 3),
                             decimal(closest.order, 2), decimal(closest.entropy, 3),
                             decimal(closest.ms_ssim, 4)};
    for (const double order : kShownOrders) {
      row.emplace_back(decimal(evaluation_nearest(one.evaluation, order).ms_ssim, 4));
    }
    table.rows.push_back(std::move(row));
  }
  table.notes = {{fmt::format(
      "For every picture, one fixed order reaches an MS-SSIM of at least {:.4f} with "
      "the adaptive texture. MS-SSIM measures similarity to the adaptive texture, not quality.",
      min_ms_ssim)}};
  return {"figure-3",
          "Figures 2 and 3: entropy and MS-SSIM over the order",
          {CitedText{
               "Fig. 2 is the procedure of MS-SSIM, which docs/method.md defines. The paper's Eq. "
               "6 prints twice the covariance in the structure term; with it, equal pictures "
               "would have terms above 1. Here the covariance is single, and equal pictures have "
               "exactly 1."},
           sweep, std::move(table)}};
}

void add_published_rows(Table& table, std::size_t index) {
  for (const PaperStatistic& statistic : kPaperStatistics) {
    if (statistic.published == nullptr) continue;
    const PublishedRow& row = kPublishedTable[index].*statistic.published;
    std::vector<Cell> cells = {picture_number(index), std::string(statistic.name)};
    for (const double number : row.original) {
      cells.emplace_back(decimal(number, statistic.decimals));
    }
    for (const double number : row.texture) cells.emplace_back(decimal(number, statistic.decimals));
    table.rows.push_back(std::move(cells));
  }
}

void add_measured_rows(Table& table, const MeasuredPicture& one) {
  for (const PaperStatistic& statistic : kPaperStatistics) {
    std::vector<Cell> cells = {one.name, std::string(statistic.name)};
    for (const engine::GlcmTable* const picture :
         {&one.evaluation.original.glcm, &one.evaluation.adaptive.glcm}) {
      for (const engine::GlcmStatistics& direction : *picture) {
        cells.emplace_back(decimal(direction.*statistic.measured, statistic.decimals));
      }
    }
    table.rows.push_back(std::move(cells));
  }
}

Table empty_cells_table(std::string id, std::string caption) {
  Table table{.id = std::move(id),
              .caption = std::move(caption),
              .columns = {{"picture", Align::left}, {"statistic", Align::left}}};
  for (const char* const when : {"before", "after"}) {
    for (const engine::GlcmOffset& offset : engine::kGlcmOffsets) {
      table.columns.push_back({fmt::format("{}, {} deg", when, offset.degrees)});
    }
  }
  return table;
}

Table published_cells_table() {
  Table table = empty_cells_table("paper-table-1", "The paper's Table 1 as it is printed");
  for (std::size_t i = 0; i < kPublishedTable.size(); ++i) add_published_rows(table, i);
  const Proportion roots = published_roots();
  table.notes = {
      {fmt::format("Its \"Entropy\" equals sqrt(ASM), within the rounding of both, in {} of {} "
                   "cells. Image libraries call that number energy; it is not an entropy.",
                   roots.correct, roots.n)}};
  return table;
}

Table measured_cells_table(const PaperMeasures& measures) {
  Table table = empty_cells_table("paper-table-1-here", "The same statistics of our pictures");
  for (const MeasuredPicture& one : measures.pictures) add_measured_rows(table, one);
  return table;
}

Table changes_table(const PaperMeasures& measures) {
  Table table{
      .id = "paper-changes",
      .caption =
          "Cells of Table 1 in which a statistic changes by extraction, in the paper and here",
      .columns = {{"statistic", Align::left},
                  {"rises, paper"},
                  {"falls, paper"},
                  {"cells, paper"},
                  {"rises, here"},
                  {"falls, here"},
                  {"cells, here"}}};
  for (const PaperStatistic& statistic : kPaperStatistics) {
    const CellChanges published = published_changes(statistic);
    const CellChanges measured = measured_changes(measures, statistic);
    const auto count_or_dash = [&](int count) {
      return Cell(published.total == 0 ? "-" : std::to_string(count));
    };
    table.rows.push_back({std::string(statistic.name), count_or_dash(published.rising),
                          count_or_dash(published.falling), count_or_dash(published.total),
                          std::to_string(measured.rising), std::to_string(measured.falling),
                          std::to_string(measured.total)});
  }
  return table;
}

void add_summary(Table& table, std::string name, const TableSummary& summary) {
  table.rows.push_back({std::move(name), decimal(summary.deviation_before, 1),
                        decimal(summary.deviation_after, 1),
                        decimal(summary.deviation_after / summary.deviation_before, 2),
                        decimal(summary.contrast_ratio, 2), decimal(summary.correlation_after, 3),
                        summary.agrees_with_text ? "yes" : "no"});
}

Table summary_table(const PaperMeasures& measures) {
  Table table{.id = "paper-summary",
              .caption =
                  "Table 1 by picture: standard deviation of the grey levels that contrast "
                  "and correlation imply, and means over the directions",
              .columns = {{"picture", Align::left},
                          {"deviation before"},
                          {"deviation after"},
                          {"after / before"},
                          {"contrast, after / before"},
                          {"correlation after"},
                          {"as the text says"}}};
  for (std::size_t i = 0; i < kPublishedTable.size(); ++i) {
    add_summary(table, picture_number(i), summary_of(kPublishedTable[i]));
  }
  for (const MeasuredPicture& one : measures.pictures) {
    add_summary(table, one.name,
                summary_of(one.evaluation.original.glcm, one.evaluation.adaptive.glcm));
  }
  table.notes = {
      {"In every direction, contrast is 2 (1 - correlation) times the squared "
       "deviation. As the text says: ASM rises, contrast falls and correlation falls, "
       "in all four directions."}};
  return table;
}

/// The number of pictures that meet a condition under one reading.
template <typename Condition>
std::string count_in_reading(const PaperMeasures& measures, std::size_t reading,
                             const Condition& condition) {
  const auto count = std::count_if(
      measures.pictures.begin(), measures.pictures.end(), [&](const MeasuredPicture& one) {
        return condition(summary_of(one.evaluation.original.glcm, one.readings[reading]));
      });
  return fmt::format("{} of {}", count, measures.pictures.size());
}

std::string range_in_reading(const PaperMeasures& measures, std::size_t reading,
                             double TableSummary::*number, int decimals) {
  return range_over(measures.pictures, decimals, [&](const MeasuredPicture& one) {
    return summary_of(one.evaluation.original.glcm, one.readings[reading]).*number;
  });
}

Table readings_table(const PaperMeasures& measures) {
  const double min_correlation = published_least_correlation();
  Table table{
      .id = "paper-readings",
      .caption = "The paper's Table 1 under other readings of what the paper leaves open",
      .columns = {{"reading of the adaptive method", Align::left},
                  {"contrast, after / before"},
                  {"correlation after"},
                  {"as the text says"},
                  {fmt::format("and correlation {:.2f} or more", min_correlation)},
                  {fmt::format("like the paper's picture {}", kPublishedContradiction + 1)}}};
  for (std::size_t i = 0; i < kTableReadings.size(); ++i) {
    table.rows.push_back(
        {kTableReadings[i].words, range_in_reading(measures, i, &TableSummary::contrast_ratio, 2),
         range_in_reading(measures, i, &TableSummary::correlation_after, 3),
         count_in_reading(measures, i,
                          [](const TableSummary& one) { return one.agrees_with_text; }),
         count_in_reading(measures, i,
                          [&](const TableSummary& one) {
                            return one.agrees_with_text && one.correlation_after >= min_correlation;
                          }),
         count_in_reading(measures, i, is_like_contradiction)});
  }
  table.notes = {
      {fmt::format("Like picture {}: contrast rises in every direction, ASM in none, and the mean "
                   "correlation is at least the paper's smallest. docs/method.md, \"Options\", "
                   "defines the readings.",
                   kPublishedContradiction + 1)}};
  return table;
}

/// The names of the readings under which a picture meets a condition.
template <typename Condition>
std::string readings_with(const PaperMeasures& measures, const Condition& condition) {
  std::string words;
  for (std::size_t i = 0; i < kTableReadings.size(); ++i) {
    const bool is_met = std::any_of(
        measures.pictures.begin(), measures.pictures.end(), [&](const MeasuredPicture& one) {
          return condition(summary_of(one.evaluation.original.glcm, one.readings[i]));
        });
    if (is_met)
      words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", kTableReadings[i].words);
  }
  return words.empty() ? "none" : words;
}

std::string contradiction_words(const PaperMeasures& measures) {
  const TableSummary contradiction = summary_of(kPublishedTable[kPublishedContradiction]);
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (std::size_t i = 0; i < kPublishedTable.size(); ++i) {
    if (i == kPublishedContradiction) continue;
    const TableSummary other = summary_of(kPublishedTable[i]);
    low = std::min(low, other.deviation_after / other.deviation_before);
    high = std::max(high, other.deviation_after / other.deviation_before);
  }
  return fmt::format(
      "Picture {} of the paper's table contradicts the text: contrast grows {:.1f}-fold and ASM "
      "rises in no direction. The texture keeps {:.0f} % of the picture's standard deviation, "
      "where "
      "the other four keep {:.0f} to {:.0f} %. The standard deviations that its cells of contrast "
      "and correlation imply differ by at most {:.1f} % between directions, so {}. How strong a "
      "texture is depends on a normalisation that the paper does not give: contrast here becomes "
      "{} "
      "times as large with the mask as defined, and {} times with the mask divided by its sum. "
      "Readings under which one of our pictures has a growing contrast, no rising ASM and a "
      "correlation as high as the paper's: {}.",
      kPublishedContradiction + 1, contradiction.contrast_ratio,
      100.0 * contradiction.deviation_after / contradiction.deviation_before, 100.0 * low,
      100.0 * high, contradiction.disagreement_percent,
      contradiction.disagreement_percent < kAgreement_percent
          ? "no single cell can be a misprint"
          : "some of these cells may be misprints",
      range_in_reading(measures, kReadingAsDefined, &TableSummary::contrast_ratio, 2),
      range_in_reading(measures, kReadingBySum, &TableSummary::contrast_ratio, 2),
      readings_with(measures, is_like_contradiction));
}

std::string correlation_words(const PaperMeasures& measures) {
  const double min_correlation = published_least_correlation();
  return fmt::format(
      "Every texture in the paper has a mean correlation over the directions of {:.2f} or more. "
      "The texture T is a difference of a pixel and its surroundings within two pixels, which "
      "removes what neighbours share, so its correlation is small unless the picture itself is "
      "smooth. Readings under which one of our pictures reaches that level while ASM, contrast and "
      "correlation change as the text says: {}. The paper gives neither the size of its mask nor "
      "its normalisation, so which one it used cannot be decided.",
      min_correlation, readings_with(measures, [&](const TableSummary& one) {
        return one.agrees_with_text && one.correlation_after >= min_correlation;
      }));
}

Section table_1_section(const PaperMeasures& measures) {
  return {"table-1",
          "Table 1: co-occurrence statistics",
          {changes_table(measures), summary_table(measures),
           CitedText{contradiction_words(measures)}, CitedText{correlation_words(measures)},
           readings_table(measures), published_cells_table(), measured_cells_table(measures)}};
}

Section figure_4_section(const PaperPictures& pictures) {
  return {
      "figure-4",
      "Figures 4 and 5: forces and apparatus",
      {CitedText{"Fig. 4 shows the forces on the texture of the picture \"Lena\" at order 0.55. "
                 "That picture is not shipped with this program, so the first picture is used "
                 "here. The figure has no scale, so its numbers cannot be compared."},
       pictures.forces,
       CitedText{"Fig. 5 is a photograph of a Phantom Omni beside a computer. Touchtrial has a "
                 "driver for that device, which has not been verified on hardware "
                 "(docs/devices)."}}};
}

double published_mean() {
  return std::accumulate(kPublishedPercents.begin(), kPublishedPercents.end(), 0.0) /
         (100.0 * kPublishedClasses);
}

void add_interval_row(Table& table, std::string name, double share, int trials_of_person) {
  const int n = kPublishedPeople * trials_of_person;
  const Proportion proportion{n, static_cast<int>(std::lround(share * n))};
  std::vector<Cell> row = {std::move(name), share_figure(share),
                           fmt::format("{} of {}", proportion.correct, proportion.n),
                           percent_range(clopper_pearson_interval(proportion))};
  for (const double spread : kSpreads) {
    row.emplace_back(
        percent_range(assumed_interval(share, spread, {kPublishedPeople, trials_of_person})));
  }
  row.emplace_back(percent_range(
      assumed_interval(share, largest_spread(share), {kPublishedPeople, trials_of_person})));
  table.rows.push_back(std::move(row));
}

Table accuracy_table() {
  Table table{
      .id = "paper-accuracies",
      .caption = "The paper's Fig. 6 with 95 % intervals, in per cent",
      .columns = {
          {"picture", Align::left}, {"reported"}, {"right"}, {"exact, trials independent"}}};
  for (const double spread : kSpreads) {
    table.columns.push_back({fmt::format("people differ by {:.0f} points", 100.0 * spread)});
  }
  table.columns.push_back({"people always right or always wrong"});
  for (std::size_t i = 0; i < kPublishedPercents.size(); ++i) {
    add_interval_row(table, fmt::format("picture {}", i + 1), kPublishedPercents[i] / 100.0,
                     kPublishedTrialsOfClass);
  }
  add_interval_row(table, "mean of all", published_mean(), kPublishedTrials);
  table.notes = {
      {fmt::format(
          "Assumes that each of {} people felt every picture {} times ({} presentations in "
          "all); the paper says only that a computer drew them at random.",
          kPublishedPeople, kPublishedTrialsOfClass, kPublishedTrials)},
      {"Exact: the interval of Clopper and Pearson, which treats all presentations as "
       "independent.",
       {Source::clopper_pearson, Source::brown_cai_dasgupta}},
      {"People differ by: the standard deviation of people's own probabilities of a right answer. "
       "The interval is the t interval over people with the variance that their shares then have "
       "on average, cut at 0 and 100.",
       {Source::student}}};
  return table;
}

double lowest_interval_end() {
  double lowest_end = 1.0;
  for (const int percent : kPublishedPercents) {
    const double share = percent / 100.0;
    lowest_end = std::min(lowest_end, assumed_interval(share, largest_spread(share),
                                                       {kPublishedPeople, kPublishedTrialsOfClass})
                                          .low);
  }
  return lowest_end;
}

Section figure_6_section() {
  const double chance = 1.0 / kPublishedClasses;
  const double lowest_end = lowest_interval_end();
  return {
      "figure-6",
      "Figure 6: accuracies of the first experiment",
      {CitedText{
           "The paper reports one percentage per picture, without a spread between people, an "
           "interval or a test. Their precision therefore depends on how much people differed."},
       accuracy_table(),
       CitedText{fmt::format("Even with the largest possible spread, the lowest interval "
                             "ends at {}, which is {} chance ({}).",
                             share_figure(lowest_end), lowest_end > chance ? "above" : "not above",
                             share_figure(chance))},
       CitedText{
           "We have no numbers to compare with these: no person has been tested with this program. "
           "Simulated participants can run the same study (docs/stimuli.md), but they model a hand "
           "and a sense of touch, not people."}}};
}

Table methods_table(const PaperMeasures& measures) {
  Table table{.id = "paper-methods",
              .caption = "Textures by both methods",
              .columns = {{"picture", Align::left},
                          {"rms, adaptive"},
                          {"rms, TV-Gabor"},
                          {"fine share, adaptive"},
                          {"fine share, TV-Gabor"},
                          {"MS-SSIM of the two"}}};
  for (const MethodMeasures& one : measures.compared) {
    table.rows.push_back({one.name, decimal(one.adaptive.rms_grey, 2),
                          decimal(one.tv_gabor.rms_grey, 2), decimal(one.adaptive.fine_share, 3),
                          decimal(one.tv_gabor.fine_share, 3), decimal(one.ms_ssim, 3)});
  }
  table.notes = {{"The paper gives no parameter of TV-Gabor; docs/method.md states ours."}};
  return table;
}

Table decibel_table(double adaptive, double tv_gabor) {
  Table table{.id = "paper-decibel",
              .caption = fmt::format("What {} dB would be in a study of {} people, 95 % intervals",
                                     kPublishedDecibel, kPublishedPeople),
              .columns = {{"people's differences spread by", Align::left},
                          {"difference, points"},
                          {"dB"},
                          {"excludes no difference", Align::left}}};
  for (const double spread : kSpreads) {
    const AssumedDifference one =
        assumed_difference(adaptive, tv_gabor, spread, {kPublishedPeople, kTrialsPerMethod});
    table.rows.push_back({fmt::format("{:.0f} points", 100.0 * spread),
                          percent_range(one.difference),
                          fmt::format("{:.2f} to {:.2f}", one.decibel.low, one.decibel.high),
                          one.difference.low > 0.0 ? "yes" : "no"});
  }
  table.notes = {
      {fmt::format("Assumes that each of {} people felt {} presentations with either method, and "
                   "that the adaptive method's accuracy is the mean of Fig. 6; the paper says "
                   "neither. t intervals over people; the one in dB to first order.",
                   kPublishedPeople, kTrialsPerMethod),
       {Source::student}}};
  return table;
}

Section table_3_section(const PaperMeasures& measures, const PaperPictures& pictures) {
  const double adaptive = published_mean();
  const double ratio = std::pow(10.0, kPublishedDecibel / 10.0);
  const double tv_gabor = adaptive / ratio;
  return {
      "table-3",
      "Table 3 and Figure 7: comparison with TV-Gabor",
      {pictures.methods, methods_table(measures),
       CitedText{fmt::format(
           "The paper's text gives no accuracy of Fig. 7, and summarises it as {} dB more. Read "
           "as 10 log10 of a ratio of accuracies, that is a factor of {:.3f}: {} instead of {}, "
           "if the adaptive method reaches the mean of Fig. 6. A decibel compares powers, "
           "which accuracies are not, and the paper does not say whether it averaged ratios or "
           "accuracies. Without numbers of people and trials, without knowing whether the same "
           "people felt both methods, and without a spread, no interval follows from it.",
           kPublishedDecibel, ratio, share_figure(adaptive), share_figure(tv_gabor))},
       decibel_table(adaptive, tv_gabor)}};
}

}  // namespace

Document paper_document(const PaperMeasures& measures, const PaperPictures& pictures,
                        const Picture& sweep, const std::string& source) {
  Document document;
  document.title = "The source paper, figure by figure";
  document.about = "This page";
  document.numbered = false;  // "Table 1" is the paper's
  document.sections = {agreement_section(measures, source), figure_1_section(measures, pictures),
                       figure_3_section(measures, sweep),   table_1_section(measures),
                       figure_4_section(pictures),          figure_6_section(),
                       table_3_section(measures, pictures)};
  document.colophon = "Made by the command touchtrial paper.";
  return document;
}

}  // namespace touchtrial::analysis
