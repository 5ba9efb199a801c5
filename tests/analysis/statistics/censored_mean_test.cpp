#include "analysis/statistics/censored_mean.hpp"

#include "analysis/statistics/descriptive.hpp"
#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <boost/math/distributions/normal.hpp>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

constexpr double kOpen = std::numeric_limits<double>::infinity();

Bounds at(double value) {
  return {value, value};
}

std::vector<Bounds> all_at(const std::vector<double>& values) {
  std::vector<Bounds> people;
  for (const double value : values) people.push_back(at(value));
  return people;
}

struct Reference {
  std::vector<Bounds> people;
  double mean, sd, low, high, p;
};

/// Means and SDs of R 4.2.2, survival 3.5-3: survreg(Surv(low, high, type = "interval2") ~ 1, dist
/// = "gaussian"), the scale times sqrt(m / (m - 1)). Ends and p, against -4, from the profile of
/// the same likelihood, with dnorm and pnorm(log.p = TRUE).
std::vector<Reference> references() {
  return {{{at(-12), at(-5), at(-7.5), {0, kOpen}, at(-3), {0, kOpen}, at(-9.25), at(-1.5)},
           -4.01719951332,
           5.80352683488,
           -9.04787616987,
           2.38053394599,
           0.993910153313},
          {{{-kOpen, -40}, at(-31), at(-38), {-kOpen, -40}, at(-29.5), at(-35)},
           -36.8016169755,
           6.72043773004,
           -49.3449519003,
           -28.8971625646,
           0.000826318077695},
          {{at(-12),
            {-20, -16},
            at(-5),
            {-kOpen, -30},
            at(-7.5),
            {0, kOpen},
            at(-3),
            at(-15),
            {-6, kOpen},
            at(-22)},
           -10.8963406636,
           13.2084532183,
           -21.4804989019,
           0.886489033784,
           0.186667318847},
          {{at(-12), at(-5), at(-7.5), at(-3), {60, kOpen}},
           9.38086117244,
           38.2693539865,
           -43.6032434483,
           75.8582702438,
           0.487623102697}};
}

}  // namespace

TEST_CASE("means of censored values are those of R's survreg") {
  for (const Reference& one : references()) {
    const CensoredMean found = censored_mean(one.people);
    CHECK(found.lack == MissingReason::nothing);
    CHECK(found.mean.value() == Approx(one.mean).epsilon(1e-9));
    CHECK(found.sd.value() == Approx(one.sd).epsilon(1e-9));
    CHECK(found.interval.value().low == Approx(one.low).epsilon(1e-9));
    CHECK(found.interval->high == Approx(one.high).epsilon(1e-9));
    CHECK(censored_p(one.people, -4.0, Sides::two).value() == Approx(one.p).epsilon(1e-7));
  }
}

TEST_CASE("if all values are known the mean is Student's") {
  const std::vector<double> values = {-12.0, -5.0, -7.5, -3.0, -8.25};
  const CensoredMean found = censored_mean(all_at(values), 0.9);
  const MeanEstimate student = participant_mean(values, {-kOpen, kOpen}, 0.9);
  CHECK(found.participants == 5);
  CHECK(found.exact == 5);
  CHECK(found.mean == student.mean);
  CHECK(found.interval == student.interval);
  CHECK(found.sd == student.sd);
  CHECK(found.median == -7.5);
  for (const Sides sides : {Sides::one, Sides::two}) {
    CHECK(censored_p(all_at(values), -9.0, sides) == t_test_p(values, -9.0, sides));
  }
}

TEST_CASE("somebody of whom nothing is known changes neither interval nor p, and has no share") {
  const std::vector<double> values = {-12.0, -5.0, -7.5, -3.0, -8.25};
  std::vector<Bounds> people = all_at(values);
  people.push_back({});
  const CensoredMean found = censored_mean(people);
  const MeanEstimate student = participant_mean(values, {-kOpen, kOpen});
  CHECK(found.participants == 5);
  CHECK(found.open == 1);
  CHECK(found.exact == 5);
  CHECK(found.mean.value() == Approx(*student.mean).epsilon(1e-9));
  CHECK(found.sd.value() == Approx(*student.sd).epsilon(1e-9));
  CHECK(found.interval.value().low == Approx(student.interval.low).epsilon(1e-9));
  CHECK(found.interval->high == Approx(student.interval.high).epsilon(1e-9));
  for (const double null : {-12.0, -7.0, 4.0}) {
    for (const Sides sides : {Sides::one, Sides::two}) {
      CHECK(censored_p(people, null, sides).value() ==
            Approx(*t_test_p(values, null, sides)).epsilon(1e-7));
    }
  }
}

