#include "app/commands/threshold_power.hpp"

#include "analysis/planning/threshold_plan.hpp"
#include "analysis/report/text_figures.hpp"
#include "app/commands/study_inputs.hpp"
#include "app/terminal/console.hpp"
#include "core/errors.hpp"
#include "core/text.hpp"
#include "engine/pack/pack.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

constexpr int kMostTrialsOfTrack = 2000;

std::vector<int> trials_to_try(const study::Study& study,
                               const ThresholdPowerArguments& arguments) {
  if (arguments.trials.empty()) return {study::threshold::options_of(study).track.trials};
  std::vector<int> trials = numbers_named(arguments.trials, "--trials", "a number of trials");
  std::ranges::sort(trials);
  const bool twice = std::ranges::adjacent_find(trials) != trials.end();
  if (twice || trials.front() < 1 || trials.back() > kMostTrialsOfTrack) {
    throw UsageError(fmt::format("--trials: give different numbers from 1 to {}, as 30,60,120",
                                 kMostTrialsOfTrack));
  }
  return trials;
}

/// The standards that are compared; nothing if there is one.
std::optional<std::pair<std::size_t, std::size_t>> compared_standards(
    const study::Study& study, const ThresholdPowerArguments& arguments) {
  const auto standards = static_cast<int>(study::threshold::standards_of(study).size());
  if (arguments.difference.empty()) {
    if (standards < 2) return std::nullopt;
    return std::pair<std::size_t, std::size_t>{0, 1};
  }
  const std::vector<int> named =
      numbers_named(arguments.difference, "--difference", "a standard's number");
  const bool is_pair = named.size() == 2 && named[0] != named[1];
  const auto [least, most] = std::ranges::minmax(named);
  if (!is_pair || least < 1 || most > standards) {
    throw UsageError(
        fmt::format("--difference: give the numbers of two different thresholds as 1,2; "
                    "the study has {}",
                    touchtrial::counted(standards, "threshold")));
  }
  return std::pair{static_cast<std::size_t>(named[0] - 1), static_cast<std::size_t>(named[1] - 1)};
}

/// \throws UsageError if nobody is left
void require_people(const planning::ThresholdPool& pool) {
  if (!pool.people.empty()) return;
  throw UsageError(
      "power: no simulated participant reached the end of a session; the subject's hand is outside "
      "the windows of speed and force, or an interval is too long: see `touchtrial simulate`");
}

}  // namespace

std::vector<int> numbers_named(std::string_view text, const std::string& option,
                               const std::string& what) {
  std::vector<int> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    const auto number = number_in<int>(part);
    if (!number || *number < 0) {
      throw UsageError(one_line(fmt::format("{}: '{}' is not {}; give for instance 8,12,16", option,
                                            part.substr(0, 60), what)));
    }
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

int plan_thresholds(const study::Study& study, const std::filesystem::path& file,
                    const simulation::SubjectModel& subject, const planning::PowerPlan& plan,
                    const ThresholdPowerArguments& arguments, int jobs, bool json) {
  const std::vector<int> trials = trials_to_try(study, arguments);
  planning::ThresholdPlanReport report;
  report.setting = {study.name, planning::words_of(subject),
                    study::threshold::unit_of_level(study::threshold::options_of(study)),
                    analysis::device_words({simulation::recorded_device(subject)})};
  report.plan = {.participants = plan.participants,
                 .runs = plan.runs,
                 .seed = plan.seed,
                 .width_db = arguments.width_db,
                 .difference = compared_standards(study, arguments)};
  if (const auto& analysis = study.registration.analysis) report.plan.alpha = analysis->alpha;
  const study::StudyKey key = simulated_key(study, file);
  prepare_simulated_pack(key);
  const engine::Pack pack(key.pack_folder);
  const session::StimulusSource source(pack, key);
  const planning::ThresholdPoolOptions options{arguments.pool, plan.seed, jobs};
  for (const int number : trials) {
    const auto bar = progress_bar(fmt::format("simulating tracks of {} trials", number));
    planning::ThresholdPool people =
        planning::simulated_thresholds(key, source, subject, number, options, bar);
    require_people(people);
    std::vector<planning::ThresholdRow> rows = planning::rows_of(people, report.plan, jobs);
    report.pools.emplace_back(std::move(people), std::move(rows));
  }
  print(json ? planning::threshold_plan_json(report) : planning::threshold_plan_text(report));
  return 0;
}

}  // namespace touchtrial::app
