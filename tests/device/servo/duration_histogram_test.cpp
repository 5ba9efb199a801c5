#include "device/servo/duration_histogram.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace touchtrial {
namespace {

using std::chrono::nanoseconds;

TEST_CASE("the bins of a histogram follow one another and are at most 5 percent wide") {
  const device::DurationHistogram histogram;
  CHECK(histogram.bin(0).least_ns == 0);
  for (std::size_t i = 0; i + 1 < device::DurationHistogram::kBins; ++i) {
    const auto bin = histogram.bin(i);
    INFO(bin.least_ns);
    REQUIRE(histogram.bin(i + 1).least_ns == bin.end_ns);
    const auto width_ns = static_cast<double>(bin.end_ns - bin.least_ns);
    REQUIRE((width_ns == 1.0 || width_ns <= 0.05 * static_cast<double>(bin.least_ns)));
  }
}

TEST_CASE("a duration is counted in the bin that holds it") {
  for (std::int64_t ns = 0; ns < 1'000'000'000; ns = ns + 1 + ns / 7) {
    device::DurationHistogram histogram;
    histogram.add(nanoseconds(ns));
    for (std::size_t i = 0; i < device::DurationHistogram::kBins; ++i) {
      const auto bin = histogram.bin(i);
      if (bin.count == 0) continue;
      INFO(ns);
      REQUIRE(bin.least_ns <= ns);
      REQUIRE(ns < bin.end_ns);
    }
    REQUIRE(histogram.count() == 1);
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
  CHECK(histogram.bin(0).count == 1);
  CHECK(histogram.bin(device::DurationHistogram::kBins - 1).count == 1);
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
