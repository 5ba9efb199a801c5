#include "analysis/statistics/mean_test.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "protocols/threshold/analysis/report_parts.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace touchtrial::analysis::threshold {
namespace {

using procedures::Censored;

/// The mean of the levels of each participant, in the order in which they first appear.
class MeanOfEach {
 public:
  void add(const std::string& participant, double value) {
    const auto [found, is_new] = place_.emplace(participant, people.size());
    if (is_new) {
      people.push_back(participant);
      sums_.push_back({0.0, 0});
    }
    sums_[found->second].first += value;
    ++sums_[found->second].second;
  }
  [[nodiscard]] std::vector<double> means() const {
    std::vector<double> all;
    for (const auto& [sum, n] : sums_) all.push_back(sum / n);
    return all;
  }
  std::vector<std::string> people;

 private:
  std::map<std::string, std::size_t> place_;
  std::vector<std::pair<double, int>> sums_;
};

StandardReport standard_report(const ThresholdReport& report, std::size_t standard) {
  StandardReport result;
  MeanOfEach each;
  for (const TrackReport& track : report.tracks) {
    if (track.standard != standard) continue;
    ++result.tracks;
    const std::optional<TrackEstimate>& quoted = report.quoted(track);
    if (!quoted) continue;
    if (quoted->threshold.censored == Censored::below) ++result.censored_below;
    if (quoted->threshold.censored == Censored::above) ++result.censored_above;
    if (quoted->threshold.level) each.add(track.participant, *quoted->threshold.level);
  }
  result.people = each.people;
  result.thresholds = each.means();
  result.mean = unbounded_mean(result.thresholds);
  return result;
}

std::vector<double> paired_differences(const StandardReport& first, const StandardReport& second) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < first.people.size(); ++i) {
    const auto other = std::ranges::find(second.people, first.people[i]);
    if (other == second.people.end()) continue;
    const auto place = static_cast<std::size_t>(other - second.people.begin());
    differences.push_back(first.thresholds[i] - second.thresholds[place]);
  }
  return differences;
}

}  // namespace

MeanEstimate unbounded_mean(std::span<const double> values) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return participant_mean(values, {-kInfinity, kInfinity});
}

procedures::Threshold mean_threshold(const MeanEstimate& mean) {
  procedures::Threshold threshold;
  threshold.level = mean.mean;
  if (const std::optional<Interval> interval = mean.known_interval()) {
    threshold.low = interval->low;
    threshold.high = interval->high;
  }
  return threshold;
}

GroupTest group_test(std::span<const double> values) {
  return {unbounded_mean(values), t_test_p(values, 0.0, Sides::two)};
}

std::vector<StandardReport> standard_reports(const ThresholdReport& report) {
  std::vector<StandardReport> all;
  for (const study::threshold::Standard& of : study::threshold::standards_of(report.design)) {
    StandardReport& added = all.emplace_back(standard_report(report, all.size()));
    added.of = of;
    added.levels = study::threshold::levels_of(report.options(), of);
    added.words = study::threshold::words_of(report.design, of);
  }
  return all;
}

std::vector<DifferenceReport> difference_reports(std::span<const StandardReport> standards) {
  std::vector<DifferenceReport> all;
  std::vector<double> p;
  for (std::size_t i = 0; i < standards.size(); ++i) {
    for (std::size_t j = i + 1; j < standards.size(); ++j) {
      const std::vector<double> differences = paired_differences(standards[i], standards[j]);
      all.push_back({i, j, group_test(differences), {}});
      if (all.back().difference.p) p.push_back(*all.back().difference.p);
    }
  }
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (DifferenceReport& one : all) {
    if (one.difference.p) one.p_holm = *next++;
  }
  return all;
}

GroupTest group_learning(const ThresholdReport& report) {
  MeanOfEach each;
  for (const TrackReport& track : report.tracks) {
    if (track.learning_db) each.add(track.participant, *track.learning_db);
  }
  return group_test(each.means());
}

}  // namespace touchtrial::analysis::threshold
