#include "record/trace.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

using namespace touchtrial;
using namespace touchtrial::record;

namespace {

constexpr double kHalfPositionStepMm = 0.0005;
constexpr double kHalfForceStepN = 0.5 / 4096.0;

double largest(Vec3 v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

void require_close(const Trace& a, const Trace& b) {
  REQUIRE(a.rate_hz == b.rate_hz);
  REQUIRE(a.samples.size() == b.samples.size());
  double position_mm = 0.0;
  double force_n = 0.0;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    position_mm =
        std::max(position_mm, largest(a.samples[i].position_mm - b.samples[i].position_mm));
    force_n = std::max(force_n, largest(a.samples[i].force_n - b.samples[i].force_n));
  }
  REQUIRE(position_mm <= kHalfPositionStepMm * (1.0 + 1e-9));
  REQUIRE(force_n <= kHalfForceStepN * (1.0 + 1e-9));
}

std::size_t sealed_size(const Trace& trace) {
  return seal(SecretKey{}, "trace|1|1", encode_trace(trace), trace_padding(trace.samples.size()))
      .size();
}

}  // namespace

TEST_CASE("a trace reads back within half a step of position and force") {
  for (const std::size_t count : {0, 1, 2, 3, 7, 1000, 10'000}) {
    const Trace trace = fixture::stroking(count, 0.05, count);
    require_close(decode_trace(encode_trace(trace)), trace);
  }
}

TEST_CASE("a trace that was read back is encoded to the same bytes") {
  const Bytes bytes = encode_trace(fixture::stroking(2500, 0.2));
  REQUIRE(encode_trace(decode_trace(bytes)) == bytes);
}

TEST_CASE("a trace may jump between the ends of its range") {
  Trace trace;
  trace.rate_hz = 4000.0;
  for (int i = 0; i < 50; ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    trace.samples.push_back(
        {.position_mm = sign * Vec3{1e4, -1e4, 1e4}, .force_n = sign * Vec3{100, -100, 100}});
  }
  require_close(decode_trace(encode_trace(trace)), trace);
}

TEST_CASE("samples that are not finite or out of range are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinite, -infinite, 10'001.0, -10'001.0}) {
    Trace trace = fixture::stroking(5, 0.0);
    trace.samples[3].position_mm.y = bad;
    REQUIRE_THROWS_AS(encode_trace(trace), StoreError);
  }
  for (const double bad : {nan, -infinite, 100.1}) {
    Trace trace = fixture::stroking(5, 0.0);
    trace.samples[4].force_n.z = bad;
    REQUIRE_THROWS_AS(encode_trace(trace), StoreError);
  }
  for (const double bad : {nan, infinite, 0.0, -1.0}) {
    Trace trace;
    trace.rate_hz = bad;
    REQUIRE_THROWS_AS(encode_trace(trace), StoreError);
  }
}

TEST_CASE("ten seconds at 1 kHz are sealed in less than 100,000 bytes") {
  REQUIRE(sealed_size(fixture::stroking(10'000, 0.05)) <= 100'000);
  REQUIRE(encode_trace(fixture::stroking(10'000, 0.05)).size() <= 60'000);
}

TEST_CASE("the size of a sealed trace does not depend on the texture") {
  for (const std::size_t count : {1, 10, 50, 100, 500, 3000, 10'000}) {
    const std::size_t smooth = sealed_size(fixture::stroking(count, 0.0));
    for (const double rms_n : {0.01, 0.05, 0.2, 0.5}) {
      REQUIRE(sealed_size(fixture::stroking(count, rms_n)) == smooth);
    }
  }
}

TEST_CASE("traces of up to ten seconds have one size, however long they are") {
  std::set<std::size_t> sizes;
  for (const std::size_t count : {0, 1, 999, 3001, 10'000}) {
    for (const double rms_n : {0.0, 0.5})
      sizes.insert(sealed_size(fixture::stroking(count, rms_n)));
  }
  REQUIRE(sizes.size() == 1);
}

TEST_CASE("the padding of traces reveals only steps of ten seconds") {
  REQUIRE(trace_padding(0) == trace_padding(10'000));
  REQUIRE(trace_padding(10'001) == 2 * trace_padding(10'000));
  REQUIRE(trace_padding(10'001) == trace_padding(20'000));
  REQUIRE(trace_padding(std::numeric_limits<std::size_t>::max()) < std::size_t{1} << 30U);
}

TEST_CASE("a trace cut short anywhere is refused") {
  const Bytes bytes = encode_trace(fixture::stroking(40, 0.05));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    REQUIRE_THROWS_AS(decode_trace(ByteView(bytes).first(size)), StoreError);
  }
  Bytes longer = bytes;
  longer.push_back(0);
  REQUIRE_THROWS_AS(decode_trace(longer), StoreError);
}

TEST_CASE("altered bytes give another trace or one clear error, and nothing worse") {
  const Bytes bytes = encode_trace(fixture::stroking(60, 0.05));
  RandomStream random(3, "altered");
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    Bytes altered = bytes;
    altered[random.below(altered.size())] ^= static_cast<std::uint8_t>(1 + random.below(255));
    std::size_t samples = 0;
    const std::string line =
        fixture::refusal_of([&] { samples = decode_trace(altered).samples.size(); });
    REQUIRE(samples <= (line.empty() ? 10'000'000 : 0));
    if (!line.empty()) ++refused;
  }
  REQUIRE(refused > 1000);
}

TEST_CASE("a trace that claims absurdly many samples is refused before memory is spent") {
  Bytes bytes = encode_trace(Trace{});
  for (std::size_t i = 12; i < 16; ++i) bytes[i] = 0xff;  // the number of samples
  const std::string refusal = fixture::refusal_of([&] { return decode_trace(bytes); });
  REQUIRE(fixture::contains(refusal, "10,000,000"));
  REQUIRE_THROWS_AS(decode_trace(bytes_of("no trace at all")), StoreError);
}
