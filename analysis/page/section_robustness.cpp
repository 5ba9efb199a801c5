#include "analysis/page/sections.hpp"
#include "analysis/page/wording.hpp"
#include "analysis/text_figures.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

const char* words_of(TrialSubset subset) {
  switch (subset) {
    case TrialSubset::counted:
      return "as counted (a missing response is wrong)";
    case TrialSubset::answered:
      return "trials without a response left out";
    case TrialSubset::valid:
      return "trials that break the validity rule left out";
    case TrialSubset::with_excluded_sessions:
      return "excluded participants' sessions put back";
  }
  return "";
}

Table robustness_table(const StudyReport& report, std::size_t index) {
  Table table{"with-and-without-" + method_slug(report, index),
              method_prefix(report, index) + "the headline with and without what could be left out",
              {{"trials", Align::left},
               {"n"},
               {"right"},
               {"pooled"},
               {"participants"},
               {"mean"},
               {"t 95% (%)"}}};
  for (const SubsetAccuracy& one : report.methods[index].robustness) {
    table.rows.push_back({words_of(one.subset), std::to_string(one.pooled.n),
                          std::to_string(one.pooled.correct), share_figure(one.pooled.share()),
                          std::to_string(one.mean.participants), share_figure(one.mean.mean),
                          one.mean.participants > 1 ? share_range(one.mean.interval) : kNoFigure});
  }
  table.notes = {
      {"Mean over participants with Student's t interval. If a row's conclusion differs "
       "from the first's, say so beside the headline.",
       {Source::student}}};
  return table;
}

struct ServoFigures {
  std::vector<double> p99_us;
  double worst_us = 0.0;
  double lowest_rate_hz = 0.0;
  std::int64_t overruns = 0;
  std::int64_t lost = 0;
};

ServoFigures servo_figures(const std::vector<ServoTrial>& trials) {
  ServoFigures figures;
  figures.lowest_rate_hz = trials.front().health.rate_hz;
  for (const ServoTrial& one : trials) {
    figures.p99_us.push_back(one.health.lateness_p99_us);
    figures.worst_us = std::max(figures.worst_us, one.health.lateness_worst_us);
    figures.lowest_rate_hz = std::min(figures.lowest_rate_hz, one.health.rate_hz);
    figures.overruns += one.overruns;
    figures.lost += one.health.lost;
  }
  return figures;
}

}  // namespace

std::optional<Table> servo_table(const Collection& collection) {
  if (collection.servo_trials.empty()) return {};
  ServoFigures figures = servo_figures(collection.servo_trials);
  const Quartiles p99 = quartiles(std::move(figures.p99_us));
  Table table{"servo",
              "How the servo kept its time, over trials in real time",
              {{"what", Align::left}, {"value"}}};
  table.rows = {{"trials", std::to_string(collection.servo_trials.size())},
                {"lowest mean rate of a trial (Hz)", plain_figure(figures.lowest_rate_hz, 1)},
                {"trials' 99th percentile of lateness, median (µs)", plain_figure(p99.median, 1)},
                {"the same, quartiles (µs)",
                 plain_figure(p99.lower, 1) + " and " + plain_figure(p99.upper, 1)},
                {"latest tick of all (µs)", plain_figure(figures.worst_us, 1)},
                {"ticks that came late", std::to_string(figures.overruns)},
                {"samples that did not reach their trace", std::to_string(figures.lost)}};
  return table;
}

Section robustness_section(const StudyReport& report) {
  Section section{"servo-and-validity", "Servo and validity", {}};
  if (const auto servo = servo_table(report.collection)) {
    section.blocks.emplace_back(*servo);
  } else {
    section.blocks.emplace_back(
        Cited{"There is no table and no figure of the servo: no trial ran in real time. In virtual "
              "time every tick is on time by construction, and says nothing of a device.",
              {}});
  }
  for (std::size_t i = 0; i < report.methods.size(); ++i) {
    if (report.methods[i].robustness.empty()) continue;
    section.blocks.emplace_back(robustness_table(report, i));
  }
  return section;
}

}  // namespace touchtrial::analysis
