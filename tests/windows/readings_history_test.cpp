#include "app/readings/history.hpp"
#include "app/readings/plot.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

TEST_CASE("the history keeps the extent of each bin, and the newest five seconds") {
  app::ReadingsHistory history(1000.0);
  for (std::int64_t tick = 0; tick < 12'000; ++tick) {
    const double time_s = static_cast<double>(tick) * 1e-3;
    history.add({{time_s, 0.0, 0.0}, {0.0, 0.0, tick == 11'990 ? 0.7 : 0.0}, tick});
  }
  const auto x = history.values(app::Channel::x);
  REQUIRE(x.size() == app::ReadingsHistory::kBins);
  CHECK(x.front().least == Approx(7.0));
  CHECK(x.back().greatest == Approx(11.999));
  CHECK(x[100].greatest - x[100].least == Approx(0.019));
  CHECK(history.values(app::Channel::force_z).back().greatest == 0.7);
  CHECK(history.rates_hz()[100].least == Approx(1000.0));
}

TEST_CASE("ticks that were left out show as a lower rate and as a gap") {
  app::ReadingsHistory history(1000.0);
  for (std::int64_t tick = 0; tick < 5000; ++tick) {
    if (tick < 2000 || tick >= 2100) history.add({{}, {}, tick});
  }
  CHECK(history.values(app::Channel::x)[102].is_empty());
  CHECK_FALSE(history.values(app::Channel::x)[98].is_empty());
  CHECK(history.rates_hz()[103].least < 500.0);
}

TEST_CASE("a new run begins a new history, and lateness belongs to the newest bin") {
  app::ReadingsHistory history(1000.0);
  history.add_lateness(5.0);
  for (std::int64_t tick = 0; tick < 100; ++tick) history.add({{1.0, 0.0, 0.0}, {}, tick});
  history.add_lateness(7.0);
  CHECK(history.values(app::Channel::late).back().greatest == 7.0);
  history.add({{2.0, 0.0, 0.0}, {}, 0});
  const auto x = history.values(app::Channel::x);
  CHECK(x.back().least == 2.0);
  CHECK(x[app::ReadingsHistory::kBins - 2].is_empty());
  CHECK(history.values(app::Channel::late).back().is_empty());
}

TEST_CASE("scales cover every value and have ticks at round numbers") {
  const std::vector<app::PlotLine> lines = {
      {"x", app::kBlue, {{-3.2, 17.0}, app::Extent{}, {0.0, 41.0}}}};
  const app::PlotScale scale = app::scale_for(lines, {0.0, 10.0}, 4);
  CHECK(scale.step == Approx(20.0));
  CHECK(scale.least == Approx(-20.0));
  CHECK(scale.greatest == Approx(60.0));
  const app::PlotScale none = app::scale_for({}, {0.0, 0.8}, 4);
  CHECK(none.step == Approx(0.2));
  CHECK(none.greatest == Approx(0.8));
}

TEST_CASE("logarithmic scales cover whole decades") {
  const app::PlotScale scale =
      app::decades_for({{"late", app::kBlue, {{0.2, 2500.0}}}}, {1.0, 1000.0});
  CHECK(scale.least == Approx(1.0));
  CHECK(scale.greatest == Approx(10'000.0));
}

}  // namespace
}  // namespace touchtrial
