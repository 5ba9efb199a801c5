#include "analysis/cues/answer_divergence.hpp"

#include "support/catch.hpp"

#include <vector>

namespace touchtrial {
namespace {

using Counts = std::vector<double>;

TEST_CASE("the divergence of equal shares is 0 and of disjoint ones 1 bit") {
  CHECK(analysis::jensen_shannon_bits(Counts{3.0, 1.0}, Counts{6.0, 2.0}) == 0.0);
  CHECK(analysis::jensen_shannon_bits(Counts{4.0, 0.0}, Counts{0.0, 1.0}) == 1.0);
}

TEST_CASE("the divergence of a certainty and an even draw is what the formula gives") {
  // H(3/4, 1/4) - H(1, 0) / 2 - H(1/2, 1/2) / 2
  CHECK(analysis::jensen_shannon_bits(Counts{1.0, 0.0}, Counts{1.0, 1.0}) ==
        Approx(0.311278124459).margin(1e-11));
  CHECK(analysis::jensen_shannon_bits(Counts{1.0, 1.0}, Counts{1.0, 0.0}) ==
        Approx(0.311278124459).margin(1e-11));
}

TEST_CASE("classes that somebody was never presented with do not count") {
  const Counts one{1.0, 0.0, 1.0, 1.0};
  const Counts other{1.0, 1.0, 0.0, 0.0};
  CHECK(analysis::answer_divergence(one, other, 2).value() == Approx(0.311278124459).margin(1e-11));
  CHECK_FALSE(analysis::answer_divergence(Counts(4, 0.0), other, 2));
  const Counts both{1.0, 0.0, 0.0, 1.0};
  CHECK(analysis::answer_divergence(both, one, 2).value() ==
        Approx(0.5 * 0.311278124459).margin(1e-11));
}

}  // namespace
}  // namespace touchtrial
