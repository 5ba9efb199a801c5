/// \file One trial as the hand went and felt, over the texture that it felt: what the figure of an
/// exploration is drawn from.
#pragma once

#include "analysis/outcomes.hpp"
#include "core/plane.hpp"
#include "core/plane_geometry.hpp"
#include "core/vec.hpp"
#include "protocols/design/study_key.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace touchtrial::analysis {

inline constexpr int kMostPathPoints = 2000;

/// One sample of the trace, and those after it up to the next point.
struct PathPoint {
  Vec2 position_mm;  ///< on the plane, from its top-left corner; y runs downwards in the picture
  Vec2 force_n;      ///< tangential, as sent to the device: of the texture and of friction, if any
  double tangential_rms_n = 0.0;  ///< size of the tangential force until the next point
  double normal_n = 0.0;
  bool in_contact = false;  ///< the normal force pushes
};

/// The texture as a grey picture, stretched so that its differences are seen.
struct PathTexture {
  PlaneGeometry geometry;
  GreyImage grey;      ///< empty if nothing tells what it looks like
  std::string source;  ///< in words: "the field in the study's pack", "the study's image"
};

struct ExplorationPath {
  bool simulated = false;  ///< to be stamped
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

/// The trace of one trial. The texture is that of the study's pack if it is there, else the image
/// of the stimulus.
/// \param pack  folder; empty: where the key says
/// \throws StoreError if the outcomes hold no such scored trial, or it has no trace
/// \throws VerificationError if the trace does not open
[[nodiscard]] ExplorationPath exploration_path(const store::StudyStore& store,
                                               const design::StudyKey& key,
                                               const Outcomes& outcomes, int session, int trial,
                                               const std::filesystem::path& pack = {});

/// `count` points at most: every n-th sample, n the least that will do.
/// \throws std::invalid_argument if `count` is below 1
[[nodiscard]] std::vector<PathPoint> thinned_path(const store::Trace& trace,
                                                  int count = kMostPathPoints);

}  // namespace touchtrial::analysis
