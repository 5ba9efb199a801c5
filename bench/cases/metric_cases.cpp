// MS-SSIM and co-occurrence statistics.
#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/peers/mat_view.hpp"
#include "bench/peers/opencv_metrics.hpp"
#include "engine/extraction.hpp"
#include "engine/metrics/glcm.hpp"
#include "engine/metrics/ssim.hpp"
#include "tests/engine/reference/glcm_reference.hpp"
#include "tests/engine/reference/ssim_reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

namespace touchtrial::bench {
namespace {

/// The slow reference sums 121 products for each window: half a second for the usual picture. For
/// larger images the truth is double precision, which agrees with the reference on smaller ones.
constexpr int kLargestReference_px = 500;
constexpr double kMsSsimTolerance = 1e-4;

/// The two pictures that `evaluate` compares: the adaptive texture and that of a fixed order.
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

/// \param measure  the similarity of a TexturePair
template <class Measure>
Case ms_ssim_case_of(const std::string& who, int size_px, Measure measure) {
  Case one = case_on_image("MS-SSIM", who, "u8", size_px, 0, {"of MS-SSIM", kMsSsimTolerance});
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

/// All statistics except contrast are at most a few units.
constexpr double kGlcmTolerance = 1e-9;

double relative(double value, double truth) {
  return std::abs(value - truth) / std::max(1.0, std::abs(truth));
}

struct Counted {
  explicit Counted(int size_px) : image(square_of(timed_picture(), size_px)) {}

  [[nodiscard]] double error() const {
    double largest = 0.0;
    for (std::size_t i = 0; i < table.size(); ++i) {
      const engine::GlcmStatistics truth =
          reference::glcm_statistics(image, engine::kGlcmOffsets[i].dy, engine::kGlcmOffsets[i].dx);
      largest = std::max(
          {largest, relative(table[i].angular_second_moment, truth.angular_second_moment),
           relative(table[i].entropy, truth.entropy), relative(table[i].contrast, truth.contrast),
           relative(table[i].correlation, truth.correlation)});
    }
    return largest;
  }

  GreyImage image;
  engine::GlcmTable table{};
};

template <class Measure>
Case glcm_case_of(const std::string& who, int size_px, Measure measure) {
  Case one =
      case_on_image("GLCM and statistics", who, "u8", size_px, 0, {"relative", kGlcmTolerance});
  one.make = [=] {
    const auto counted = std::make_shared<Counted>(size_px);
    return Job{[=] { counted->table = measure(counted->image); }, [=] { return counted->error(); }};
  };
  return one;
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

Case glcm_case(int size_px) {
  return glcm_case_of(our_name(), size_px,
                      [](const GreyImage& image) { return engine::glcm_statistics(image); });
}

Case pair_loop_case(int size_px) {
  return glcm_case_of("plain loop over pairs", size_px,
                      [](const GreyImage& image) { return pair_loop_glcm(mat_of(image)); });
}

Cases glcm_cases(const Scope& scope) {
  Cases cases;
  for (const int size_px : scope.sizes_px) {
    cases.push_back(glcm_case(size_px));
    cases.push_back(pair_loop_case(size_px));
  }
  return cases;
}

}  // namespace touchtrial::bench
