#include "bench/measure/tv_gabor_courses.hpp"

#include "bench/inputs/truth.hpp"
#include "bench/measure/timing.hpp"
#include "tests/engine/plane_comparison.hpp"
#include "tests/engine/reference/tv_gabor_course.hpp"

namespace touchtrial::bench {
namespace {

/// ADMM computes its own gap at every tenth step, so that only this interval costs nothing extra.
constexpr int kAdmmRhythm = 10;
constexpr int kMostAdmmLooks = 30;

/// A solver whose steps are timed.
template <typename Real>
class TimedCourse {
 public:
  TimedCourse(const GreyImage& image, reference::TvGaborAlgorithm algorithm)
      : truth_(tv_gabor_truth(image)),
        start_us_(cpu_clock_us()),
        course_(image, {}, algorithm),
        us_(cpu_clock_us() - start_us_) {}

  [[nodiscard]] CoursePoint after(int steps) {
    const double start_us = cpu_clock_us();
    course_.advance(steps);
    us_ += cpu_clock_us() - start_us;
    const reference::TvGaborPoint<Real> point = course_.point();
    return {point.steps, us_, distance_relative_to(point.texture, truth_), point.gap};
  }

 private:
  const Plane<double>& truth_;
  double start_us_;
  reference::TvGaborCourse<Real> course_;
  double us_;
};

/// \param steps  between two points
/// \param looks  how many points
template <typename Real>
std::vector<CoursePoint> watch_course(const GreyImage& image, reference::TvGaborAlgorithm algorithm,
                                      int steps, int looks) {
  TimedCourse<Real> course(image, algorithm);
  std::vector<CoursePoint> points;
  for (int look = 0; look < looks; ++look) points.push_back(course.after(steps));
  return points;
}

}  // namespace

std::optional<CoursePoint> admm_until(const GreyImage& image, double error) {
  TimedCourse<float> course(image, reference::TvGaborAlgorithm::admm);
  for (int look = 0; look < kMostAdmmLooks; ++look) {
    const CoursePoint point = course.after(kAdmmRhythm);
    if (point.error <= error) return point;
  }
  return std::nullopt;
}

std::vector<SolverCourse> solver_courses(const GreyImage& image) {
  using enum reference::TvGaborAlgorithm;
  return {{"ADMM", watch_course<float>(image, admm, kAdmmRhythm, 15)},
          {"ADMM, double", watch_course<double>(image, admm, kAdmmRhythm, 15)},
          {"FISTA", watch_course<float>(image, fista, 50, 20)},
          {"fixed point", watch_course<float>(image, fixed_point, 50, 20)}};
}

}  // namespace touchtrial::bench
