// Fractional filters, sub-bands and complete extractions, compared with OpenCV and the machine's
// bounds.
#include "bench/inputs.hpp"
#include "bench/limits.hpp"
#include "bench/peers/opencv.hpp"
#include "bench/rows.hpp"
#include "engine/daub4.hpp"
#include "engine/gl_texture.hpp"
#include "engine/kernels/aligned_rows.hpp"
#include "engine/kernels/float_extraction.hpp"
#include "engine/kernels/gl_row.hpp"
#include "engine/rendering/texture_field.hpp"
#include "tests/engine/plane_comparison.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace touchtrial::bench {
namespace {

constexpr const char* kGrey = "grey levels";
constexpr double kEngineTolerance_grey = 4e-5;
/// filter2D uses the Fourier transform for masks of 11 x 11 and more.
constexpr double kPeerTolerance_grey = 2e-3;
/// Sub-bands reach 510, where a float's precision is 3e-5.
constexpr double kBandTolerance_grey = 3e-4;
constexpr int kWideRadius = 7;
constexpr int kLargeSize_px = 4096;
constexpr int kFurtherSizes_px[] = {64, 128, 256, 1024, 2048};

/// The timed picture and its orders from the adaptive method.
struct OrderedImage {
  GreyImage image = timed_image(kDefaultSize_px);
  Plane<float> orders = [this] {
    engine::RequestedPlanes planes;
    planes.order = true;
    return engine::extract_texture<float>(image, {}, planes).order;
  }();
  Plane<float> texture{kDefaultSize_px, kDefaultSize_px};

  [[nodiscard]] Plane<double> half_orders() const {
    Plane<double> half((orders.height() + 1) / 2, (orders.width() + 1) / 2);
    for (int y = 0; y < half.height(); ++y) {
      for (int x = 0; x < half.width(); ++x) half.at(y, x) = orders.at(2 * y, 2 * x);
    }
    return half;
  }

  /// Runs only the engine's adaptive filter.
  void filter(int radius) {
    constexpr std::size_t kOverread = 2 * engine::kVectorBytes / sizeof(float);
    const auto width = static_cast<std::size_t>(image.width());
    engine::AlignedRows<float> last(1, width, kOverread);
    engine::ExtendedRows rows(image, radius);
    for (int y = 0; y < image.height(); ++y) {
      const float* order = orders.row(y).data();
      if ((static_cast<std::size_t>(y) + 1) * width + kOverread > orders.size()) {
        std::copy_n(order, width, last.row(0));
        order = last.row(0);
      }
      rows.next_row();
      engine::gl_row(rows, radius, order, texture.row(y).data());
    }
  }
};

OrderedImage ordered_image() {
  return {};
}

Case adaptive_filter(int radius, const std::string& target = {}) {
  Case result = timed(
      "touchtrial", ordered_image, [=](OrderedImage& input) { input.filter(radius); },
      [=](const OrderedImage& input) {
        return largest_difference(
            input.texture, engine::gl_texture<double>(input.image, radius, input.half_orders()));
      },
      kEngineTolerance_grey);
  result.simd_target = target;
  return result;
}

/// A picture, and its texture from OpenCV or the engine.
struct FixedFilter {
  GreyImage image = timed_image(kDefaultSize_px);
  engine::Extraction<float> result{};
  cv::Mat mask{}, input{}, texture{};
};

double fixed_error(const Plane<float>& texture, const GreyImage& image, int radius) {
  return largest_difference(texture, engine::gl_texture<double>(image, radius, kFixedOrder));
}

Case fixed_filter() {
  return timed(
      "touchtrial", [] { return FixedFilter{}; },
      [](FixedFilter& filter) {
        engine::ExtractionOptions options;
        options.method = engine::Method::fixed;
        options.order = kFixedOrder;
        engine::extract_texture_into(filter.image, options, {}, filter.result);
      },
      [](const FixedFilter& filter) {
        return fixed_error(filter.result.texture, filter.image, kDefaultRadius);
      },
      kEngineTolerance_grey);
}

/// \param enhanced  whether the mask computes the enhanced image I + T, from which I is subtracted
Case filter2d(int radius, const std::string& depth = "f32", bool enhanced = false) {
  return timed(
      "OpenCV filter2D, " + depth + (enhanced ? ", I + T - I" : ""),
      [=] {
        FixedFilter filter{.mask = fixed_order_mask(kFixedOrder, radius, enhanced)};
        mat_of(filter.image).convertTo(filter.input, depth == "f32" ? CV_32F : CV_8U);
        return filter;
      },
      [=](FixedFilter& filter) {
        cv::filter2D(filter.input, filter.texture, CV_32F, filter.mask, {-1, -1}, 0,
                     cv::BORDER_REFLECT);
        if (enhanced) cv::subtract(filter.texture, filter.input, filter.texture);
      },
      [=](const FixedFilter& filter) {
        return fixed_error(plane_of(filter.texture), filter.image, radius);
      },
      kPeerTolerance_grey);
}

/// \return the largest error of ll, lh, hl and hh
double error_of_bands(const GreyImage& image, const std::array<Plane<float>, 4>& bands) {
  const engine::SubBands truth = engine::daub4_sub_bands(image);
  return std::max({largest_difference(bands[0], truth.ll), largest_difference(bands[1], truth.lh),
                   largest_difference(bands[2], truth.hl), largest_difference(bands[3], truth.hh)});
}

/// A picture, and its extraction by the engine or by OpenCV.
template <class Peer = int>
struct ExtractionState {
  GreyImage image;
  Peer peer{};
  engine::Extraction<float> result{};
  double max_height = 0.0;  ///< of the texture; the models need it
};

Case engine_daub4() {
  return timed(
      "touchtrial", [] { return ExtractionState<>{timed_image(kDefaultSize_px)}; },
      [](ExtractionState<>& work) { engine::extract_sub_bands(work.image, work.result); },
      [](const ExtractionState<>& work) {
        return error_of_bands(work.image, {work.result.sub_band_ll, work.result.sub_band_lh,
                                           work.result.sub_band_hl, work.result.sub_band_hh});
      },
      kBandTolerance_grey);
}

Case opencv_daub4(const std::string& name, Daub4Mode mode) {
  using State = ExtractionState<OpenCvDaub4>;
  return timed(
      name,
      [=] {
        return State{timed_image(kDefaultSize_px), OpenCvDaub4(mode)};
      },
      [](State& work) { work.peer.run(mat_of(work.image)); },
      [](const State& work) {
        const std::array<cv::Mat, 4>& bands = work.peer.bands();
        return error_of_bands(work.image, {plane_of(bands[0]), plane_of(bands[1]),
                                           plane_of(bands[2]), plane_of(bands[3])});
      },
      kBandTolerance_grey);
}

double texture_error(const GreyImage& image, const Plane<float>& texture) {
  return ExtractionTruth(image, kDefaultRadius).texture_error(texture);
}

Case engine_extraction(int size_px, bool includes_maximum) {
  return timed(
      "touchtrial", [=] { return ExtractionState<>{timed_image(size_px)}; },
      [=](ExtractionState<>& work) {
        engine::extract_texture_into(work.image, {}, {}, work.result);
        const Plane<float>& heights = work.result.texture;
        if (includes_maximum) {
          work.max_height = engine::highest_of(
              {.geometry = {0.2, heights.height(), heights.width()}, .heights = heights.samples()});
        }
      },
      [](const ExtractionState<>& work) { return texture_error(work.image, work.result.texture); },
      kEngineTolerance_grey);
}

Case ring_sums(const std::string& name, int size_px, bool includes_maximum, RingSums mode) {
  using State = ExtractionState<OpenCvRingSums>;
  return timed(
      name,
      [=] {
        return State{timed_image(size_px), OpenCvRingSums(mode)};
      },
      [=](State& work) {
        work.peer.extract(mat_of(work.image), kDefaultRadius);
        if (includes_maximum) work.max_height = work.peer.max_texture();
      },
      [](const State& work) { return texture_error(work.image, plane_of(work.peer.texture())); },
      kPeerTolerance_grey);
}

struct Streams {
  GreyImage image;
  Plane<float> plane{image.height(), image.width()};
  float sum = 0.0F;
};

Cases bounds(int size_px) {
  const auto make_streams = [=] { return Streams{timed_image(size_px)}; };
  const auto write_case = [](WriteMode mode) {
    return [=](Streams& work) { stream(work.image.samples(), work.plane.samples(), mode); };
  };
  return {timed("arithmetic", make_streams,
                [](Streams& work) { work.sum += texture_arithmetic(work.plane.size()); }),
          timed("memory", make_streams, write_case(WriteMode::through_caches)),
          timed("memory, past caches", make_streams, write_case(WriteMode::past_caches))};
}

Row extraction_row(int size_px, bool includes_maximum, const Goal& goal) {
  const char* task = includes_maximum ? "texture and its highest point" : "adaptive texture";
  Row row{.title = fmt::format("{}, {} x {}", task, size_px, size_px),
          .ours = engine_extraction(size_px, includes_maximum),
          .peers = {ring_sums("OpenCV ring sums, u8", size_px, includes_maximum, RingSums::plain),
                    ring_sums("OpenCV ring sums, tuned, u8", size_px, includes_maximum,
                              RingSums::tuned)},
          .bounds = bounds(size_px),
          .goal = goal,
          .error_unit = kGrey};
  for (Case& peer : row.peers) peer.is_slow = size_px >= kLargeSize_px;
  return row;
}

}  // namespace