TEST_CASE("an end of the interval is a mean with the interval's p") {
  const std::vector<Bounds> people = references().front().people;
  const CensoredMean found = censored_mean(people, 0.9);
  CHECK(censored_p(people, found.interval->low, Sides::one).value() == Approx(0.05).epsilon(1e-8));
  CHECK(censored_p(people, found.interval->high, Sides::one).value() == Approx(0.95).epsilon(1e-8));
  CHECK(censored_p(people, found.interval->high, Sides::two).value() == Approx(0.1).epsilon(1e-8));
  CHECK(censored_p(people, *found.mean, Sides::two).value() == Approx(1.0).margin(1e-6));
}

TEST_CASE("narrow bounds say what a value says, and mirrored ones the mirrored mean") {
  const std::vector<double> values = {-12.0, -5.0, -7.5, -3.0};
  std::vector<Bounds> narrow = all_at(values);
  narrow.push_back({-0.5e-7, 0.5e-7});
  std::vector<Bounds> known = all_at(values);
  known.push_back(at(0.0));
  CHECK(censored_mean(narrow).mean.value() == Approx(*censored_mean(known).mean).epsilon(1e-6));
  for (const Reference& one : references()) {
    std::vector<Bounds> mirrored;
    for (const Bounds& bounds : one.people) mirrored.push_back({-bounds.high, -bounds.low});
    const CensoredMean found = censored_mean(mirrored);
    CHECK(found.mean.value() == Approx(-one.mean).epsilon(1e-9));
    CHECK(found.interval.value().high == Approx(-one.low).epsilon(1e-9));
  }
}

TEST_CASE("bounds far away from the values, and any unit, are within reach") {
  const std::vector<Bounds> base = references().front().people;
  const CensoredMean found = censored_mean(base);
  for (const double unit : {1e-6, 1e9}) {
    std::vector<Bounds> scaled;
    for (const Bounds& one : base) scaled.push_back({unit * one.low, unit * one.high});
    CHECK(censored_mean(scaled).mean.value() == Approx(unit * *found.mean).epsilon(1e-9));
    CHECK(censored_mean(scaled).interval.value().high ==
          Approx(unit * found.interval->high).epsilon(1e-9));
  }
  std::vector<Bounds> far = all_at({-12.0, -5.0, -7.5, -3.0});
  far.push_back({1e9, kOpen});
  far.push_back({-kOpen, -1e9});
  const CensoredMean wide = censored_mean(far);
  CHECK(wide.interval.value().low < -1e9);
  CHECK(wide.interval->high > 1e9);
  CHECK(std::isfinite(censored_p(far, 1e12, Sides::two).value()));
  // A bound that everybody's value meets tells nothing.
  far.resize(4);
  far.push_back({-1e300, kOpen});
  CHECK(censored_mean(far).mean.value() == Approx(-6.875).epsilon(1e-9));
}

TEST_CASE("with more than half of the people censored there is no mean") {
  std::vector<Bounds> people = all_at({-5.0, -7.0, -3.0});
  people.resize(6, {0.0, kOpen});
  CHECK(censored_mean(people).mean);
  CHECK(censored_mean(people).interval);
  people.push_back({0.0, kOpen});
  const CensoredMean found = censored_mean(people);
  CHECK(found.lack == MissingReason::most);
  CHECK_FALSE(found.mean);
  CHECK_FALSE(found.interval);
  CHECK_FALSE(found.sd);
  CHECK_FALSE(censored_p(people, 0.0, Sides::two));
  CHECK(found.median_within == Bounds{0.0, kOpen});
  CHECK_FALSE(found.median);
}

TEST_CASE("fewer than two known values have no interval, and a mean only if nobody is censored") {
  CHECK(censored_mean({}).lack == MissingReason::values);
  CHECK_FALSE(censored_mean({}).mean);
  const CensoredMean one = censored_mean(all_at({-5.0}));
  CHECK(one.mean == -5.0);
  CHECK(one.median == -5.0);
  CHECK_FALSE(one.interval);
  CHECK(one.lack == MissingReason::values);
  const CensoredMean two = censored_mean(std::vector<Bounds>{at(-5.0), {0.0, kOpen}});
  CHECK_FALSE(two.mean);
  CHECK_FALSE(two.interval);
  CHECK(two.lack == MissingReason::values);
}

