#include "analysis/planning/power_curve.hpp"

#include "support/catch.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using planning::PowerFit;
using planning::PowerPoint;

/// Points from numbers of participants, studies, and studies that reach the goal.
std::vector<PowerPoint> points_of(const std::vector<std::vector<int>>& rows) {
  std::vector<PowerPoint> points;
  for (const auto& row : rows) points.push_back({row[0], {row[1], row[2]}});
  return points;
}

const std::vector<std::vector<int>> kStudies = {{8, 500, 78},   {12, 500, 138}, {16, 500, 195},
                                                {20, 500, 239}, {30, 500, 336}, {40, 500, 407}};

TEST_CASE("the power curve is the probit regression on the root of the size") {
  // R 4.2: glm(cbind(k, n - k) ~ sqrt(size), binomial("probit"))
  struct Case {
    std::vector<std::vector<int>> studies;
    double intercept;
    double slope;
  };
  const std::vector<Case> cases = {{kStudies, -2.450089840, 0.531533004},
                                   {{{6, 40, 3}, {10, 80, 40}}, -6.386469384, 2.019578946}};
  for (const Case& one : cases) {
    const std::optional<PowerFit> fit = planning::fit_power(points_of(one.studies));
    REQUIRE(fit);
    CHECK(fit->intercept == Approx(one.intercept).margin(1e-5));
    CHECK(fit->slope == Approx(one.slope).margin(1e-5));
  }
}

TEST_CASE("a power curve needs two sizes and both outcomes") {
  for (const auto& studies : std::vector<std::vector<std::vector<int>>>{
           {}, {{8, 100, 50}}, {{8, 100, 100}, {12, 100, 100}}, {{8, 100, 0}, {12, 100, 0}}}) {
    CHECK_FALSE(planning::fit_power(points_of(studies)));
  }
  // Power that falls with the size is noise.
  const std::optional<PowerFit> falling =
      planning::fit_power(points_of({{8, 100, 60}, {12, 100, 40}}));
  REQUIRE(falling);
  CHECK(falling->slope == Approx(0.0).margin(1e-9));
  CHECK(falling->power(8) == Approx(0.5).margin(1e-4));
}

TEST_CASE("the chosen size is the smallest within the sizes tried") {
  const std::vector<PowerPoint> points = points_of(kStudies);
  const PowerFit fit{-1.96, 0.5};
  const auto size = [&](double target) { return planning::size_with_power(fit, points, target); };
  CHECK(size(0.8) == 32);  // ((1.96 + 0.8416) / 0.5)^2 = 31.4
  CHECK(size(0.2) == std::nullopt);
  CHECK(size(0.95) == std::nullopt);
  CHECK(fit.power(8) > 0.2);
  CHECK(fit.power(40) < 0.95);
}

TEST_CASE("the power figure has a curve, points and the chosen size of each series") {
  const analysis::Figure figure = planning::power_figure(
      {"study",
       "goal",
       {{"30 trials", points_of(kStudies)}, {"60 trials", points_of({{8, 9, 9}})}}});
  REQUIRE(figure.panels.size() == 1);
  std::vector<std::string> names;
  for (const analysis::Layer& layer : figure.panels.front().layers) names.push_back(layer.name);
  CHECK(names == std::vector<std::string>{"80 %", "fit, 30 trials", "size with 80 % power", "",
                                          "30 trials", "60 trials"});
  CHECK(figure.simulated);
}

}  // namespace
}  // namespace touchtrial
