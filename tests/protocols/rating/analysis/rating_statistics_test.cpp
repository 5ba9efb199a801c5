// References: R 4.2.2 (aov, t.test, pt, p.adjust, quantile) and psych 2.2.9 (ICC with lmer =
// FALSE), whose two-way values agree with Shrout, Fleiss 1979 and with the formulas of R's irr.
#include "protocols/rating/analysis/rating_statistics.hpp"

#include "support/catch.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

namespace own = analysis::rating;
using analysis::Interval;
using analysis::Proportion;
using own::Item;
using own::RatedParticipant;

constexpr Interval kLine{0.0, 1.0};

/// Two classes with three methods each.
const std::vector<Item> kItems{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}};

/// Both ratings of an item.
using Twice = std::array<double, 2>;

RatedParticipant participant_of(const std::vector<Twice>& ratings, std::vector<double> catches) {
  RatedParticipant one;
  for (std::size_t i = 0; i < ratings.size(); ++i) {
    for (const double value : ratings[i]) one.scored.push_back({kItems[i], value});
  }
  one.catches = std::move(catches);
  return one;
}

/// Five people, of whom the last has not rated the last item, and the fourth no catch trial.
std::vector<RatedParticipant> people() {
  return {
      participant_of({{.80, .86}, {.62, .58}, {.31, .27}, {.71, .65}, {.55, .61}, {.20, .26}},
                     {.1, .2, .0}),
      participant_of({{.95, .91}, {.70, .78}, {.52, .44}, {.88, .92}, {.81, .75}, {.40, .50}},
                     {.5, .9}),
      participant_of({{.60, .68}, {.66, .54}, {.25, .35}, {.52, .60}, {.40, .48}, {.33, .21}},
                     {.3, .5}),
      participant_of({{.74, .70}, {.50, .58}, {.10, .06}, {.69, .75}, {.62, .52}, {.05, .11}}, {}),
      participant_of({{.85, .79}, {.80, .72}, {.45, .55}, {.77, .83}, {.58, .66}}, {.7})};
}

/// People who rate everything as `value`.
std::vector<RatedParticipant> people_who_say(double value, int number) {
  return std::vector<RatedParticipant>(
      static_cast<std::size_t>(number),
      participant_of(std::vector<Twice>(kItems.size(), {value, value}), {value}));
}

void check_near(double number, double expected) {
  CHECK(number == Approx(expected).margin(1e-12).epsilon(1e-9));
}

void check_near(const Interval& interval, double low, double high) {
  CHECK(interval.low == Approx(low).margin(1e-9).epsilon(1e-7));
  CHECK(interval.high == Approx(high).margin(1e-9).epsilon(1e-7));
}

void check_mean(const analysis::MeanEstimate& mean, int participants, double expected, double low,
                double high) {
  CHECK(mean.participants == participants);
  check_near(mean.mean.value(), expected);
  check_near(mean.known_interval().value(), low, high);
}

/// Six targets in rows, four judges.
const std::vector<std::vector<double>> kShroutFleiss{{9, 2, 5, 8}, {6, 1, 3, 2},  {8, 4, 6, 8},
                                                     {7, 1, 2, 6}, {10, 5, 6, 9}, {6, 2, 4, 7}};

