#include "protocols/session/trial_measures.hpp"

#include "support/catch.hpp"

namespace touchtrial {
namespace {

constexpr double kLimitN = 3.3;

/// A stroke of 100 mm/s at 1 kHz with one force all along.
Trace stroke(double seconds, Vec3 force_n) {
  Trace trace;
  for (int i = 0; i < static_cast<int>(seconds * 1000.0); ++i) {
    trace.samples.push_back({{0.1 * i, 5.0, -1.0}, force_n});
  }
  return trace;
}

TEST_CASE("measures of a steady stroke are those of its one force") {
  const TrialFindings found = findings_of(stroke(6.0, {0.3, 0.0, 0.4}), kLimitN);
  CHECK(found.measures.contact_s == Approx(6.0));
  CHECK(found.measures.path_mm == Approx(599.9));
  CHECK(found.measures.force_rms_n == Approx(0.5));
  CHECK(found.measures.saturated_share == 0.0);
  CHECK(found.valid);
}

TEST_CASE("time and way without contact do not count") {
  Trace trace = stroke(8.0, {0.0, 0.0, 0.7});
  for (int i = 2000; i < 4000; ++i) trace.samples[i].force_n = {};
  const TrialFindings found = findings_of(trace, kLimitN);
  CHECK(found.measures.contact_s == Approx(6.0));
  CHECK(found.measures.path_mm == Approx(199.9 + 399.9));
  CHECK(found.measures.force_rms_n == Approx(0.7));
}

TEST_CASE("a trial without contact measures nothing and is invalid") {
  const TrialFindings found = findings_of(stroke(10.0, {}), kLimitN);
  CHECK(found.measures == TrialMeasures{});
  CHECK_FALSE(found.valid);
}

TEST_CASE("each clause of the validity rule can fail alone") {
  CHECK_FALSE(findings_of(stroke(4.9, {0.0, 0.0, 0.7}), kLimitN).valid);
  CHECK_FALSE(findings_of(stroke(6.0, {0.0, 0.0, 0.19}), kLimitN).valid);
  CHECK_FALSE(findings_of(stroke(6.0, {0.0, 0.0, 2.01}), kLimitN).valid);
  Trace still = stroke(6.0, {0.0, 0.0, 0.7});
  for (TraceSample& sample : still.samples) sample.position_mm.x *= 0.4;
  CHECK_FALSE(findings_of(still, kLimitN).valid);
  Trace saturated = stroke(6.0, {0.0, 0.0, 0.7});
  for (int i = 0; i < 60; ++i) saturated.samples[100 * i].force_n = {0.0, 0.0, kLimitN};
  const TrialFindings found = findings_of(saturated, kLimitN);
  CHECK(found.measures.saturated_share == Approx(0.01));
  CHECK_FALSE(found.valid);
}

TEST_CASE("the validity rule asks for the median force, whatever the extremes") {
  Trace trace = stroke(6.0, {0.0, 0.0, 0.7});
  for (std::size_t i = 0; i < trace.samples.size(); ++i) {
    if (i % 5 == 0) trace.samples[i].force_n.z = 0.01;
    if (i % 5 == 1) trace.samples[i].force_n.z = 2.5;
  }
  CHECK(findings_of(trace, kLimitN).valid);
}

}  // namespace
}  // namespace touchtrial
