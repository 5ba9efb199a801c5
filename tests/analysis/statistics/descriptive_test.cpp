#include "analysis/statistics/descriptive.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace touchtrial {

// Expected values: SciPy 1.10, mean -+ t.ppf(0.975, n - 1) * std(ddof=1) / sqrt(n).
TEST_CASE("participant_mean gives Student's interval") {
  const std::vector<double> shares{0.8, 0.6, 0.92, 0.76, 0.88};
  const analysis::MeanEstimate estimate = analysis::participant_mean(shares);
  CHECK(estimate.participants == 5);
  CHECK(estimate.mean.value() == Approx(0.792).margin(1e-12));
  CHECK(estimate.interval.low == Approx(0.637314378178071).margin(1e-12).epsilon(0));
  CHECK(estimate.interval.high == Approx(0.9466856218219291).margin(1e-12).epsilon(0));
  CHECK(estimate.sd.value() == Approx(0.12457929201917951).margin(1e-12));
}

TEST_CASE("participant_mean has no mean without participants and no interval from one") {
  const analysis::MeanEstimate none = analysis::participant_mean({});
  CHECK_FALSE(none.mean.has_value());
  CHECK(none.interval == analysis::Interval{0.0, 1.0});
  const std::vector<double> one{0.8};
  CHECK(analysis::participant_mean(one).mean == 0.8);
  CHECK(analysis::participant_mean(one).interval == analysis::Interval{0.0, 1.0});
  CHECK_FALSE(none.known_interval());
  CHECK_FALSE(analysis::participant_mean(one).known_interval());
  CHECK_FALSE(analysis::participant_mean(one).sd.has_value());
}

TEST_CASE("participant_mean keeps its interval within what is possible") {
  const std::vector<double> wide{0.0, 1.0};
  CHECK(analysis::participant_mean(wide).interval == analysis::Interval{0.0, 1.0});
}

TEST_CASE("participants who are all alike have no interval") {
  const std::vector<double> perfect{1.0, 1.0, 1.0};
  CHECK(analysis::all_alike(perfect));
  CHECK(analysis::participant_mean(perfect).mean == 1.0);
  CHECK(analysis::participant_mean(perfect).interval == analysis::Interval{1.0, 1.0});
  CHECK_FALSE(analysis::participant_mean(perfect).known_interval());
  const std::vector<double> but_for_rounding{0.1 + 0.2, 0.3, 0.3};
  CHECK(analysis::all_alike(but_for_rounding));
  CHECK_FALSE(analysis::participant_mean(but_for_rounding).known_interval());
  CHECK_FALSE(analysis::all_alike(std::vector{0.3}));
  CHECK_FALSE(analysis::all_alike(std::vector{0.3, 0.30001}));
}

TEST_CASE("participant_mean refuses values that are not finite") {
  const std::vector<double> values{0.5, std::nan("")};
  CHECK_THROWS_AS(analysis::participant_mean(values), std::invalid_argument);
  CHECK_THROWS_AS(analysis::participant_mean({}, {}, 0.0), std::invalid_argument);
}

// Expected values: NumPy 1.24, quantile(values, share), whose default is definition 7.
TEST_CASE("quantile and quartiles give the values of an independent implementation") {
  const analysis::Quartiles result = analysis::quartiles({3.1, 0.2, 7.5, 1.1, 2.2, 9.0, 4.4, 5.0});
  CHECK(result.n == 8);
  CHECK(*result.lower == Approx(1.925).epsilon(1e-14));
  CHECK(*result.median == Approx(3.75).epsilon(1e-14));
  CHECK(*result.upper == Approx(5.625).epsilon(1e-14));
  const std::vector<double> sorted{0.2, 1.1, 2.2, 3.1, 4.4, 5.0, 7.5, 9.0};
  CHECK(*analysis::quantile(sorted, 0.1) == Approx(0.83).epsilon(1e-14));
}

TEST_CASE("quantile reaches the ends exactly and passes through the values") {
  const std::vector<double> sorted{-1.0, 0.0, 0.0, 4.0, 10.0};
  CHECK(analysis::quantile(sorted, 0.0) == -1.0);
  CHECK(analysis::quantile(sorted, 0.25) == 0.0);
  CHECK(analysis::quantile(sorted, 0.75) == 4.0);
  CHECK(analysis::quantile(sorted, 1.0) == 10.0);
}

TEST_CASE("Quartiles of one value are that value, and of none they are nothing") {
  const analysis::Quartiles one = analysis::quartiles({7.0});
  CHECK(one.lower == 7.0);
  CHECK(one.median == 7.0);
  CHECK(one.upper == 7.0);
  const analysis::Quartiles none = analysis::quartiles({});
  CHECK(none.n == 0);
  CHECK_FALSE(none.median.has_value());
}

TEST_CASE("quantile refuses impossible shares, quartiles values without an order") {
  CHECK_THROWS_AS(analysis::quantile({}, 1.1), std::invalid_argument);
  CHECK_THROWS_AS(analysis::quantile({}, std::nan("")), std::invalid_argument);
  CHECK_THROWS_AS(analysis::quartiles({1.0, std::nan("")}), std::invalid_argument);
}

}  // namespace touchtrial
