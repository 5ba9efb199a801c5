/// \file The path of the hand in one trial, with forces, over the texture that was felt: the data
/// for the figure of an exploration. Also selects the trials that a report draws.
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

/// One sample of the trace, which also represents the samples up to the next point.
struct PathPoint {
  Vec2 position_mm;  ///< from the top-left corner of the plane; y runs downwards
  Vec2 force_n;      ///< tangential, as sent to the device: texture and friction, if any
  double tangential_rms_n = 0.0;  ///< rms tangential force until the next point
  bool in_contact = false;        ///< the normal force is above zero
};

/// The texture as a grey picture with stretched contrast.
struct PathTexture {
  PlaneGeometry geometry;
  GreyImage grey;      ///< empty if there is neither a pack nor an image
  std::string source;  ///< in words: "the field in the study's pack", "the study's image"
};

/// In a public report, participant is empty, session is 0, and trial is the number of the method,
/// from 1.
struct ExplorationPath {
  bool simulated = false;  ///< the figure needs the stamp
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

/// A trial as named by the user.
struct TrialName {
  std::string participant;
  int trial = 0;  ///< from 1, among all trials of the session
};

/// Reads a name like "P01:12". A participant's name may contain colons.
/// \throws UsageError if the text is not of that form
[[nodiscard]] TrialName trial_name(const std::string& text);

/// The path of the named scored trial. If a participant has several sessions, the trial is of the
/// session that counts.
/// \throws UsageError if there is no such trial
/// \throws StoreError if the trial has no trace
/// \throws VerificationError if the trace does not open
[[nodiscard]] ExplorationPath exploration_named(const record::StudyStore& store,
                                                const study::StudyKey& key,
                                                const Outcomes& outcomes, const TrialName& name);

/// For each method, the path of the first counted trial that has a trace, in the order of sessions
/// and trials. This choice does not depend on what the path shows.
/// \throws VerificationError if a trace does not open
[[nodiscard]] std::vector<ExplorationPath> first_explorations(const record::StudyStore& store,
                                                              const study::StudyKey& key,
                                                              const Outcomes& outcomes);

/// Every n-th sample of a trace, with the smallest n that gives at most `count` points.
/// \throws std::invalid_argument if `count` is below 1
[[nodiscard]] std::vector<PathPoint> thinned_path(const record::Trace& trace,
                                                  int count = kMaxPathPoints);

/// A field of a pack as a picture of the surface at the centres of its pixels. Mid-grey is the
/// field's mean; black and white are 2.5 standard deviations away from it. Lighter pixels feel
/// higher. A flat field is mid-grey everywhere.
/// \return an empty picture if the field is empty
[[nodiscard]] GreyImage field_picture(engine::FieldView field);

}  // namespace touchtrial::analysis::identification
