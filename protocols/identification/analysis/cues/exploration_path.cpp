#include "protocols/identification/analysis/cues/exploration_path.hpp"

#include "analysis/outcomes/recorded_pack.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "core/errors.hpp"
#include "core/text.hpp"
#include "engine/image_file.hpp"
#include "engine/rendering/cubic_spline.hpp"
#include "protocols/identification/analysis/cues/felt_trials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

namespace touchtrial::analysis::identification {
namespace {

const TrialOutcome& trial_of(const Outcomes& outcomes, int session, int trial) {
  const auto found = std::ranges::find_if(outcomes.trials, [&](const TrialOutcome& outcome) {
    return outcome.scored && outcome.row.session == session && outcome.row.trial == trial;
  });
  if (found == outcomes.trials.end()) {
    throw StoreError(
        fmt::format("session {}, trial {}: the study has no such scored trial; choose "
                    "one that `touchtrial export` lists",
                    session, trial));
  }
  return *found;
}

record::Trace trace_of(const record::StudyStore& store, const study::StudyKey& key,
                       const TrialOutcome& trial) {
  const std::array<const TrialOutcome*, 1> trials{&trial};
  record::Trace trace;
  const auto missing = visit_traces(
      store, key, trials, 1, [&](std::size_t, const record::Trace& opened) { trace = opened; });
  if (missing.empty()) return trace;
  throw StoreError(fmt::format("session {}, trial {}: has no trace; choose another trial",
                               trial.row.session, trial.row.trial));
}

PathTexture texture_in_pack(const engine::Pack& pack, const std::string& code) {
  const engine::MappedField field = pack.map(code);
  return {field.view().geometry, field_picture(field.view()), "the field in the study's pack"};
}

PathTexture texture_in_image(const study::Study& study, const study::StimulusIndex& stimulus) {
  const auto& image = study.classes[stimulus.class_index].images[stimulus.exemplar];
  GreyImage grey = engine::read_grey_image(study.folder / image);
  const PlaneGeometry geometry{study.rendering.pitch_mm, grey.height(), grey.width()};
  return {geometry, std::move(grey), "the study's image"};
}

PathTexture texture_of(const study::StudyKey& key, const study::StimulusIndex& stimulus,
                       const std::optional<engine::Pack>& pack) {
  try {
    if (pack) return texture_in_pack(*pack, key.code_of(stimulus));
  } catch (const FileError&) {
    // Fall back to the image.
  }
  try {
    return texture_in_image(key.study, stimulus);
  } catch (const FileError&) {
    return {{}, {}, "neither pack nor image was found"};
  }
}

/// The part of the plane that the hand reached, for planes of unknown size.
PlaneGeometry explored_plane(std::span<const PathPoint> points, double pitch_mm) {
  Vec2 furthest{};
  for (const PathPoint& point : points) {
    furthest.x = std::max(furthest.x, point.position_mm.x);
    furthest.y = std::max(furthest.y, point.position_mm.y);
  }
  PlaneGeometry plane;
  plane.pitch_mm = pitch_mm;
  plane.width_px = static_cast<int>(furthest.x / pitch_mm) + 1;
  plane.height_px = static_cast<int>(furthest.y / pitch_mm) + 1;
  return plane;
}

double tangential_rms_n(std::span<const record::TraceSample> samples) {
  double squares = 0.0;
  for (const record::TraceSample& sample : samples) {
    squares += sample.force_n.x * sample.force_n.x + sample.force_n.y * sample.force_n.y;
  }
  return std::sqrt(squares / static_cast<double>(samples.size()));
}

const TrialOutcome* find_trial(const Outcomes& outcomes, const TrialName& name) {
  const TrialOutcome* found = nullptr;
  for (const TrialOutcome& trial : outcomes.trials) {
    const bool is_named =
        trial.scored && trial.participant == name.participant && trial.row.trial == name.trial;
    if (is_named && (found == nullptr || (trial.counted && !found->counted))) found = &trial;
  }
  return found;
}

constexpr double kMidGrey = 127.5;
constexpr double kMaxDeviations = 2.5;

std::vector<double> surface_of(engine::FieldView field) {
  if (field.model == engine::ModelKind::paper) return {field.heights.begin(), field.heights.end()};
  std::vector<double> surface;
  const PlaneGeometry& plane = field.geometry;
  for (int y = 0; y < plane.height_px; ++y) {
    for (int x = 0; x < plane.width_px; ++x) {
      surface.push_back(
          engine::spline_at(field.heights, plane.height_px, plane.width_px, x, y).value);
    }
  }
  return surface;
}

}  // namespace

std::vector<PathPoint> thinned_path(const record::Trace& trace, int count) {
  if (count < 1) throw std::invalid_argument("thinned_path: needs at least one point");
  const std::span<const record::TraceSample> samples(trace.samples);
  const auto max_points = static_cast<std::size_t>(count);
  const std::size_t step = std::max<std::size_t>(1, (samples.size() + max_points - 1) / max_points);
  std::vector<PathPoint> points;
  for (std::size_t i = 0; i < samples.size(); i += step) {
    const record::TraceSample& sample = samples[i];
    points.push_back({{sample.position_mm.x, sample.position_mm.y},
                      {sample.force_n.x, sample.force_n.y},
                      tangential_rms_n(samples.subspan(i, std::min(step, samples.size() - i))),
                      sample.force_n.z > 0.0});
  }
  return points;
}

ExplorationPath exploration_path(const record::StudyStore& store, const study::StudyKey& key,
                                 const Outcomes& outcomes, int session, int trial,
                                 const std::filesystem::path& pack) {
  const TrialOutcome& outcome = trial_of(outcomes, session, trial);
  const record::Trace trace = trace_of(store, key, outcome);
  ExplorationPath path;
  path.simulated = outcomes.simulated;
  const bool is_public = outcomes.collection.is_public;
  path.session = is_public ? 0 : session;
  path.trial = is_public ? outcome.stimulus.method + 1 : trial;
  path.participant = is_public ? "" : outcome.participant;
  path.class_label = outcomes.classes[outcome.stimulus.class_index];
  path.exemplar = outcomes.exemplars[outcome.stimulus.class_index][outcome.stimulus.exemplar];
  path.method = outcomes.methods[outcome.stimulus.method];
  path.answered_right = outcome.correct();
  path.duration_s = static_cast<double>(trace.samples.size()) / trace.rate_hz;
  path.points = thinned_path(trace);
  path.texture = texture_of(key, outcome.stimulus, pack_of(store, key, pack));
  PlaneGeometry& plane = path.texture.geometry;
  if (plane.width_px == 0) plane = explored_plane(path.points, key.study.rendering.pitch_mm);
  return path;
}

TrialName trial_name(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && colon > 0) {
    const int trial = number_in<int>(std::string_view(text).substr(colon + 1)).value_or(0);
    if (trial > 0) return {text.substr(0, colon), trial};
  }
  throw UsageError(
      one_line(text) +
      ": is not the name of a trial; write PARTICIPANT:N, such as P01:3 for P01's third trial");
}

