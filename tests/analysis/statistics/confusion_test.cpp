#include "analysis/statistics/confusion.hpp"

#include "analysis/confusion_of_counts.hpp"
#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <vector>

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
  CHECK(confusion.answered(2) == 2);
  CHECK(confusion.answered(1) == 1);
  CHECK(confusion.accuracy(0) == analysis::Proportion{3, 1});
  CHECK(confusion.accuracy() == analysis::Proportion{4, 2});
}

TEST_CASE("Trials that are alike count the same at once as one by one") {
  analysis::ConfusionMatrix at_once(2);
  at_once.add({0, 1}, 3);
  at_once.add({1, std::nullopt}, 2);
  at_once.add({1, 1}, 0);
  analysis::ConfusionMatrix one_by_one(2);
  for (int i = 0; i < 3; ++i) one_by_one.add({0, 1});
  for (int i = 0; i < 2; ++i) one_by_one.add({1, std::nullopt});
  CHECK(at_once == one_by_one);
}

TEST_CASE("A trial without a response counts as wrong and stands in its own column") {
  analysis::ConfusionMatrix confusion(2);
  confusion.add({0, 0});
  confusion.add({0, std::nullopt});
  CHECK(confusion.no_response(0) == 1);
  CHECK(confusion.no_response(1) == 0);
  CHECK(confusion.answered() == 1);
  CHECK(confusion.answered(0) == 1);
  CHECK(confusion.accuracy(0) == analysis::Proportion{2, 1});
}

TEST_CASE("Classes that a confusion matrix does not have are refused") {
  CHECK_THROWS_AS(analysis::ConfusionMatrix(0), std::invalid_argument);
  analysis::ConfusionMatrix confusion(2);
  CHECK_THROWS_AS(confusion.add({2, 0}), std::invalid_argument);
  CHECK_THROWS_AS(confusion.add({0, -1}), std::invalid_argument);
}

TEST_CASE("A confusion matrix made from choices is the one that they are added to") {
  const std::vector<analysis::Choice> choices{{0, 1}, {1, 1}, {1, std::nullopt}};
  analysis::ConfusionMatrix added(2);
  for (const analysis::Choice& choice : choices) added.add(choice);
  CHECK(analysis::ConfusionMatrix(2, choices) == added);
  CHECK_THROWS_AS(analysis::ConfusionMatrix(1, choices), std::invalid_argument);
}

TEST_CASE("A percentage of nothing does not exist") {
  CHECK(analysis::percentage(1, 4) == 25.0);
  CHECK_FALSE(analysis::percentage(0, 0).has_value());
}

namespace {

analysis::ConfusionMatrix random_matrix(int classes, int trials, RandomStream& random) {
  analysis::ConfusionMatrix confusion(classes);
  for (int i = 0; i < trials; ++i) {
    confusion.add(
        {static_cast<int>(random.below(classes)), static_cast<int>(random.below(classes))});
  }
  return confusion;
}

int trials_of(const analysis::ConfusionMatrix& confusion, const std::vector<int>& answer_of) {
  int trials = 0;
  for (int i = 0; i < confusion.classes(); ++i) trials += confusion.count(i, answer_of[i]);
  return trials;
}

int kept(const std::vector<int>& answer_of) {
  int same = 0;
  for (std::size_t i = 0; i < answer_of.size(); ++i) same += answer_of[i] == static_cast<int>(i);
  return same;
}

}  // namespace

TEST_CASE("best_label_matching finds the most trials of all K! matchings, labels kept in a tie") {
  RandomStream random(1, "label matching test");
  for (int round = 0; round < 120; ++round) {
    const int classes = 2 + round % 5;
    const analysis::ConfusionMatrix confusion = random_matrix(classes, 3 * classes, random);
    const analysis::LabelMatching best = analysis::best_label_matching(confusion);
    REQUIRE(best.accuracy.correct == trials_of(confusion, best.answer_of));
    std::vector<int> any(classes);
    std::iota(any.begin(), any.end(), 0);
    REQUIRE(std::is_permutation(any.begin(), any.end(), best.answer_of.begin()));
    do {
      const int trials = trials_of(confusion, any);
      REQUIRE(trials <= best.accuracy.correct);
      if (trials == best.accuracy.correct) REQUIRE(kept(any) <= kept(best.answer_of));
    } while (std::next_permutation(any.begin(), any.end()));
  }
}

TEST_CASE("best_label_matching keeps the labels where no trial decides") {
  const analysis::LabelMatching best = analysis::best_label_matching(analysis::ConfusionMatrix(4));
  CHECK(best.answer_of == std::vector<int>{0, 1, 2, 3});
  CHECK(best.accuracy == analysis::Proportion{0, 0});
  CHECK(analysis::best_label_matching(analysis::ConfusionMatrix(1)).answer_of ==
        std::vector<int>{0});
}

