/// \file Practice: textures that are not in the study, made in memory, and the order they come in.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/pack/pack.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/texture_field.hpp"
#include "protocols/design/study.hpp"

#include <vector>

namespace touchtrial::design {

/// The force models of a study's practice textures, and of the plane without texture that catch
/// trials present. Textures are taken with the study's first method and rendered as the study is,
/// on a plane of the study's size, so that a hand meets nothing new in the first trial.
class PracticeSet {
 public:
  /// Reads the images and makes the fields: as slow as the method is, some 0.1 s a texture for
  /// `adaptive`, seconds for `tv-gabor`.
  /// \param gains  of the study's pack, see weakest_gains. Where they come from the stiffness
  ///   budget, practice is felt with the lower of these and of what the budget leaves the practice
  ///   textures; equalised textures have the latter.
  /// \param plane  that all stimuli of the pack have, in pixels; the middle of an image is taken
  /// \throws StudyError with the place of an image that is missing, unreadable or smaller than the
  ///   plane
  PracticeSet(const Study& study, const engine::Gains& gains, const PlaneGeometry& plane);
  PracticeSet(const PracticeSet&) = delete;
  PracticeSet& operator=(const PracticeSet&) = delete;
  PracticeSet(PracticeSet&&) = default;
  PracticeSet& operator=(PracticeSet&&) = default;
  ~PracticeSet() = default;

  [[nodiscard]] int classes() const noexcept { return static_cast<int>(models_.size()); }
  /// \param class_index  in the study's practice classes. \throws std::out_of_range
  [[nodiscard]] const engine::RenderingModel& model(int class_index) const;
  /// A wall and nothing else.
  [[nodiscard]] const engine::RenderingModel& flat() const noexcept { return flat_; }
  [[nodiscard]] const PlaneGeometry& plane() const noexcept { return plane_; }

 private:
  PlaneGeometry plane_;
  std::vector<engine::TextureField> fields_;
  std::vector<engine::RenderingModel> models_;
  engine::RenderingModel flat_;
};

/// Each gain at its lowest in the pack.
[[nodiscard]] engine::Gains weakest_gains(const engine::PackManifest& manifest);

/// The textures of a practice round, one for each of its `trials.practice` presentations: indices
/// into the practice classes, each as often as any other or once more, in a random order. A
/// function of the study's seed, practice and trials and of the arguments alone.
/// \param round  from 1
[[nodiscard]] std::vector<int> practice_round(const Study& study, int enrolment, int round);

/// The practice class whose picture is at each position, random for each participant and round.
[[nodiscard]] std::vector<int> practice_layout(const Study& study, int enrolment, int round);

}  // namespace touchtrial::design
