#include "engine/simd/targets.hpp"

#include "engine/every_simd_target.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <cstdint>
#include <set>

#include <hwy/targets.h>

namespace touchtrial {
namespace {

TEST_CASE("simd_targets names at least one target, and none twice") {
  const std::vector<std::string> targets = simd_targets();
  REQUIRE_FALSE(targets.empty());
  CHECK(std::set<std::string>(targets.begin(), targets.end()).size() == targets.size());
  CHECK(std::set<std::string>(targets.begin(), targets.end()).count("Unknown") == 0);
}

TEST_CASE("the kernels under test have the portable target besides those of this processor") {
  const std::vector<std::string> targets = simd_targets();
  const bool has_portable =
      std::any_of(targets.begin(), targets.end(),
                  [](const std::string& name) { return name == "SCALAR" || name == "EMU128"; });
  CHECK(has_portable);
  // Every processor that the program supports has SSE4 (x86-64-v2) or an equivalent.
  CHECK(targets.size() >= 2);
}

TEST_CASE("force_simd_target leaves one target to choose from, and afterwards all again") {
  const std::vector<std::string> targets = simd_targets();
  const std::int64_t all = hwy::SupportedTargets();
  for (const std::string& name : targets) {
    const ForcedSimdTarget forced(name);
    CHECK(hwy::TargetName(hwy::SupportedTargets()) == name);
    CHECK(simd_targets() == targets);
  }
  CHECK(hwy::SupportedTargets() == all);
}

TEST_CASE("force_simd_target refuses a name that the machine does not have") {
  CHECK_THAT(message_of<std::invalid_argument>([] { force_simd_target("AVX9"); }), names("AVX9"));
  CHECK_FALSE(message_of<std::invalid_argument>([] { force_simd_target(""); }).empty());
}

}  // namespace
}  // namespace touchtrial
