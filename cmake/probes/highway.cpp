// Links if forwarders.cpp has every function of Highway's library that its headers call.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cmake/probes/highway.cpp"
#include <hwy/aligned_allocator.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace probe {
namespace HWY_NAMESPACE {
void add(float* values) {
  const hwy::HWY_NAMESPACE::ScalableTag<float> lanes;
  hwy::HWY_NAMESPACE::Store(hwy::HWY_NAMESPACE::Add(hwy::HWY_NAMESPACE::Load(lanes, values),
                                                    hwy::HWY_NAMESPACE::Set(lanes, 1.0F)),
                            lanes, values);
}
}  // namespace HWY_NAMESPACE
}  // namespace probe
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace probe {
HWY_EXPORT(add);
}
int main() {
  const auto values = hwy::AllocateAligned<float>(64);
  HWY_DYNAMIC_DISPATCH(probe::add)(values.get());
}
#endif
