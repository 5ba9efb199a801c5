#include "device/servo/realtime_region.hpp"

namespace touchtrial::device {
namespace {

// Of a plain type, so that reading it for the first time on a thread constructs nothing.
thread_local int regions = 0;

}  // namespace

RealtimeRegion::RealtimeRegion() noexcept {
  ++regions;
}

RealtimeRegion::~RealtimeRegion() {
  --regions;
}

bool RealtimeRegion::entered() noexcept {
  return regions > 0;
}

}  // namespace touchtrial::device
