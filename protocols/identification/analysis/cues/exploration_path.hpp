/// \file The path of the hand and the forces over the texture in one trial, for the figure of an
/// exploration; selects the trials that a report draws.
#pragma once

#include "analysis/outcomes/outcomes.hpp"
#include "core/plane.hpp"
#include "core/plane_geometry.hpp"
#include "core/vec.hpp"
#include "engine/rendering/texture_field.hpp"
#include "record/study_store.hpp"
#include "study/study_key.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::analysis::identification {

inline constexpr int kMaxPathPoints = 2000;

/// One sample of the trace; represents the samples until the next point.
struct PathPoint {
  Vec2 position_mm;               ///< from the top-left corner of the plane; y runs downwards
  Vec2 force_n;                   ///< tangential, as sent to the device: texture and friction
  double tangential_rms_n = 0.0;  ///< until the next point
  bool in_contact = false;        ///< the normal force is above zero
};

/// The texture as a grey picture with stretched contrast.
struct PathTexture {
  PlaneGeometry geometry;
  GreyImage grey;      ///< empty if there is neither a pack nor an image
  std::string source;  ///< "the field in the study's pack", "the study's image"
};

/// In a public report, `participant` is empty, `session` is 0, and `trial` is the number of the
/// method, from 1.
struct ExplorationPath {
  bool simulated = false;
  int session = 0;
  int trial = 0;
  std::string participant;
  std::string class_label;
  std::string exemplar;
  std::string method;
  bool answered_right = false;
  double duration_s = 0.0;
  std::vector<PathPoint> points;  ///< evenly spaced in time, kMaxPathPoints at most
  PathTexture texture;
};

/// The path of one trial. The texture comes from the study's pack if it is available, otherwise
/// from the image of the stimulus.
/// \param pack  folder; empty: the path in the key
/// \throws StoreError if the outcomes have no such scored trial, or the trial has no trace
/// \throws VerificationError if the trace does not open
[[nodiscard]] ExplorationPath exploration_path(const record::StudyStore& store,
                                               const study::StudyKey& key, const Outcomes& outcomes,
                                               int session, int trial,
                                               const std::filesystem::path& pack = {});

struct TrialName {
  std::string participant;
  int trial = 0;  ///< from 1, among all trials of the session
};

/// Reads a name like "P01:12". A participant's name may contain colons.
/// \throws UsageError for other texts
[[nodiscard]] TrialName trial_name(const std::string& text);

/// The path of the named scored trial. If a participant has several sessions, the trial of the
/// counted session.
/// \throws UsageError if there is no such trial
/// \throws StoreError if the trial has no trace
/// \throws VerificationError if the trace does not open
[[nodiscard]] ExplorationPath find_exploration(const record::StudyStore& store,
                                               const study::StudyKey& key, const Outcomes& outcomes,
                                               const TrialName& name);

/// For each method, the path of the first counted trial with a trace, so that the choice does not
/// depend on the path.
/// \throws VerificationError if a trace does not open
[[nodiscard]] std::vector<ExplorationPath> first_explorations(const record::StudyStore& store,
                                                              const study::StudyKey& key,
                                                              const Outcomes& outcomes);

/// Every n-th sample of a trace, with the smallest n that gives no more than `count` points.
/// \throws std::invalid_argument if `count` is below 1
[[nodiscard]] std::vector<PathPoint> thinned_path(const record::Trace& trace,
                                                  int count = kMaxPathPoints);

/// A picture of the surface of a field at the centres of its pixels: lighter is higher. Mid-grey is
/// the mean; black and white are 2.5 standard deviations away. A flat field is mid-grey.
/// \return an empty picture if the field is empty
[[nodiscard]] GreyImage field_picture(engine::FieldView field);

}  // namespace touchtrial::analysis::identification
