#include "protocols/threshold/planning/planner.hpp"

#include "analysis/report/text_figures.hpp"
#include "core/errors.hpp"
#include "core/text.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/threshold/planning/pilots.hpp"
#include "protocols/threshold/planning/threshold_plan.hpp"
#include "protocols/threshold/planning/track_walk.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include <fmt/format.h>

namespace touchtrial::planning::threshold {
namespace {

constexpr int kMaxTrialsPerTrack = 2000;

std::vector<int> trials_to_try(const study::Study& study, const PowerOptions& options) {
  if (options.trials.empty()) return {study::threshold::options_of(study).track.trials};
  std::vector<int> trials = parse_numbers(options.trials, "--trials", "a number of trials");
  std::ranges::sort(trials);
  const bool has_duplicates = std::ranges::adjacent_find(trials) != trials.end();
  if (has_duplicates || trials.front() < 1 || trials.back() > kMaxTrialsPerTrack) {
    throw UsageError(fmt::format("--trials: give different numbers from 1 to {}, such as 30,60,120",
                                 kMaxTrialsPerTrack));
  }
  return trials;
}

/// The two compared standards; empty if the study has only one.
std::optional<std::pair<std::size_t, std::size_t>> compared_standards(const study::Study& study,
                                                                      const PowerOptions& options) {
  const auto standards = static_cast<int>(study::threshold::standards_of(study).size());
  if (options.difference.empty()) {
    if (standards < 2) return std::nullopt;
    return std::pair<std::size_t, std::size_t>{0, 1};
  }
  const std::vector<int> numbers =
      parse_numbers(options.difference, "--difference", "a standard's number");
  const bool is_pair = numbers.size() == 2 && numbers[0] != numbers[1];
  const auto [min, max] = std::ranges::minmax(numbers);
  if (!is_pair || min < 1 || max > standards) {
    throw UsageError(
        fmt::format("--difference: give the numbers of two different thresholds, such as 1,2; "
                    "the study has {}",
                    touchtrial::counted(standards, "threshold")));
  }
  return std::pair{static_cast<std::size_t>(numbers[0] - 1),
                   static_cast<std::size_t>(numbers[1] - 1)};
}

/// \throws UsageError if no participant completed the session
void require_people(const ThresholdPool& pool) {
  if (!pool.people.empty()) return;
  throw UsageError(
      "power: no simulated participant completed a session; the subject's hand is outside the "
      "windows of speed and force, or an interval is too long; find the cause with `touchtrial "
      "simulate`");
}

class ThresholdPlanner final : public Planner {
 public:
  std::span<const std::string_view> options() const override {
    static constexpr std::array<std::string_view, 4> kOptions = {"--trials", "--width",
                                                                 "--difference", "--pool"};
    return kOptions;
  }

  PowerResult power(const study::Study& study, const PowerOptions& options,
                    const PowerTools& tools) const override {
    const simulation::SubjectModel subject = tools.subject();
    const std::vector<int> trials = trials_to_try(study, options);
    ThresholdPlanReport report;
    report.setting = {study.name, words_of(subject),
                      study::threshold::unit_of_level(study::threshold::options_of(study)),
                      analysis::device_words({simulation::recorded_device(subject)})};
    report.plan = {.participants = options.plan.participants,
                   .runs = options.plan.runs,
                   .seed = options.plan.seed,
                   .width_db = options.width_db,
                   .difference = compared_standards(study, options)};
    if (const auto& analysis = study.registration.analysis) report.plan.alpha = analysis->alpha;
    const study::StudyKey key = tools.key();
    tools.prepare(key);
    const engine::Pack pack(key.pack_folder);
    const session::StimulusSource source(pack, key);
    const ThresholdPoolOptions pool{options.pool, options.plan.seed, options.jobs};
    for (const int number : trials) {
      const auto bar = tools.progress(fmt::format("simulating tracks of {} trials", number));
      ThresholdPool people = simulated_thresholds(key, source, subject, number, pool, bar);
      require_people(people);
      std::vector<ThresholdRow> rows = rows_of(people, report.plan, options.jobs);
      report.pools.emplace_back(std::move(people), std::move(rows));
    }
    return {options.json ? threshold_plan_json(report) : threshold_plan_text(report),
            threshold_power_curve(report)};
  }

  std::string_view study_with_tracks() const override { return "config/detection.json"; }
  std::string procedure(const study::Study& study, int track,
                        const std::vector<bool>& answers) const override {
    return track_walk_json(replay_track(study, track, answers));
  }

  std::vector<std::pair<std::string, double>> pilot_thresholds(
      const analysis::Outcomes& outcomes, const std::string& place) const override {
    const auto means = pilot_means(analysis::threshold::make_report(outcomes), place);
    return means ? *means : Planner::pilot_thresholds(outcomes, place);
  }
};

}  // namespace

const Planner& threshold_planner() {
  static const ThresholdPlanner planner;
  return planner;
}

}  // namespace touchtrial::planning::threshold