const double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("ratings have means by item, method and class over the people who rated all of it") {
  const own::RatingMeans means = own::rating_means(people(), kItems, kLine);
  REQUIRE(means.items.size() == 6);
  CHECK(means.items[4].item == Item{1, 1});
  check_mean(means.items[0].mean, 5, 0.788, 0.649901507168017, 0.926098492831983);
  check_mean(means.items[4].mean, 5, 0.598, 0.446333906532226, 0.749666093467774);
  check_mean(means.items[5].mean, 4, 0.2575, 0.015349851561437, 0.499650148438563);
  check_near(means.items[5].mean.sd.value(), 0.152178623115513);
  REQUIRE(means.methods.size() == 3);
  CHECK(means.methods[2].group == 2);
  CHECK(means.methods[2].items == 2);
  check_mean(means.methods[0].mean, 5, 0.76, 0.616066022263330, 0.903933977736670);
  check_mean(means.methods[2].mean, 4, 0.2725, 0.0218718297172107, 0.5231281702827892);
  REQUIRE(means.classes.size() == 2);
  CHECK(means.classes[1].items == 3);
  check_mean(means.classes[0].mean, 5, 0.588666666666667, 0.445184166982930, 0.732149166350403);
  check_mean(means.classes[1].mean, 4, 0.521666666666667, 0.316263467372781, 0.727069865960552);
}

TEST_CASE("a participant's repeats weigh as one number, however many there are") {
  std::vector<RatedParticipant> unequal(2);
  unequal[0].scored = {{{0, 0}, 0.2}, {{0, 0}, 0.4}, {{0, 0}, 0.6}, {{0, 0}, 0.4}};
  unequal[1].scored = {{{0, 0}, 0.8}};
  const std::vector<Item> item{{0, 0}, {0, 0}};
  const own::RatingMeans means = own::rating_means(unequal, item, kLine);
  REQUIRE(means.items.size() == 1);
  check_near(means.items[0].mean.mean.value(), 0.6);
  CHECK(means.items[0].mean.known_interval() == kLine);
}

TEST_CASE("means of ratings exist for one person without an interval, and for nobody not at all") {
  const own::RatingMeans one = own::rating_means(std::vector{people().front()}, kItems, kLine);
  check_near(one.methods[0].mean.mean.value(), 0.755);
  CHECK_FALSE(one.methods[0].mean.known_interval());
  const own::RatingMeans none = own::rating_means({}, kItems, kLine);
  REQUIRE(none.items.size() == 6);
  CHECK(none.items[0].mean.participants == 0);
  CHECK_FALSE(none.items[0].mean.mean);
  CHECK(own::rating_means(people(), {}, kLine).methods.empty());
  const own::RatingMeans constant = own::rating_means(people_who_say(0.3, 4), kItems, kLine);
  check_near(constant.methods[1].mean.mean.value(), 0.3);
  CHECK_FALSE(constant.methods[1].mean.known_interval());
}

TEST_CASE("ratings beyond the ends of their scale, and scales without ends are refused") {
  CHECK_THROWS_AS(own::rating_means(people(), kItems, {0.1, 1.0}), std::invalid_argument);
  CHECK_THROWS_AS(own::rating_means(people(), kItems, {1.0, 0.0}), std::invalid_argument);
  CHECK_THROWS_AS(own::rating_means(people(), kItems, {0.5, 0.5}), std::invalid_argument);
  CHECK_THROWS_AS(own::rating_means(people(), kItems, {0.0, kNaN}), std::invalid_argument);
  CHECK_THROWS_AS(own::rating_means(people(), kItems, kLine, 1.0), std::invalid_argument);
  CHECK_THROWS_AS(own::scale_use(people_who_say(kNaN, 1), kLine), std::invalid_argument);
  CHECK_THROWS_AS(own::method_differences(people_who_say(7.5, 2), kItems, {1.0, 7.0}),
                  std::invalid_argument);
  CHECK_THROWS_AS(own::catch_comparison(people_who_say(-0.1, 2), kItems, kLine),
                  std::invalid_argument);
  CHECK_THROWS_AS(own::agreement(people_who_say(kNaN, 2), kItems), std::invalid_argument);
  CHECK_THROWS_AS(own::agreement(people(), kItems, 0.0), std::invalid_argument);
  CHECK_THROWS_AS(own::retest_reliability(people_who_say(kNaN, 2), kItems), std::invalid_argument);
  CHECK_THROWS_AS(own::retest_reliability(people(), kItems, 1.0), std::invalid_argument);
}

