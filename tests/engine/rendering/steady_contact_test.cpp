/// \file The law that decides whether a rendering model can be used at all: a hand that rests on a
/// flat texture feels a steady force.
#include "engine/rendering/rendering_model.hpp"
#include "engine/rendering/sample_fields.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial {
namespace {

/// A point mass on a spring and a damper, as a hand that holds a stylus and strokes along x.
struct Hand {
  double mass_kg = 0.15;
  double arm_n_per_mm = 0.05;
  double damping_n_s_per_mm = 0.004;
  double target_mm = 0.0;  ///< where the arm's spring pulls to
  Vec3 position_mm{20.0, 50.0, 2.0};
  Vec3 velocity_mm_s{60.0, 0.0, 0.0};

  /// Pushes with `push_n` once it rests on a wall of the given stiffness.
  void push(double push_n, double wall_n_per_mm) {
    target_mm = -push_n / wall_n_per_mm - push_n / arm_n_per_mm;
  }

  /// A step of semi-implicit Euler at a servo's 1 kHz.
  void step(double wall_n) {
    constexpr double kStepS = 1e-3;
    const double arm_n = arm_n_per_mm * (target_mm - position_mm.z);
    const double drag_n = damping_n_s_per_mm * velocity_mm_s.z;
    velocity_mm_s.z += kStepS * 1000.0 * (wall_n + arm_n - drag_n) / mass_kg;
    position_mm = position_mm + kStepS * velocity_mm_s;
  }
};

struct Contact {
  double worst_deviation_n = 0.0;
  bool kept = true;
  int landings = 0;
};

/// Lands, and observes the force for a second, from 0.5 s after first contact.
Contact land(const engine::RenderingModel& model, double push_n, double stiffness_n_per_mm) {
  Hand hand;
  hand.push(push_n, stiffness_n_per_mm);
  Contact contact;
  engine::Bristle bristle;
  bool touching = false;
  int since_landing = -1;
  while (since_landing < 1500) {
    const double force_n = model.force_n(hand.position_mm, hand.velocity_mm_s, bristle).z;
    if (force_n > 0.0 && !touching) ++contact.landings;
    touching = force_n > 0.0;
    if (contact.landings > 0) ++since_landing;
    if (since_landing >= 500) {
      contact.kept = contact.kept && touching;
      contact.worst_deviation_n = std::max(contact.worst_deviation_n, std::abs(force_n - push_n));
    }
    hand.step(force_n);
  }
  return contact;
}

TEST_CASE("a hand that pushes on a flat texture keeps contact with a steady force") {
  const double push_n = GENERATE(0.3, 0.7, 2.0);
  engine::RenderingOptions options;
  options.model = GENERATE(engine::ModelKind::paper, engine::ModelKind::surface);
  options.friction = options.model == engine::ModelKind::surface ? GENERATE(0.0, 0.3) : 0.0;
  const engine::TextureField field = engine::make_texture_field(Plane<double>(500, 1000), options);
  const engine::RenderingModel model(field.view(), options, {0.012, 0.01, 0.01});
  const Contact contact = land(model, push_n, options.stiffness_n_per_mm);
  CAPTURE(push_n, contact.worst_deviation_n);
  CHECK(contact.kept);
  CHECK(contact.worst_deviation_n < 0.02);
}

TEST_CASE("the same hand bounces on the literal reading, which is why it is not the default") {
  const engine::TextureField field = flat_field(500, 1000);
  engine::RenderingOptions options{.reference_grey = 0.0};
  const engine::RenderingModel model(field.view(), options, {0.012, 0.01});
  const Contact contact = land(model, 1.0, options.stiffness_n_per_mm);
  CHECK_FALSE(contact.kept);
  CHECK(contact.landings > 20);
  CHECK(contact.worst_deviation_n > 0.2);
}

}  // namespace
}  // namespace touchtrial
