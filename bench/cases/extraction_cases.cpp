#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/inputs/truth.hpp"
#include "bench/peers/mat_view.hpp"
#include "bench/peers/opencv_extraction.hpp"
#include "engine/rendering/texture_field.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace touchtrial::bench {
namespace {

constexpr double kOurExtractionTolerance = 4e-5;
constexpr double kPeerExtractionTolerance = 2e-3;
/// Larger images get no error: they compute the same rows, and double would need gigabytes.
constexpr int kLargestWithError_px = 4096;

std::string work_of(Extras extras) {
  switch (extras) {
    case Extras::picture:
      return "extraction, picture";
    case Extras::heights:
      return "extraction, heights";
    case Extras::force:
      return "extraction, force";
    case Extras::none:
      break;
  }
  return "extraction";
}

Case extraction_case_of(Extras extras, const std::string& who, int size_px, int radius,
                        double tolerance) {
  // Force is a sum of six differences of textures.
  const double share = extras == Extras::force ? 10.0 : 1.0;
  return case_on_image(work_of(extras), who, "u8", size_px, radius,
                       {"grey levels", share * tolerance});
}

struct OurExtraction {
  OurExtraction(int size_px, int radius, Extras extras)
      : image(square_of(timed_picture(), size_px)) {
    options.radius = radius;
    wanted.picture = extras == Extras::picture;
    wanted.force = extras == Extras::force;
  }

  [[nodiscard]] double error(Extras extras) const {
    const ExtractionTruth& truth = remembered_truth(image, options.radius, extras == Extras::force);
    double error = truth.texture_error(result.texture);
    if (extras == Extras::force) {
      error = std::max(error, truth.force_error(result.force.x, result.force.y));
    }
    return error;
  }

  void find_highest() {
    const Plane<float>& heights = result.texture;
    highest = engine::highest_of(
        {.geometry = {0.2, heights.height(), heights.width()}, .heights = heights.samples()});
  }

  GreyImage image;
  engine::ExtractionOptions options;
  engine::WantedPlanes wanted;
  engine::Extraction<float> result;
  double highest = 0.0;
};

struct PeerExtraction {
  PeerExtraction(int size_px, RingSums how)
      : image(square_of(timed_picture(), size_px)), pipeline(how) {}

  void run(int radius, Extras extras) {
    pipeline.extract(mat_of(image), radius);
    if (extras == Extras::picture) pipeline.make_picture();
    if (extras == Extras::heights) pipeline.find_highest();
    if (extras == Extras::force) pipeline.make_force();
  }

  [[nodiscard]] double error(int radius, Extras extras) const {
    const ExtractionTruth& truth = remembered_truth(image, radius, extras == Extras::force);
    double error = truth.texture_error(plane_of<float>(pipeline.texture()));
    if (extras == Extras::force) {
      error = std::max(error, truth.force_error(plane_of<float>(pipeline.force_x()),
                                                plane_of<float>(pipeline.force_y())));
    }
    return error;
  }

  GreyImage image;
  OpenCvRingSums pipeline;
};

template <class ErrorOf>
std::function<double()> error_up_to(int size_px, ErrorOf error_of) {
  if (size_px > kLargestWithError_px) return {};
  return error_of;
}

void add_all(int size_px, int radius, Extras extras, Cases& cases) {
  cases.push_back(extraction_case(size_px, radius, extras));
  for (const RingSums how : {RingSums::plain, RingSums::tuned}) {
    cases.push_back(ring_sums_case(size_px, radius, extras, how));
  }
}

}  // namespace

Case extraction_case(int size_px, int radius, Extras extras) {
  Case one = extraction_case_of(extras, our_name(), size_px, radius, kOurExtractionTolerance);
  one.make = [=] {
    const auto ours = std::make_shared<OurExtraction>(size_px, radius, extras);
    return Job{[=] {
                 engine::extract_texture_into(ours->image, ours->options, ours->wanted,
                                              ours->result);
                 if (extras == Extras::heights) ours->find_highest();
               },
               error_up_to(size_px, [=] { return ours->error(extras); })};
  };
  return one;
}

Case ring_sums_case(int size_px, int radius, Extras extras, RingSums how) {
  const std::string who = how == RingSums::tuned ? "OpenCV ring sums, tuned" : "OpenCV ring sums";
  Case one = extraction_case_of(extras, who, size_px, radius, kPeerExtractionTolerance);
  one.make = [=] {
    const auto peer = std::make_shared<PeerExtraction>(size_px, how);
    return Job{[=] { peer->run(radius, extras); },
               error_up_to(size_px, [=] { return peer->error(radius, extras); })};
  };
  return one;
}

Cases extraction_cases(const Scope& scope) {
  Cases cases;
  for (const int size_px : scope.sizes_px) {
    for (const int radius : scope.radii) add_all(size_px, radius, Extras::none, cases);
    add_all(size_px, kUsualRadius, Extras::picture, cases);
    add_all(size_px, kUsualRadius, Extras::heights, cases);
    add_all(size_px, kUsualRadius, Extras::force, cases);
  }
  for (const int size_px : scope.more_sizes_px) {
    add_all(size_px, kUsualRadius, Extras::none, cases);
    add_all(size_px, kUsualRadius, Extras::force, cases);
  }
  return cases;
}

}  // namespace touchtrial::bench
