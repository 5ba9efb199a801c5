#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/peers/gl_filters.hpp"
#include "bench/peers/mat_view.hpp"
#include "engine/extraction.hpp"
#include "engine/gl_texture.hpp"
#include "tests/engine/plane_comparison.hpp"

#include <memory>

#include <opencv2/imgproc.hpp>

namespace touchtrial::bench {
namespace {

/// The naive mask takes 40 ms for the usual picture; larger ones would show nothing new.
constexpr int kLargestNaive_px = 500;
constexpr int kLargestNaiveRadius = 3;
/// Grey levels; filter2D uses the Fourier transform for masks of 11 x 11 and more.
constexpr double kOurTolerance = 4e-5;
constexpr double kPeerTolerance = 2e-3;

/// An image with its orders by the adaptive method.
struct OrderedImage {
  explicit OrderedImage(int size_px) : image(square_of(timed_picture(), size_px)) {
    engine::WantedPlanes wanted;
    wanted.order = true;
    orders = engine::extract_texture<float>(image, {}, wanted).order;
  }

  [[nodiscard]] Plane<double> half_orders() const {
    Plane<double> half((orders.height() + 1) / 2, (orders.width() + 1) / 2);
    for (int y = 0; y < half.height(); ++y) {
      for (int x = 0; x < half.width(); ++x) half.at(y, x) = orders.at(2 * y, 2 * x);
    }
    return half;
  }

  GreyImage image;
  Plane<float> orders;
};

Case gl_case(const std::string& work, const std::string& who, const std::string& input, int size_px,
             int radius) {
  return case_on_image(work, who, input, size_px, radius, {"grey levels", kPeerTolerance});
}

Case our_case(const std::string& work, int size_px, int radius, const std::string& target) {
  Case one = gl_case(work, our_name(target), "u8", size_px, radius);
  one.target = target;
  one.accuracy.tolerance = kOurTolerance;
  return one;
}

/// The filter alone, with an order for each pixel.
struct AdaptiveFilter {
  explicit AdaptiveFilter(int size_px) : input(size_px) {}
  OrderedImage input;
  Plane<float> texture;
};

Job adaptive_job(int size_px, int radius) {
  const auto filter = std::make_shared<AdaptiveFilter>(size_px);
  return {
      [=] { filter_adaptive(filter->input.image, radius, filter->input.orders, filter->texture); },
      [=] {
        const auto truth =
            engine::gl_texture<double>(filter->input.image, radius, filter->input.half_orders());
        return largest_difference(filter->texture, truth);
      }};
}

struct FixedFilter {
  explicit FixedFilter(int size_px) : image(square_of(timed_picture(), size_px)) {}
  GreyImage image;
  engine::Extraction<float> result;
};

Case fixed_filter_case(int size_px, int radius) {
  Case one = our_case("G-L fixed", size_px, radius, {});
  one.make = [=] {
    const auto filter = std::make_shared<FixedFilter>(size_px);
    engine::ExtractionOptions options;
    options.method = engine::Method::fixed;
    options.radius = radius;
    options.order = kFixedOrder;
    return Job{[=] { engine::extract_texture_into(filter->image, options, {}, filter->result); },
               [=] {
                 return largest_difference(
                     filter->result.texture,
                     engine::gl_texture<double>(filter->image, radius, kFixedOrder));
               }};
  };
  return one;
}

struct Filter2d {
  Filter2d(int size_px, int radius, MaskGives gives)
      : image(square_of(timed_picture(), size_px)),
        mask(fixed_order_mask(kFixedOrder, radius, gives)) {
    mat_of(image).convertTo(floats, CV_32F);
  }

  [[nodiscard]] double error(int radius) const {
    return largest_difference(plane_of<float>(texture),
                              engine::gl_texture<double>(image, radius, kFixedOrder));
  }

