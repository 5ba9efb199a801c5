#include "analysis/report/page/wording.hpp"
#include "core/named.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/measures.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using procedures::Censored;
using study::threshold::LevelQuantity;
using study::threshold::Question;
using study::threshold::Task;
using study::threshold::ThresholdOptions;

std::string answer_words(const ThresholdOptions& options) {
  switch (options.question) {
    case Question::odd_one_out:
      return "which of three planes differed from the other two";
    case Question::same_different:
      return "whether two planes were the same";
    case Question::which_interval:
      break;
  }
  const std::string planes = fmt::format("which of {} planes ", options.intervals);
  if (options.task == Task::detection) return planes + "had the texture";
  return planes + (options.along == LevelQuantity::pitch ? "was coarser" : "was stronger");
}

std::string task_words(const ThresholdOptions& options) {
  if (options.task == Task::detection) return "the detection threshold of a texture";
  static constexpr auto kWords = std::to_array<Named<LevelQuantity>>(
      {{"the discrimination threshold of strength", LevelQuantity::gain},
       {"the discrimination threshold of pitch", LevelQuantity::pitch},
       {"the discrimination threshold of order", LevelQuantity::order},
       {"the smallest share of a second texture that is felt", LevelQuantity::blend}});
  return std::string(name_in(kWords, options.along));
}

std::string criterion_words(const ThresholdReport& report) {
  if (!report.criterion) return "";
  return fmt::format(
      " A threshold is the level with {} right for an observer without lapses whose guesses are {} "
      "right.",
      share_figure(report.criterion), share_figure(report.guess));
}

/// The numbers of known and unknown thresholds; empty if all are known.
std::string censored_note(const StandardReport& standard) {
  const int known = standard.number_of(Censored::no);
  if (known == std::ssize(standard.people)) return "";
  const std::string undetermined = undetermined_words(standard);
  return fmt::format(
      " Of {}, {} {} a threshold within the levels; {} above the highest, {} below the lowest, {} "
      "not determined.{}",
      counted(std::ssize(standard.people), "participant"), known, known == 1 ? "has" : "have",
      standard.number_of(Censored::above), standard.number_of(Censored::below),
      standard.number_of(Censored::undetermined),
      undetermined.empty() ? "" : " " + undetermined + ".");
}

std::string_view missing_reason_words(MissingReason reason) {
  static constexpr auto kWords = std::to_array<Named<MissingReason>>(
      {{"", MissingReason::nothing},
       {"fewer than two thresholds are known", MissingReason::values},
       {"more than half of the thresholds are unknown", MissingReason::most},
       {"the known thresholds are all equal", MissingReason::spread}});
  return name_in(kWords, reason);
}

std::string people_words(const CensoredMean& mean) {
  if (mean.participants == 1) return "of one participant";
  const std::string people = "mean of " + counted(mean.participants, "participant");
  if (!mean.interval)
    return people + ", without an interval: " + std::string(missing_reason_words(mean.lack));
  const char* kind = mean.exact == mean.participants ? "t" : "likelihood";
  return fmt::format("{} with its 95% {} interval, standard deviation {}, median {}", people, kind,
                     plain_figure(mean.sd, 1), median_text(mean));
}

std::string no_mean_words(const CensoredMean& mean) {
  const std::string median = median_text(mean);
  return fmt::format("no mean, because {}.{}", missing_reason_words(mean.lack),
                     median.empty() ? "" : fmt::format(" Median: {} dB.", median));
}

std::string standard_sentence(const ThresholdReport& report, const StandardReport& standard) {
  if (standard.tracks == 0) return standard.words + ": no counted trials.";
  if (!standard.mean.mean)
    return standard.words + ": " + no_mean_words(standard.mean) + censored_note(standard);
  const procedures::Threshold mean = mean_threshold(standard.mean);
  std::string text =
      fmt::format("{}: {} dB, {}.", standard.words, threshold_text(mean, standard.levels),
                  people_words(standard.mean));
  const std::string quantity = quantity_name(report.options());
  if (!quantity.empty()) {
    text += fmt::format(
        " {}: {}.", quantity,
        quantity_text(quantity_of(report.options(), standard.definition, mean), report.options()));
  }
  return text + censored_note(standard);
}

std::string d_prime_sentence(const SameDifferentGroup& group, const ThresholdReport& report) {
  return fmt::format("{}, {} dB: d' {} {} by differencing, answers of {} pooled.",
                     report.standards[group.standard].words, plain_figure(group.level, 1),
                     plain_figure(group.differencing.d_prime, 2),
                     plain_range(group.differencing.interval, 2),
                     counted(group.participants, "participant"));
}

Table standards_table(const ThresholdReport& report) {
  Table table = table_of("thresholds-by-standard",
                         fmt::format("Thresholds in {}; means over participants",
                                     study::threshold::unit_of_level(report.options())),
                         report.standards, standard_measures(report));
  table.notes.push_back(
      {"Levels are logarithmic, so their mean is a geometric mean. Mean and SD: maximum likelihood "
       "of a normal distribution censored at the levels (Tobin 1958). Interval: likelihood ratio, "
       "with the degrees of freedom of the known thresholds; Student's if all are known.",
       {Source::student, Source::tobin}});
  return table;
}

constexpr const char* kOpenEnd = "open";

std::string end_text(const std::optional<double>& end, int decimals) {
  return end ? plain_figure(end, decimals) : kOpenEnd;
}

std::string interval_text(const std::optional<double>& low, const std::optional<double>& high,
                          int decimals) {
  if (!low && !high) return "";
  return " [" + end_text(low, decimals) + ", " + end_text(high, decimals) + "]";
}

