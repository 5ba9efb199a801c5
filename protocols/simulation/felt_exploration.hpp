/// \file A simulated hand that explores a plane, and what it feels: no session, no trace.
#pragma once

#include "core/plane_geometry.hpp"
#include "core/random.hpp"
#include "device/servo/servo.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "engine/perception/felt_features.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "protocols/simulation/subject_model.hpp"

namespace touchtrial::simulation {

/// A hand above the plane. Draws its path and its starting height.
[[nodiscard]] device::SimulatedHand make_exploring_hand(const SubjectModel& subject,
                                                        const PlaneGeometry& plane,
                                                        RandomStream& random);

/// Puts a subject's hand on a plane, through device, servo and safety chain in virtual time, and
/// senses what the servo did. A function of its arguments; thread-safe. Virtual time and the
/// simulated hand have no faults. A force that is not finite ends the exploration; the features
/// are then those of the ticks before it. Cost: about 0.15 us a tick.
/// \param plane  extent of the explored part: session::StimulusSource::plane
/// \param random  for the path and the starting height
/// \return the features without noise, natural logarithms of newtons
[[nodiscard]] engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                                    const PlaneGeometry& plane,
                                                    const SubjectModel& subject,
                                                    const device::ServoOptions& options,
                                                    RandomStream random);

}  // namespace touchtrial::simulation
