#include "protocols/rating/planning/planner.hpp"

#include "analysis/report/text_figures.hpp"
#include "core/errors.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/rating/planning/rating_plan.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "study/study.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::planning::rating {
namespace {

int method_index(const study::Study& study, const std::string& label) {
  for (int i = 0; i < study.presented_methods(); ++i) {
    if (study.methods[static_cast<std::size_t>(i)].label == label) return i;
  }
  throw UsageError(one_line("--methods: the study has no method " + in_quotes(label) +
                            "; it presents: " + study.presented_labels()));
}

MethodPair compared_methods(const study::Study& study, const std::vector<std::string>& labels) {
  if (study.presented_methods() < 2) {
    throw StudyError(one_line(study.source +
                              ": /methods: has one method, but `power` needs two to compare; add "
                              "another"));
  }
  if (labels.empty()) return {};
  if (labels.size() != 2 || labels[0] == labels[1]) {
    throw UsageError("--methods: give two different methods as A,B, of: " +
                     study.presented_labels());
  }
  return {method_index(study, labels[0]), method_index(study, labels[1])};
}

/// \throws UsageError if a size is too small ever to be significant
void require_min_size(const RatingPlan& plan) {
  const int min_size = min_participants(plan.alpha);
  for (const int size : plan.participants) {
    if (size >= min_size) continue;
    throw UsageError(fmt::format(
        "--participants: sign flips of {} cannot give a p of {:.4g} or less, whatever the "
        "difference; give {} or more",
        touchtrial::counted(size, "participant"), plan.alpha, min_size));
  }
}

/// \throws UsageError if no participant completed all sessions
void require_people(const RatingPool& pool) {
  if (pool.people > 0) return;
  throw UsageError(
      "power: no simulated participant completed all sessions; find the cause with `touchtrial "
      "simulate`");
}

class RatingPlanner final : public Planner {
 public:
  std::span<const std::string_view> options() const override {
    static constexpr std::array<std::string_view, 2> kOptions = {"--methods", "--pool"};
    return kOptions;
  }

  PowerResult power(const study::Study& study, const PowerOptions& options,
                    const PowerTools& tools) const override {
    const MethodPair pair = compared_methods(study, options.methods);
    RatingPlanReport report;
    report.plan = {.participants = options.plan.participants,
                   .runs = options.plan.runs,
                   .seed = options.plan.seed,
                   .alpha = options.plan.level};
    require_min_size(report.plan);
    const simulation::SubjectModel subject = tools.subject();
    report.setting = {study.name, words_of(subject),
                      study.methods[static_cast<std::size_t>(pair.first)].label,
                      study.methods[static_cast<std::size_t>(pair.second)].label,
                      analysis::device_words({simulation::recorded_device(subject)})};
    const study::StudyKey key = tools.key();
    tools.prepare(key);
    const engine::Pack pack(key.pack_folder);
    const session::StimulusSource source(pack, key);
    report.pool = simulated_ratings(key, source, subject, pair,
                                    {options.pool, options.plan.seed, options.jobs},
                                    tools.progress("simulating ratings"));
    require_people(report.pool);
    report.rows = rows_of(report.pool, report.plan, options.jobs);
    return {options.json ? rating_plan_json(report) : rating_plan_text(report),
            rating_power_curve(report)};
  }
};

}  // namespace

const Planner& rating_planner() {
  static const RatingPlanner planner;
  return planner;
}

}  // namespace touchtrial::planning::rating
