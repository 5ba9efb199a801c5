/// \file One exploration by a simulated hand, felt and forgotten: no session, no trace.
#pragma once

#include "core/plane_geometry.hpp"
#include "core/random.hpp"
#include "device/servo/servo.hpp"
#include "engine/perception/felt_features.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "protocols/session/subject_model.hpp"

namespace touchtrial::session {

/// Puts a subject's hand on a plane, through device, servo and safety chain in virtual time, and
/// senses what the servo did. A function of its arguments; thread-safe. Virtual time and the
/// simulated hand have no faults; a force that is not finite ends the exploration, and what was
/// felt until then is what is felt. Cost: some 0.15 us a tick.
/// \param plane  what is told to be explored: StimulusSource::plane
/// \param random  path and starting height
/// \return before any noise, natural logarithms of newtons
[[nodiscard]] engine::FeltFeatures feel_exploration(const engine::RenderingModel& model,
                                                    const PlaneGeometry& plane,
                                                    const SubjectModel& subject,
                                                    const device::ServoOptions& options,
                                                    RandomStream random);

}  // namespace touchtrial::session
