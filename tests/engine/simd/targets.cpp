#include "engine/simd/targets.hpp"

#include <cstdint>
#include <stdexcept>

#include <hwy/highway.h>

namespace touchtrial {
namespace {

/// The targets that this processor can run, determined before one is forced.
const std::vector<std::int64_t>& runnable() {
  static const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  return targets;
}

}  // namespace

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const std::int64_t target : runnable()) names.emplace_back(hwy::TargetName(target));
  return names;
}

void force_simd_target(const std::optional<std::string>& name) {
  std::int64_t forced = name ? 0 : -1;
  for (const std::int64_t target : runnable()) {
    if (name == hwy::TargetName(target)) forced = target;
  }
  if (forced == 0) throw std::invalid_argument("force_simd_target: no target " + *name);
  hwy::SetSupportedTargetsForTest(name ? forced : 0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace touchtrial
