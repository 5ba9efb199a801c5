#include "analysis/cues/exploration_path.hpp"

#include "analysis/cues/field_picture.hpp"
#include "analysis/cues/study_plane.hpp"
#include "analysis/cues/trace_reader.hpp"
#include "core/errors.hpp"
#include "engine/image_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace touchtrial::analysis {
namespace {

const TrialOutcome& trial_of(const Outcomes& outcomes, int session, int trial) {
  const auto found = std::ranges::find_if(outcomes.trials, [&](const TrialOutcome& one) {
    return one.scored && one.row.session == session && one.row.trial == trial;
  });
  if (found == outcomes.trials.end()) {
    throw StoreError(
        fmt::format("session {}, trial {}: there is no such scored trial; choose "
                    "one that `touchtrial export` lists",
                    session, trial));
  }
  return *found;
}

store::Trace trace_of(const store::StudyStore& store, const design::StudyKey& key,
                      const TrialOutcome& trial) {
  const std::array<const TrialOutcome*, 1> wanted{&trial};
  store::Trace trace;
  const auto missing = visit_traces(
      store, key, wanted, 1, [&](std::size_t, const store::Trace& opened) { trace = opened; });
  if (missing.empty()) return trace;
  throw StoreError(fmt::format("session {}, trial {}: has no trace; choose another trial",
                               trial.row.session, trial.row.trial));
}

PathTexture texture_in_pack(const engine::Pack& pack, const std::string& code) {
  const engine::MappedField field = pack.map(code);
  return {field.view().geometry, field_picture(field.view()), "the field in the study's pack"};
}

PathTexture texture_in_image(const design::Study& study, const design::StimulusIndex& stimulus) {
  const auto& image = study.classes[stimulus.class_index].images[stimulus.exemplar];
  GreyImage grey = engine::read_grey_image(study.folder / image);
  const PlaneGeometry geometry{study.rendering.pitch_mm, grey.height(), grey.width()};
  return {geometry, std::move(grey), "the study's image"};
}

PathTexture texture_of(const design::StudyKey& key, const design::StimulusIndex& stimulus,
                       const std::optional<engine::Pack>& pack) {
  try {
    if (pack) return texture_in_pack(*pack, key.code_of(stimulus));
  } catch (const FileError&) {
    // The image will do.
  }
  try {
    return texture_in_image(key.study, stimulus);
  } catch (const FileError&) {
    return {{}, {}, "neither pack nor image was found"};
  }
}

double tangential_rms_n(std::span<const store::TraceSample> samples) {
  double squares = 0.0;
  for (const store::TraceSample& sample : samples) {
    squares += sample.force_n.x * sample.force_n.x + sample.force_n.y * sample.force_n.y;
  }
  return std::sqrt(squares / static_cast<double>(samples.size()));
}

}  // namespace

std::vector<PathPoint> thinned_path(const store::Trace& trace, int count) {
  if (count < 1) throw std::invalid_argument("thinned_path: there must be a point");
  const std::span<const store::TraceSample> samples(trace.samples);
  const auto most = static_cast<std::size_t>(count);
  const std::size_t step = std::max<std::size_t>(1, (samples.size() + most - 1) / most);
  std::vector<PathPoint> points;
  for (std::size_t i = 0; i < samples.size(); i += step) {
    const store::TraceSample& at = samples[i];
    points.push_back({{at.position_mm.x, at.position_mm.y},
                      {at.force_n.x, at.force_n.y},
                      tangential_rms_n(samples.subspan(i, std::min(step, samples.size() - i))),
                      at.force_n.z,
                      at.force_n.z > 0.0});
  }
  return points;
}

ExplorationPath exploration_path(const store::StudyStore& store, const design::StudyKey& key,
                                 const Outcomes& outcomes, int session, int trial,
                                 const std::filesystem::path& pack) {
  const TrialOutcome& felt = trial_of(outcomes, session, trial);
  const store::Trace trace = trace_of(store, key, felt);
  ExplorationPath path;
  path.simulated = outcomes.simulated;
  path.session = session;
  path.trial = trial;
  path.participant = felt.participant;
  path.class_label = outcomes.classes[felt.stimulus.class_index];
  path.exemplar = outcomes.exemplars[felt.stimulus.class_index][felt.stimulus.exemplar];
  path.method = outcomes.methods[felt.stimulus.method];
  path.answered_right = felt.correct();
  path.duration_s = static_cast<double>(trace.samples.size()) / trace.rate_hz;
  path.points = thinned_path(trace);
  path.texture = texture_of(key, felt.stimulus, pack_of(store, key, pack));
  return path;
}

}  // namespace touchtrial::analysis