std::string undetermined_text(const procedures::Threshold& threshold) {
  const auto& [level, low, high, censored] = threshold;
  const std::string text = "not determined";
  if (low && high) {
    return text + ", between " + plain_figure(low, 1) + " and " + plain_figure(high, 1);
  }
  if (low) return text + ", above " + plain_figure(low, 1);
  if (high) return text + ", below " + plain_figure(high, 1);
  return text;
}

std::optional<double> percent_of(const std::optional<double>& share) {
  return share ? std::optional(100.0 * *share) : std::nullopt;
}

Section result_section(const ThresholdReport& report) {
  Section section{"result", "Result", {}};
  const ThresholdOptions& options = report.options();
  const auto add = [&](std::string text) {
    section.blocks.emplace_back(CitedText{std::move(text)});
  };
  if (report.tracks.empty()) {
    add("No trial counts, so there is no result.");
    return section;
  }
  if (report.has_thresholds()) {
    // With a verdict, these sentences would only repeat the table.
    for (const StandardReport& standard : report.standards) {
      if (!report.primary) add(standard_sentence(report, standard));
    }
  } else {
    for (const SameDifferentGroup& group : report.same_different_groups) {
      add(d_prime_sentence(group, report));
    }
  }
  if (was_heard(report)) add(sound_sentence(report));
  add(fmt::format("Measured: {}. Participants answered {}.{}", task_words(options),
                  answer_words(options), criterion_words(report)));
  if (report.without_answer > 0) {
    add(fmt::format("Left out: {} without an answer.", counted(report.without_answer, "trial")));
  }
  return section;
}

Section thresholds_section(const ThresholdReport& report) {
  Section section{"thresholds", "Thresholds", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  section.blocks.emplace_back(standards_table(report));
  if (!report.differences.empty()) {
    section.blocks.emplace_back(
        table_of("differences-of-standards",
                 "Differences of thresholds, first minus second, of participants with both",
                 report.differences, difference_measures(report)));
  }
  return section;
}

/// \param has_figure  folds the table
Section tracks_section(const ThresholdReport& report, bool has_figure) {
  Section section{"tracks-of-participants", "Tracks", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  (has_figure ? section.folded_blocks : section.blocks)
      .emplace_back(table_of("tracks",
                             fmt::format("Every track: thresholds in {}",
                                         study::threshold::unit_of_level(report.options())),
                             report.tracks, track_measures(report)));
  return section;
}

}  // namespace

std::string undetermined_words(const StandardReport& standard) {
  if (!standard.mean.mean || standard.number_of(Censored::undetermined) == 0) return "";
  int values = 0;
  int sides = 0;
  int open = 0;
  for (const PersonThreshold& person : standard.thresholds) {
    if (person.censored != Censored::undetermined) continue;
    ++(person.bounds.exact() ? values : person.bounds == Bounds{} ? open : sides);
  }
  return fmt::format(
      "Of those not determined, {} enter the mean by the likeliest threshold and {} as censored; "
      "{} {} not enter it",
      values, sides, open, open == 1 ? "does" : "do");
}

Document threshold_document(const ThresholdReport& report, const Provenance& provenance,
                            const Pictures& pictures) {
  const bool has_figure = std::ranges::any_of(pictures, [](const Picture& picture) {
    return picture.id.starts_with("threshold") && !picture.svg.empty();
  });
  return framed_document(
      report, result_section(report),
      {thresholds_section(report), same_different_section(report),
       tracks_section(report, has_figure), control_section(report), habits_section(report)},
      provenance, pictures);
}

std::string threshold_text(const procedures::Threshold& threshold,
                           const std::vector<double>& levels) {
  if (levels.empty()) return kNoFigure;
  if (threshold.censored == Censored::below) return "below " + plain_figure(levels.front(), 1);
  if (threshold.censored == Censored::above) return "above " + plain_figure(levels.back(), 1);
  if (threshold.censored == Censored::undetermined) return undetermined_text(threshold);
  if (!threshold.level) return kNoFigure;
  return plain_figure(threshold.level, 1) + interval_text(threshold.low, threshold.high, 1);
}

std::string median_text(const CensoredMean& mean) {
  if (mean.median) return plain_figure(mean.median, 1);
  const auto& [low, high] = mean.median_within;
  if (!std::isfinite(low)) return std::isfinite(high) ? "below " + plain_figure(high, 1) : "";
  if (!std::isfinite(high)) return "above " + plain_figure(low, 1);
  return "between " + plain_figure(low, 1) + " and " + plain_figure(high, 1);
}

std::string quantity_text(const Quantity& quantity, const ThresholdOptions& options) {
  if (!quantity.value) return kNoFigure;
  if (options.along == LevelQuantity::order) {
    return plain_figure(quantity.value, 3) + interval_text(quantity.low, quantity.high, 3);
  }
  return share_figure(quantity.value) +
         interval_text(percent_of(quantity.low), percent_of(quantity.high), 1);
}

std::string quantity_name(const ThresholdOptions& options) {
  if (options.task == Task::detection) return "";
  static constexpr auto kNames =
      std::to_array<Named<LevelQuantity>>({{"Weber fraction", LevelQuantity::gain},
                                           {"Weber fraction of the pitch", LevelQuantity::pitch},
                                           {"change of order", LevelQuantity::order},
                                           {"share of the second texture", LevelQuantity::blend}});
  return std::string(name_in(kNames, options.along));
}

}  // namespace touchtrial::analysis::threshold
