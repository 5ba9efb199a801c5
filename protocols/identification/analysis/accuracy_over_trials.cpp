#include "protocols/identification/analysis/accuracy_over_trials.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::analysis::identification {
namespace {

constexpr double kMinWidth = 2.0;
constexpr double kTrialsOfWidth = 10.0;
constexpr std::size_t kMaxPlaces = 60;

double smoothed(const std::vector<bool>& right, double place, double width) {
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    const double away = (static_cast<double>(i + 1) - place) / width;
    const double weight = std::exp(-0.5 * away * away);
    weights += weight;
    if (right[i]) sum += weight;
  }
  return sum / weights;
}

}  // namespace

AccuracyOverTrials accuracy_over_trials(std::span<const choices::Person> people) {
  std::vector<std::vector<bool>> right;
  for (const choices::Person& person : people) {
    choices::OwnTrials trials = person.trials;
    choices::sort_as_felt(trials);
    std::vector<bool>& own = right.emplace_back();
    for (const TrialOutcome* trial : trials) own.push_back(trial->correct());
  }
  return accuracy_over_trials(right);
}

AccuracyOverTrials accuracy_over_trials(std::span<const std::vector<bool>> right) {
  std::size_t most = 0;
  for (const std::vector<bool>& own : right) most = std::max(most, own.size());
  AccuracyOverTrials course{std::max(kMinWidth, static_cast<double>(most) / kTrialsOfWidth), {}};
  const std::size_t places = std::min(most, kMaxPlaces);
  for (std::size_t i = 0; i < places; ++i) {
    const double place = places < 2
                             ? 1.0
                             : std::lerp(1.0, static_cast<double>(most),
                                         static_cast<double>(i) / static_cast<double>(places - 1));
    std::vector<double> shares;
    for (const std::vector<bool>& own : right) {
      if (static_cast<double>(own.size()) >= place) {
        shares.push_back(smoothed(own, place, course.width));
      }
    }
    course.points.push_back({place, participant_mean(shares)});
  }
  return course;
}

}  // namespace touchtrial::analysis::identification
