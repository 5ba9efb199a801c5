// What a servo computes in every tick: a model's force, and the kinematics of a Falcon.
#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "core/random.hpp"
#include "device/falcon/falcon_kinematics.hpp"
#include "engine/extraction.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/texture_field.hpp"
#include "tests/device/falcon/falcon_inverse.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace touchtrial::bench {
namespace {

/// Places that are evaluated in one run.
constexpr int kPlaces = 10000;
/// The hand moves this far per tick, at a depth of 1 mm.
constexpr double kStep_mm = 0.1;
constexpr double kDepth_mm = 1.0;

struct Stroke {
  explicit Stroke(double side_mm) {
    RandomStream random(1, "benchmark stroke");
    double heading = 0.0;
    Vec3 place = {side_mm / 2, side_mm / 2, -kDepth_mm};
    for (int i = 0; i < kPlaces; ++i) {
      heading += 0.2 * random.normal();
      place.x = std::abs(place.x + kStep_mm * std::cos(heading));
      place.y = std::abs(place.y + kStep_mm * std::sin(heading));
      places_mm.push_back({std::fmod(place.x, side_mm), std::fmod(place.y, side_mm), place.z});
    }
  }
  std::vector<Vec3> places_mm;
};

engine::TextureField field_of(const GreyImage& image, const engine::RenderingOptions& options) {
  return engine::make_texture_field(engine::extract_texture<double>(image, {}).texture, options);
}

engine::RenderingOptions options_of(engine::ModelKind model) {
  engine::RenderingOptions options;
  options.model = model;
  return options;
}

struct ModelStroke {
  explicit ModelStroke(engine::ModelKind kind)
      : options(options_of(kind)),
        image(square_of(timed_picture(), kUsualSize_px)),
        field(field_of(image, options)),
        model(field.view(), options,
              engine::choose_gains(std::array{field.view()}, options).of_field[0]),
        stroke(kUsualSize_px * options.pitch_mm) {}

  void run() {
    for (const Vec3& place_mm : stroke.places_mm) {
      const Vec3 force_n = model.force_n(place_mm, {}, touch);
      sum_n.x += force_n.x;
      sum_n.y += force_n.y;
      sum_n.z += force_n.z;
    }
  }

  engine::RenderingOptions options;
  GreyImage image;
  engine::TextureField field;
  engine::RenderingModel model;
  engine::Bristle touch;
  Stroke stroke;
  Vec3 sum_n;  ///< keeps the compiler from removing evaluations
};

Case force_case(engine::ModelKind model, const char* name) {
  Case one;
  one.work = "force evaluation";
  one.who = our_name() + ", " + name;
  one.make = [model] {
    const auto stroke = std::make_shared<ModelStroke>(model);
    return Job{[=] { stroke->run(); }, {}, kPlaces};
  };
  return one;
}

/// Readings in one run, 1 ms apart, of a hand that moves at about 100 mm/s.
constexpr int kReadings = 10000;
constexpr double kStepMm = 0.1;
/// The hand turns back before the edge of the workspace.
constexpr double kTurnBackMm = 30.0;
constexpr Vec3 kForceN = {0.3, -0.2, 0.6};

std::vector<device::falcon::PerLeg> readings_of_a_stroke() {
  RandomStream random(1, "benchmark falcon");
  std::vector<device::falcon::PerLeg> readings;
  Vec3 place_mm;
  Vec3 heading = {1.0, 0.0, 0.0};
  while (readings.size() < kReadings) {
    heading = heading + 0.2 * Vec3{random.normal(), random.normal(), random.normal()};
    if (norm(place_mm) > kTurnBackMm) heading = -1.0 * place_mm;
    heading = (1.0 / norm(heading)) * heading;
    place_mm = place_mm + kStepMm * heading;
    const auto legs =
        device::falcon::inverse_kinematics(device::falcon::to_native_m(place_mm)).value();
    readings.push_back({legs[0].theta1_rad, legs[1].theta1_rad, legs[2].theta1_rad});
  }
  return readings;
}

struct FalconStroke {
  void run() {
    for (const device::falcon::PerLeg& reading : readings) {
      const device::falcon::Pose pose = device::falcon::forward_kinematics(reading);
      sum_nm += device::falcon::torques_nm(pose.jacobian, kForceN).value()[0];
    }
  }

  std::vector<device::falcon::PerLeg> readings = readings_of_a_stroke();
  double sum_nm = 0.0;  ///< keeps the compiler from removing poses
};

Case falcon_case() {
  Case one;
  one.work = "Falcon, angles to pose to torques";
  one.who = our_name();
  one.make = [] {
    const auto stroke = std::make_shared<FalconStroke>();
    return Job{[=] { stroke->run(); }, {}, kReadings};
  };
  return one;
}

}  // namespace

Case paper_force_case() {
  return force_case(engine::ModelKind::paper, "paper");
}

Case surface_force_case() {
  return force_case(engine::ModelKind::surface, "surface");
}

Cases force_cases() {
  return {paper_force_case(), surface_force_case()};
}

Cases falcon_cases() {
  return {falcon_case()};
}

}  // namespace touchtrial::bench
