#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/peers/mat_view.hpp"
#include "bench/peers/pair_loop_glcm.hpp"
#include "engine/metrics/glcm.hpp"
#include "tests/engine/reference/glcm_reference.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

namespace touchtrial::bench {
namespace {

/// All statistics but contrast are at most a few units.
constexpr double kTolerance = 1e-9;

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
  Case one = case_on_image("GLCM and statistics", who, "u8", size_px, 0, {"relative", kTolerance});
  one.make = [=] {
    const auto counted = std::make_shared<Counted>(size_px);
    return Job{[=] { counted->table = measure(counted->image); }, [=] { return counted->error(); }};
  };
  return one;
}

}  // namespace

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
