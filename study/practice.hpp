/// \file The textures that participants practise with, which are not in the study, built in memory.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/pack/pack.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/texture_field.hpp"
#include "study/study.hpp"

#include <vector>

namespace touchtrial::study {

/// The force models of a study's practice textures, and of the plane without texture that catch
/// trials present. Textures are extracted with the study's first method and rendered with the
/// study's options, on a plane of the same size, so that the first trial feels familiar.
class PracticeSet {
 public:
  /// Reads the images and makes the fields. The method decides how long this takes: about 0.1 s per
  /// texture for `adaptive`, seconds for `tv-gabor`.
  /// \param gains  gains of the study's pack, see weakest_gains. If the stiffness budget sets the
  ///   gains, each practice texture gets the lower of these and the gains that the budget gives the
  ///   practice textures. Equalised textures always get the latter; explicit gains apply unchanged.
  /// \param plane  plane of all stimuli of the pack, in pixels; it is cut from an image's middle
  /// \throws StudyError with the place of an image that is missing, unreadable or smaller than the
  ///   plane
  PracticeSet(const Study& study, const engine::Gains& gains, const PlaneGeometry& plane);
  PracticeSet(const PracticeSet&) = delete;
  PracticeSet& operator=(const PracticeSet&) = delete;
  PracticeSet(PracticeSet&&) = default;
  PracticeSet& operator=(PracticeSet&&) = default;
  ~PracticeSet() = default;

  [[nodiscard]] int classes() const noexcept { return static_cast<int>(models_.size()); }
  /// \param class_index  index into the study's practice classes
  /// \throws std::out_of_range if there is no such class
  [[nodiscard]] const engine::RenderingModel& model(int class_index) const;
  /// A smooth wall without texture.
  [[nodiscard]] const engine::RenderingModel& flat() const noexcept { return flat_; }
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }

 private:
  PlaneGeometry plane_;
  std::vector<engine::TextureField> fields_;
  std::vector<engine::RenderingModel> models_;
  engine::RenderingModel flat_;
};

/// The lowest value of each gain in the pack.
[[nodiscard]] engine::Gains weakest_gains(const engine::PackManifest& manifest);

}  // namespace touchtrial::study