  GreyImage image;
  cv::Mat mask, floats, texture;
};

Job filter2d_job(int size_px, int radius, const std::string& input) {
  const auto filter = std::make_shared<Filter2d>(size_px, radius, MaskGives::texture);
  const cv::Mat from = input == "u8" ? mat_of(filter->image) : filter->floats;
  return {
      [=] {
        cv::filter2D(from, filter->texture, CV_32F, filter->mask, {-1, -1}, 0, cv::BORDER_REFLECT);
      },
      [=] { return filter->error(radius); }};
}

/// Computes the enhanced image and subtracts the image: twice the rounding error.
Case enhanced_first_case(int size_px, int radius) {
  Case one = gl_case("G-L fixed", "OpenCV filter2D, I + T less I", "f32", size_px, radius);
  one.make = [=] {
    const auto filter = std::make_shared<Filter2d>(size_px, radius, MaskGives::enhanced);
    return Job{[=] {
                 cv::filter2D(filter->floats, filter->texture, CV_32F, filter->mask, {-1, -1}, 0,
                              cv::BORDER_REFLECT);
                 cv::subtract(filter->texture, filter->floats, filter->texture);
               },
               [=] { return filter->error(radius); }};
  };
  return one;
}

template <typename Real>
struct Naive {
  explicit Naive(int size_px)
      : input(size_px), orders(converted<double>(input.orders)), texture(size_px, size_px) {}
  OrderedImage input;
  Plane<double> orders;
  Plane<Real> texture;
};

template <typename Real>
Case naive_case(const std::string& who, int size_px, int radius) {
  Case one = gl_case("G-L adaptive", who, "u8", size_px, radius);
  one.make = [=] {
    const auto naive = std::make_shared<Naive<Real>>(size_px);
    return Job{
        [=] { naive_mask_texture(naive->input.image, naive->orders, radius, naive->texture); },
        [=] {
          Plane<long double> truth(size_px, size_px);
          naive_mask_texture(naive->input.image, naive->orders, radius, truth);
          return largest_difference(naive->texture, truth);
        }};
  };
  return one;
}

/// The engine in double.
Case double_case(int size_px, int radius) {
  Case one = gl_case("G-L adaptive", our_name() + ", double", "u8", size_px, radius);
  one.make = [=] {
    const auto naive = std::make_shared<Naive<double>>(size_px);
    const auto half = std::make_shared<Plane<double>>(naive->input.half_orders());
    return Job{
        [=] { naive->texture = engine::gl_texture<double>(naive->input.image, radius, *half); },
        [=] {
          Plane<long double> truth(size_px, size_px);
          naive_mask_texture(naive->input.image, naive->orders, radius, truth);
          return largest_difference(naive->texture, truth);
        }};
  };
  return one;
}

void add_slow_cases(int size_px, int radius, Cases& cases) {
  if (size_px > kLargestNaive_px || radius > kLargestNaiveRadius) return;
  cases.push_back(naive_case<float>("naive mask, float", size_px, radius));
  cases.push_back(naive_case<double>("naive mask, double", size_px, radius));
  cases.push_back(double_case(size_px, radius));
}

}  // namespace

Case adaptive_filter_case(int size_px, int radius, const std::string& target) {
  Case one = our_case("G-L adaptive", size_px, radius, target);
  one.make = [=] { return adaptive_job(size_px, radius); };
  return one;
}

Case filter2d_case(int size_px, int radius, const std::string& input) {
  Case one = gl_case("G-L fixed", "OpenCV filter2D", input, size_px, radius);
  one.make = [=] { return filter2d_job(size_px, radius, input); };
  return one;
}

Cases gl_cases(const Scope& scope) {
  Cases cases;
  for (const int size_px : scope.sizes_px) {
    for (const int radius : scope.radii) {
      for (const std::string& target : scope.targets) {
        cases.push_back(adaptive_filter_case(size_px, radius, target));
      }
      cases.push_back(fixed_filter_case(size_px, radius));
      cases.push_back(filter2d_case(size_px, radius, "f32"));
      cases.push_back(filter2d_case(size_px, radius, "u8"));
      if (radius == kUsualRadius) cases.push_back(enhanced_first_case(size_px, radius));
      add_slow_cases(size_px, radius, cases);
    }
  }
  return cases;
}

}  // namespace touchtrial::bench
