#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/inputs/truth.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "engine/tv_gabor/tv_gabor.hpp"
#include "tests/engine/plane_comparison.hpp"
#include "tests/engine/reference/tv_gabor_course.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>

#include <fftw3.h>

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

/// FFTW's transforms of one size, there and back. They are planned by measurement, unlike the
/// engine's: a bound need not give the same digits twice.
class MeasuredTransforms {
 public:
  explicit MeasuredTransforms(int side)
      : samples_(fftwf_alloc_real(area(side, side))),
        spectrum_(fftwf_alloc_complex(area(side, side / 2 + 1))),
        forward_(fftwf_plan_dft_r2c_2d(side, side, samples_, spectrum_, FFTW_MEASURE)),
        inverse_(fftwf_plan_dft_c2r_2d(side, side, spectrum_, samples_, FFTW_MEASURE)) {
    // Zeros stay zeros, and take no less time than other samples.
    std::fill_n(samples_, area(side, side), 0.0F);
  }
  ~MeasuredTransforms() {
    fftwf_destroy_plan(forward_);
    fftwf_destroy_plan(inverse_);
    fftwf_free(samples_);
    fftwf_free(spectrum_);
  }
  MeasuredTransforms(const MeasuredTransforms&) = delete;
  MeasuredTransforms& operator=(const MeasuredTransforms&) = delete;

  void run(int rounds) const {
    for (int round = 0; round < rounds; ++round) {
      fftwf_execute(forward_);
      fftwf_execute(inverse_);
    }
  }

 private:
  static std::size_t area(int height, int width) {
    return static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  }

  float* samples_;
  fftwf_complex* spectrum_;
  fftwf_plan forward_;
  fftwf_plan inverse_;
};

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
    const auto transforms =
        std::make_shared<const MeasuredTransforms>(engine::torus_length(size_px));
    const int rounds = steps + steps / engine::PenaltySchedule::kStepsBetweenChecks;
    return Job{[=] { transforms->run(rounds); }, {}};
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
