#include "protocols/session/trace_builder.hpp"

#include "support/catch.hpp"

#include <vector>

namespace touchtrial {
namespace {

device::ServoSample sample_at(std::int64_t tick, double z_mm = -1.0, double push_n = 0.5) {
  return {{0.1 * static_cast<double>(tick), 2.0, z_mm}, {0.0, 0.0, push_n}, tick};
}

TEST_CASE("a trace without gaps holds the samples as they came") {
  store::Trace trace;
  session::TraceBuilder builder(trace, 2000.0, 10);
  for (std::int64_t tick = 0; tick < 10; ++tick) builder.add(sample_at(tick));
  REQUIRE(trace.samples.size() == 10);
  CHECK(trace.rate_hz == 2000.0);
  CHECK(trace.samples[7].position_mm.x == Approx(0.7));
  CHECK(builder.held() == 0);
}

TEST_CASE("a gap is filled by the sample before it, so that a sample's place is its time") {
  store::Trace trace;
  session::TraceBuilder builder(trace, 1000.0, 10);
  builder.add(sample_at(0, 5.0, 0.0));
  builder.add(sample_at(3));
  builder.add(sample_at(6));
  REQUIRE(trace.samples.size() == 7);
  CHECK(trace.samples[1].position_mm.z == 5.0);
  CHECK(trace.samples[2].position_mm.z == 5.0);
  CHECK(trace.samples[5].position_mm.x == Approx(0.3));
  CHECK(trace.samples[6].position_mm.x == Approx(0.6));
  CHECK(builder.held() == 4);
  CHECK(builder.held_in_contact() == 2);
}

TEST_CASE("a first sample that is late fills what came before it") {
  store::Trace trace;
  session::TraceBuilder builder(trace, 1000.0, 10);
  builder.add(sample_at(2));
  REQUIRE(trace.samples.size() == 3);
  CHECK(trace.samples[0].position_mm == trace.samples[2].position_mm);
  CHECK(builder.held() == 2);
}

TEST_CASE("a trace never grows beyond its room and takes no tick twice") {
  store::Trace trace;
  session::TraceBuilder builder(trace, 1000.0, 4);
  const auto* const memory = trace.samples.data();
  for (const std::int64_t tick : {0, 1, 1, 0, 2, 9, 3, 4}) builder.add(sample_at(tick));
  CHECK(trace.samples.size() == 4);
  CHECK(trace.samples.data() == memory);
  CHECK(builder.held() == 0);
}

TEST_CASE("landing is the time of the first sample that is low enough, whatever was left out") {
  store::Trace trace;
  session::TraceBuilder builder(trace, 4000.0, 100);
  CHECK_FALSE(builder.landed_at());
  builder.add(sample_at(0, 10.0, 0.0));
  builder.add(sample_at(8, 3.0, 0.0));
  builder.add(sample_at(9, 1.0, 0.5));
  CHECK(builder.landed_at() == std::chrono::milliseconds(2));
}

}  // namespace
}  // namespace touchtrial
