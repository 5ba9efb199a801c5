#include "protocols/session/trace_replay.hpp"

#include <utility>
#include <vector>

namespace touchtrial::session {

device::RecordedMotion motion_of(const store::Trace& trace) {
  std::vector<Vec3> positions_mm;
  positions_mm.reserve(trace.samples.size());
  for (const store::TraceSample& sample : trace.samples) positions_mm.push_back(sample.position_mm);
  return {std::move(positions_mm), trace.rate_hz};
}

}  // namespace touchtrial::session
