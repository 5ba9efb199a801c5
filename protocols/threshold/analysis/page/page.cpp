#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
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

std::string procedure_words(const ThresholdReport& report) {
  const study::threshold::ThresholdOptions& options = report.options();
  std::string text = fmt::format("Procedure: {}, {} a track.", options.track.procedure,
                                 counted(options.track.trials, "trial"));
  if (report.without_answer > 0) {
    text += fmt::format(" {} without an answer belong to no track.",
                        counted(report.without_answer, "trial"));
  }
  if (options.rove_db > 0.0) {
    text += fmt::format(" Gains were roved over {} dB.", options.rove_db);
  }
  return text;
}

std::string estimate_words(const ThresholdReport& report) {
  if (!report.has_thresholds()) {
    return "The question has no fixed guess rate, so there are d' by level and no thresholds.";
  }
  return "A threshold's 95 % interval holds the thresholds that the answers do not reject, "
         "whatever "
         "the observer's slope and lapse rate may be; its number is the likeliest threshold of "
         "usual "
         "observers. Answers to the catch trials, which are at the highest level and tell how "
         "often somebody lapses, count as those to the procedure's trials do. Nothing depends on "
         "which observers the procedure assumed. procedures-recovery.md shows how far to trust it, "
         "with simulated observers of many kinds.";
}

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
  if (options.task == Task::detection) return "the weakest texture that is felt";
  switch (options.along) {
    case Along::gain:
      return "the least change of strength that is felt";
    case Along::pitch:
      return "the least change of pitch that is felt";
    case Along::order:
      return "the least change of order that is felt";
    case Along::blend:
      return "the least share of a second texture that is felt";
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
  if (one.mean.exact == one.mean.participants) return "";
  return fmt::format(
      " Of {} {} {} a threshold inside the levels; {} above the highest, {} below the lowest, {} "
      "not determined.",
      counted(one.mean.participants, "participant"), one.mean.exact,
      one.mean.exact == 1 ? "has" : "have", one.number_of(Censored::above),
      one.number_of(Censored::below), one.number_of(Censored::undetermined));
}

/// "−12.5", "above 0.0" or "between −5.0 and −2.5"; empty if nothing is known of it.
std::string median_text(const CensoredMean& mean) {
  if (mean.median) return plain_figure(mean.median, 1);
  const auto& [low, high] = mean.median_within;
  if (!std::isfinite(low)) return std::isfinite(high) ? "below " + plain_figure(high, 1) : "";
  if (!std::isfinite(high)) return "above " + plain_figure(low, 1);
  return "between " + plain_figure(low, 1) + " and " + plain_figure(high, 1);
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
      return "those that are known are all alike";
  }
  return "";
}