TEST_CASE("intraclass correlations are those of Shrout and Fleiss") {
  const own::TwoWayMeanSquares squares = own::two_way_mean_squares(kShroutFleiss).value();
  CHECK(squares.rows == 6);
  CHECK(squares.columns == 4);
  check_near(squares.between_rows, 11.24166666666667);
  check_near(squares.between_columns, 32.48611111111109);
  check_near(squares.residual, 1.01944444444444);
  const own::IntraclassCorrelation single = own::single_agreement(squares).value();
  check_near(single.estimate, 0.289763779527559);
  check_near(single.interval.value(), 0.018786513374712, 0.761084369648953);
  const own::IntraclassCorrelation average = own::average_agreement(squares).value();
  check_near(average.estimate, 0.6200505475989893);
  check_near(average.interval.value(), 0.0711368153025035, 0.9272320401677220);
  check_near(own::one_way_correlation(kShroutFleiss).value(), 0.165741768405476);
}

TEST_CASE("intraclass correlations of a line have their intervals at other levels") {
  const std::vector<std::vector<double>> table{{.82, .64, .91, .55, .70, .78},
                                               {.45, .51, .62, .30, .58, .40},
                                               {.66, .60, .74, .52, .35, .71},
                                               {.12, .33, .28, .05, .41, .22},
                                               {.90, .72, .97, .61, .66, .83}};
  const own::TwoWayMeanSquares squares = own::two_way_mean_squares(table).value();
  const own::IntraclassCorrelation single = own::single_agreement(squares).value();
  check_near(single.estimate, 0.721675540179403);
  check_near(single.interval.value(), 0.383632735415220, 0.958587220378681);
  const own::IntraclassCorrelation average = own::average_agreement(squares, 0.9).value();
  check_near(average.estimate, 0.939604676985044);
  check_near(average.interval.value(), 0.826858322214823, 0.989454659556417);
  check_near(own::one_way_correlation(table).value(), 0.716445276946009);
}

TEST_CASE("agreement below chance has no interval where its approximation breaks down") {
  const std::vector<std::vector<double>> table{{1, 5, 3, 2}, {4, 2, 3, 3}, {2, 4, 5, 1}};
  const own::TwoWayMeanSquares squares = own::two_way_mean_squares(table).value();
  const own::IntraclassCorrelation single = own::single_agreement(squares).value();
  check_near(single.estimate, -0.317460317460317);
  CHECK_FALSE(single.interval);
  const own::IntraclassCorrelation average = own::average_agreement(squares).value();
  CHECK(average.estimate == Approx(-26.6666666666667));
  CHECK_FALSE(average.interval);
  const std::vector<std::vector<double>> crossed{{1, 2}, {2, 1}, {1.5, 1.5}};
  const own::TwoWayMeanSquares opposed = own::two_way_mean_squares(crossed).value();
  CHECK(own::single_agreement(opposed)->estimate == -3.0);
  CHECK_FALSE(own::average_agreement(opposed));
  const std::vector<std::vector<double>> square{{1, 2}, {2, 1}};
  CHECK_FALSE(own::single_agreement(own::two_way_mean_squares(square).value()));
}

TEST_CASE("intraclass correlations of perfect agreement are 1, of constant numbers nothing") {
  const std::vector<std::vector<double>> agreed{{0.1, 0.1, 0.1}, {0.7, 0.7, 0.7}, {0.4, 0.4, 0.4}};
  const own::TwoWayMeanSquares same = own::two_way_mean_squares(agreed).value();
  CHECK(same.residual == 0.0);
  CHECK(own::single_agreement(same)->estimate == 1.0);
  CHECK_FALSE(own::single_agreement(same)->interval);
  CHECK(own::average_agreement(same)->estimate == 1.0);
  CHECK(own::one_way_correlation(agreed) == 1.0);
  const std::vector<std::vector<double>> constant(3, {0.1, 0.1, 0.1});
  const own::TwoWayMeanSquares none = own::two_way_mean_squares(constant).value();
  CHECK(none.between_rows == 0.0);
  CHECK_FALSE(own::single_agreement(none));
  CHECK_FALSE(own::average_agreement(none));
  CHECK_FALSE(own::one_way_correlation(constant));
}