Rows extraction_rows(const Scope& scope) {
  Rows rows;
  for (const std::string& target : scope.simd_targets) {
    const std::string set = instruction_set_of(target);
    rows.push_back({.title = "adaptive 5 x 5 on u8, " + set,
                    .ours = adaptive_filter(kDefaultRadius, target),
                    .peers = {filter2d(kDefaultRadius)},
                    .error_unit = kGrey});
    if (set == "AVX-512") rows.back().goal = {"ratio", 0.5};
    if (set == "AVX2") rows.back().goal = {"ratio", 0.75};
  }
  rows.insert(rows.end(),
              {{.title = "adaptive 15 x 15",
                .ours = adaptive_filter(kWideRadius),
                .peers = {filter2d(kWideRadius)},
                .goal = {"ratio", 0.05},
                .error_unit = kGrey},
               {.title = "fixed 5 x 5 on u8",
                .ours = fixed_filter(),
                .peers = {filter2d(kDefaultRadius, "u8"), filter2d(kDefaultRadius, "f32", true)},
                .error_unit = kGrey},
               {.title = "DAUB4, four bands",
                .ours = engine_daub4(),
                .peers = {opencv_daub4("OpenCV sepFilter2D, u8", Daub4Mode::full_size),
                          opencv_daub4("OpenCV sepFilter2D by rows, u8", Daub4Mode::by_rows)},
                .goal = {"ratio", 0.08},
                .error_unit = kGrey},
               extraction_row(kDefaultSize_px, false, {"of bound", 1.6}),
               extraction_row(kDefaultSize_px, true, {"of bound", 2.0}),
               extraction_row(kLargeSize_px, false, {"of bound", 1.6}),
               extraction_row(kLargeSize_px, true, {"of bound", 2.0})});
  for (const int size_px : kFurtherSizes_px) rows.push_back(extraction_row(size_px, false, {}));
  return rows;
}

}  // namespace touchtrial::bench
