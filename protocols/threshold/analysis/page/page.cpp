#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <algorithm>
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
  if (report.by_posterior) {
    return "Quoted are posterior means with credible intervals. In simulations with known "
           "observers they are nearly without bias after 30 adaptive trials and their intervals "
           "cover at least what they state, while those of maximum likelihood cover less in short "
           "adaptive tracks (procedures-recovery.md). Slopes fitted to adaptive tracks are too "
           "steep.";
  }
  return "Quoted are maximum-likelihood fits with profile intervals, which with constant stimuli "
         "cover what they state (procedures-recovery.md). Goodness of fit is by simulation.";
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

std::string censored_words(const StandardReport& one) {
  const int censored = one.censored_below + one.censored_above;
  if (censored == 0) return "";
  return fmt::format(" {} of {} gave none, {} below the lowest level and {} above the highest.",
                     censored, counted(one.tracks, "track"), one.censored_below,
                     one.censored_above);
}

std::string people_words(const MeanEstimate& mean) {
  if (mean.participants == 1) return "of one participant";
  return fmt::format("mean of {} with its 95 % t interval, standard deviation {}",
                     counted(mean.participants, "participant"), plain_figure(mean.sd, 1));
}

std::string standard_sentence(const ThresholdReport& report, const StandardReport& one) {
  if (one.tracks == 0) return one.words + ": no trials that count.";
  if (!one.mean.mean) return one.words + ": no threshold." + censored_words(one);
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

std::string control_sentence(const ThresholdReport& report) {
  if (!report.control) {
    return "There was no control block with the hand off the device: whether the textures could be "
           "heard is not known.";
  }
  const RightAnswers& pooled = report.control->pooled;
  const std::string counts = fmt::format(
      "With the hand off the device {} of {} answers were right ({} {}, exact, one-sided {} "
      "against guessing)",
      pooled.answers.correct, pooled.answers.n, share_figure(pooled.answers.share()),
      share_range(pooled.interval), p_phrase(pooled.p.value_or(1.0)));
  if (pooled.p.value_or(1.0) <= kUsualLevel) {
    return counts +
           ": more than by guessing. Participants could hear it; the threshold may be of "
           "the ear.";
  }
  return counts +
         ": no sign that anybody could hear it. Few trials show only what is easily "
         "heard.";
}

std::string difference_sentence(const SameDifferentGroup& one, const ThresholdReport& report) {
  return fmt::format("{}, {} dB: d' {} {} by differencing, mean of {}.",
                     report.standards[one.standard].words, plain_figure(one.level, 1),
                     plain_figure(one.differencing.mean, 2),
                     plain_range(one.differencing.known_interval(), 2),
                     counted(one.differencing.participants, "participant"));
}

/// How the quoted thresholds were estimated.
std::string quoted_words(const ThresholdReport& report) {
  return report.by_posterior ? "posterior means" : "maximum likelihood";
}

Table standards_table(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  const std::string quantity = quantity_name(options);
  Table table{"thresholds-by-standard",
              fmt::format("Thresholds in {}, {}; means over participants with t intervals",
                          study::threshold::unit_of_level(options), quoted_words(report)),
              columns_of({"standard", "n", "threshold and 95% (dB)", "SD (dB)", "tracks", "below",
                          "above"})};
  if (!quantity.empty()) table.columns.push_back({quantity + " and 95%"});
  for (const StandardReport& one : report.standards) {
    const procedures::Threshold mean = mean_threshold(one.mean);
    std::vector<Cell>& row = table.rows.emplace_back(std::vector<Cell>{
        one.words, std::to_string(one.mean.participants), threshold_text(mean, one.levels),
        plain_figure(one.mean.sd, 1), std::to_string(one.tracks),
        std::to_string(one.censored_below), std::to_string(one.censored_above)});
    if (!quantity.empty()) {
      row.emplace_back(quantity_text(quantity_of(options, one.of, mean), options));
    }
  }
  table.notes = {
      {"n: participants with a threshold, each the mean of the own tracks. Below, above: tracks "
       "that reached a bound of the levels; they give no number and are left out of the mean."},
      {"Levels are logarithms, so their mean is that of a geometric mean. The interval is "
       "Student's, over participants.",
       {Source::student}}};
  return table;
}

Table differences_table(const ThresholdReport& report) {
  Table table{
      "differences-of-standards",
      "Differences of thresholds, first minus second, of participants who have both",
      columns_of({"first", "second", "n", "difference (dB)", "t 95% (dB)", "p", "p by Holm"},
                 {"second"})};
  for (const DifferenceReport& one : report.differences) {
    const MeanEstimate& mean = one.difference.mean;
    table.rows.push_back({report.standards[one.first].words, report.standards[one.second].words,
                          std::to_string(mean.participants), signed_plain_figure(mean.mean, 1),
                          plain_range(mean.known_interval(), 1), p_figure(one.difference.p),
                          p_figure(one.p_holm)});
  }
  table.notes = {{"p: Student's t test, two-sided; by Holm: adjusted over all pairs.",
                  {Source::student, Source::holm}}};
  return table;
}

bool any_track(const ThresholdReport& report, bool (*has)(const TrackReport&)) {
  return std::ranges::any_of(report.tracks, has);
}

std::string estimate_text(const std::optional<TrackEstimate>& estimate,
                          const std::vector<double>& levels) {
  return estimate ? threshold_text(estimate->threshold, levels) : kNoFigure;
}

Table tracks_table(const ThresholdReport& report) {
  const ThresholdOptions& options = report.options();
  Table table{
      "tracks",
      fmt::format("Every track: thresholds in {}", study::threshold::unit_of_level(options)),
      columns_of({"participant", "track", "standard", "n", "right",
                  report.by_posterior ? "posterior, to quote" : "posterior",
                  report.by_posterior ? "likelihood" : "likelihood, to quote", "slope", "lapses"},
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
    const TrackEstimate quoted = report.quoted(track).value_or(TrackEstimate{});
    std::vector<Cell>& row = table.rows.emplace_back(
        std::vector<Cell>{track.participant, std::to_string(track.track), standard.words,
                          std::to_string(track.answers.n), share_figure(track.answers.share()),
                          estimate_text(track.posterior, standard.levels),
                          estimate_text(track.likelihood, standard.levels),
                          plain_figure(quoted.slope, 2), share_figure(quoted.lapse)});
    if (turns) {
      row.emplace_back(track.reversals ? threshold_text(*track.reversals, standard.levels)
                                       : kNoFigure);
    }
    if (fits) row.emplace_back(track.fit ? p_figure(track.fit->p) : kNoFigure);
    if (!quantity.empty()) {
      row.emplace_back(quantity_text(quantity_of(options, standard.of, quoted.threshold), options));
    }
  }
  return table;
}

/// What the columns of the tracks mean.
std::vector<Cited> tracks_notes(const ThresholdReport& report) {
  const procedures::TrackSettings& track = report.options().track;
  std::vector<Cited> notes = {
      {"Posterior: mean and 95 % credible interval, over the study's grid. Likelihood: the most "
       "likely observer and the 95 % profile interval, the guess rate held. Slope and lapses are "
       "those of the estimate to quote. Below, above: the track reached a bound of the levels and "
       "has no threshold; open: the interval has no end on this side."}};
  if (track.procedure.ends_with("up-down")) {
    notes.push_back({fmt::format(
        "Reversals: mean of the last turns of the staircase. It estimates the level with {} right, "
        "not the threshold's {}, so the two are not to be compared; it has no interval.",
        share_figure(procedures::convergence_of(track.up_down)), share_figure(report.criterion))});
  }
  if (!report.by_posterior) {
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

std::optional<double> hundredfold(const std::optional<double>& share) {
  return share ? std::optional(100.0 * *share) : std::nullopt;
}

void add_headline(const ThresholdReport& report, Section& section) {
  const ThresholdOptions& options = report.options();
  const auto say = [&](std::string text) { section.blocks.emplace_back(Cited{std::move(text)}); };
  say(fmt::format("Measured: {}. Participants said {}. Levels are {}, from {} to {}.{}",
                  task_words(options), question_words(options),
                  study::threshold::unit_of_level(options),
                  plain_figure(options.track.levels.front(), 1),
                  plain_figure(options.track.levels.back(), 1), criterion_words(report)));
  if (report.tracks.empty()) {
    say("No trial counts, so there is no result.");
    return;
  }
  if (report.has_thresholds()) {
    for (const StandardReport& one : report.standards) say(standard_sentence(report, one));
  } else {
    for (const SameDifferentGroup& one : report.same_different_groups) {
      say(difference_sentence(one, report));
    }
  }
  say(control_sentence(report));
}

Section thresholds_section(const ThresholdReport& report) {
  Section section{"thresholds", "Thresholds", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  section.blocks.emplace_back(standards_table(report));
  if (!report.differences.empty()) section.blocks.emplace_back(differences_table(report));
  return section;
}

Section tracks_section(const ThresholdReport& report) {
  Section section{"tracks-of-participants", "Tracks", {}};
  if (!report.has_thresholds() || report.tracks.empty()) return section;
  Table table = tracks_table(report);
  table.notes = tracks_notes(report);
  section.blocks.emplace_back(std::move(table));
  return section;
}

Section methods_section(const ThresholdReport& report) {
  Section section{"analysis", "Analysis", {}, true};
  section.blocks.emplace_back(Cited{procedure_words(report)});
  section.blocks.emplace_back(Cited{estimate_words(report)});
  section.blocks.emplace_back(Cited{
      "A track that reaches a bound of the levels, or whose posterior gathers at the end of its "
      "grid, is censored: it says on which side the threshold lies and enters no mean."});
  return section;
}

}  // namespace

Document threshold_document(const ThresholdReport& report, const Provenance& provenance,
                            const Pictures& pictures) {
  Section result{"result", "Result", {}};
  add_headline(report, result);
  return framed_document(
      report, std::move(result),
      {thresholds_section(report), same_different_section(report), control_section(report),
       tracks_section(report), habits_section(report), methods_section(report)},
      provenance, pictures);
}

std::string threshold_text(const procedures::Threshold& threshold,
                           const std::vector<double>& levels) {
  if (levels.empty()) return kNoFigure;
  if (threshold.censored == Censored::below) return "below " + plain_figure(levels.front(), 1);
  if (threshold.censored == Censored::above) return "above " + plain_figure(levels.back(), 1);
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
