/// \file Prints docs/statistics-recovery.md: recovery_table REPETITIONS.
#include "recovery/finding.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace {

using touchtrial::recovery::Finding;

constexpr const char* kIntroduction = R"(# Parameter recovery of statistics

This page compares the analysis of simulated participants with their known parameters. They answer by signal
detection with a known sensitivity d', spread between people, lapses, biases and swapped labels (or by a
similarity choice model), with five classes and, unless stated otherwise, 25 trials each. Every line comes
from {} simulated studies or a quarter of that; exact lines sum over all outcomes.

`scripts/recovery {}` prints this page; the test program `test_recovery` checks every line with fewer
studies. A number is as expected if it is within four Monte-Carlo errors of nominal, or of the range
that its remark explains. [statistics.md](statistics.md) defines the statistics.

Conclusions:

- The t test of the mean against chance keeps its level unless a few people are worse than chance.
  Unadjusted looks at outcomes do not.
- The comparison of two methods in separate blocks keeps level and power with any effect of the period;
  sign flips lose half of the power.
- Intervals over participants keep their level from 8 participants on. If people differ, intervals and
  tests that treat pooled trials as independent do not.
- Chi-square rejects a true choice model too often.
- Information transfer from 25 trials is unreliable, corrected or not.
)";

std::string line_of(const Finding& finding) {
  const std::string error =
      finding.monte_carlo > 0.0 ? fmt::format("{:.4f}", finding.monte_carlo) : "exact";
  return fmt::format("| {} | {} | {:.4g} | {:.4f} | {} | {} | {} |\n", finding.what,
                     finding.population, finding.nominal, finding.found, error,
                     finding.holds() ? "yes" : "NO", finding.why);
}

std::string table_of(const std::vector<Finding>& findings, const std::string& group) {
  std::string text = fmt::format(
      "\n## {}\n\n| statistic | population | nominal | found | Monte-Carlo error | as "
      "expected | remark |\n| --- | --- | --- | --- | --- | --- | --- |\n",
      group);
  for (const Finding& finding : findings) {
    if (finding.group == group) text += line_of(finding);
  }
  return text;
}

}  // namespace

int main(int count, char** arguments) {
  const int repetitions = count == 2 ? std::atoi(arguments[1]) : 0;
  if (repetitions < 100) {
    std::fputs("usage: recovery_table REPETITIONS (100 or more)\n", stderr);
    return 2;
  }
  std::vector<Finding> findings = touchtrial::recovery::coverage_findings(repetitions);
  for (const auto& more : {touchtrial::recovery::error_findings(repetitions),
                           touchtrial::recovery::estimate_findings(repetitions),
                           touchtrial::recovery::registered_findings(repetitions),
                           touchtrial::recovery::crossover_findings(repetitions),
                           touchtrial::recovery::cue_findings(repetitions),
                           touchtrial::recovery::people_findings(repetitions),
                           touchtrial::recovery::measures_findings(repetitions)}) {
    findings.insert(findings.end(), more.begin(), more.end());
  }
  std::fputs(fmt::format(kIntroduction, repetitions, repetitions).c_str(), stdout);
  bool all_hold = true;
  for (const Finding& finding : findings) all_hold = all_hold && finding.holds();
  for (const char* group : {"coverage", "type-I error", "power", "bias", "recovered"}) {
    std::fputs(table_of(findings, group).c_str(), stdout);
  }
  return all_hold ? 0 : 1;
}
