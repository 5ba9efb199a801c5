/// \file Runs a check on every instruction set that the machine has.
#pragma once

#include "engine/simd/targets.hpp"
#include "support/catch.hpp"

#include <optional>
#include <string>

namespace touchtrial {

/// Forces a target during its lifetime.
class ForcedSimdTarget {
 public:
  explicit ForcedSimdTarget(const std::string& name) { force_simd_target(name); }
  ~ForcedSimdTarget() { force_simd_target(std::nullopt); }
  ForcedSimdTarget(const ForcedSimdTarget&) = delete;
  ForcedSimdTarget& operator=(const ForcedSimdTarget&) = delete;
};

template <typename Check>
void on_every_simd_target(const Check& check) {
  for (const std::string& name : simd_targets()) {
    const ForcedSimdTarget forced(name);
    INFO("target " << name);
    check();
  }
}

}  // namespace touchtrial