TEST_CASE("an analysis of variance needs two rows and columns of numbers") {
  using Table = std::vector<std::vector<double>>;
  CHECK_FALSE(own::two_way_mean_squares(Table{}));
  CHECK_FALSE(own::two_way_mean_squares(Table{{1, 2, 3}}));
  CHECK_FALSE(own::two_way_mean_squares(Table{{1}, {2}, {3}}));
  CHECK_FALSE(own::two_way_mean_squares(Table{{}, {}}));
  CHECK_THROWS_AS(own::two_way_mean_squares(Table{{1, 2}, {3}}), std::invalid_argument);
  CHECK_THROWS_AS(own::two_way_mean_squares(Table{{1, 2}, {3, kNaN}}), std::invalid_argument);
  CHECK_THROWS_AS(own::single_agreement({6, 4, 1.0, 1.0, 1.0}, 1.0), std::invalid_argument);
  CHECK_FALSE(own::one_way_correlation(Table{{1, 2}, {3}}));
  CHECK_THROWS_AS(own::one_way_correlation(Table{{1, 2}, {kNaN}}), std::invalid_argument);
}

TEST_CASE("the one-way correlation holds for groups of different sizes") {
  const std::vector<std::vector<double>> groups{
      {.2, .3}, {.5, .6, .55}, {.8}, {.9, .7}, {.4, .1, .3, .2}};
  check_near(own::one_way_correlation(groups).value(), 0.83917761279269);
  const std::vector<std::vector<double>> opposed{{0, 1}, {1, 0}, {0, 1}};
  CHECK(own::one_way_correlation(opposed) == -1.0);
}

TEST_CASE("agreement about the items is that of the people who rated all") {
  const own::Agreement found = own::agreement(people(), kItems);
  CHECK(found.items == 6);
  CHECK(found.participants == 4);
  CHECK(found.left_out == 1);
  check_near(found.mean_squares->between_rows, 0.19273416666666668);
  check_near(found.mean_squares->between_columns, 0.08598194444444446);
  check_near(found.mean_squares->residual, 0.00534527777777777);
  check_near(found.single->estimate, 0.713786900857052);
  check_near(found.single->interval.value(), 0.237724678099859, 0.947653658161409);
  check_near(found.average->estimate, 0.908888814038869);
  check_near(found.average->interval.value(), 0.555050854940260, 0.986378643398632);
}

TEST_CASE("one person, or people who rated one item, have nothing to agree about") {
  const own::Agreement one = own::agreement(std::vector{people().front()}, kItems);
  CHECK(one.participants == 1);
  CHECK_FALSE(one.mean_squares);
  CHECK_FALSE(one.single);
  const own::Agreement one_item = own::agreement(people(), std::vector{kItems.front()});
  CHECK(one_item.participants == 5);
  CHECK_FALSE(one_item.mean_squares);
  const own::Agreement no_item = own::agreement(people(), {});
  CHECK(no_item.participants == 0);
  CHECK(no_item.left_out == 5);
  CHECK_FALSE(own::agreement({}, kItems).single);
  const own::Agreement constant = own::agreement(people_who_say(0.3, 4), kItems);
  CHECK(constant.mean_squares);
  CHECK_FALSE(constant.single);
  CHECK_FALSE(constant.average);
}

