// Fractional filters, sub-bands and whole extractions, beside OpenCV and the machine's bounds.
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
constexpr double kOurTolerance_grey = 4e-5;
/// filter2D uses the Fourier transform for masks of 11 x 11 and more.
constexpr double kPeerTolerance_grey = 2e-3;
/// Sub-bands reach 510, where the last bit of a float is 3e-5.
constexpr double kBandTolerance_grey = 3e-4;
constexpr int kWideRadius = 7;
constexpr int kLargeSize_px = 4096;
constexpr int kOtherSizes_px[] = {64, 128, 256, 1024, 2048};

/// The timed picture with its orders by the adaptive method.
struct OrderedImage {
  GreyImage image = timed_image(kDefaultSize_px);
  Plane<float> orders = [this] {
    engine::WantedPlanes wanted;
    wanted.order = true;
    return engine::extract_texture<float>(image, {}, wanted).order;
  }();
  Plane<float> texture{kDefaultSize_px, kDefaultSize_px};

  [[nodiscard]] Plane<double> half_orders() const {
    Plane<double> half((orders.height() + 1) / 2, (orders.width() + 1) / 2);
    for (int y = 0; y < half.height(); ++y) {
      for (int x = 0; x < half.width(); ++x) half.at(y, x) = orders.at(2 * y, 2 * x);
    }
    return half;
  }

