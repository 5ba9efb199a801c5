/// \file Prints the table of docs/statistics-recovery.md: recovery_table REPETITIONS.
#include "recovery/finding.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace {

using touchtrial::recovery::Finding;

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
  bool all_hold = true;
  for (const Finding& finding : findings) all_hold = all_hold && finding.holds();
  for (const char* group : {"coverage", "type-I error", "bias", "recovered"}) {
    std::fputs(table_of(findings, group).c_str(), stdout);
  }
  return all_hold ? 0 : 1;
}
