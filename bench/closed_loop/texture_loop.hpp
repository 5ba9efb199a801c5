/// \file A simulated hand that strokes a texture slowly through the servo: does it chatter?
/// Source: docs/benchmarks/closed-loop.md.
#pragma once

#include "core/plane.hpp"
#include "engine/rendering/rendering_options.hpp"

#include <cstdint>

namespace touchtrial::bench {

/// How a hand strokes.
struct TextureStroke {
  double push_n = 0.7;
  double speed_mm_s = 2.0;  ///< so slow that no detail of a texture passes 30 times a second
  double time_s = 6.0;      ///< the first second, of landing, is not looked at
  std::uint64_t seed = 1;
};

/// What the hand does that its stroke does not explain.
struct Chatter {
  double vibration_mm_s = 0.0;  ///< rms of the velocity above 30 Hz, all three directions
  double lost_contacts_per_s = 0.0;
  double normal_deviation_n = 0.0;  ///< largest difference of the normal force from the push
};

/// Runs the servo at 1 kHz in virtual time with the safety chain's defaults.
/// \param texture  T, as extracted; \param options  whose gains come from the stiffness budget
/// \throws std::invalid_argument as make_texture_field and choose_gains
/// \throws std::runtime_error if the run ended as a fault, which is named
[[nodiscard]] Chatter stroke_texture(const Plane<double>& texture,
                                     const engine::RenderingOptions& options,
                                     const TextureStroke& stroke = {});

}  // namespace touchtrial::bench
