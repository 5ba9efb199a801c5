#include "analysis/planning/power_progress.hpp"

#include "core/strict_json.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::planning {
namespace {

std::string with_spread(const char* name, double value, double spread) {
  return std::string(name) + " " + number_text(value) + " (spread " + number_text(spread) + ")";
}

}  // namespace

std::string words_of(const session::SubjectModel& subject) {
  std::string words =
      with_spread("weber", subject.weber, subject.weber_spread) + ", " +
      with_spread("lapse", subject.lapse, subject.lapse_spread) + ", " +
      with_spread("position bias", subject.position_bias, subject.position_bias_spread) +
      ", class bias spread " + number_text(subject.class_bias_spread);
  for (const session::ClassBias& bias : subject.class_bias) {
    words += ", bias for " + in_quotes(bias.label) + " " + number_text(bias.log_odds);
  }
  for (const auto& [one, other] : subject.label_swap) {
    words += ", " + in_quotes(one) + " swapped with " + in_quotes(other);
  }
  return words + ", explores " + number_text(subject.explore_s) + " s at " +
         number_text(subject.slowest_mm_s) + " to " + number_text(subject.fastest_mm_s) +
         " mm/s with " + number_text(subject.push_n) + " N, " +
         std::to_string(subject.training_passes) + " training passes";
}

PowerProgress new_progress(PowerSetting setting, const PowerPlan& plan, const Shard& shard) {
  PowerProgress progress{std::move(setting), plan, shard, {}};
  for (const int size : plan.participants) {
    progress.cells.push_back({size, Hypothesis::population, {}});
    progress.cells.push_back({size, Hypothesis::null, {}});
  }
  return progress;
}

std::optional<int> runs_when_done(const PowerProgress& progress, const PowerCell& cell) {
  const int own = progress.shard.own_runs(progress.plan.runs);
  const bool may_stop = progress.shard.is_all() && cell.hypothesis == Hypothesis::population;
  if (may_stop) {
    if (const auto certain = certain_after(progress.plan, cell.runs)) return certain;
  }
  if (static_cast<int>(cell.runs.size()) >= own) return own;
  return std::nullopt;
}

bool is_complete(const PowerProgress& progress) {
  return std::ranges::all_of(progress.cells, [&](const PowerCell& cell) {
    return runs_when_done(progress, cell).has_value();
  });
}

std::string first_difference(const PowerProgress& a, const PowerProgress& b) {
  const PowerSetting& x = a.setting;
  const PowerSetting& y = b.setting;
  const std::pair<const char*, bool> equal[] = {
      {"the study", x.study == y.study && x.protocol == y.protocol},
      {"the study file", x.seal == y.seal},
      {"the primary test", x.test == y.test && x.estimate == y.estimate},
      {"the prepared force fields", x.fields == y.fields},
      {"the subject model", x.subject == y.subject},
      {"the program's version", x.program == y.program},
      {"--participants", a.plan.participants == b.plan.participants},
      {"--runs", a.plan.runs == b.plan.runs},
      {"--seed", a.plan.seed == b.plan.seed},
      {"--no-early-stop", a.plan.stop_early == b.plan.stop_early},
      {"--servo", a.plan.servo == b.plan.servo},
      {"--explorations", a.plan.explorations == b.plan.explorations},
      {"--trainings", a.plan.trainings == b.plan.trainings}};
  const auto differs = std::ranges::find(equal, false, &std::pair<const char*, bool>::second);
  return differs == std::end(equal) ? "" : differs->first;
}

}  // namespace touchtrial::planning
