#include "analysis/report/page/wording.hpp"
#include "core/text.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"

#include <fmt/format.h>

namespace touchtrial::analysis::threshold {
namespace {

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
  constexpr double kUsual = 0.05;
  if (pooled.p.value_or(1.0) <= kUsual) {
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

}  // namespace

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

}  // namespace touchtrial::analysis::threshold
