#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/peers/mat_view.hpp"
#include "bench/peers/opencv_ms_ssim.hpp"
#include "engine/extraction.hpp"
#include "engine/metrics/ssim.hpp"
#include "tests/engine/reference/ssim_reference.hpp"

#include <cmath>
#include <memory>

namespace touchtrial::bench {
namespace {

/// The slow reference sums 121 products for each window: half a second for the usual picture, which
/// is enough. Beyond it double is the truth, which the reference has confirmed.
constexpr int kLargestReference_px = 500;
constexpr double kTolerance = 1e-4;

/// What `evaluate` compares: the adaptive texture with that of a fixed order.
struct TexturePair {
  explicit TexturePair(int size_px) {
    const GreyImage image = square_of(timed_picture(), size_px);
    engine::ExtractionOptions options;
    a = engine::texture_picture(engine::extract_texture<float>(image, options).texture);
    options.method = engine::Method::fixed;
    options.order = kFixedOrder;
    b = engine::texture_picture(engine::extract_texture<float>(image, options).texture);
  }

  [[nodiscard]] double error() const {
    const double truth = a.width() > kLargestReference_px ? engine::ms_ssim<double>(a, b).unit
                                                          : reference::ms_ssim(a, b).unit;
    return std::abs(similarity - truth);
  }

  GreyImage a;
  GreyImage b;
  double similarity = kNotTaken;
  OpenCvMsSsim opencv;
};

/// \param measure  of a TexturePair: its similarity
template <class Measure>
Case ms_ssim_case_of(const std::string& who, int size_px, Measure measure) {
  Case one = case_on_image("MS-SSIM", who, "u8", size_px, 0, {"of MS-SSIM", kTolerance});
  one.make = [=] {
    const auto pair = std::make_shared<TexturePair>(size_px);
    return Job{[=] { pair->similarity = measure(*pair); }, [=] { return pair->error(); }};
  };
  return one;
}

Case reference_case(int size_px) {
  return ms_ssim_case_of("windows one by one, double", size_px, [](const TexturePair& pair) {
    return reference::ms_ssim(pair.a, pair.b).unit;
  });
}

}  // namespace

template <typename Real>
Case ms_ssim_case(int size_px) {
  const bool in_double = sizeof(Real) == sizeof(double);
  return ms_ssim_case_of(
      our_name() + (in_double ? ", double" : ""), size_px,
      [](const TexturePair& pair) { return engine::ms_ssim<Real>(pair.a, pair.b).unit; });
}

template Case ms_ssim_case<float>(int);
template Case ms_ssim_case<double>(int);

Case opencv_ms_ssim_case(int size_px) {
  return ms_ssim_case_of("OpenCV GaussianBlur", size_px, [](TexturePair& pair) {
    return pair.opencv.run(mat_of(pair.a), mat_of(pair.b));
  });
}

Cases ms_ssim_cases(const Scope& scope) {
  Cases cases;
  for (const int size_px : scope.sizes_px) {
    cases.push_back(ms_ssim_case<float>(size_px));
    cases.push_back(ms_ssim_case<double>(size_px));
    cases.push_back(opencv_ms_ssim_case(size_px));
    if (size_px == kUsualSize_px) cases.push_back(reference_case(size_px));
  }
  return cases;
}

}  // namespace touchtrial::bench