ExplorationPath find_exploration(const record::StudyStore& store, const study::StudyKey& key,
                                 const Outcomes& outcomes, const TrialName& name) {
  const TrialOutcome* trial = find_trial(outcomes, name);
  if (trial == nullptr) {
    throw UsageError(fmt::format(
        "{}:{}: the study has no such scored trial; choose one that `touchtrial export` lists",
        one_line(name.participant), name.trial));
  }
  return exploration_path(store, key, outcomes, trial->row.session, trial->row.trial);
}

std::vector<ExplorationPath> first_explorations(const record::StudyStore& store,
                                                const study::StudyKey& key,
                                                const Outcomes& outcomes) {
  std::vector<ExplorationPath> paths;
  for (int method = 0; method < static_cast<int>(outcomes.methods.size()); ++method) {
    const auto first = std::ranges::find_if(outcomes.trials, [&](const TrialOutcome& trial) {
      return trial.counted && trial.stimulus.method == method &&
             store.sealed_trace(trial.row.session, trial.row.trial).has_value();
    });
    if (first == outcomes.trials.end()) continue;
    paths.push_back(exploration_path(store, key, outcomes, first->row.session, first->row.trial));
  }
  return paths;
}

GreyImage field_picture(engine::FieldView field) {
  if (field.empty()) return {};
  const std::vector<double> surface = surface_of(field);
  const double mean = mean_of(surface);
  const double deviation = standard_deviation(surface, mean, static_cast<double>(surface.size()));
  // A field that varies only by rounding is flat.
  const bool is_flat = deviation <= 1e-6 * (1.0 + std::abs(mean));
  const double gain = is_flat ? 0.0 : kMidGrey / (kMaxDeviations * deviation);
  GreyImage picture(field.geometry.height_px, field.geometry.width_px);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const double grey = kMidGrey + gain * (surface[i] - mean);
    picture.samples()[i] = static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
  }
  return picture;
}

}  // namespace touchtrial::analysis::identification
