#include "device/servo/sample_ring.hpp"

#include "support/catch.hpp"

#include <array>
#include <atomic>
#include <stdexcept>
#include <thread>

namespace touchtrial {
namespace {

device::ServoSample sample_of(std::int64_t tick) {
  const auto x = static_cast<double>(tick);
  return {{x, 2.0 * x, 3.0 * x}, {-x, 0.0, 0.5 * x}, tick};
}

TEST_CASE("a ring gives samples back in their order, in batches") {
  device::SampleRing ring(8);
  for (int i = 0; i < 5; ++i) CHECK(ring.push(sample_of(i)));
  CHECK(ring.size() == 5);
  std::array<device::ServoSample, 3> read;
  CHECK(ring.pop(read) == 3);
  CHECK(read[2].position_mm == sample_of(2).position_mm);
  CHECK(read[2].force_n == sample_of(2).force_n);
  CHECK(ring.pop(read) == 2);
  CHECK(read[1].tick == 4);
  CHECK(ring.pop(read) == 0);
}

TEST_CASE("a ring holds its capacity and refuses more") {
  const std::size_t capacity = GENERATE(1U, 7U, 1000U);
  device::SampleRing ring(capacity);
  CHECK(ring.capacity() == capacity);
  for (std::size_t i = 0; i < capacity; ++i) REQUIRE(ring.push({}));
  CHECK_FALSE(ring.push({}));
  CHECK(ring.size() == capacity);
}

TEST_CASE("a ring without room for a sample is refused") {
  CHECK_THROWS_AS(device::SampleRing(0), std::invalid_argument);
}

TEST_CASE("a full ring loses the newest samples and counts each of them") {
  device::SampleRing ring(4);
  device::RingSink sink(ring);
  for (int i = 0; i < 7; ++i) sink.record(sample_of(i));
  CHECK(sink.dropped() == 3);
  std::array<device::ServoSample, 8> read;
  REQUIRE(ring.pop(read) == 4);
  CHECK(read[3].tick == 3);
}

TEST_CASE("between two threads a ring loses nothing, repeats nothing and keeps the order") {
  constexpr std::int64_t kSamples = 200'000;
  device::SampleRing ring(64);
  std::int64_t expected = 0;
  std::atomic<bool> wrong{false};
  std::thread reader([&] {
    std::array<device::ServoSample, 48> read;
    while (expected < kSamples) {
      const std::size_t got = ring.pop(read);
      for (std::size_t i = 0; i < got; ++i) {
        const device::ServoSample sample = sample_of(expected++);
        if (read[i].tick != sample.tick || read[i].force_n != sample.force_n) wrong = true;
      }
      if (got == 0) std::this_thread::yield();
    }
  });
  for (std::int64_t i = 0; i < kSamples; ++i) {
    while (!ring.push(sample_of(i))) std::this_thread::yield();
  }
  reader.join();
  CHECK_FALSE(wrong);
  CHECK(ring.size() == 0);
}

}  // namespace
}  // namespace touchtrial
