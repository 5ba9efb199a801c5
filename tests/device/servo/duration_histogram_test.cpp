#include "device/servo/duration_histogram.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchtrial {
namespace {

using std::chrono::nanoseconds;

TEST_CASE("a duration is counted exactly below 32 ns, and at most a 32nd longer above") {
  for (std::int64_t ns = 0; ns < 1'000'000'000; ns = ns + 1 + ns / 7) {
    device::DurationHistogram histogram;
    histogram.add(nanoseconds(ns));
    histogram.add(std::chrono::hours(1));
    INFO(ns);
    const double us = histogram.percentile_us(0.5);
    REQUIRE(us >= 1e-3 * static_cast<double>(ns));
    REQUIRE(us <= 1e-3 * static_cast<double>(ns < 32 ? ns : ns + ns / 32));
  }
}

TEST_CASE("percentiles of a histogram are those of the sorted durations, at most 5 percent above") {
  RandomStream random(7, "histogram test");
  std::vector<double> all_us;
  device::DurationHistogram histogram;
  for (int i = 0; i < 20'000; ++i) {
    const auto ns = static_cast<std::int64_t>(std::exp(9.0 + 2.0 * random.normal()));
    histogram.add(nanoseconds(ns));
    all_us.push_back(static_cast<double>(ns) * 1e-3);
  }
  std::sort(all_us.begin(), all_us.end());
  for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * 20'000.0));
    INFO(share);
    CHECK(histogram.percentile_us(share) >= all_us[rank - 1]);
    CHECK(histogram.percentile_us(share) <= 1.05 * all_us[rank - 1]);
  }
  CHECK(histogram.percentile_us(1.0) == all_us.back());
}

TEST_CASE("a histogram without durations has percentiles of zero") {
  CHECK(device::DurationHistogram().percentile_us(0.99) == 0.0);
  CHECK(device::DurationHistogram().worst() == nanoseconds(0));
}

TEST_CASE("a histogram takes durations below and beyond its bins") {
  device::DurationHistogram histogram;
  histogram.add(nanoseconds(-5));
  histogram.add(std::chrono::hours(1));
  CHECK(histogram.percentile_us(0.5) == 0.0);
  CHECK(histogram.percentile_us(1.0) == 3.6e9);
}

TEST_CASE("the sum of histograms equals one histogram of all durations") {
  device::DurationHistogram one;
  device::DurationHistogram other;
  one.add(nanoseconds(100));
  other.add(nanoseconds(100));
  other.add(nanoseconds(9000));
  one.add(other);
  CHECK(one.count() == 3);
  CHECK(one.worst() == nanoseconds(9000));
  CHECK(one.percentile_us(0.6) < 0.11);
}

}  // namespace
}  // namespace touchtrial
