#include "bench/measure/simd_target.hpp"

#include "tests/engine/simd/targets.hpp"

#include <optional>

namespace touchtrial::bench {
namespace {

std::optional<std::string>& usual_target() {
  static std::optional<std::string> name;
  return name;
}

}  // namespace

void choose_usual_target(const std::string& name) {
  if (!name.empty()) usual_target() = name;
  force_simd_target(usual_target());
}

ForcedTarget::ForcedTarget(const std::string& name) : forced_(!name.empty()) {
  if (forced_) force_simd_target(name);
}

ForcedTarget::~ForcedTarget() {
  if (forced_) force_simd_target(usual_target());
}

}  // namespace touchtrial::bench
