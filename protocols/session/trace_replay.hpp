/// \file A stored trial as motion that a ReplayDevice repeats.
#pragma once

#include "device/replay/motion.hpp"
#include "protocols/store/trace.hpp"

namespace touchtrial::session {

/// The positions of a trace. Under the same model and servo options they call forth the trace's
/// forces again, to within its quantisation, as long as the model does not look at velocities
/// (those of a replay are differences of positions).
/// \throws std::invalid_argument if the trace has no samples
[[nodiscard]] device::RecordedMotion motion_of(const store::Trace& trace);

}  // namespace touchtrial::session
