#include "bench/inputs/tv_gabor_truth.hpp"

#include "tests/engine/reference/tv_gabor_course.hpp"

#include <optional>

namespace touchtrial::bench {
namespace {

/// The gap is then below 1e-7 on pictures, and v within about 1e-4.
constexpr int kSteps = 400;

}  // namespace

const Plane<double>& tv_gabor_truth(const GreyImage& image) {
  struct Remembered {
    GreyImage image;
    Plane<double> texture;
  };
  static std::optional<Remembered> last;
  if (!last || last->image != image) {
    reference::TvGaborCourse<double> course(image, {}, reference::TvGaborAlgorithm::admm);
    course.advance(kSteps);
    last = Remembered{image, course.point().texture};
  }
  return last->texture;
}

}  // namespace touchtrial::bench