TEST_CASE("people agree with themselves as far as their repeats correlate") {
  const own::RetestReliability found = own::retest_reliability(people(), kItems);
  REQUIRE(found.correlations.size() == 5);
  check_near(found.correlations[0].value(), 0.972941393518234);
  check_near(found.correlations[2].value(), 0.821998526884361);
  check_near(found.correlations[4].value(), 0.850746268656716);
  CHECK(found.participants == 5);
  CHECK(found.clamped == 0);
  check_near(found.quartiles.lower.value(), 0.850746268656716);
  check_near(found.quartiles.median.value(), 0.943138158905794);
  check_near(found.mean.value(), 0.935857806046403);
  check_near(found.interval.value(), 0.803276335908032, 0.980073650811256);
}

TEST_CASE("somebody who repeats every answer counts as far as the cut, who says the same nothing") {
  std::vector<RatedParticipant> mixed = people_who_say(0.3, 1);
  mixed.push_back(participant_of({{.1, .1}, {.9, .9}}, {}));
  const own::RetestReliability found = own::retest_reliability(mixed, kItems);
  CHECK_FALSE(found.correlations[0]);
  CHECK(found.correlations[1] == 1.0);
  CHECK(found.participants == 1);
  CHECK(found.clamped == 1);
  check_near(found.mean.value(), own::kMaxCorrelation);
  CHECK_FALSE(found.interval);
  mixed.push_back(participant_of({{.1, .1}, {.8, .8}}, {}));
  CHECK_FALSE(own::retest_reliability(mixed, kItems).interval);
  RatedParticipant once;
  for (const Item& item : kItems) once.scored.push_back({item, 0.1 * item.method});
  const own::RetestReliability single = own::retest_reliability(std::vector{once}, kItems);
  CHECK(single.participants == 0);
  CHECK_FALSE(single.mean);
  CHECK_FALSE(single.quartiles.median);
}

TEST_CASE("the use of a scale counts its ends, different values and who uses almost none of it") {
  RatedParticipant bold;
  for (const double value : {1.0, 1.0, 7.0, 4.0, 7.0, 7.0}) bold.scored.push_back({{0, 0}, value});
  bold.catches = {1.0, 1.0};
  RatedParticipant timid;
  for (const double value : {4.0, 4.0, 4.0, 4.3}) timid.scored.push_back({{0, 0}, value});
  RatedParticipant brief;
  brief.scored = {{{0, 0}, 7.0}};
  const own::ScaleUses uses =
      own::scale_use(std::vector{bold, timid, brief, RatedParticipant{}}, {1.0, 7.0});
  REQUIRE(uses.participants.size() == 4);
  CHECK(uses.participants[0].at_low == Proportion{6, 2});
  CHECK(uses.participants[0].at_high == Proportion{6, 3});
  CHECK(uses.participants[0].distinct == 3);
  check_near(uses.participants[0].mean.value(), 4.5);
  check_near(uses.participants[0].sd.value(), std::sqrt(8.7));
  CHECK_FALSE(uses.participants[0].is_narrow);
  check_near(uses.participants[1].sd.value(), 0.15);
  CHECK(uses.participants[1].is_narrow);
  CHECK(uses.participants[1].distinct == 2);
  CHECK_FALSE(uses.participants[2].sd);
  CHECK_FALSE(uses.participants[2].is_narrow);
  CHECK(uses.participants[3].at_low.n == 0);
  CHECK_FALSE(uses.participants[3].mean);
  CHECK(uses.participants[3].distinct == 0);
  CHECK(uses.at_low == Proportion{11, 2});
  CHECK(uses.at_high == Proportion{11, 4});
  CHECK(uses.narrow_count == 1);
}

TEST_CASE("constant answers use nothing of the scale, nobody's have no share at its ends") {
  const own::ScaleUses constant = own::scale_use(people_who_say(0.1, 2), kLine);
  CHECK(constant.narrow_count == 2);
  CHECK(constant.participants[0].sd == 0.0);
  CHECK(constant.participants[0].distinct == 1);
  CHECK_FALSE(own::scale_use({}, kLine).at_low.share());
}

