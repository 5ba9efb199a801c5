#include "protocols/session/trial_trace.hpp"

#include "support/catch.hpp"

namespace touchtrial {
namespace {

constexpr double kLimitN = 3.3;

/// A stroke of 100 mm/s at 1 kHz with one force all along.
record::Trace stroke(double seconds, Vec3 force_n) {
  record::Trace trace;
  for (int i = 0; i < static_cast<int>(seconds * 1000.0); ++i) {
    trace.samples.push_back({{0.1 * i, 5.0, -1.0}, force_n});
  }
  return trace;
}

TEST_CASE("measures of a steady stroke are those of its one force") {
  const session::TrialFindings found = session::findings_of(stroke(6.0, {0.3, 0.0, 0.4}), kLimitN);
  CHECK(found.measures.contact_s == Approx(6.0));
  CHECK(found.measures.path_mm == Approx(599.9));
  CHECK(found.measures.force_rms_n == Approx(0.5));
  CHECK(found.measures.saturated_share == 0.0);
  CHECK(found.is_valid());
}

TEST_CASE("time and path without contact do not count") {
  record::Trace trace = stroke(8.0, {0.0, 0.0, 0.7});
  for (int i = 2000; i < 4000; ++i) trace.samples[i].force_n = {};
  const session::TrialFindings found = session::findings_of(trace, kLimitN);
  CHECK(found.measures.contact_s == Approx(6.0));
  CHECK(found.measures.path_mm == Approx(199.9 + 399.9));
  CHECK(found.measures.force_rms_n == Approx(0.7));
}

TEST_CASE("a trial without contact measures nothing and is invalid") {
  const session::TrialFindings found = session::findings_of(stroke(10.0, {}), kLimitN);
  CHECK(found.measures == record::TrialMeasures{.within_limits = false});
  CHECK_FALSE(found.is_valid());
  CHECK_FALSE(session::findings_of({}, kLimitN).is_valid());
}

TEST_CASE("each clause of the validity rule that depends on forces can fail alone, and is sealed") {
  const auto fails_within = [](const record::Trace& trace) {
    const session::TrialFindings found = session::findings_of(trace, kLimitN);
    return found.long_enough && !found.measures.within_limits && !found.is_valid();
  };
  CHECK(fails_within(stroke(6.0, {0.0, 0.0, 0.19})));
  CHECK(fails_within(stroke(6.0, {0.0, 0.0, 2.01})));
  record::Trace lifted = stroke(6.0, {0.0, 0.0, 0.7});
  for (int i = 0; i < 1100; ++i) lifted.samples[i].force_n = {};
  CHECK(fails_within(lifted));
  record::Trace still = stroke(6.0, {0.0, 0.0, 0.7});
  for (record::TraceSample& sample : still.samples) sample.position_mm.x *= 0.4;
  CHECK(fails_within(still));
  record::Trace saturated = stroke(6.0, {0.0, 0.0, 0.7});
  for (int i = 0; i < 60; ++i) saturated.samples[100 * i].force_n = {0.0, 0.0, kLimitN};
  CHECK(session::findings_of(saturated, kLimitN).measures.saturated_share == Approx(0.01));
  CHECK(fails_within(saturated));
}

TEST_CASE("the length of an exploration counts from landing, independent of forces") {
  CHECK(session::findings_of(stroke(5.0, {0.0, 0.0, 0.7}), kLimitN).long_enough);
  CHECK_FALSE(session::findings_of(stroke(4.999, {0.0, 0.0, 0.7}), kLimitN).long_enough);
  CHECK(session::findings_of(stroke(5.0, {}), kLimitN).long_enough);
  record::Trace late = stroke(6.0, {0.0, 0.0, 0.7});
  for (int i = 0; i < 1001; ++i) late.samples[i].position_mm.z = 3.1;
  CHECK_FALSE(session::findings_of(late, kLimitN).long_enough);
  late.samples[1000].position_mm.z = 3.0;
  CHECK(session::findings_of(late, kLimitN).long_enough);
}

TEST_CASE("each window of the hand can be missed alone") {
  using Hand = record::HandWindows;
  const auto hand = [](const record::Trace& trace) {
    return session::findings_of(trace, kLimitN).hand;
  };
  /// A stroke of this speed.
  const auto stroke_at = [](double mm_s, double seconds) {
    record::Trace trace = stroke(seconds, {0.0, 0.0, 0.7});
    for (record::TraceSample& sample : trace.samples) sample.position_mm.x *= mm_s / 100.0;
    return trace;
  };
  CHECK(hand(stroke(6.0, {0.0, 0.0, 0.7})) == Hand{});
  CHECK(hand(stroke(4.999, {0.0, 0.0, 0.7})) == Hand{.contact = false});
  CHECK(hand(stroke_at(55.0, 5.4)) == Hand{.path = false});
  CHECK(hand(stroke(6.0, {0.0, 0.0, 0.199})) == Hand{.force = false});
  CHECK(hand(stroke(6.0, {0.0, 0.0, 2.001})) == Hand{.force = false});
  CHECK(hand(stroke_at(49.0, 9.0)) == Hand{.speed = false});
  CHECK(hand(stroke_at(151.0, 6.0)) == Hand{.speed = false});
  const Hand none{.contact = false, .path = false, .force = false, .speed = false};
  CHECK(hand({}) == none);
  record::Trace above = stroke(6.0, {});
  for (record::TraceSample& sample : above.samples) sample.position_mm.z = 3.1;
  CHECK(hand(above) == none);
}

TEST_CASE("what a texture does to the hand's forces does not move it out of its windows") {
  record::Trace rough = stroke(6.0, {2.4, 0.0, 0.7});
  for (std::size_t i = 0; i < rough.samples.size(); ++i) {
    // On a relief, contact is lost half of the time, and the push is met by the other half.
    rough.samples[i].position_mm.z = i % 2 == 0 ? -1.0 : 0.5;
    rough.samples[i].force_n = i % 2 == 0 ? Vec3{3.0, 0.0, 1.4} : Vec3{};
  }
  const session::TrialFindings found = session::findings_of(rough, kLimitN);
  CHECK(found.hand == record::HandWindows{});
  CHECK_FALSE(found.measures.within_limits);
  CHECK(found.saturated);
  CHECK_FALSE(session::findings_of(stroke(6.0, {0.0, 0.0, 0.7}), kLimitN).saturated);
}

TEST_CASE("the validity rule uses the median force and ignores extremes") {
  record::Trace trace = stroke(6.0, {0.0, 0.0, 0.7});
  for (std::size_t i = 0; i < trace.samples.size(); ++i) {
    if (i % 5 == 0) trace.samples[i].force_n.z = 0.01;
    if (i % 5 == 1) trace.samples[i].force_n.z = 2.5;
  }
  CHECK(session::findings_of(trace, kLimitN).is_valid());
}

}  // namespace
}  // namespace touchtrial
