#include "protocols/threshold/planning/track_walk.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "protocols/threshold/study/threshold.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::planning::threshold {
namespace {

using nlohmann::ordered_json;
using procedures::Marginal;
using procedures::Posterior;
using study::threshold::Question;
using study::threshold::ThresholdOptions;

ParameterSummary summary_of(const Marginal& marginal, double mode) {
  return {procedures::mean_of(marginal), procedures::sd_of(marginal), mode};
}

ObserverSummary observer_summary_of(const Posterior& posterior) {
  const procedures::Observer mode = posterior.mode();
  return {summary_of(posterior.threshold(), mode.threshold),
          summary_of(posterior.slope(), mode.slope), summary_of(posterior.lapse(), mode.lapse)};
}

/// Replays the answers through the procedure, and records the levels.
/// \return index of the level of each answer
std::vector<std::size_t> replay_levels(TrackWalk& walk) {
  // Fixed seed: repeated calls give the same order of constant stimuli.
  RandomStream stream(0, "touchtrial procedure", static_cast<std::uint64_t>(walk.track));
  const std::unique_ptr<procedures::Procedure> procedure =
      procedures::make_procedure(walk.settings, stream);
  std::vector<std::size_t> answered_levels;
  for (const bool correct : walk.answers) {
    answered_levels.push_back(procedure->next());
    procedure->answer(correct);
  }
  for (const std::size_t level : answered_levels)
    walk.levels.push_back(walk.settings.levels[level]);
  if (walk.answers.size() < static_cast<std::size_t>(walk.settings.trials)) {
    walk.levels.push_back(walk.settings.levels[procedure->next()]);
  }
  return answered_levels;
}

void update_posterior(TrackWalk& walk, const std::vector<std::size_t>& answered_levels) {
  Posterior posterior(walk.settings.levels, walk.settings.grid);
  walk.prior = {posterior.threshold(), posterior.slope(), posterior.lapse()};
  walk.posteriors.push_back(observer_summary_of(posterior));
  for (std::size_t i = 0; i < answered_levels.size(); ++i) {
    posterior.observe(answered_levels[i], walk.answers[i]);
    walk.posteriors.push_back(observer_summary_of(posterior));
  }
}

ordered_json parameter_summary_json(const ParameterSummary& summary) {
  return {{"mean", summary.mean}, {"sd", summary.sd}, {"mode", summary.mode}};
}

ordered_json walked_grid_json(const TrackWalk& walk) {
  const procedures::ParameterGrid& grid = walk.settings.grid;
  return {{"shape", study::threshold::name_of(grid.shape)},
          {"levels", walk.settings.levels},
          {"threshold", grid.thresholds},
          {"slope", grid.slopes},
          {"guess", {grid.guess}},
          {"lapse", grid.lapses},
          {"prior",
           {{"threshold", walk.prior[0].weights},
            {"slope", walk.prior[1].weights},
            {"lapse", walk.prior[2].weights}}}};
}

}  // namespace

TrackWalk replay_track(const study::Study& study, int track, const std::vector<bool>& answers) {
  const ThresholdOptions& options = study::threshold::options_of(study);
  const std::vector<procedures::TrackSettings> tracks =
      study::threshold::block_settings(study).tracks;
  if (track < 1 || static_cast<std::size_t>(track) > tracks.size()) {
    throw UsageError(
        one_line(fmt::format("--track: {} is not a track of {}, which has {}; use 1{}", track,
                             study.source, touchtrial::counted(std::ssize(tracks), "track"),
                             tracks.size() > 1 ? fmt::format(" to {}", tracks.size()) : "")));
  }
  const auto index = static_cast<std::size_t>(track - 1);
  const std::size_t standard = index / static_cast<std::size_t>(options.tracks_each);
  TrackWalk walk;
  walk.track = track;
  walk.words = study::threshold::words_of(study, study::threshold::standards_of(study)[standard]);
  walk.unit = study::threshold::unit_of_level(options);
  walk.settings = tracks[index];
  walk.answers = answers;
  if (answers.size() > static_cast<std::size_t>(walk.settings.trials)) {
    throw UsageError(fmt::format(
        "--answers: has {} answers, but the track has {} trials; give at most one answer per trial",
        answers.size(), walk.settings.trials));
  }
  const std::vector<std::size_t> answered_levels = replay_levels(walk);
  if (options.question != Question::same_different) update_posterior(walk, answered_levels);
  return walk;
}

std::string track_walk_json(const TrackWalk& walk) {
  ordered_json posterior = nullptr;
  if (!walk.posteriors.empty()) {
    posterior = ordered_json::array();
    for (const ObserverSummary& summary : walk.posteriors) {
      posterior.push_back({{"threshold", parameter_summary_json(summary.threshold)},
                           {"slope", parameter_summary_json(summary.slope)},
                           {"lapse", parameter_summary_json(summary.lapse)}});
    }
  }
  ordered_json answers = ordered_json::array();
  for (const bool correct : walk.answers) answers.push_back(correct ? 1 : 0);
  const ordered_json document = {
      {"track", walk.words},
      {"number", walk.track},
      {"procedure", walk.settings.procedure},
      {"trials", walk.settings.trials},
      {"unit", walk.unit},
      {"answers", answers},
      {"levels", walk.levels},
      {"grid", walk.posteriors.empty() ? ordered_json(nullptr) : walked_grid_json(walk)},
      {"posterior", posterior}};
  return json_text(document);
}

}  // namespace touchtrial::planning::threshold
