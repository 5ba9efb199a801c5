#include "recovery/finding.hpp"
#include "recovery/population.hpp"
#include "support/catch.hpp"

using namespace touchtrial;
using namespace touchtrial::analysis;
using namespace touchtrial::recovery;

namespace {

/// Enough to detect errors of some 4 %; the table in docs/statistics-recovery.md uses more.
constexpr int kRepetitions = 400;
/// For what takes tens of milliseconds a study.
constexpr int kFewRepetitions = 120;

void check_all(const std::vector<Finding>& findings) {
  REQUIRE_FALSE(findings.empty());
  for (const Finding& finding : findings) {
    INFO(finding.group << ": " << finding.what << "; " << finding.population << ": found "
                       << finding.found << " +- " << finding.monte_carlo << ", may be "
                       << finding.least << " to " << finding.most);
    CHECK(finding.holds());
  }
}

}  // namespace

TEST_CASE("intervals cover the truth as often as they say") {
  check_all(coverage_findings(kRepetitions));
}

TEST_CASE("tests of a true null reject as seldom as they say") {
  check_all(error_findings(kRepetitions));
}

TEST_CASE("the registered question keeps its levels, with looks and among people who differ") {
  check_all(registered_findings(kRepetitions));
}

TEST_CASE("two methods in blocks are compared apart from the period, with full power") {
  check_all(crossover_findings(kRepetitions));
}

TEST_CASE("known sensitivity, bias, lapses and swaps are found again") {
  check_all(estimate_findings(kRepetitions));
}

TEST_CASE("divergences cover the truth, and equal observers are seldom told apart") {
  check_all(cue_findings(kFewRepetitions));
}

TEST_CASE("the spread between people is found, and people alike are seldom told from it") {
  check_all(people_findings(kFewRepetitions));
}

TEST_CASE("unbiased hit rates, order, confidence and stations keep their levels") {
  check_all(measures_findings(kRepetitions));
}

TEST_CASE("simulated participants answer with their stated probabilities") {
  const Population people{
      .d_prime = 1.2, .lapse = 0.2, .bias = {0.5, 0.0, -0.5}, .classes = 3, .repeats = 20000};
  RandomStream random(1, "population");
  const ConfusionMatrix counts = confusion_of(3, study_of(people, 1, random));
  const Plane<double> p = answer_probabilities(people, people.d_prime);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      CHECK(counts.count(i, j) / 20000.0 == Approx(p.at(i, j)).margin(0.015));
  }
}
