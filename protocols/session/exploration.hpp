/// \file One exploration in virtual time: servo, force model, participant, trace.
#pragma once

#include "device/servo/servo.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "protocols/session/participant.hpp"
#include "protocols/store/trace.hpp"

#include <chrono>
#include <optional>

namespace touchtrial {

/// Height above the plane, mm, at which the stylus is taken to have landed. A height, because the
/// place and time at which a force begins tell of the texture, and first contacts are stored in
/// clear.
inline constexpr double kLandingHeightMm = 3.0;

/// What may be known of an exploration without knowing what was felt.
struct Exploration {
  ServoReport servo;
  std::optional<std::chrono::nanoseconds> landed_at;  ///< since plane-on
};

/// Puts a plane before a participant until the hand stops or time is up. The participant gets the
/// plane's extent and the samples, and nothing else.
/// \param trace  gets every sample; its memory is used again
[[nodiscard]] Exploration explore(const RenderingModel& model, const PlaneGeometry& plane,
                                  Participant& participant, const ServoOptions& options,
                                  Trace& trace);

}  // namespace touchtrial
