#include "bench/cases/cases.hpp"
#include "bench/inputs/difference.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/peers/mat_view.hpp"
#include "engine/fourier/real_fft.hpp"

#include <algorithm>
#include <memory>

namespace touchtrial::bench {
namespace {

constexpr double kTolerance = 1e-2;

/// There and back is the identity: what is lost is the error.
Case fft_case_of(const std::string& who, const std::string& input, int size_px) {
  return case_on_image("FFT there and back", who, input, size_px, 0, {"grey levels", kTolerance});
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
