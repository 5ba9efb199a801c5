#include "analysis/statistics/confusion.hpp"

#include "support/catch.hpp"

#include <stdexcept>

namespace touchtrial {

TEST_CASE("A confusion matrix has presented classes in rows and answers in columns") {
  analysis::ConfusionMatrix confusion(3);
  confusion.add({0, 0});
  confusion.add({0, 2});
  confusion.add({0, 2});
  confusion.add({1, 1});
  CHECK(confusion.count(0, 0) == 1);
  CHECK(confusion.count(0, 2) == 2);
  CHECK(confusion.count(2, 0) == 0);
  CHECK(confusion.presented(0) == 3);
  CHECK(confusion.presented(2) == 0);
  CHECK(confusion.accuracy(0) == analysis::Proportion{3, 1});
  CHECK(confusion.accuracy() == analysis::Proportion{4, 2});
}

TEST_CASE("A trial without a response counts as wrong and stands in its own column") {
  analysis::ConfusionMatrix confusion(2);
  confusion.add({0, 0});
  confusion.add({0, std::nullopt});
  CHECK(confusion.no_response(0) == 1);
  CHECK(confusion.no_response(1) == 0);
  CHECK(confusion.answered() == 1);
  CHECK(confusion.accuracy(0) == analysis::Proportion{2, 1});
}

TEST_CASE("Classes that a confusion matrix does not have are refused") {
  CHECK_THROWS_AS(analysis::ConfusionMatrix(0), std::invalid_argument);
  analysis::ConfusionMatrix confusion(2);
  CHECK_THROWS_AS(confusion.add({2, 0}), std::invalid_argument);
  CHECK_THROWS_AS(confusion.add({0, -1}), std::invalid_argument);
}

TEST_CASE("A percentage of nothing does not exist") {
  CHECK(analysis::percentage(1, 4) == 25.0);
  CHECK_FALSE(analysis::percentage(0, 0).has_value());
}

}  // namespace touchtrial
