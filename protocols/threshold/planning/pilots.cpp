#include "protocols/threshold/planning/pilots.hpp"

#include "core/errors.hpp"

#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::planning::threshold {
namespace {

using analysis::CensoredMean;
using analysis::threshold::StandardReport;
using analysis::threshold::ThresholdReport;
using analysis::threshold::TrackReport;

constexpr int kMinPilots = 3;
/// Shares of right answers at d' = 1.62, the criterion of stimulus levels, with two and three
/// intervals.
constexpr double kShareRightOfTwo = 0.8744;
constexpr double kShareRightOfThree = 0.794;

/// The distance from the report's thresholds to the criterion of stimulus levels, dB. It is the
/// mean over the psychometric functions of all tracks with a threshold.
double criterion_shift_db(const ThresholdReport& report, std::size_t standard) {
  const double right = report.guess > 0.4 ? kShareRightOfTwo : kShareRightOfThree;
  double sum = 0.0;
  int n = 0;
  for (const TrackReport& track : report.tracks) {
    if (track.standard != standard || !track.threshold()) continue;
    procedures::Observer observer = track.estimate->observer;
    observer.lapse = 0.0;
    sum += procedures::level_at(observer, right) - observer.threshold;
    ++n;
  }
  return n > 0 ? sum / n : 0.0;
}

}  // namespace

std::optional<std::vector<std::pair<std::string, double>>> pilot_means(
    const ThresholdReport& report, const std::string& place) {
  const study::threshold::ThresholdOptions& options = report.options();
  if (options.task != study::threshold::Task::detection ||
      options.along != study::threshold::LevelQuantity::gain ||
      options.question != study::threshold::Question::which_interval) {
    return std::nullopt;
  }
  std::vector<std::pair<std::string, double>> means;
  for (std::size_t i = 0; i < report.standards.size(); ++i) {
    const StandardReport& standard = report.standards[i];
    const CensoredMean& mean = standard.mean;
    if (mean.exact < kMinPilots || !mean.mean) {
      throw StudyError(one_line(fmt::format(
          "{}: has {} known and {} unknown thresholds of {}; it needs {} or more known ones, and "
          "no "
          "more unknown than known ones; run more pilots",
          place, mean.exact, mean.participants - mean.exact, standard.words, kMinPilots)));
    }
    means.emplace_back(report.classes.at(static_cast<std::size_t>(standard.definition.class_index)),
                       *mean.mean + criterion_shift_db(report, i));
  }
  if (means.empty()) throw StudyError(one_line(place + ": has no threshold yet; run pilots"));
  return means;
}

}  // namespace touchtrial::planning::threshold
