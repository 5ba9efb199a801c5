// The machine's own bounds, in the same run as the engine and its peers.
#include "bench/cases/cases.hpp"
#include "bench/inputs/pictures.hpp"
#include "bench/limits/limits.hpp"
#include "core/hash.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace touchtrial::bench {
namespace {

constexpr const char* kMachine = "this machine";

/// Inputs and outputs of a bound.
struct Streams {
  explicit Streams(int size_px)
      : image(square_of(timed_picture(), size_px)), plane(size_px, size_px) {}
  GreyImage image;
  Plane<float> plane;
  std::uint64_t sum = 0;
  float result = 0.0F;
};

/// \param work  called with the streams
template <typename Work>
Case limit_case(const char* what, int size_px, Work work) {
  Case one;
  one.work = what;
  one.who = kMachine;
  one.size_px = size_px;
  one.make = [=] {
    const auto streams = std::make_shared<Streams>(size_px);
    return Job{[=] { work(*streams); }, {}};
  };
  return one;
}

}  // namespace

Cases streaming_cases(int size_px) {
  return {limit_case("read picture, write plane", size_px,
                     [](Streams& streams) {
                       stream(streams.image.samples(), streams.plane.samples(),
                              Writing::through_caches);
                     }),
          limit_case("read picture, write plane past caches", size_px, [](Streams& streams) {
            stream(streams.image.samples(), streams.plane.samples(), Writing::past_caches);
          })};
}

Case arithmetic_case(int size_px) {
  return limit_case("sub-bands and two rings from registers", size_px, [](Streams& streams) {
    streams.result += texture_arithmetic(streams.plane.size());
  });
}

Case hash_case(int bytes) {
  Case one;
  one.work = "SHA-256, a byte";
  one.who = kMachine;
  one.make = [=] {
    const auto data = std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(bytes));
    return Job{[=] { (*data)[0] ^= sha256(*data)[0]; }, {}, bytes};
  };
  return one;
}

Cases limit_cases(const Scope& scope) {
  Cases cases;
  for (const int size_px : scope.sizes_px) {
    cases.push_back(limit_case("read picture", size_px, [](Streams& streams) {
      streams.sum += read_bytes(streams.image.samples());
    }));
    cases.push_back(limit_case("write plane", size_px, [](Streams& streams) {
      write_samples(streams.plane.samples(), Writing::through_caches);
    }));
    cases.push_back(limit_case("write plane past caches", size_px, [](Streams& streams) {
      write_samples(streams.plane.samples(), Writing::past_caches);
    }));
    for (Case& one : streaming_cases(size_px)) cases.push_back(std::move(one));
    cases.push_back(arithmetic_case(size_px));
  }
  cases.push_back(hash_case(1 << 20));
  return cases;
}

}  // namespace touchtrial::bench
