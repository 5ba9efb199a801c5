#include "bench/inputs/tv_gabor_truth.hpp"

#include "engine/tv_gabor/course.hpp"

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
    engine::TvGaborCourse<double> course(image, {}, engine::TvGaborAlgorithm::admm);
    course.advance(kSteps);
    last = Remembered{image, course.point().texture};
  }
  return last->texture;
}

}  // namespace touchtrial::bench
