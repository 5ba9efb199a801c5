/// \file How well the strength of their forces alone distinguishes classes.
#pragma once

#include "engine/rendering/texture_field.hpp"

#include <span>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// Patches along each side of a field, for rms_alone().
inline constexpr int kPatchesASide = 5;

/// The strengths of one picture's patches.
struct PatchStrengths {
  int label = 0;                ///< of its class, from 0 without gaps
  std::vector<double> log_rms;  ///< natural logarithms of rms tangential force in newtons
};

/// Logarithms of sqrt(rms^2 + threshold^2) over kPatchesASide x kPatchesASide equal parts of a
/// field, row by row; if the sides are not divisible, the last parts are larger.
/// \param tangential_n  gain
/// \param threshold_n  weaker forces are not felt, > 0
/// \throws std::invalid_argument if a side is below kPatchesASide
[[nodiscard]] std::vector<double> patch_strengths(engine::FieldView field, double tangential_n,
                                                  double threshold_n);

/// Shares of right answers over all sets of a number of classes; chance is 1 / classes.
struct RmsAlone {
  int classes = 0;
  int sets = 0;               ///< all sets of that many classes
  double unseen_patch = 0.0;  ///< with every other patch known
  /// With no patch of the same picture known; negative if a class has only one picture.
  double unseen_picture = -1.0;
};

/// Answers each patch with the class whose mean strength is nearest to the patch's, among the
/// classes of a set: once with means over all other patches, once with means over the class's other
/// pictures. Every class of a set has the same weight. This is the best that rms force allows:
/// neither a hand nor a sense adds noise.
/// \param classes_in_set  2 .. number of classes
/// \throws std::invalid_argument if it is out of range, or a class has no patch
[[nodiscard]] RmsAlone rms_alone(std::span<const PatchStrengths> pictures, int classes_in_set);

}  // namespace touchtrial::analysis
