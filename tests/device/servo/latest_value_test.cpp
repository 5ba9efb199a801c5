#include "device/servo/latest_value.hpp"

#include "support/catch.hpp"

#include <cstdint>
#include <thread>

namespace touchtrial {
namespace {

/// All members are equal unless a copy is torn.
struct Pair {
  std::uint64_t a = 0;
  std::uint64_t b = 0;
  std::uint64_t c = 0;
};

TEST_CASE("a latest value starts as the first and stays until a newer one comes") {
  device::LatestValue<Pair> latest(Pair{7, 7, 7});
  CHECK(latest.get().a == 7);
  latest.set({1, 1, 1});
  latest.set({2, 2, 2});
  CHECK(latest.get().a == 2);
  CHECK(latest.get().a == 2);
}

TEST_CASE("a reader beside a writer sees whole values, never an older one") {
  device::LatestValue<Pair> latest;
  constexpr std::uint64_t kLast = 200'000;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) latest.set({i, i, i});
  });
  std::uint64_t seen = 0;
  bool whole = true;
  bool forward = true;
  while (seen < kLast && whole && forward) {
    const Pair value = latest.get();
    whole = value.a == value.b && value.b == value.c;
    forward = value.a >= seen;
    seen = value.a;
  }
  writer.join();
  CHECK(whole);
  CHECK(forward);
  CHECK(latest.get().a == kLast);
}

}  // namespace
}  // namespace touchtrial
