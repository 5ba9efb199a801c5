#include "engine/simd/targets.hpp"

#include "engine/every_simd_target.hpp"
#include "engine/refusal.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cstdint>
#include <set>

#include <hwy/targets.h>

namespace touchtrial {
namespace {

TEST_CASE("simd_targets names at least one target, and none twice") {
  const std::vector<std::string> names = simd_targets();
  REQUIRE_FALSE(names.empty());
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  CHECK(std::set<std::string>(names.begin(), names.end()).count("Unknown") == 0);
}

TEST_CASE("the kernels under test have the portable target besides those of this processor") {
  const std::vector<std::string> names = simd_targets();
  const bool has_portable = std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return name == "SCALAR" || name == "EMU128";
  });
  CHECK(has_portable);
  // Every processor that the program supports has SSE4 (x86-64-v2) or an equivalent.
  CHECK(names.size() >= 2);
}

TEST_CASE("force_simd_target leaves one target to choose from, and afterwards all again") {
  const std::vector<std::string> names = simd_targets();
  const std::int64_t all = hwy::SupportedTargets();
  for (const std::string& name : names) {
    const ForcedSimdTarget forced(name);
    CHECK(hwy::TargetName(hwy::SupportedTargets()) == name);
    CHECK(simd_targets() == names);
  }
  CHECK(hwy::SupportedTargets() == all);
}

TEST_CASE("force_simd_target refuses a name that the machine does not have") {
  CHECK(refusal_of([] { force_simd_target("AVX9"); }) == "force_simd_target: no target AVX9");
  CHECK_FALSE(refusal_of([] { force_simd_target(""); }).empty());
}

}  // namespace
}  // namespace touchtrial
