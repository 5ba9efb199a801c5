#include "protocols/procedures/simulated_tracks.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::tracked {

using namespace procedures;

std::vector<double> decibels(int low, int high, int step) {
  std::vector<double> levels;
  for (int level = low; level <= high; level += step) levels.push_back(level);
  return levels;
}

TrackSettings usual_track(const std::string& procedure, int trials) {
  TrackSettings settings{.procedure = procedure, .levels = decibels(-40, 0), .trials = trials};
  if (procedure == "constant-stimuli") settings.levels = decibels(-30, -5, 5);
  settings.up_down.first_level = 30;  // -10 dB: easy
  if (procedure == "weighted-up-down") {
    settings.up_down.correct_for_down = 1;
    settings.up_down.up_for_one_down = 3;
    settings.up_down.steps_down = {2, 1};
  }
  settings.grid = {Shape::weibull,
                   decibels(-40, 0),
                   {1, 1.5, 2, 3, 4, 6, 8},
                   0.5,
                   {0.0, 0.02, 0.05, 0.1, 0.15, 0.2}};
  return settings;
}

std::vector<TrackTrial> answered_track(const TrackSettings& settings, const Observer& observer,
                                       std::uint64_t seed, double drift_db) {
  RandomStream orders(seed, "tracked/order");
  RandomStream answers(seed, "tracked/answers");
  const std::unique_ptr<Procedure> procedure = make_procedure(settings, orders);
  std::vector<TrackTrial> trials;
  for (int i = 0; i < settings.trials; ++i) {
    const std::size_t level = procedure->next();
    Observer now = observer;
    now.threshold += drift_db * ((i + 0.5) / settings.trials - 0.5);
    const double share = shares_at(now, settings.levels[level]).correct;
    trials.push_back({level, answers.uniform() < share});
    procedure->answer(trials.back().correct);
  }
  return trials;
}

ThresholdEstimate estimate_of(const TrackSettings& settings, std::span<const TrackTrial> trials,
                              const Observer& observer, std::uint64_t seed) {
  RandomStream answers(seed, "tracked/asymptote");
  const double share = shares_at(observer, settings.levels.back()).correct;
  std::vector<TrackTrial> all(trials.begin(), trials.end());
  for (int i = 0; i < std::max(6, settings.trials / 10); ++i) {
    all.push_back({settings.levels.size() - 1, answers.uniform() < share});
  }
  return estimate_threshold(counts_of(settings.levels, all), settings.levels, settings.grid.shape,
                            settings.grid.guess);
}

Observer some_observer(std::uint64_t seed) {
  RandomStream random(seed, "tracked/observer");
  Observer observer;
  observer.shape = Shape::weibull;
  observer.threshold = random.uniform(-24.0, -14.0);
  observer.slope = std::exp(random.uniform(std::log(2.0), std::log(6.0)));
  observer.lapse = random.uniform(0.0, 0.05);
  return observer;
}

}  // namespace touchtrial::tracked
