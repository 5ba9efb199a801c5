#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/measures.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

using procedures::Censored;
using study::threshold::Along;
using study::threshold::Question;
using study::threshold::Task;
using study::threshold::ThresholdOptions;

std::string question_words(const ThresholdOptions& options) {
  switch (options.question) {
    case Question::odd_one_out:
      return "which of three planes was unlike the other two";
    case Question::same_different:
      return "whether two planes were alike";
    case Question::which_interval:
      break;
  }
  const std::string which = fmt::format("which of {} planes ", options.intervals);
  if (options.task == Task::detection) return which + "had the texture";
  return which + (options.along == Along::pitch ? "was coarser" : "was stronger");
}

std::string task_words(const ThresholdOptions& options) {
  if (options.task == Task::detection) return "the detection threshold of a texture";
  switch (options.along) {
    case Along::gain:
      return "the discrimination threshold of strength";
    case Along::pitch:
      return "the discrimination threshold of pitch";
    case Along::order:
      return "the discrimination threshold of order";
    case Along::blend:
      return "the smallest share of a second texture that is felt";
  }
  return "";
}

std::string criterion_words(const ThresholdReport& report) {
  if (!report.criterion) return "";
  return fmt::format(
      " A threshold is the level with {} right, of an observer without lapses who guesses {} "
      "right.",
      share_figure(report.criterion), share_figure(report.guess));
}

/// Empty if everybody's threshold is known.
std::string censored_words(const StandardReport& one) {
  const int known = one.number_of(Censored::no);
  if (known == std::ssize(one.people)) return "";
  const std::string taken = taken_words(one);
  return fmt::format(
      " Of {} {} {} a threshold inside the levels; {} above the highest, {} below the lowest, {} "
      "not determined.{}",
      counted(std::ssize(one.people), "participant"), known, known == 1 ? "has" : "have",
      one.number_of(Censored::above), one.number_of(Censored::below),
      one.number_of(Censored::undetermined), taken.empty() ? "" : " " + taken + ".");
}

std::string lack_words(Lack lack) {
  switch (lack) {
    case Lack::nothing:
      break;
    case Lack::values:
      return "fewer than two thresholds are known";
    case Lack::most:
      return "more than half of the thresholds are not known";
    case Lack::spread:
      return "the known thresholds are all equal";
  }
  return "";
}

std::string people_words(const CensoredMean& mean) {
  if (mean.participants == 1) return "of one participant";
  const std::string people = "mean of " + counted(mean.participants, "participant");
  if (!mean.interval) return people + ", without an interval: " + lack_words(mean.lack);
  const char* kind = mean.exact == mean.participants ? "t" : "likelihood";
  return fmt::format("{} with its 95% {} interval, standard deviation {}, median {}", people, kind,
                     plain_figure(mean.sd, 1), median_text(mean));
}

std::string no_mean_words(const CensoredMean& mean) {
  const std::string median = median_text(mean);
  return fmt::format("no mean, because {}.{}", lack_words(mean.lack),
                     median.empty() ? "" : fmt::format(" Median: {} dB.", median));
}

std::string standard_sentence(const ThresholdReport& report, const StandardReport& one) {
  if (one.tracks == 0) return one.words + ": no trials that count.";
  if (!one.mean.mean) return one.words + ": " + no_mean_words(one.mean) + censored_words(one);
  const procedures::Threshold mean = mean_threshold(one.mean);
  std::string text = fmt::format("{}: {} dB, {}.", one.words, threshold_text(mean, one.levels),
                                 people_words(one.mean));
  const std::string quantity = quantity_name(report.options());
  if (!quantity.empty()) {
    text +=
        fmt::format(" {}: {}.", quantity,
                    quantity_text(quantity_of(report.options(), one.of, mean), report.options()));
  }
  return text + censored_words(one);
}

