#include "analysis/planning/power_words.hpp"
#include "analysis/statistics/chance_test.hpp"

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

std::string looks_sentence(const PowerPlan& plan) {
  if (!plan.stop_early) {
    return "Every size has all its runs; the interval of a power is Wilson's at 95 %.";
  }
  const std::vector<int> looks = looks_of(plan);
  std::string after;
  for (const int look : looks) after += (after.empty() ? "" : ", ") + std::to_string(look);
  return fmt::format(
      "A size stops when its power's interval holds neither 80 nor 90 %, asked after {} runs. "
      "Intervals are Clopper-Pearson's at {:.4g} %, so that all looks together are wrong in 5 % of "
      "sizes at most (Bonferroni). Studies under the null are all made.",
      after, 100.0 * power_level(plan));
}

std::string null_sentence(const PowerReport& report) {
  return report.setting.protocol == "comparison"
             ? "Type-I error: methods that feel alike, each presentation felt by either method at "
               "random."
             : "Type-I error: participants who feel any texture at random, whatever is presented, "
               "with the same biases and lapses.";
}

std::string bank_sentence() {
  return "Monte-Carlo intervals do not hold the error of these explorations and trainings, which "
         "all "
         "studies share: other seeds show it, and more runs do not make it smaller.";
}

std::string orders_sentence() {
  return "Orders of this study do not present every class equally often: all figures, and type-I "
         "errors above all, are of the orders that this study's seed draws; another seed's differ.";
}

}  // namespace

std::string power_per_cent(double share) {
  return fmt::format("{:.1f}", 100.0 * share);
}

std::string power_range(const analysis::Interval& interval) {
  return "[" + power_per_cent(interval.low) + ", " + power_per_cent(interval.high) + "]";
}

std::vector<std::string> target_sentences(const PowerReport& report) {
  std::vector<std::string> sentences;
  for (const TargetSize& target : report.targets) {
    const std::string power = fmt::format("{:.0f} % power", 100.0 * target.target);
    if (!target.smallest) {
      sentences.push_back(power + ": no size given reaches it.");
    } else if (target.surely == target.smallest) {
      sentences.push_back(fmt::format("{}: {} participants.", power, *target.smallest));
    } else {
      sentences.push_back(fmt::format(
          "{}: {} participants by the estimate; {}.", power, *target.smallest,
          target.surely ? fmt::format("{} beyond Monte-Carlo error", *target.surely)
                        : std::string("no size beyond Monte-Carlo error, more runs would tell")));
    }
  }
  return sentences;
}

std::vector<std::string> method_sentences(const PowerReport& report) {
  const PowerPlan& plan = report.plan;
  std::vector<std::string> sentences;
  sentences.push_back(fmt::format(
      "Up to {} simulated studies of each size and hypothesis, seed {}, no participant in two of "
      "them; {}",
      plan.runs, plan.seed,
      plan.servo ? std::string("every exploration through the servo.")
                 : fmt::format("feelings drawn from {} explorations of each stimulus and {} "
                               "trainings through the servo.",
                               plan.explorations, plan.trainings)));
  if (!plan.servo) sentences.push_back(bank_sentence());
  sentences.push_back(looks_sentence(plan));
  sentences.push_back(null_sentence(report));
  if (!report.setting.has_fixed_counts) sentences.push_back(orders_sentence());
  sentences.push_back(fmt::format(
      "Attainable: what the type-I error is exactly, as counts are whole numbers and no p lies at "
      "{} itself; its Monte-Carlo interval is Wilson's at 95 %.",
      analysis::kSignificanceLevel));
  sentences.push_back("Interval width: of the 95 % t interval of the mean over participants.");
  return sentences;
}

}  // namespace touchtrial::planning
