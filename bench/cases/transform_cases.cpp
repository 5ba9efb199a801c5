// DAUB4 sub-bands and Fourier transforms.
#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/peers/mat_view.hpp"
#include "bench/peers/opencv_extraction.hpp"
#include "engine/daub4.hpp"
#include "engine/fourier/real_fft.hpp"
#include "engine/kernels/float_extraction.hpp"
#include "tests/engine/plane_comparison.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

namespace touchtrial::bench {
namespace {

/// A sub-band reaches 510, where the last bit of a float is 3e-5.
constexpr double kBandTolerance = 3e-4;

Case daub4_case_of(const std::string& who, const std::string& input, int size_px) {
  return case_on_image("DAUB4", who, input, size_px, 0, {"grey levels", kBandTolerance});
}

/// The largest error of ll, lh, hl and hh.
double error_of_bands(const GreyImage& image, const std::array<const Plane<float>*, 4>& bands) {
  const engine::SubBands truth = engine::daub4_sub_bands(image);
  const std::array<const Plane<double>*, 4> truths = {&truth.ll, &truth.lh, &truth.hl, &truth.hh};
  double largest = 0.0;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    largest = std::max(largest, largest_difference(*bands[i], *truths[i]));
  }
  return largest;
}

struct OurBands {
  explicit OurBands(int size_px) : image(square_of(timed_picture(), size_px)) {}
  GreyImage image;
  engine::Extraction<float> result;
};

struct PeerBands {
  PeerBands(int size_px, const std::string& input, Daub4Way way)
      : image(square_of(timed_picture(), size_px)), daub4(way) {
    from = mat_of(image);
    if (input == "f32") mat_of(image).convertTo(from, CV_32F);
  }

  [[nodiscard]] double error() const {
    std::array<Plane<float>, 4> planes;
    std::array<const Plane<float>*, 4> bands{};
    for (std::size_t i = 0; i < planes.size(); ++i) {
      planes[i] = plane_of<float>(daub4.bands()[i]);
      bands[i] = &planes[i];
    }
    return error_of_bands(image, bands);
  }

  GreyImage image;
  cv::Mat from;
  OpenCvDaub4 daub4;
};

Case peer_case(Daub4Way way, const std::string& input, int size_px) {
  const std::string who =
      way == Daub4Way::by_rows ? "OpenCV sepFilter2D by rows" : "OpenCV sepFilter2D";
  Case one = daub4_case_of(who, input, size_px);
  one.make = [=] {
    const auto peer = std::make_shared<PeerBands>(size_px, input, way);
    return Job{[=] { peer->daub4.run(peer->from); }, [=] { return peer->error(); }};
  };
  return one;
}

constexpr double kFftTolerance = 1e-2;

/// A transform and its inverse are the identity; the deviation from it is the error.
Case fft_case_of(const std::string& who, const std::string& input, int size_px) {
  return case_on_image("FFT there and back", who, input, size_px, 0,
                       {"grey levels", kFftTolerance});
}

template <typename Real>
struct OurTransform {
  explicit OurTransform(int size_px)
      : samples(converted<Real>(square_of(timed_picture(), size_px))), fft(size_px, size_px) {}

  void run() {
    std::copy(samples.samples().begin(), samples.samples().end(), fft.plane().begin());
    fft.forward();
    fft.inverse();
  }

  [[nodiscard]] double error() {
    Plane<Real> back(samples.height(), samples.width());
    const Real scale = Real{1} / static_cast<Real>(samples.size());
    std::transform(fft.plane().begin(), fft.plane().end(), back.samples().begin(),
                   [=](Real sample) { return sample * scale; });
    return largest_difference(back, samples);
  }

  Plane<Real> samples;
  engine::RealFft<Real> fft;
};

template <typename Real>
Case fft_case(const std::string& input, int size_px) {
  Case one = fft_case_of(our_name(), input, size_px);
  one.make = [=] {
    const auto transform = std::make_shared<OurTransform<Real>>(size_px);
    return Job{[=] { transform->run(); }, [=] { return transform->error(); }};
  };
  return one;
}

struct PeerTransform {
  explicit PeerTransform(int size_px)
      : samples(converted<float>(square_of(timed_picture(), size_px))) {}
  Plane<float> samples;
  cv::Mat spectrum, back;
};

Case opencv_dft_case(int size_px) {
  Case one = fft_case_of("OpenCV dft", "f32", size_px);
  one.make = [=] {
    const auto peer = std::make_shared<PeerTransform>(size_px);
    return Job{[=] {
                 cv::dft(mat_of(peer->samples), peer->spectrum);
                 cv::dft(peer->spectrum, peer->back,
                         cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
               },
               [=] { return largest_difference(plane_of<float>(peer->back), peer->samples); }};
  };
  return one;
}

}  // namespace

Case daub4_case(int size_px) {
  Case one = daub4_case_of(our_name(), "u8", size_px);
  one.make = [=] {
    const auto ours = std::make_shared<OurBands>(size_px);
    return Job{[=] { engine::extract_sub_bands(ours->image, ours->result); },
               [=] {
                 const engine::Extraction<float>& result = ours->result;
                 return error_of_bands(ours->image, {&result.sub_band_ll, &result.sub_band_lh,
                                                     &result.sub_band_hl, &result.sub_band_hh});
               }};
  };
  return one;
}

Case opencv_daub4_case(int size_px, Daub4Way way) {
  return peer_case(way, "u8", size_px);
}

Cases daub4_cases(const Scope& scope) {
  Cases cases;
  for (const int size_px : scope.sizes_px) {
    cases.push_back(daub4_case(size_px));
    for (const Daub4Way way : {Daub4Way::full_size, Daub4Way::by_rows}) {
      cases.push_back(peer_case(way, "u8", size_px));
      cases.push_back(peer_case(way, "f32", size_px));
    }
  }
  return cases;
}

Cases fft_cases(const Scope& scope) {
  Cases cases;
  for (const int size_px : scope.sizes_px) {
    cases.push_back(fft_case<float>("f32", size_px));
    cases.push_back(fft_case<double>("f64", size_px));
    cases.push_back(opencv_dft_case(size_px));
  }
  return cases;
}

}  // namespace touchtrial::bench
