#include "analysis/planning/primary_test.hpp"

#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "protocols/design/protocol.hpp"
#include "protocols/identification/analysis/chance.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

/// 0.05 times (drawings + the study itself) is a whole number, so that p can equal the level.
constexpr int kMostDeals = 999;

std::string labels_of(const design::Study& study) {
  const auto presented = static_cast<std::size_t>(study.presented_methods());
  return listed(std::span(study.methods).first(presented), ", ", &design::StudyMethod::label);
}

int method_of(const design::Study& study, const std::string& label) {
  for (int i = 0; i < study.presented_methods(); ++i) {
    if (study.methods[i].label == label) return i;
  }
  throw UsageError("--methods: the study has no method " + in_quotes(label) +
                   "; it presents: " + labels_of(study));
}

PrimaryTest pair_test(const design::Study& study, const std::optional<MethodLabels>& methods) {
  constexpr auto kKind = PrimaryTest::Kind::methods_differ;
  if (!methods) {
    if (study.presented_methods() == 2) return {kKind, 0, 1};
    throw UsageError(
        "the study compares " + std::to_string(study.presented_methods()) +
        " methods; name the two of its primary test with --methods, of: " + labels_of(study));
  }
  const PrimaryTest test{kKind, method_of(study, methods->first),
                         method_of(study, methods->second)};
  if (test.first == test.second) {
    throw UsageError("--methods: " + in_quotes(methods->first) +
                     " is given twice; a comparison needs two methods, of: " + labels_of(study));
  }
  return test;
}

}  // namespace

PrimaryTest primary_test_of(const design::Study& study,
                            const std::optional<MethodLabels>& methods) {
  design::require_choice_of_classes(study, "power");
  if (study.presented_methods() > 1) return pair_test(study, methods);
  if (methods) {
    throw UsageError("--methods: the study presents one method; leave the option out");
  }
  return {};
}

std::string words_of(const PrimaryTest& test, const design::Study& study) {
  const std::string& first = study.methods[test.first].label;
  if (test.kind == PrimaryTest::Kind::above_chance) {
    return fmt::format(
        "accuracy above chance ({}): permutation over the orders of the design, one-sided, level "
        "{}",
        first, analysis::kSignificanceLevel);
  }
  return fmt::format(
      "accuracy with {} against {}: sign flips over participants, two-sided, level {}", first,
      study.methods[test.second].label, analysis::kSignificanceLevel);
}

std::string estimate_words(const PrimaryTest& test) {
  return test.kind == PrimaryTest::Kind::above_chance ? "accuracy" : std::string(kDifferenceWords);
}

PowerRun judged(const PrimaryTest& test, const analysis::Outcomes& outcomes, bool with_attainable) {
  if (test.kind == PrimaryTest::Kind::above_chance) {
    const analysis::identification::ChanceFigures numbers =
        analysis::identification::chance_figures(outcomes, test.first, kMostDeals);
    return {numbers.chance ? numbers.chance->p : 1.0,
            with_attainable && numbers.chance ? numbers.chance->attainable : 0.0,
            numbers.mean.mean.value_or(0.0), numbers.mean.interval.low, numbers.mean.interval.high};
  }
  const analysis::identification::PairFigures numbers =
      analysis::identification::pair_figures(outcomes, test.first, test.second, with_attainable);
  const analysis::MethodComparison& overall = numbers.overall;
  return {overall.p.value_or(1.0), numbers.attainable, overall.difference.value_or(0.0),
          overall.interval.low, overall.interval.high};
}

bool is_significant(const PowerRun& run) noexcept {
  return run.p <= analysis::kSignificanceLevel;
}

}  // namespace touchtrial::planning
