/// \file Measures chatter while a simulated hand strokes a texture through the servo, and forces at
/// touchdown. Source: docs/benchmarks/README.md.
#pragma once

#include "core/plane.hpp"
#include "engine/rendering/rendering_model.hpp"

#include <cstdint>

namespace touchtrial::bench {

/// The stroke of a hand.
struct TextureStroke {
  double push_n = 0.7;
  double speed_mm_s = 2.0;  ///< slow enough that no texture detail passes 30 times per second
  double time_s = 6.0;      ///< the first second, in which the hand lands, is not analysed
  std::uint64_t seed = 1;
};

/// Unwanted motion and force of the hand.
struct Chatter {
  double vibration_mm_s = 0.0;  ///< rms velocity above 30 Hz, in all three directions
  double lost_contacts_per_s = 0.0;
  double normal_deviation_n = 0.0;  ///< maximum difference between normal force and push
};

/// Runs the servo at 1 kHz in virtual time with the safety chain's defaults.
/// \param texture  T, as extracted
/// \param options  its stiffness budget determines the gains
/// \throws std::invalid_argument as make_texture_field and choose_gains
/// \throws std::runtime_error if the run ended with a fault; the message names it
[[nodiscard]] Chatter stroke_texture(const Plane<double>& texture,
                                     const engine::RenderingOptions& options,
                                     const TextureStroke& stroke = {});

/// The lateral force at touchdown of a moving hand, as sent to the device.
struct Touchdown {
  double step_n = 0.0;          ///< in the first tick of contact
  double largest_step_n = 0.0;  ///< from tick to tick, within 20 ms of the first contact
  double rms_n = 0.0;           ///< after the first second
};

/// Runs the servo as stroke_texture.
/// \param stroke  longer than 1 s
/// \throws std::runtime_error if the run ended with a fault; the message names it
[[nodiscard]] Touchdown touch_down(const engine::RenderingModel& model, const PlaneGeometry& plane,
                                   const TextureStroke& stroke);

}  // namespace touchtrial::bench