  /// The engine's adaptive filter alone.
  void filter(int radius) {
    constexpr std::size_t kReadPast = 2 * engine::kVectorBytes / sizeof(float);
    const auto width = static_cast<std::size_t>(image.width());
    engine::AlignedRows<float> last(1, width, kReadPast);
    engine::ExtendedRows rows(image, radius);
    for (int y = 0; y < image.height(); ++y) {
      const float* order = orders.row(y).data();
      if ((static_cast<std::size_t>(y) + 1) * width + kReadPast > orders.size()) {
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
  Case one = timed(
      "touchtrial", ordered_image, [=](OrderedImage& input) { input.filter(radius); },
      [=](const OrderedImage& input) {
        return largest_difference(
            input.texture, engine::gl_texture<double>(input.image, radius, input.half_orders()));
      },
      kOurTolerance_grey);
  one.simd_target = target;
  return one;
}

/// A picture, and a float plane by OpenCV or the engine.
struct FixedFilter {
  GreyImage image = timed_image(kDefaultSize_px);
  engine::Extraction<float> result{};
  cv::Mat mask{}, from{}, texture{};
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
      kOurTolerance_grey);
}

/// \param subtracts  whether the mask gives the enhanced image I + T, from which I is subtracted
Case filter2d(int radius, const std::string& input = "f32", bool subtracts = false) {
  return timed(
      "OpenCV filter2D, " + input + (subtracts ? ", I + T less I" : ""),
      [=] {
        FixedFilter filter{.mask = fixed_order_mask(kFixedOrder, radius, subtracts)};
        mat_of(filter.image).convertTo(filter.from, input == "f32" ? CV_32F : CV_8U);
        return filter;
      },
      [=](FixedFilter& filter) {
        cv::filter2D(filter.from, filter.texture, CV_32F, filter.mask, {-1, -1}, 0,
                     cv::BORDER_REFLECT);
        if (subtracts) cv::subtract(filter.texture, filter.from, filter.texture);
      },
      [=](const FixedFilter& filter) {
        return fixed_error(plane_of(filter.texture), filter.image, radius);
      },
      kPeerTolerance_grey);
}

/// The largest error of ll, lh, hl and hh.
double error_of_bands(const GreyImage& image, const std::array<Plane<float>, 4>& bands) {
  const engine::SubBands truth = engine::daub4_sub_bands(image);
  return std::max({largest_difference(bands[0], truth.ll), largest_difference(bands[1], truth.lh),
                   largest_difference(bands[2], truth.hl), largest_difference(bands[3], truth.hh)});
}

/// A picture with what is extracted from it, by the engine or by OpenCV.
template <class Peer = int>
struct Extracted {
  GreyImage image;
  Peer peer{};
  engine::Extraction<float> result{};
  double highest = 0.0;  ///< of the texture, for the models' forces
};

Case our_daub4() {
  return timed(
      "touchtrial", [] { return Extracted<>{timed_image(kDefaultSize_px)}; },
      [](Extracted<>& our) { engine::extract_sub_bands(our.image, our.result); },
      [](const Extracted<>& our) {
        return error_of_bands(our.image, {our.result.sub_band_ll, our.result.sub_band_lh,
                                          our.result.sub_band_hl, our.result.sub_band_hh});
      },
      kBandTolerance_grey);
}

Case opencv_daub4(const std::string& name, Daub4Way way) {
  using Peer = Extracted<OpenCvDaub4>;
  return timed(
      name,
      [=] {
        return Peer{timed_image(kDefaultSize_px), OpenCvDaub4(way)};
      },
      [](Peer& work) { work.peer.run(mat_of(work.image)); },
      [](const Peer& work) {
        const std::array<cv::Mat, 4>& bands = work.peer.bands();
        return error_of_bands(work.image, {plane_of(bands[0]), plane_of(bands[1]),
                                           plane_of(bands[2]), plane_of(bands[3])});
      },
      kBandTolerance_grey);
}

double texture_error(const GreyImage& image, const Plane<float>& texture) {
  return ExtractionTruth(image, kDefaultRadius).texture_error(texture);
}

Case our_extraction(int size_px, bool with_highest) {
  return timed(
      "touchtrial", [=] { return Extracted<>{timed_image(size_px)}; },
      [=](Extracted<>& our) {
        engine::extract_texture_into(our.image, {}, {}, our.result);
        const Plane<float>& heights = our.result.texture;
        if (with_highest) {
          our.highest = engine::highest_of(
              {.geometry = {0.2, heights.height(), heights.width()}, .heights = heights.samples()});
        }
      },
      [](const Extracted<>& our) { return texture_error(our.image, our.result.texture); },
      kOurTolerance_grey);
}

Case ring_sums(const std::string& name, int size_px, bool with_highest, RingSums how) {
  using Peer = Extracted<OpenCvRingSums>;
  return timed(
      name,
      [=] {
        return Peer{timed_image(size_px), OpenCvRingSums(how)};
      },
      [=](Peer& work) {
        work.peer.extract(mat_of(work.image), kDefaultRadius);
        if (with_highest) work.highest = work.peer.highest();
      },
      [](const Peer& work) { return texture_error(work.image, plane_of(work.peer.texture())); },
      kPeerTolerance_grey);
}

struct Streams {
  GreyImage image;
  Plane<float> plane{image.height(), image.width()};
  float kept = 0.0F;
};

Cases bounds(int size_px) {
  const auto streams = [=] { return Streams{timed_image(size_px)}; };
  const auto writing = [](Writing how) {
    return [=](Streams& work) { stream(work.image.samples(), work.plane.samples(), how); };
  };
  return {timed("arithmetic", streams,
                [](Streams& work) { work.kept += texture_arithmetic(work.plane.size()); }),
          timed("memory", streams, writing(Writing::through_caches)),
          timed("memory, past caches", streams, writing(Writing::past_caches))};
}

Row extraction_row(int size_px, bool with_highest, const Goal& goal) {
  const char* what = with_highest ? "texture and what forces need" : "adaptive texture";
  Row row{
      .what = fmt::format("{}, {} x {}", what, size_px, size_px),
      .ours = our_extraction(size_px, with_highest),
      .peers = {ring_sums("OpenCV ring sums, u8", size_px, with_highest, RingSums::plain),
                ring_sums("OpenCV ring sums, tuned, u8", size_px, with_highest, RingSums::tuned)},
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
    rows.push_back({.what = "adaptive 5 x 5 on u8, " + set,
                    .ours = adaptive_filter(kDefaultRadius, target),
                    .peers = {filter2d(kDefaultRadius)},
                    .error_unit = kGrey});
    if (set == "AVX-512") rows.back().goal = {"ratio", 0.5};
    if (set == "AVX2") rows.back().goal = {"ratio", 0.75};
  }
  rows.insert(rows.end(),
              {{.what = "adaptive 15 x 15",
                .ours = adaptive_filter(kWideRadius),
                .peers = {filter2d(kWideRadius)},
                .goal = {"ratio", 0.05},
                .error_unit = kGrey},
               {.what = "fixed 5 x 5 on u8",
                .ours = fixed_filter(),
                .peers = {filter2d(kDefaultRadius, "u8"), filter2d(kDefaultRadius, "f32", true)},
                .error_unit = kGrey},
               {.what = "DAUB4, four bands",
                .ours = our_daub4(),
                .peers = {opencv_daub4("OpenCV sepFilter2D, u8", Daub4Way::full_size),
                          opencv_daub4("OpenCV sepFilter2D by rows, u8", Daub4Way::by_rows)},
                .goal = {"ratio", 0.08},
                .error_unit = kGrey},
               extraction_row(kDefaultSize_px, false, {"of bound", 1.6}),
               extraction_row(kDefaultSize_px, true, {"of bound", 2.0}),
               extraction_row(kLargeSize_px, false, {"of bound", 1.6}),
               extraction_row(kLargeSize_px, true, {"of bound", 2.0})});
  for (const int size_px : kOtherSizes_px) rows.push_back(extraction_row(size_px, false, {}));
  return rows;
}

}  // namespace touchtrial::bench
