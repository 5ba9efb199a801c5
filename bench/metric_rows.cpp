// MS-SSIM, co-occurrence statistics and TV-Gabor, compared with OpenCV, plain code and other
// solvers.
#include "bench/inputs.hpp"
#include "bench/peers/opencv.hpp"
#include "bench/rows.hpp"
#include "engine/metrics/ssim.hpp"
#include "engine/tv_gabor/problem.hpp"
#include "engine/tv_gabor/solver.hpp"
#include "engine/tv_gabor/tv_gabor.hpp"
#include "tests/engine/plane_comparison.hpp"
#include "tests/engine/reference/glcm_reference.hpp"
#include "tests/engine/reference/ssim_reference.hpp"
#include "tests/engine/reference/tv_gabor_fixed_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fftw3.h>
#include <fmt/format.h>

namespace touchtrial::bench {
namespace {

constexpr double kMsSsimTolerance = 1e-4;
/// All statistics except contrast are at most a few units.
constexpr double kGlcmTolerance = 1e-9;
/// Relative to v; large, because some solvers stop early.
constexpr double kTvGaborTolerance = 0.5;
constexpr double kGoalDistance = 1e-3;
/// ADMM computes its gap at every tenth step, so checking at this interval is free.
constexpr int kAdmmCheckSteps = 10;
constexpr int kMaxAdmmSteps = 300;
constexpr int kQuickPictures = 2;

/// The two pictures that `evaluate` compares: the adaptive texture and a texture of fixed order.
struct TexturePair {
  GreyImage a, b;
  double similarity = 0.0;
  OpenCvMsSsim opencv{};
};

TexturePair timed_pair() {
  const GreyImage image = timed_image(kDefaultSize_px);
  engine::ExtractionOptions fixed;
  fixed.method = engine::Method::fixed;
  fixed.order = kFixedOrder;
  return {engine::texture_picture(engine::extract_texture<float>(image, {}).texture),
          engine::texture_picture(engine::extract_texture<float>(image, fixed).texture)};
}

/// \param measure  the similarity of a TexturePair
template <class Measure>
Case ms_ssim(const std::string& name, Measure measure) {
  return timed(
      name, timed_pair, [=](TexturePair& pair) { pair.similarity = measure(pair); },
      [](const TexturePair& pair) {
        return std::abs(pair.similarity - reference::ms_ssim(pair.a, pair.b).unit);
      },
      kMsSsimTolerance);
}

Row ms_ssim_row() {
  return {.title = "MS-SSIM, five scales",
          .ours = ms_ssim(
              "touchtrial",
              [](const TexturePair& pair) { return engine::ms_ssim<float>(pair.a, pair.b).unit; }),
          .peers = {ms_ssim("OpenCV GaussianBlur, u8",
                            [](TexturePair& pair) {
                              return pair.opencv.run(mat_of(pair.a), mat_of(pair.b));
                            }),
                    ms_ssim("touchtrial, double",
                            [](const TexturePair& pair) {
                              return engine::ms_ssim<double>(pair.a, pair.b).unit;
                            }),
                    ms_ssim("windows one by one, double",
                            [](const TexturePair& pair) {
                              return reference::ms_ssim(pair.a, pair.b).unit;
                            })},
          .goal = {"ratio", 0.25},
          .error_unit = "of MS-SSIM"};
}

double relative_error(double value, double truth) {
  return std::abs(value - truth) / std::max(1.0, std::abs(truth));
}

struct GlcmState {
  GreyImage image = timed_image(kDefaultSize_px);
  engine::GlcmTable table{};
};

double error_of(const GlcmState& state) {
  double largest = 0.0;
  for (std::size_t i = 0; i < state.table.size(); ++i) {
    const engine::GlcmOffset offset = engine::kGlcmOffsets[i];
    const engine::GlcmStatistics& ours = state.table[i];
    const auto truth = reference::glcm_statistics(state.image, offset.dy, offset.dx);
    largest = std::max(
        {largest, relative_error(ours.angular_second_moment, truth.angular_second_moment),
         relative_error(ours.entropy, truth.entropy), relative_error(ours.contrast, truth.contrast),
         relative_error(ours.correlation, truth.correlation)});
  }
  return largest;
}

template <class Measure>
Case glcm(const std::string& name, Measure measure) {
  return timed(
      name, [] { return GlcmState{}; },
      [=](GlcmState& state) { state.table = measure(state.image); }, error_of, kGlcmTolerance);
}

Row glcm_row() {
  return {.title = "GLCM and statistics",
          .ours = glcm("touchtrial",
                       [](const GreyImage& image) { return engine::glcm_statistics(image); }),
          .peers = {glcm("plain loop over pairs, u8",
                         [](const GreyImage& image) { return pair_loop_glcm(mat_of(image)); })},
          .goal = {"ratio", 0.5},
          .error_unit = "relative"};
}

/// \return the number of steps after which ADMM in single precision is within kGoalDistance of v
int steps_to_goal(const GreyImage& image) {
  const Plane<double> truth = tv_gabor_truth(image);
  engine::TvGaborSolver<float> solver(image, kUnreachableGap);
  for (int steps = kAdmmCheckSteps; steps <= kMaxAdmmSteps; steps += kAdmmCheckSteps) {
    static_cast<void>(solver.run(steps, engine::Patience::unlimited));
    if (distance_relative_to(solver.texture(), truth) <= kGoalDistance) return steps;
  }
  return std::numeric_limits<int>::max();
}

int default_steps() {
  static const int steps = steps_to_goal(timed_image(kDefaultSize_px));
  return steps;
}

struct TvGaborState {
  GreyImage image = timed_image(kDefaultSize_px);
  Plane<float> v{};
};

/// \param decompose  computes v of an image
template <class Decompose>
Case tv_gabor(const std::string& name, Decompose decompose) {
  Case result = timed(
      name, [] { return TvGaborState{}; },
      [=](TvGaborState& work) { work.v = decompose(work.image); },
      [](const TvGaborState& work) {
        static const Plane<double> truth = tv_gabor_truth(work.image);
        return distance_relative_to(work.v, truth);
      },
      kTvGaborTolerance);
  result.is_slow = true;
  return result;
}

Case admm_to_goal() {
  return tv_gabor("touchtrial", [](const GreyImage& image) {
    engine::TvGaborSolver<float> solver(image, kUnreachableGap);
    static_cast<void>(solver.run(default_steps(), engine::Patience::unlimited));
    return solver.texture();
  });
}

/// FFTW's forward and inverse transforms of one size. Unlike the engine's, they are planned by
/// measurement, because a bound need not be reproducible.
class MeasuredTransforms {
 public:
  explicit MeasuredTransforms(int side)
      : samples_(fftwf_alloc_real(area(side, side))),
        spectrum_(fftwf_alloc_complex(area(side, side / 2 + 1))),
        forward_(fftwf_plan_dft_r2c_2d(side, side, samples_, spectrum_, FFTW_MEASURE)),
        inverse_(fftwf_plan_dft_c2r_2d(side, side, spectrum_, samples_, FFTW_MEASURE)) {
    // Zeros take the same time as other samples, and stay zeros.
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

/// The transforms in the solver's steps and checks.
Case transforms() {
  Case result = timed(
      "transforms",
      [] { return std::make_unique<MeasuredTransforms>(engine::torus_length(kDefaultSize_px)); },
      [](const std::unique_ptr<MeasuredTransforms>& transforms) {
        const int steps = default_steps();
        transforms->run(steps + steps / engine::PenaltySchedule::kStepsBetweenChecks);
      });
  result.is_slow = true;
  return result;
}

/// \return the maximum number of steps to the goal over the shipped pictures
double steps_on_pictures(bool quick) {
  std::vector<GreyImage> pictures = shipped_pictures();
  if (quick) pictures.resize(kQuickPictures);
  int max_steps = 0;
  for (const GreyImage& picture : pictures) {
    max_steps = std::max(max_steps, steps_to_goal(picture));
  }
  return max_steps;
}

Rows tv_gabor_rows(bool quick) {
  return {{.title = "TV-Gabor, to 1e-3 of v",
           .ours = admm_to_goal(),
           .peers = {tv_gabor("fixed point, 1000 steps",
                              [](const GreyImage& image) {
                                return reference::tv_gabor_fixed_point(image, {}, 1000);
                              })},
           .goal = {"ratio", 0.08},
           .error_unit = "of v"},
          {.title = "TV-Gabor, against its own transforms",
           .ours = admm_to_goal(),
           .bounds = {transforms()},
           .goal = {"of bound", 1.3},
           .error_unit = "of v"},
          {.title = "TV-Gabor, most steps to 1e-3 of v",
           .ours = counted("touchtrial", [=] { return steps_on_pictures(quick); }),
           .goal = {"count", 80},
           .count_unit = "steps"}};
}

}  // namespace

Rows metric_rows(const Scope& scope) {
  Rows rows = {ms_ssim_row(), glcm_row()};
  for (Row& row : tv_gabor_rows(scope.quick)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace touchtrial::bench
