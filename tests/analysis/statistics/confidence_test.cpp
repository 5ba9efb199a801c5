// Reference: SciPy 1.10 (stats.mannwhitneyu, divided by the number of pairs).
#include "analysis/statistics/d_prime.hpp"
#include "support/catch.hpp"

#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;

TEST_CASE("a type-2 area is how often a right answer was rated higher than a wrong one") {
  const std::vector<RatedAnswer> answers = {{3, true},  {1, false}, {4, true}, {4, true},
                                            {2, false}, {2, true},  {4, false}};
  CHECK(*type_2_area(answers) == Approx(8.5 / 12.0));
  CHECK(*type_2_area(std::vector<RatedAnswer>{{2, true}, {1, false}}) == 1.0);
  CHECK(*type_2_area(std::vector<RatedAnswer>{{1, true}, {2, false}}) == 0.0);
  CHECK(*type_2_area(std::vector<RatedAnswer>{{5, true}, {5, false}}) == 0.5);
}

TEST_CASE("a type-2 area needs a right and a wrong answer") {
  CHECK_FALSE(type_2_area({}));
  CHECK_FALSE(type_2_area(std::vector<RatedAnswer>{{1, true}, {2, true}}));
  CHECK_FALSE(type_2_area(std::vector<RatedAnswer>{{1, false}}));
}
