/// \file How well classes can be told apart by the strength of their forces alone.
#pragma once

#include "engine/rendering/texture_field.hpp"

#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Patches along each side of a field, for rms_alone().
inline constexpr int kPatchesASide = 5;

/// Strengths of one picture's patches: natural logarithms of rms tangential force in newtons.
struct PatchStrengths {
  int label = 0;  ///< of its class, from 0 without gaps
  std::vector<double> log_rms;
};

/// Logarithms of sqrt(rms^2 + threshold^2) over kPatchesASide x kPatchesASide equal parts of a
/// field (the last ones larger where the sides do not divide), row by row.
/// \param tangential_n  gain \param threshold_n  what is felt as nothing, > 0
/// \throws std::invalid_argument if a side is below kPatchesASide
[[nodiscard]] std::vector<double> patch_strengths(engine::FieldView field, double tangential_n,
                                                  double threshold_n);

/// Shares of right answers over all sets of so many classes; chance is 1 / classes.
struct RmsAlone {
  int classes = 0;
  int sets = 0;               ///< of classes that were tried: all there are
  double unseen_patch = 0.0;  ///< every other patch is known
  /// Patches of a picture of which none is known; negative if a class has but one picture.
  double unseen_picture = -1.0;
};

/// Answers each patch with the class of the set whose mean strength is nearest to the patch's: once
/// with means over all other patches, once with means over the class's other pictures. Every class
/// of a set counts alike. This is the best that rms force can do: no noise of a hand or of a sense
/// is added.
/// \param classes_in_set  2 .. number of classes
/// \throws std::invalid_argument if it is out of range, or a class has no patch
[[nodiscard]] RmsAlone rms_alone(std::span<const PatchStrengths> pictures, int classes_in_set);

}  // namespace touchtrial::analysis