TEST_CASE("methods are compared within the people who rated both on all classes") {
  const std::vector<own::MethodDifference> pairs = own::method_differences(people(), kItems, kLine);
  REQUIRE(pairs.size() == 3);
  CHECK(pairs[0].first == 0);
  CHECK(pairs[0].second == 1);
  CHECK(pairs[0].classes == 2);
  check_mean(pairs[0].difference, 5, 0.137, 0.0912518003073237, 0.1827481996926763);
  check_near(pairs[0].t.value(), 8.31449066777135570);
  check_near(pairs[0].t_test->p, 0.00114299998677037);
  check_near(pairs[0].t_test->holm, 0.0034289999603111);
  check_near(pairs[0].sign_flip->p, 0.0625);
  check_near(pairs[0].sign_flip->holm, 0.1875);
  check_near(pairs[0].standardised->d_z, 3.71835326628487);
  check_mean(pairs[1].difference, 4, 0.475, 0.261811724921403, 0.688188275078597);
  check_near(pairs[1].t_test->holm, 0.0115391268559717);
  CHECK(pairs[2].first == 1);
  CHECK(pairs[2].second == 2);
  check_mean(pairs[2].difference, 4, 0.33375, 0.171427689123936, 0.496072310876064);
  check_near(pairs[2].t_test->p, 0.00725599224185799);
  check_near(pairs[2].t_test->holm, 0.0115391268559717);
  check_near(pairs[2].sign_flip->p, 0.125);
  check_near(pairs[2].sign_flip->holm, 0.25);
}

TEST_CASE("methods are compared over the classes that both have") {
  std::vector<Item> fewer = kItems;
  fewer.pop_back();
  const std::vector<own::MethodDifference> pairs = own::method_differences(people(), fewer, kLine);
  REQUIRE(pairs.size() == 3);
  CHECK(pairs[0].classes == 2);
  CHECK(pairs[1].classes == 1);
  CHECK(pairs[1].difference.participants == 5);
  check_near(pairs[1].difference.mean.value(), 0.788 - 0.33);
  const std::vector<Item> apart{{0, 0}, {1, 1}};
  const std::vector<own::MethodDifference> none = own::method_differences(people(), apart, kLine);
  REQUIRE(none.size() == 1);
  CHECK(none[0].classes == 0);
  CHECK_FALSE(none[0].difference.mean);
  CHECK_FALSE(none[0].t_test);
  CHECK_FALSE(none[0].sign_flip);
}

TEST_CASE("methods compared by one person have no test of t, and alike methods no difference") {
  const own::MethodDifference one =
      own::method_differences(std::vector{people().front()}, kItems, kLine).front();
  CHECK(one.difference.mean);
  CHECK_FALSE(one.difference.known_interval());
  CHECK_FALSE(one.t);
  CHECK_FALSE(one.t_test);
  CHECK_FALSE(one.standardised);
  CHECK(one.sign_flip->p == 1.0);
  const own::MethodDifference alike =
      own::method_differences(people_who_say(0.3, 4), kItems, kLine).front();
  CHECK(alike.difference.mean == 0.0);
  CHECK_FALSE(alike.t);
  CHECK_FALSE(alike.difference.known_interval());
  CHECK_FALSE(alike.t_test);
  CHECK(alike.sign_flip->holm == 1.0);
  CHECK_FALSE(alike.standardised);
  CHECK(own::method_differences(people(), std::vector{kItems.front()}, kLine).empty());
  CHECK(own::method_differences({}, kItems, kLine)[0].difference.participants == 0);
}