std::string people_words(const CensoredMean& mean) {
  if (mean.participants == 1) return "of one participant";
  const std::string people = "mean of " + counted(mean.participants, "participant");
  if (!mean.interval) return people + ", without an interval: " + lack_words(mean.lack);
  const char* kind = mean.exact == mean.participants ? "t" : "likelihood";
  return fmt::format("{} with its 95 % {} interval, standard deviation {}, median {}", people, kind,
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

std::string or_no_figure(const std::string& text) {
  return text.empty() ? kNoFigure : text;
}

Cited mean_note() {
  return {
      "Levels are logarithms, so their mean is that of a geometric mean. Mean and SD are of the "
      "normal distribution that is most likely for everybody, of those beyond the levels by "
      "the probability to lie there (Tobin 1958). The interval is by likelihood ratio, with "
      "the degrees of freedom of those who are known. If everybody is, that is Student's.",
      {Source::student, Source::tobin}};
}

/// "2 below, 1 above"
std::string beyond_text(int below, int above) {
  if (below == 0 && above == 0) return "0";
  if (above == 0) return fmt::format("{} below", below);
  if (below == 0) return fmt::format("{} above", above);
  return fmt::format("{} below, {} above", below, above);
}

Table standards_table(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  const std::string quantity = quantity_name(options);
  Table table{"thresholds-by-standard",
              fmt::format("Thresholds in {}; means over participants",
                          study::threshold::unit_of_level(options)),
              columns_of({"standard", "n", "mean and 95% (dB)", "SD (dB)", "median (dB)", "known",
                          "beyond", "not determined"})};
  if (!quantity.empty()) table.columns.push_back({quantity + " and 95%"});
  for (const StandardReport& one : report.standards) {
    const procedures::Threshold mean = mean_threshold(one.mean);
    std::vector<Cell>& row = table.rows.emplace_back(std::vector<Cell>{
        one.words, std::to_string(one.mean.participants), threshold_text(mean, one.levels),
        plain_figure(one.mean.sd, 1), or_no_figure(median_text(one.mean)),
        std::to_string(one.number_of(Censored::no)),
        beyond_text(one.number_of(Censored::below), one.number_of(Censored::above)),
        std::to_string(one.number_of(Censored::undetermined))});
    if (!quantity.empty()) {
      row.emplace_back(quantity_text(quantity_of(options, one.of, mean), options));
    }
  }
  table.notes = {
      {"n: participants with a track, all of whom the mean counts, each with the mean of the own "
       "tracks. Known: the estimate lies inside the levels; beyond: below the lowest or above the "
       "highest, and counts as that. Not determined: the answers say hardly anything, or own "
       "tracks differ in this. If more than half are not known there is no mean."},
      {mean_note()}};
  return table;
}

Table differences_table(const ThresholdReport& report) {
  Table table{"differences-of-standards",
              "Differences of thresholds, first minus second, of participants with tracks of both",
              columns_of({"first", "second", "n", "known", "difference (dB)", "95% (dB)", "t", "p",
                          "p by Holm", "d_z, 95%"},
                         {"second"})};
  for (const DifferenceReport& one : report.differences) {
    const CensoredMean& mean = one.difference;
    table.rows.push_back({report.standards[one.first].words, report.standards[one.second].words,
                          std::to_string(mean.participants), std::to_string(mean.exact),
                          signed_plain_figure(mean.mean, 1), plain_range(mean.interval, 1),
                          one.statistic ? t_phrase(*one.statistic) : kNoFigure, p_figure(one.p),
                          p_figure(one.p_holm), effect_figure(one.statistic)});
  }
  table.notes = {
      {"Mean, interval and p, two-sided, as for thresholds; a difference is known if both "
       "thresholds are, and has a bound if one of them lies beyond the levels. By Holm: adjusted "
       "over all pairs. t and d_z, the mean over its standard deviation between participants, if "
       "every difference is known.",
       {Source::student, Source::tobin, Source::holm, Source::cumming_finch}}};
  return table;
}

bool any_track(const ThresholdReport& report, bool (*has)(const TrackReport&)) {
  return std::ranges::any_of(report.tracks, has);
}

/// "6 of 6"
std::string catches_text(const Proportion& of) {
  return of.n == 0 ? kNoFigure : fmt::format("{} of {}", of.correct, of.n);
}

Table tracks_table(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  Table table{
      "tracks",
      fmt::format("Every track: thresholds in {}", study::threshold::unit_of_level(options)),
      columns_of({"participant", "track", "standard", "n", "right", "catch trials right",
                  "threshold and 95% (dB)"},
                 {"standard"})};
  const bool turns =
      any_track(report, [](const TrackReport& t) { return t.reversals.has_value(); });
  const bool fits = any_track(report, [](const TrackReport& t) { return t.fit.has_value(); });
  const std::string quantity = quantity_name(options);
  if (turns) table.columns.push_back({"reversals"});
  if (fits) table.columns.push_back({"p of the fit"});
  if (!quantity.empty()) table.columns.push_back({quantity});
  for (const TrackReport& track : report.tracks) {
    const StandardReport& standard = report.standards[track.standard];
    const procedures::Threshold threshold = track.estimate.value().threshold;
    std::vector<Cell>& row = table.rows.emplace_back(
        std::vector<Cell>{track.participant, std::to_string(track.track), standard.words,
                          std::to_string(track.answers.n), share_figure(track.answers.share()),
                          catches_text(track.catches), threshold_text(threshold, standard.levels)});
    if (turns) {
      row.emplace_back(track.reversals ? threshold_text(*track.reversals, standard.levels)
                                       : kNoFigure);
    }
    if (fits) row.emplace_back(track.fit ? p_figure(track.fit->p) : kNoFigure);
    if (!quantity.empty()) {
      row.emplace_back(quantity_text(quantity_of(options, standard.of, threshold), options));
    }
  }
  return table;
}

/// What the columns of the tracks mean.
std::vector<Cited> tracks_notes(const ThresholdReport& report) {
  const procedures::TrackSettings& track = report.options().track;
  const bool is_any_fitted =
      any_track(report, [](const TrackReport& t) { return t.fit.has_value(); });
  std::vector<Cited> notes = {
      {"Threshold: with its 95 % interval, as under Analysis. Above, below: with usual "
       "lapse rates the whole interval lies beyond the highest or the lowest level. Not "
       "determined: the answers tell "
       "neither a threshold inside the levels nor a side; where an end of the interval is known "
       "it is stated. n and right: trials that the procedure chose; catch trials are at the "
       "highest level and count in the threshold too."}};
  if (track.procedure.ends_with("up-down")) {
    notes.push_back({fmt::format(
        "Reversals: mean of the last turns of the staircase. It estimates the level with {} right, "
        "not the threshold's {}, so the two are not to be compared; it has no interval, and is "
        "above "
        "or below where one of these turns was at a bound of the levels.",
        share_figure(procedures::convergence_of(track.up_down)), share_figure(report.criterion))});
  }
  if (is_any_fitted) {
    notes.push_back(
        {"p of the fit: the share of data sets of the fitted observer itself that deviate as much "
         "from their own fits, of 399 (Wichmann and Hill 2001). With few trials a level it finds "
         "coarse departures alone."});
  }
  return notes;
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
  return section;
}

Section thresholds_section(const ThresholdReport& report) {
  Section section{"thresholds", "Thresholds", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  section.blocks.emplace_back(standards_table(report));
  if (!report.differences.empty()) section.blocks.emplace_back(differences_table(report));
  return section;
}

/// A figure shows each person's threshold: the table is for those who need the numbers.
Section tracks_section(const ThresholdReport& report, bool drawn) {
  Section section{"tracks-of-participants", "Tracks", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  Table table = tracks_table(report);
  table.notes = tracks_notes(report);
  (drawn ? section.more : section.blocks).emplace_back(std::move(table));
  return section;
}

Section methods_section(const ThresholdReport& report) {
  Section section{"analysis", "Analysis", {}};
  section.more.emplace_back(Cited{procedure_words(report)});
  section.more.emplace_back(Cited{estimate_words(report)});
  return section;
}

}  // namespace

Document threshold_document(const ThresholdReport& report, const Provenance& provenance,
                            const Pictures& pictures) {
  const bool drawn = std::ranges::any_of(pictures, [](const Picture& one) {
    return one.id.starts_with("threshold") && !one.svg.empty();
  });
  return framed_document(
      report, result_section(report),
      {thresholds_section(report), same_different_section(report), tracks_section(report, drawn),
       control_section(report), habits_section(report), methods_section(report)},
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
