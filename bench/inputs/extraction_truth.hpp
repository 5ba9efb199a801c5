/// \file The adaptive extraction in double, which every other is held against.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"

namespace touchtrial::bench {

class ExtractionTruth {
 public:
  ExtractionTruth(const GreyImage& image, int radius, bool with_force);

  /// Grey levels; the largest but where CSGV is within 1e-3 of 2 or 128: there two ways of summing
  /// may take different branches of the order map.
  [[nodiscard]] double texture_error(const Plane<float>& texture) const;

  /// Grey levels per pixel, one pixel inside the edge (where peers have another definition), and
  /// away from branch points too. \pre with_force
  [[nodiscard]] double force_error(const Plane<float>& x, const Plane<float>& y) const;

  /// Samples of the 8-bit picture that differ from that of double, though CSGV is not near a branch
  /// point and the texture not within 1e-4 of a tie.
  [[nodiscard]] int unlike_pixels(const GreyImage& picture) const;

 private:
  [[nodiscard]] bool is_at_branch(int y, int x) const;
  [[nodiscard]] bool is_near_branch(int y, int x) const;

  engine::Extraction<double> truth_;
};

/// The same, kept until another is asked for: in double a large image takes seconds.
[[nodiscard]] const ExtractionTruth& remembered_truth(const GreyImage& image, int radius,
                                                      bool with_force);

}  // namespace touchtrial::bench