TEST_CASE("a standardised difference has the interval of noncentral t") {
  const std::vector<double> differences{.18, .05, .31, -.02, .12, .22, .09};
  const own::StandardisedDifference found = own::standardised_difference(differences).value();
  check_near(found.d_z, 1.227263174655904);
  check_near(found.interval.value(), 0.197347758470469, 2.205575046651103);
  check_near(found.jackknife_estimate->value, 1.1036161840044594);
  check_near(found.jackknife_estimate->interval, -0.1104683413144383, 2.3177007093233568);
  std::vector<double> turned;
  for (const double difference : differences) turned.push_back(-difference);
  check_near(own::standardised_difference(turned, 0.9)->interval.value(), -2.034955283462731,
             -0.348985902896016);
  const std::vector<double> wide{-.3, .2, .25, -.1};
  check_near(own::standardised_difference(wide)->interval.value(), -0.9362682222079493,
             1.0250712766498977);
  const std::vector<double> balanced{-.1, .1, .2, -.2};
  const Interval around = own::standardised_difference(balanced)->interval.value();
  CHECK(around.low == Approx(-around.high));
}

TEST_CASE("a standardised difference needs two that differ, and its interval a t within reach") {
  CHECK_FALSE(own::standardised_difference(std::vector{0.2}));
  CHECK_FALSE(own::standardised_difference(std::vector{0.2, 0.2, 0.2}));
  CHECK_FALSE(own::standardised_difference(std::vector{0.2, 0.3})->jackknife_estimate);
  CHECK_FALSE(own::standardised_difference(std::vector{0.2, 0.2, 0.2, 0.3})->jackknife_estimate);
  const own::StandardisedDifference far =
      own::standardised_difference(std::vector{0.5, 0.5 + 1e-3}).value();
  CHECK(far.interval->low < far.d_z);
  CHECK(far.interval->high > far.d_z);
  const own::StandardisedDifference further =
      own::standardised_difference(std::vector{0.5, 0.5 + 1e-6}).value();
  CHECK(further.d_z > 1e5);
  CHECK_FALSE(further.interval);
  CHECK_THROWS_AS(own::standardised_difference(std::vector{0.1, kNaN}), std::invalid_argument);
  CHECK_THROWS_AS(own::standardised_difference({}, 1.0), std::invalid_argument);
}

TEST_CASE("catch trials are held against the scored trials of the same person") {
  const own::CatchComparison found = own::catch_comparison(people(), kItems, kLine);
  REQUIRE(found.participants.size() == 4);
  CHECK(found.participants[3].participant == 4);
  check_near(found.participants[0].catches, 0.1);
  check_near(found.participants[0].scored, 0.535);
  check_mean(found.catches, 4, 0.475, 0.0179559457513563, 0.9320440542486437);
  check_mean(found.difference, 4, 0.129166666666667, -0.198661490950559, 0.456994824283893);
  CHECK(found.not_lower == 1);
}

TEST_CASE("catch trials of nobody, and without scored ones, are compared with nothing") {
  RatedParticipant only_catches;
  only_catches.catches = {0.5};
  const own::CatchComparison none = own::catch_comparison(std::vector{only_catches}, kItems, kLine);
  CHECK(none.participants.empty());
  CHECK_FALSE(none.catches.mean);
  CHECK_FALSE(none.difference.mean);
  CHECK(none.not_lower == 0);
  CHECK(own::catch_comparison(people_who_say(0.3, 3), kItems, kLine).not_lower == 3);
}

TEST_CASE("points of a scale give the same correlations and standardised differences as a line") {
  std::vector<RatedParticipant> points = people();
  for (RatedParticipant& one : points) {
    for (own::ItemRating& rating : one.scored) rating.value = 1.0 + 6.0 * rating.value;
    for (double& rating : one.catches) rating = 1.0 + 6.0 * rating;
  }
  CHECK(own::agreement(points, kItems).single->estimate ==
        Approx(own::agreement(people(), kItems).single->estimate));
  CHECK(own::retest_reliability(points, kItems).mean.value() ==
        Approx(own::retest_reliability(people(), kItems).mean.value()));
  const own::MethodDifference pair = own::method_differences(points, kItems, {1.0, 7.0})[0];
  CHECK(pair.difference.mean.value() == Approx(6.0 * 0.137));
  CHECK(pair.standardised->d_z == Approx(3.71835326628487));
}

}  // namespace touchtrial
