#include "analysis/statistics/information_transfer.hpp"

#include "support/catch.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace touchtrial {
namespace {

std::vector<analysis::Choice> choices(const std::vector<std::vector<int>>& counts) {
  std::vector<analysis::Choice> all;
  for (int i = 0; i < static_cast<int>(counts.size()); ++i) {
    for (int j = 0; j < static_cast<int>(counts.size()); ++j) {
      all.insert(all.end(), static_cast<std::size_t>(counts[i][j]), analysis::Choice{i, j});
    }
  }
  return all;
}

analysis::InformationTransfer of(const std::vector<std::vector<int>>& counts) {
  const std::vector<std::vector<analysis::Choice>> one{choices(counts)};
  return analysis::information_transfer(static_cast<int>(counts.size()), one);
}

}  // namespace

TEST_CASE("Perfect answers carry all bits, swapped ones too, and independent ones nothing") {
  CHECK(of({{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 3}}).raw.value() ==
        Approx(2.0).margin(1e-12));
  CHECK(of({{0, 4}, {4, 0}}).raw.value() == Approx(1.0).margin(1e-12));
  CHECK(of({{2, 4}, {3, 6}}).raw.value() == Approx(0.0).margin(1e-12));
}

// Expected values: sum of p log2(p / (p_row p_column)) and (K - 1)^2 / (2 n ln 2) in NumPy.
TEST_CASE("information_transfer gives hand-made examples") {
  const analysis::InformationTransfer two = of({{8, 2}, {3, 7}});
  CHECK(two.raw.value() == Approx(0.19116495692878083).margin(1e-12).epsilon(0));
  CHECK(two.corrected.value() == Approx(0.15509758090655673).margin(1e-12).epsilon(0));
  const analysis::InformationTransfer three = of({{5, 0, 0}, {1, 3, 1}, {0, 2, 3}});
  CHECK(three.raw.value() == Approx(0.7849625007211563).margin(1e-12).epsilon(0));
  CHECK(three.corrected.value() == Approx(0.5926031619359611).margin(1e-12).epsilon(0));
}

TEST_CASE("The null mean approaches the mean over all deals of the answers") {
  // Two and two among two classes: of six deals two carry a bit, the others nothing.
  const std::vector<std::vector<analysis::Choice>> one{choices({{2, 0}, {0, 2}})};
  const double mean = analysis::information_transfer(2, one, 0, 20000).null_mean.value();
  CHECK(mean == Approx(1.0 / 3.0).margin(4.0 * std::sqrt(2.0 / 9.0 / 20000.0)));
}

TEST_CASE("The null mean of 25 balanced trials of five classes is the known bias") {
  // 0.61469 +- 0.15331 over 20,000 random permutations in NumPy; four standard errors of our 500.
  const std::vector<std::vector<int>> perfect{
      {5, 0, 0, 0, 0}, {0, 5, 0, 0, 0}, {0, 0, 5, 0, 0}, {0, 0, 0, 5, 0}, {0, 0, 0, 0, 5}};
  CHECK(of(perfect).null_mean.value() ==
        Approx(0.61469).margin(4.0 * 0.15331 / std::sqrt(500.0)).epsilon(0));
}

TEST_CASE("Answers are permuted only within a participant") {
  // Each participant always gives the same answer, so no deal within a participant changes
  // anything.
  const std::vector<std::vector<analysis::Choice>> two{{{0, 0}, {0, 0}}, {{1, 1}, {1, 1}}};
  const analysis::InformationTransfer transfer = analysis::information_transfer(2, two);
  CHECK(transfer.raw.value() == Approx(1.0).margin(1e-12));
  CHECK(transfer.null_mean.value() == Approx(1.0).margin(1e-12));
}

TEST_CASE("Trials without a response do not enter information transfer") {
  const std::vector<std::vector<analysis::Choice>> with{
      {{0, 0}, {1, 1}, {0, std::nullopt}, {1, std::nullopt}}};
  CHECK(analysis::information_transfer(2, with).raw.value() == Approx(1.0).margin(1e-12));
  const std::vector<std::vector<analysis::Choice>> none{{{0, std::nullopt}}};
  CHECK_FALSE(analysis::information_transfer(2, none).raw.has_value());
  CHECK_FALSE(analysis::information_transfer(2, none).null_mean.has_value());
}

TEST_CASE("information_transfer refuses impossible arguments") {
  const std::vector<std::vector<analysis::Choice>> bad{{{0, 5}}};
  CHECK_THROWS_AS(analysis::information_transfer(2, bad), std::invalid_argument);
  CHECK_THROWS_AS(analysis::information_transfer(2, {}, 0, 0), std::invalid_argument);
}

}  // namespace touchtrial
