#include "protocols/threshold/analysis/hand_made_tracks.hpp"

#include "analysis/hand_made_study.hpp"
#include "analysis/report/results.hpp"
#include "protocols/procedures/procedure.hpp"
#include "protocols/threshold/analysis/threshold_analysis.hpp"

#include <utility>

namespace touchtrial {
namespace {

using study::threshold::ThresholdOptions;

void add_grid(ThresholdOptions& options) {
  procedures::ParameterGrid& grid = options.track.grid;
  grid.thresholds = options.track.levels;
  grid.slopes = {1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0};
  grid.lapses = {0.0, 0.01, 0.02, 0.03, 0.04, 0.05};
  grid.guess = 1.0 / options.intervals;
  options.track.up_down.first_level = options.track.levels.size() - 1;
}

}  // namespace

std::vector<double> levels_from(double low, double high, double step) {
  std::vector<double> levels;
  for (double level = low; level <= high + 1e-9; level += step) levels.push_back(level);
  return levels;
}

ThresholdOptions detection_options() {
  ThresholdOptions options;
  options.standards = {0.0};
  options.track.levels = levels_from(-40.0, 0.0, 1.0);
  add_grid(options);
  return options;
}

ThresholdOptions constant_options(std::vector<double> standards) {
  ThresholdOptions options;
  options.task = study::threshold::Task::discrimination;
  options.standards = std::move(standards);
  options.track.procedure = "constant-stimuli";
  options.track.levels = levels_from(-32.0, -2.0, 5.0);
  options.track.trials = 140;
  add_grid(options);
  options.track.grid.thresholds = levels_from(-32.0, -2.0, 1.0);
  return options;
}

ThresholdOptions same_different_options() {
  ThresholdOptions options;
  options.task = study::threshold::Task::discrimination;
  options.question = study::threshold::Question::same_different;
  options.along = study::threshold::LevelQuantity::blend;
  options.standards = {0.0};
  options.track.procedure = "constant-stimuli";
  options.track.levels = {-20.0, -10.0, 0.0};
  options.track.trials = 30;
  add_grid(options);
  return options;
}

HandMadeTracks::HandMadeTracks(const ThresholdOptions& options,
                               const std::vector<std::string>& classes) {
  outcomes.study = "weak";
  outcomes.design.name = "weak";
  outcomes.design.protocol = &study::threshold::protocol();
  outcomes.design = study::threshold::with_options(outcomes.design, options);
  set_classes(outcomes, classes);
  outcomes.methods = {"adaptive"};
  for (const study::Choice& choice : study::choices_of(outcomes.design)) {
    outcomes.choices.push_back(choice.label);
  }
}

const ThresholdOptions& HandMadeTracks::options() const {
  return study::threshold::options_of(outcomes.design);
}

void HandMadeTracks::session(bool counted) {
  add_session(outcomes, counted);
}

void HandMadeTracks::answer(const HandMadeAnswer& of) {
  analysis::TrialOutcome& trial = add_trial(outcomes, of.session);
  trial.row.block = of.role == study::Role::control ? 1 : 0;
  trial.role = of.role;
  trial.chosen = {of.track, of.level, of.target};
  trial.scored = of.role == study::Role::scored;
  trial.counted =
      trial.scored && outcomes.sessions.at(static_cast<std::size_t>(of.session - 1)).counted;
  trial.response = of.response;
  trial.right = of.target;
}

void HandMadeTracks::missed(int session, int track, int level) {
  answer({session, track, level});
  outcomes.trials.back().response.reset();
  outcomes.trials.back().row.state = record::TrialState::timed_out;
  outcomes.trials.back().row.answered_at.reset();
}

void HandMadeTracks::track(int session, int number, const procedures::Observer& observer,
                           RandomStream& random) {
  const procedures::TrackSettings settings = study::threshold::block_settings(outcomes.design)
                                                 .tracks.at(static_cast<std::size_t>(number - 1));
  const auto procedure = procedures::make_procedure(settings, random);
  const auto choices = static_cast<std::uint64_t>(outcomes.choices.size());
  for (int i = 0; i < settings.trials; ++i) {
    const std::size_t level = procedure->next();
    const double share = procedures::shares_at(observer, settings.levels[level]).correct;
    const bool right = random.uniform() < share;
    const auto target = static_cast<int>(random.below(choices));
    const int other = (target + 1) % static_cast<int>(choices);
    answer({session, number, static_cast<int>(level), target, right ? target : other});
    procedure->answer(right);
  }
}

void HandMadeTracks::attended_track(int session, int number, const procedures::Observer& observer,
                                    RandomStream& random) {
  track(session, number, observer, random);
  const auto tracks = study::threshold::block_settings(outcomes.design).tracks;
  const double highest = tracks.at(static_cast<std::size_t>(number - 1)).levels.back();
  constexpr int kCatches = 6;
  int right = 0;
  for (int i = 0; i < kCatches; ++i) {
    right += random.uniform() < procedures::shares_at(observer, highest).correct ? 1 : 0;
  }
  caught(session, number, right, kCatches - right);
}

void HandMadeTracks::caught(int session, int track, int right, int wrong) {
  const auto tracks = study::threshold::block_settings(outcomes.design).tracks;
  const std::size_t levels = tracks.at(static_cast<std::size_t>(track - 1)).levels.size();
  for (int i = 0; i < right + wrong; ++i) {
    const int target = i % 2;
    answer({session, track, static_cast<int>(levels) - 1, target, i < right ? target : 1 - target,
            study::Role::catch_trial});
  }
}

void HandMadeTracks::outside(int session, study::Role role, int right, int wrong) {
  const auto top = static_cast<int>(options().track.levels.size()) - 1;
  for (int i = 0; i < right + wrong; ++i) {
    const int target = i % 2;
    answer({session, 0, top, target, i < right ? target : 1 - target, role});
  }
}

procedures::Observer observer_at(double threshold) {
  return {procedures::Shape::weibull, threshold, 3.5, 0.5, 0.01};
}

HandMadeTracks tracks_of(const ThresholdOptions& options, int tracks,
                         const std::vector<double>& thresholds, bool with_catches) {
  HandMadeTracks made(options);
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    made.session();
    for (int track = 1; track <= tracks; ++track) {
      RandomStream random(8, "threshold report test", 10 * i + static_cast<std::size_t>(track));
      const int session = static_cast<int>(i) + 1;
      if (with_catches) {
        made.attended_track(session, track, observer_at(thresholds[i]), random);
      } else {
        made.track(session, track, observer_at(thresholds[i]), random);
      }
    }
  }
  return made;
}

nlohmann::json json_of(const HandMadeTracks& made) {
  return nlohmann::json::parse(
      analysis::threshold::threshold_analysis().results(made.outcomes, {})->json());
}

}  // namespace touchtrial