TEST_CASE("best_label_matching counts trials without a response as wrong") {
  analysis::ConfusionMatrix confusion(2);
  confusion.add({0, 1});
  confusion.add({1, 0});
  confusion.add({1, {}});
  const analysis::LabelMatching best = analysis::best_label_matching(confusion);
  CHECK(best.accuracy == analysis::Proportion{3, 2});
  CHECK(best.answer_of == std::vector<int>{1, 0});
}

TEST_CASE("best_label_matching of twelve classes undoes any exchange") {
  RandomStream random(2, "label matching test");
  std::vector<int> exchange(12);
  std::iota(exchange.begin(), exchange.end(), 0);
  shuffle(std::span(exchange), random);
  analysis::ConfusionMatrix confusion(12);
  for (int i = 0; i < 12; ++i) {
    for (int k = 0; k < 3; ++k) confusion.add({i, exchange[i]});
  }
  const analysis::LabelMatching best = analysis::best_label_matching(confusion);
  CHECK(best.answer_of == exchange);
  CHECK(best.accuracy == analysis::Proportion{36, 36});
}

TEST_CASE("The p of swapped labels is that of fair coins, times the exchanges of as many labels") {
  const auto p_of = [](const std::vector<std::vector<int>>& counts) {
    const analysis::ConfusionMatrix confusion = confusion_of_counts(counts);
    return analysis::label_swap_p(confusion, analysis::best_label_matching(confusion));
  };
  CHECK(p_of({{0, 5, 0}, {5, 0, 0}, {0, 0, 5}}) == Approx(1.0 / 1024.0).epsilon(1e-12));
  // Nine of ten that agree with either: (10 + 1) / 1024. Answers to the third class do not count.
  CHECK(p_of({{1, 4, 0}, {5, 0, 0}, {2, 2, 1}}) == Approx(11.0 / 1024.0).epsilon(1e-12));
  // Two orders of three labels leave none in its place.
  CHECK(p_of({{0, 5, 0}, {0, 0, 5}, {5, 0, 0}}) == Approx(2.0 / 32768.0).epsilon(1e-12));
  // Nine orders of four.
  CHECK(p_of({{0, 3, 0, 0}, {3, 0, 0, 0}, {0, 0, 0, 3}, {0, 0, 3, 0}}) ==
        Approx(9.0 / 4096.0).epsilon(1e-12));
  CHECK(p_of({{0, 1}, {1, 0}}) == 0.25);
  CHECK(p_of({{5, 0}, {0, 5}}) == 1.0);
  CHECK(p_of({{0, 0}, {0, 0}}) == 1.0);
}

TEST_CASE("An unbiased hit rate is not raised by giving one answer every time") {
  const analysis::ConfusionMatrix fair = confusion_of_counts({{4, 1}, {2, 3}});
  CHECK(*analysis::unbiased_hit_rate(fair, 0) == Approx(4.0 / 5.0 * 4.0 / 6.0));
  CHECK(*analysis::unbiased_hit_rate(fair, 1) == Approx(3.0 / 5.0 * 3.0 / 4.0));
  const analysis::ConfusionMatrix stubborn = confusion_of_counts({{5, 0}, {5, 0}});
  CHECK(*analysis::unbiased_hit_rate(stubborn, 0) == Approx(0.5));
  CHECK(analysis::unbiased_hit_rate(stubborn, 1) == 0.0);
  analysis::ConfusionMatrix silent(3);
  silent.add({0, std::nullopt});
  CHECK(analysis::unbiased_hit_rate(silent, 0) == 0.0);
  CHECK(analysis::unbiased_hit_rate_by_chance(silent, 0) == 0.0);
  CHECK_FALSE(analysis::unbiased_hit_rate(silent, 1));
  CHECK_FALSE(analysis::unbiased_hit_rate_by_chance(silent, 1));
}

TEST_CASE("By chance an unbiased hit rate is its mean over all orders of the presentations") {
  std::vector<int> presented = {0, 0, 1, 1, 1, 2};
  const std::vector<std::optional<int>> answered = {0, 1, 0, std::nullopt, 1, 0};
  analysis::ConfusionMatrix first(3);
  for (std::size_t i = 0; i < presented.size(); ++i) first.add({presented[i], answered[i]});
  for (int of = 0; of < 3; ++of) {
    double sum = 0.0;
    int orders = 0;
    std::ranges::sort(presented);
    do {
      analysis::ConfusionMatrix one(3);
      for (std::size_t i = 0; i < presented.size(); ++i) one.add({presented[i], answered[i]});
      sum += *analysis::unbiased_hit_rate(one, of);
      ++orders;
    } while (std::ranges::next_permutation(presented).found);
    CHECK(*analysis::unbiased_hit_rate_by_chance(first, of) == Approx(sum / orders));
  }
}

}  // namespace touchtrial
