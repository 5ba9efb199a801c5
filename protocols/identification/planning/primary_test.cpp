#include "protocols/identification/planning/primary_test.hpp"

#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "study/protocol.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::planning::identification {
namespace {

int method_of(const study::Study& study, const std::string& label) {
  for (int i = 0; i < study.presented_methods(); ++i) {
    if (study.methods[i].label == label) return i;
  }
  throw UsageError("--methods: the study has no method " + in_quotes(label) +
                   "; it presents: " + study.presented_labels());
}

PrimaryTest pair_test(const study::Study& study, const std::optional<MethodLabels>& methods) {
  std::optional<PrimaryTest> test = choices::primary_question(study, study.presented_methods());
  if (!methods) {
    if (test) return *test;
    throw UsageError("the study compares " + std::to_string(study.presented_methods()) +
                     " methods; choose two for the primary test with --methods, of: " +
                     study.presented_labels());
  }
  // For more methods, the default test of two methods applies.
  if (!test) test = choices::primary_question(study, 2);
  test->first = method_of(study, methods->first);
  test->second = method_of(study, methods->second);
  if (test->first == test->second) {
    throw UsageError(
        "--methods: " + in_quotes(methods->first) +
        " is given twice; a comparison needs two methods, of: " + study.presented_labels());
  }
  return *test;
}

bool is_difference(const PrimaryTest& test) {
  return test.estimand == study::Estimand::difference;
}

/// The largest possible p within the level, given the sizes of these differences.
double attainable_of(const PrimaryTest& test, const std::vector<double>& values) {
  if (test.test != study::RegisteredTest::sign_flip) return test.alpha;
  if (test.sides == analysis::Sides::two) {
    return analysis::sign_flip_attainable(values, test.alpha);
  }
  return 0.5 * analysis::sign_flip_attainable(values, 2.0 * test.alpha);
}

}  // namespace

PrimaryTest primary_test_of(const study::Study& study, const std::optional<MethodLabels>& methods) {
  study::require_choice_of_classes(study, "power");
  if (study.presented_methods() > 1) return pair_test(study, methods);
  if (methods) {
    throw UsageError("--methods: the study presents only one method; remove the option");
  }
  return *choices::primary_question(study, 1);
}

PrimaryTest as_noninferiority_test(PrimaryTest test, double margin) {
  if (!is_difference(test)) {
    throw UsageError(
        "--margin: needs two methods, but the study presents only one; remove the option");
  }
  if (!(margin > 0.0 && margin <= 1.0)) {
    throw UsageError(fmt::format(
        "--margin: {} is out of range; give a difference of accuracies, 0.07 for 7 points",
        margin));
  }
  test.margin = margin;
  test.smallest_effect.reset();
  test.sides = analysis::Sides::one;
  if (test.test == study::RegisteredTest::sign_flip) test.test = study::RegisteredTest::t;
  return test;
}

std::string words_of(const PrimaryTest& test, const study::Study& study) {
  const std::string& first = study.methods[test.first].label;
  std::string estimand = is_difference(test) ? "accuracy with " + first + " less that with " +
                                                   study.methods[test.second].label
                                             : "mean accuracy with " + first + " against chance";
  if (test.margin) estimand += fmt::format(" against {:.4g} points", -100.0 * *test.margin);
  return fmt::format("{}: {}, level {}", estimand, choices::test_words(test), test.alpha);
}

std::string estimate_words(const PrimaryTest& test) {
  return is_difference(test) ? std::string(kDifferenceWords) : "accuracy";
}

PowerRun analyse_run(const PrimaryTest& test, const analysis::Outcomes& outcomes,
                     bool with_attainable) {
  const auto people = choices::primary_values(test, outcomes);
  const auto classes = static_cast<int>(outcomes.classes.size());
  const choices::PrimaryEstimate estimate =
      choices::primary_estimate(test, people, analysis::kConfidenceLevel);
  const analysis::Interval full_range{is_difference(test) ? -1.0 : 0.0, 1.0};
  const analysis::Interval interval = estimate.interval.value_or(full_range);
  double p = choices::primary_p(test, classes, people).value_or(1.0);
  if (test.margin) {
    // Non-inferiority also requires that both methods are above chance.
    const choices::Selection counted{{}, {}, choices::counted_sessions(outcomes)};
    for (const analysis::AboveChance& one : choices::above_chance(test, outcomes, counted)) {
      p = std::max(p, one.p.value_or(1.0));
    }
  }
  return {p, with_attainable ? attainable_of(test, choices::differences_of(people)) : 0.0,
          estimate.estimate.value_or(0.0), interval.low, interval.high};
}

bool is_significant(const PowerRun& run, double level) noexcept {
  return run.p <= level;
}

}  // namespace touchtrial::planning::identification
