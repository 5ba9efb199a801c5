/// \file One trial's path of the hand with its forces, over the texture that was felt: the data
/// behind the figure of an exploration; and which trials a report draws.
#pragma once

#include "analysis/outcomes.hpp"
#include "core/plane.hpp"
#include "core/plane_geometry.hpp"
#include "core/vec.hpp"
#include "engine/rendering/texture_field.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

inline constexpr int kMostPathPoints = 2000;

/// One sample of the trace, which also stands for the samples up to the next point.
struct PathPoint {
  Vec2 position_mm;  ///< on the plane, from its top-left corner; y runs downwards in the picture
  Vec2 force_n;      ///< tangential, as sent to the device: of the texture and of friction, if any
  double tangential_rms_n = 0.0;  ///< rms tangential force until the next point
  double normal_n = 0.0;
  bool in_contact = false;  ///< the normal force pushes
};

/// The texture as a grey picture, its contrast stretched.
struct PathTexture {
  PlaneGeometry geometry;
  GreyImage grey;      ///< empty if neither pack nor image is there
  std::string source;  ///< in words: "the field in the study's pack", "the study's image"
};

struct ExplorationPath {
  bool simulated = false;  ///< needs the stamp
  int session = 0;
  int trial = 0;
  std::string participant;
  std::string class_label;
  std::string exemplar;
  std::string method;
  bool answered_right = false;
  double duration_s = 0.0;
  std::vector<PathPoint> points;  ///< evenly spaced in time, kMostPathPoints at most
  PathTexture texture;
};

/// The path of one trial. The texture comes from the study's pack if that is there, else from the
/// image of the stimulus.
/// \param pack  folder; empty: where the key says
/// \throws StoreError if the outcomes hold no such scored trial, or it has no trace
/// \throws VerificationError if the trace does not open
[[nodiscard]] ExplorationPath exploration_path(const store::StudyStore& store,
                                               const design::StudyKey& key,
                                               const Outcomes& outcomes, int session, int trial,
                                               const std::filesystem::path& pack = {});

/// A trial as its user names it.
struct TrialName {
  std::string participant;
  int trial = 0;  ///< from 1, among all trials of the session
};

/// Reads a name like "P01:12"; a participant's name may contain colons.
/// \throws UsageError if the text is not of that form
[[nodiscard]] TrialName trial_name(const std::string& text);

/// The path of the scored trial of that name; if a participant has several sessions, of the one
/// that counts. \throws UsageError if there is no such trial \throws StoreError if it has no trace
/// \throws VerificationError if the trace does not open
[[nodiscard]] ExplorationPath exploration_named(const store::StudyStore& store,
                                                const design::StudyKey& key,
                                                const Outcomes& outcomes, const TrialName& name);

/// For each method the path of the first counted trial that has a trace, in the order of sessions
/// and trials: this choice does not depend on what the path shows.
/// \throws VerificationError if a trace does not open
[[nodiscard]] std::vector<ExplorationPath> first_explorations(const store::StudyStore& store,
                                                              const design::StudyKey& key,
                                                              const Outcomes& outcomes);

/// Every n-th sample, with the least n that gives at most `count` points.
/// \throws std::invalid_argument if `count` is below 1
[[nodiscard]] std::vector<PathPoint> thinned_path(const store::Trace& trace,
                                                  int count = kMostPathPoints);

/// A field of a pack as a picture: the surface at the centres of its pixels, mid-grey at its mean,
/// black and white at 2.5 standard deviations; what is felt as higher is lighter. A flat field is
/// mid-grey everywhere.
/// \return empty if the field is
[[nodiscard]] GreyImage field_picture(engine::FieldView field);

}  // namespace touchtrial::analysis::identification
