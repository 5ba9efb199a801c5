/// \file Which assumption about people and devices moves a study's power most: each is changed alone,
/// and the same studies are simulated again. Source: docs/power.md, "What if".
#pragma once

#include "analysis/planning/power_progress.hpp"
#include "analysis/planning/rehearsed_study.hpp"
#include "analysis/statistics/proportion.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// A subject that differs from another in one assumption.
struct Assumption {
  std::string name;  ///< "device", "sense", "hand", or a subject file's key
  std::string from;
  std::string to;
  simulation::SubjectModel subject;
};

/// The assumptions about a subject, each changed alone: every other sense, hand and shipped device,
/// then every key of the subject file in which `other` differs and that answers depend on, and at
/// last all that `other` says, on the base's device.
[[nodiscard]] std::vector<Assumption> assumptions_about(const simulation::SubjectModel& base,
                                                        const simulation::SubjectModel& other);

/// Whether two subjects feel and learn the same, so that they can share their feelings.
[[nodiscard]] bool feel_alike(const simulation::SubjectModel& one,
                              const simulation::SubjectModel& other);

/// The power under one assumption, and how much it differs from the base's.
struct WhatIfRow {
  std::string name;
  std::string from;
  std::string to;
  analysis::Proportion significant;
  double estimate = 0.0;          ///< mean over runs of the test's estimand
  double difference = 0.0;        ///< of power
  analysis::Interval interval{};  ///< of the difference, 95 %: paired_share_interval
};

struct WhatIf {
  PowerSetting setting;
  PowerPlan plan;  ///< of one size
  WhatIfRow base;
  std::vector<WhatIfRow> rows;  ///< the largest difference first
};

/// Makes what a subject feels.
using MakeFeelings =
    std::function<std::unique_ptr<const Feelings>(const simulation::SubjectModel& subject)>;

/// Simulates the same studies under each assumption: run by run with the same seed, and so the same
/// orders and the same people but for the assumption. The result depends on everything but `jobs`.
/// \param plan  of one size; every run of it is made
/// \param progress  called from one thread at a time, with the finished assumptions
[[nodiscard]] WhatIf what_if(const design::Study& study, const PrimaryTest& test,
                             const simulation::SubjectModel& base,
                             const std::vector<Assumption>& assumptions, const PowerPlan& plan,
                             PowerSetting setting, const MakeFeelings& feelings, int jobs,
                             const std::function<void(int done, int of)>& progress = {});

/// A table for a terminal; ends with a line feed.
[[nodiscard]] std::string what_if_text(const WhatIf& result);
/// One indented JSON object; ends with a line feed.
[[nodiscard]] std::string what_if_json(const WhatIf& result);

}  // namespace touchtrial::planning
