/// \file Prints docs/statistics-recovery.md: recovery_table REPETITIONS.
#include "recovery/finding.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace {

using touchtrial::recovery::Finding;

constexpr const char* kIntroduction = R"(# Known participants, found again

What the analysis makes of participants of whom everything is known: made-up people who answer by
signal detection with a known sensitivity d', spread between people, lapses, biases and swapped
labels (or by a similarity choice model), five classes, 25 trials each if nothing else is said. Every
line is {} made-up studies or a quarter of that (the exact ones add up all outcomes).

This page is what `scripts/recovery {}` prints; the test program `test_recovery` holds every line to
its expectation with fewer studies. A figure is as expected within four Monte-Carlo errors of nominal,
or of the range that its remark explains. What the statistics are: [statistics.md](statistics.md).

What to take from it: intervals over participants hold their level from 8 participants on; intervals
and tests that take pooled trials for independent do not once people differ; information transfer is
not to be believed from 25 trials, corrected or not.
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
      "\n## {}\n\n| figure | population | nominal | found | Monte-Carlo error | as "
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
                           touchtrial::recovery::estimate_findings(repetitions)}) {
    findings.insert(findings.end(), more.begin(), more.end());
  }
  std::fputs(fmt::format(kIntroduction, repetitions, repetitions).c_str(), stdout);
  bool all_hold = true;
  for (const Finding& finding : findings) all_hold = all_hold && finding.holds();
  for (const char* group : {"coverage", "type-I error", "bias", "recovered"}) {
    std::fputs(table_of(findings, group).c_str(), stdout);
  }
  return all_hold ? 0 : 1;
}