TEST_CASE("values that are all alike have no interval of zero width, and no p") {
  const CensoredMean same = censored_mean(all_at({-20.0, -20.0, -20.0}));
  CHECK(same.lack == MissingReason::spread);
  CHECK(same.mean == -20.0);
  CHECK(same.sd == 0.0);
  CHECK_FALSE(same.interval);
  CHECK_FALSE(censored_p(all_at({-20.0, -20.0, -20.0}), 0.0, Sides::two));
  std::vector<Bounds> held = all_at({-20.0, -20.0});
  held.push_back({-30.0, kOpen});
  CHECK(censored_mean(held).mean == -20.0);
  CHECK_FALSE(censored_mean(held).interval);
  held.back() = {0.0, kOpen};
  CHECK_FALSE(censored_mean(held).mean);
  CHECK(censored_mean(held).median == -20.0);
}

TEST_CASE("a median is given where every value within the bounds has the same") {
  const Bounds above{0.0, kOpen};
  const Bounds below{-kOpen, -40.0};
  CHECK(censored_mean(std::vector{at(-5), at(-7), above}).median == -5.0);
  CHECK(censored_mean(std::vector{at(-5), at(-7), above, below}).median == -6.0);
  CHECK(censored_mean(std::vector{at(-5), at(-7), above, above}).median_within ==
        Bounds{-2.5, kOpen});
  CHECK(censored_mean(std::vector{at(-5), Bounds{-6, -4}, at(-3)}).median_within ==
        Bounds{-5.0, -4.0});
  CHECK(censored_mean(std::vector{Bounds{-9, -6}, at(-5), at(-3)}).median == -5.0);
  CHECK(censored_mean(std::vector{below, Bounds{}, above}).median_within == Bounds{-kOpen, kOpen});
}

TEST_CASE("differences of bounds are bounds") {
  const Bounds above{0.0, kOpen};
  const Bounds below{-kOpen, -40.0};
  CHECK(difference_of(at(-5.5), at(-7.25)) == at(1.75));
  CHECK(difference_of(above, at(-5)) == Bounds{5.0, kOpen});
  CHECK(difference_of(at(-5), above) == Bounds{-kOpen, -5.0});
  CHECK(difference_of(above, above) == Bounds{});
  CHECK(difference_of(above, below) == Bounds{40.0, kOpen});
  CHECK(difference_of({-3.0, -1.0}, at(-5)) == Bounds{2.0, 4.0});
}

TEST_CASE("impossible bounds, levels and nulls are refused") {
  const double nan = std::nan("");
  for (const Bounds& wrong : {Bounds{1.0, 0.0}, Bounds{nan, 0.0}, Bounds{0.0, nan},
                              Bounds{kOpen, kOpen}, Bounds{-kOpen, -kOpen}}) {
    CHECK_THROWS_AS(censored_mean(std::vector{wrong}), std::invalid_argument);
    CHECK_THROWS_AS(censored_p(std::vector{wrong}, 0.0, Sides::two), std::invalid_argument);
  }
  CHECK_THROWS_AS(censored_mean({}, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(censored_p({}, nan, Sides::two), std::invalid_argument);
}

TEST_CASE("the interval of 12 people, a third of them censored, covers the mean of all") {
  constexpr int kStudies = 1000;
  const boost::math::normal people(-2.0, 5.0);
  int given = 0;
  int covered = 0;
  int without_covers = 0;
  double sum = 0.0;
  for (int study = 0; study < kStudies; ++study) {
    RandomStream random(11, "censored mean", static_cast<std::uint64_t>(study));
    std::vector<Bounds> found;
    std::vector<double> known;
    for (int i = 0; i < 12; ++i) {
      const double value = boost::math::quantile(people, std::max(random.uniform(), 1e-12));
      found.push_back(value > 0.0 ? Bounds{0.0, kOpen} : at(value));
      if (value <= 0.0) known.push_back(value);
    }
    const CensoredMean mean = censored_mean(found);
    if (!mean.interval) continue;
    ++given;
    sum += *mean.mean;
    covered += mean.interval->low <= -2.0 && mean.interval->high >= -2.0 ? 1 : 0;
    const Interval of_known = participant_mean(known, {-kOpen, kOpen}).interval;
    without_covers += of_known.high >= -2.0 ? 1 : 0;
  }
  CHECK(given > 850);
  CHECK(covered >= 0.93 * given);
  CHECK(sum / given == Approx(-2.0).margin(0.5));
  CHECK(without_covers < 0.5 * given);
}
