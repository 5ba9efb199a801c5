/// \file Results in double precision, against which all others are compared.
#pragma once

#include "core/plane.hpp"
#include "engine/extraction.hpp"

namespace touchtrial::bench {

/// The adaptive extraction of one image in double.
class ExtractionTruth {
 public:
  ExtractionTruth(const GreyImage& image, int radius, bool with_force);

  /// The largest error, in grey levels. Pixels whose CSGV is within 1e-3 of 2 or 128 do not count:
  /// there, two orders of summation may take different branches of the order map.
  [[nodiscard]] double texture_error(const Plane<float>& texture) const;

  /// The largest error, in grey levels per pixel. The outermost pixels, for which peers use another
  /// definition, and neighbours of branch points do not count.
  /// \pre with_force
  [[nodiscard]] double force_error(const Plane<float>& x, const Plane<float>& y) const;

  /// How many samples of the 8-bit picture differ from double's, although CSGV is not near a branch
  /// point and the texture is not within 1e-4 of a tie.
  [[nodiscard]] int unlike_pixels(const GreyImage& picture) const;

 private:
  [[nodiscard]] bool is_at_branch(int y, int x) const;
  /// Whether the pixel or one of its neighbours is at a branch.
  /// \pre (y, x) is not at the edge
  [[nodiscard]] bool is_near_branch(int y, int x) const;

  engine::Extraction<double> truth_;
};

/// The truth of one image, which is kept until another is requested: a large image takes seconds in
/// double.
[[nodiscard]] const ExtractionTruth& remembered_truth(const GreyImage& image, int radius,
                                                      bool with_force);

/// v under the default options after hundreds of steps in double. It is kept until another image is
/// requested.
/// \param image  not flat
[[nodiscard]] const Plane<double>& tv_gabor_truth(const GreyImage& image);

}  // namespace touchtrial::bench
