/// \file A report with numbers that follow a rule, from which figures are drawn.
#pragma once

#include "protocols/identification/analysis/cues/cue_report.hpp"
#include "protocols/identification/analysis/report.hpp"

#include <string>
#include <vector>

namespace touchtrial {

struct FakeReportOptions {
  std::vector<std::string> classes = {"bark", "cloth", "pebbles", "straw", "brick"};
  std::vector<std::string> methods = {"adaptive"};
  int participants = 20;
  int repeats = 5;  ///< trials a class, participant and method
  int servo_trials = 0;
};

[[nodiscard]] analysis::identification::StudyReport fake_report(
    const FakeReportOptions& options = {});

/// Of the same classes, methods and participants.
[[nodiscard]] analysis::identification::CueReport fake_cues(const FakeReportOptions& options = {});

}  // namespace touchtrial
