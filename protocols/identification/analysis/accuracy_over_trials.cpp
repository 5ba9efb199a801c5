#include "protocols/identification/analysis/accuracy_over_trials.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::analysis::identification {
namespace {

constexpr double kMinWidth = 2.0;
constexpr double kTrialsPerWidth = 10.0;
constexpr std::size_t kMaxPlaces = 60;

double smoothed_share(const std::vector<bool>& right, double place, double width) {
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    const double distance = (static_cast<double>(i + 1) - place) / width;
    const double weight = std::exp(-0.5 * distance * distance);
    weights += weight;
    if (right[i]) sum += weight;
  }
  return sum / weights;
}

}  // namespace

AccuracyOverTrials accuracy_over_trials(std::span<const choices::Person> people) {
  std::vector<std::vector<bool>> right;
  for (const choices::Person& person : people) {
    choices::PersonTrials trials = person.trials;
    choices::sort_in_felt_order(trials);
    std::vector<bool>& answers = right.emplace_back();
    for (const TrialOutcome* trial : trials) answers.push_back(trial->correct());
  }
  return accuracy_over_trials(right);
}

AccuracyOverTrials accuracy_over_trials(std::span<const std::vector<bool>> right) {
  std::size_t max_trials = 0;
  for (const std::vector<bool>& answers : right) max_trials = std::max(max_trials, answers.size());
  AccuracyOverTrials course{std::max(kMinWidth, static_cast<double>(max_trials) / kTrialsPerWidth),
                            {}};
  const std::size_t places = std::min(max_trials, kMaxPlaces);
  for (std::size_t i = 0; i < places; ++i) {
    const double place = places < 2
                             ? 1.0
                             : std::lerp(1.0, static_cast<double>(max_trials),
                                         static_cast<double>(i) / static_cast<double>(places - 1));
    std::vector<double> shares;
    for (const std::vector<bool>& answers : right) {
      if (static_cast<double>(answers.size()) >= place) {
        shares.push_back(smoothed_share(answers, place, course.width));
      }
    }
    course.points.push_back({place, participant_mean(shares)});
  }
  return course;
}

}  // namespace touchtrial::analysis::identification
