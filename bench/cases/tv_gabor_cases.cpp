#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/inputs/truth.hpp"
#include "engine/fourier/real_fft.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "engine/tv_gabor/tv_gabor.hpp"
#include "tests/engine/plane_comparison.hpp"
#include "tests/engine/reference/tv_gabor_course.hpp"

#include <algorithm>
#include <memory>
#include <string>

namespace touchtrial::bench {
namespace {

/// A larger image takes a minute in double.
constexpr int kLargest_px = 1024;
/// To 1e-3 of v on a photograph.
constexpr int kUsualSteps = 50;
constexpr int kFistaSteps = 200;
/// Relative to v; solvers that stop early are far from it.
constexpr double kTolerance = 0.2;

struct Decomposition {
  explicit Decomposition(int size_px) : image(square_of(timed_picture(), size_px)) {}
  [[nodiscard]] double error() const { return distance_relative_to(v, tv_gabor_truth(image)); }
  GreyImage image;
  Plane<float> v;
};

/// \param decompose  computes v of an image
template <class Decompose>
Case tv_gabor_case_of(const std::string& who, int size_px, Decompose decompose) {
  Case one = case_on_image("TV-Gabor", who, "u8", size_px, 0, {"of v, relative", kTolerance});
  one.is_slow = true;
  one.make = [=] {
    const auto work = std::make_shared<Decomposition>(size_px);
    return Job{[=] { work->v = decompose(work->image); }, [=] { return work->error(); }};
  };
  return one;
}

Case solver_case(const std::string& who, reference::TvGaborAlgorithm algorithm, int size_px,
                 int steps) {
  return tv_gabor_case_of(who + ", " + std::to_string(steps) + " steps", size_px,
                          [=](const GreyImage& image) {
                            reference::TvGaborCourse<float> course(image, {}, algorithm);
                            course.advance(steps);
                            return course.point().texture;
                          });
}

/// As an extraction calls it: until the gap is 1e-5.
Case default_stop_case(int size_px) {
  return tv_gabor_case_of(our_name() + ", default stop", size_px, [](const GreyImage& image) {
    return engine::tv_gabor<float>(image, {}).texture;
  });
}

}  // namespace

Case admm_case(int size_px, int steps) {
  return solver_case(our_name(), reference::TvGaborAlgorithm::admm, size_px, steps);
}

Case fixed_point_case(int size_px, int steps) {
  return solver_case("fixed point", reference::TvGaborAlgorithm::fixed_point, size_px, steps);
}

Case transforms_case(int size_px, int steps) {
  Case one = case_on_image("TV-Gabor", "its transforms alone, " + std::to_string(steps) + " steps",
                           "u8", size_px, 0, {});
  one.is_slow = true;
  one.make = [=] {
    const int side = engine::torus_length(size_px);
    const auto fft =
        std::make_shared<engine::RealFft<float>>(side, side, engine::FftPlan::measured);
    // Zeros stay zeros, and take no less time than other samples.
    std::ranges::fill(fft->plane(), 0.0F);
    const int rounds = steps + steps / engine::PenaltySchedule::kStepsBetweenChecks;
    return Job{[=] {
                 for (int round = 0; round < rounds; ++round) {
                   fft->forward();
                   fft->inverse();
                 }
               },
               {}};
  };
  return one;
}

Cases tv_gabor_cases(const Scope& scope) {
  Cases cases;
  for (const int size_px : scope.sizes_px) {
    if (size_px > kLargest_px) continue;
    cases.push_back(default_stop_case(size_px));
    cases.push_back(admm_case(size_px, kUsualSteps));
    cases.push_back(transforms_case(size_px, kUsualSteps));
    cases.push_back(solver_case("FISTA", reference::TvGaborAlgorithm::fista, size_px, kFistaSteps));
  }
  return cases;
}

}  // namespace touchtrial::bench