std::string difference_sentence(const SameDifferentGroup& one, const ThresholdReport& report) {
  return fmt::format("{}, {} dB: d' {} {} by differencing, all answers of {} pooled.",
                     report.standards[one.standard].words, plain_figure(one.level, 1),
                     plain_figure(one.differencing.d_prime, 2),
                     plain_range(one.differencing.interval, 2),
                     counted(one.participants, "participant"));
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

std::optional<double> hundredfold(const std::optional<double>& share) {
  return share ? std::optional(100.0 * *share) : std::nullopt;
}

Section result_section(const ThresholdReport& report) {
  Section section{"result", "Result", {}};
  const ThresholdOptions& options = report.options();
  const auto say = [&](std::string text) { section.blocks.emplace_back(Cited{std::move(text)}); };
  if (report.tracks.empty()) {
    say("No trial counts, so there is no result.");
    return section;
  }
  if (report.has_thresholds()) {
    // Beside a verdict they would repeat the table.
    for (const StandardReport& one : report.standards) {
      if (!report.primary) say(standard_sentence(report, one));
    }
  } else {
    for (const SameDifferentGroup& one : report.same_different_groups) {
      say(difference_sentence(one, report));
    }
  }
  if (was_heard(report)) say(sound_sentence(report));
  say(fmt::format("Measured: {}. Participants said {}.{}", task_words(options),
                  question_words(options), criterion_words(report)));
  if (report.without_answer > 0) {
    say(fmt::format("Left out: {} without an answer.", counted(report.without_answer, "trial")));
  }
  return section;
}

Section thresholds_section(const ThresholdReport& report) {
  Section section{"thresholds", "Thresholds", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  section.blocks.emplace_back(standards_table(report));
  if (!report.differences.empty()) {
    section.blocks.emplace_back(table_of(
        "differences-of-standards",
        "Differences of thresholds, first minus second, of participants with tracks of both",
        report.differences, difference_measures(report)));
  }
  return section;
}

/// A figure shows each person's threshold: the table is for those who need the numbers.
Section tracks_section(const ThresholdReport& report, bool drawn) {
  Section section{"tracks-of-participants", "Tracks", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  (drawn ? section.more : section.blocks)
      .emplace_back(table_of("tracks",
                             fmt::format("Every track: thresholds in {}",
                                         study::threshold::unit_of_level(report.options())),
                             report.tracks, track_measures(report)));
  return section;
}

}  // namespace

std::string taken_words(const StandardReport& one) {
  if (!one.mean.mean || one.number_of(Censored::undetermined) == 0) return "";
  int values = 0;
  int sides = 0;
  int open = 0;
  for (const PersonThreshold& person : one.thresholds) {
    if (person.censored != Censored::undetermined) continue;
    ++(person.bounds.exact() ? values : person.bounds == Bounds{} ? open : sides);
  }
  return fmt::format(
      "Of those not determined, the mean takes {} by the likeliest threshold and {} by the side on "
      "which it lies; {} {} no share in it",
      values, sides, open, open == 1 ? "has" : "have");
}

Document threshold_document(const ThresholdReport& report, const Provenance& provenance,
                            const Pictures& pictures) {
  const bool drawn = std::ranges::any_of(pictures, [](const Picture& one) {
    return one.id.starts_with("threshold") && !one.svg.empty();
  });
  return framed_document(
      report, result_section(report),
      {thresholds_section(report), same_different_section(report), tracks_section(report, drawn),
       control_section(report), habits_section(report)},
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
  if (options.along == Along::order) {
    return plain_figure(quantity.value, 3) + interval_text(quantity.low, quantity.high, 3);
  }
  return share_figure(quantity.value) +
         interval_text(hundredfold(quantity.low), hundredfold(quantity.high), 1);
}

std::string quantity_name(const ThresholdOptions& options) {
  if (options.task == Task::detection) return "";
  switch (options.along) {
    case Along::gain:
      return "Weber fraction";
    case Along::pitch:
      return "Weber fraction of the pitch";
    case Along::order:
      return "change of order";
    case Along::blend:
      return "share of the second texture";
  }
  return "";
}

}  // namespace touchtrial::analysis::threshold
