/// \file How a simulated participant puts a hand on a plane.
#pragma once

#include "core/random.hpp"
#include "device/simulated/simulated_hand.hpp"
#include "protocols/session/subject_model.hpp"

namespace touchtrial::session {

/// A hand over the plane, with a path and a starting height drawn anew.
[[nodiscard]] device::SimulatedHand make_exploring_hand(const SubjectModel& subject,
                                                        const PlaneGeometry& plane,
                                                        RandomStream& random);

}  // namespace touchtrial::session
