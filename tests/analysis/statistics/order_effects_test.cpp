#include "analysis/statistics/order_effects.hpp"

#include "support/catch.hpp"

#include <array>
#include <stdexcept>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::analysis;

namespace {

using Participants = std::vector<std::vector<FeltBlock>>;

constexpr int kDraws = 9999;

/// Trials that all move, one after another, with places from 1.
FeltBlock block_of(const std::vector<std::array<int, 2>>& presented_and_answered) {
  FeltBlock block;
  for (const auto& [presented, answered] : presented_and_answered) {
    FeltTrial trial{presented, answered, !block.empty()};
    trial.place = static_cast<double>(block.size()) + 1.0;
    block.push_back(trial);
  }
  return block;
}

/// 25 trials of five classes in order; each answer is `answer_to(class, answer before)`.
template <typename AnswerTo>
FeltBlock answers_by(AnswerTo answer_to) {
  std::vector<std::array<int, 2>> trials;
  for (int i = 0; i < 25; ++i) {
    const int presented = (3 * i + i / 5) % 5;
    const int before = trials.empty() ? -1 : trials.back()[0];
    trials.push_back({presented, answer_to(i, presented, before)});
  }
  return block_of(trials);
}

}  // namespace

TEST_CASE("the slope is that of least squares, and its p that of all orders") {
  // Right answers last: of the six orders of two right and two wrong answers, two are as steep.
  const Participants one = {{block_of({{0, 1}, {1, 0}, {0, 0}, {1, 1}})}};
  const OrderEffects found = *order_effects(one, {}, kDraws);
  CHECK(*found.slope.mean == Approx(0.4));
  CHECK(*found.slope_p == Approx(2.0 / 6.0).margin(0.02));
  CHECK(found.draws == kDraws);
  // SciPy 1.10, stats.linregress.
  const Participants six = {{block_of({{0, 1}, {1, 1}, {0, 1}, {1, 1}, {0, 0}, {1, 1}})}};
  CHECK(*order_effects(six, {}, 1)->slope.mean == Approx(0.17142857142857143));
}

TEST_CASE("a slope is within blocks: a difference between blocks is none") {
  const Participants one = {{block_of({{0, 1}, {1, 0}}), block_of({{0, 0}, {1, 1}})}};
  const OrderEffects found = *order_effects(one, {}, kDraws);
  CHECK(*found.slope.mean == 0.0);
  CHECK(*found.slope_p == 1.0);
}

TEST_CASE("wrong answers that name what came before are counted, and those at random expected") {
  // Every fourth answer names the texture before.
  const auto drawn = [](int i, int presented, int before) {
    return i % 4 == 3 ? before : presented;
  };
  const OrderEffects found = *order_effects(Participants(6, {answers_by(drawn)}), {}, kDraws);
  CHECK(found.class_before.wrong == 36);
  CHECK(found.class_before.same == 36);
  // A wrong answer is not the first in 24 of 25 orders; 5 of the other 24 presentations are of the
  // class that it names.
  CHECK(found.class_before.expected == Approx(36.0 * 24.0 / 25.0 * 5.0 / 24.0).margin(0.1));
  CHECK(*found.class_before.p == Approx(2.0 / (kDraws + 1)));
}

TEST_CASE("answers that never name what came before have as small a p as those that always do") {
  const auto driven = [](int i, int presented, int before) {
    return i % 2 == 0                      ? presented
           : (before + 1) % 5 == presented ? (before + 2) % 5
                                           : (before + 1) % 5;
  };
  const OrderEffects found = *order_effects(Participants(6, {answers_by(driven)}), {}, kDraws);
  CHECK(found.class_before.same == 0);
  CHECK(found.class_before.expected > 5.0);
  CHECK(*found.class_before.p <= 0.01);
}

TEST_CASE("a trial that does not move may come before, but is not counted") {
  FeltBlock block = block_of({{1, 1}, {0, 1}, {0, 0}});
  block[0].moves = false;  // a lead-in
  const OrderEffects found = *order_effects(Participants{{block}}, {}, kDraws);
  CHECK(found.class_before.wrong == 1);
  CHECK(found.class_before.same == 1);
  // In half of the orders the wrong answer comes after the right one of the other class.
  CHECK(found.class_before.expected == Approx(0.5).margin(0.03));
  block[1].follows = false;  // the break of a block
  CHECK(order_effects(Participants{{block}}, {}, 1)->class_before.wrong == 0);
  CHECK_FALSE(order_effects(Participants{{block}}, {}, 1)->class_before.p.has_value());
}

TEST_CASE("orders are those of the design") {
  // The classes alternate, whichever comes first; the only wrong answer names the other class,
  // which is always before it, unless it comes first.
  const Participants one = {{block_of({{0, 0}, {1, 0}, {0, 0}, {1, 1}})}};
  const ClassRedraw alternating = [](std::size_t, int draw) {
    return draw % 2 == 0 ? std::vector<int>{0, 1, 0, 1} : std::vector<int>{1, 0, 1, 0};
  };
  CHECK(order_effects(one, alternating, kDraws)->class_before.expected ==
        Approx(0.75).margin(0.02));
  // Of all orders, half of the other trials are of that class.
  CHECK(order_effects(one, {}, kDraws)->class_before.expected ==
        Approx(0.75 * 2.0 / 3.0).margin(0.02));
  // Where a drawn order does not have the classes, the block stays as it was.
  const ClassRedraw others = [](std::size_t, int) { return std::vector<int>{0, 0, 0, 0}; };
  CHECK(order_effects(one, others, kDraws)->class_before.expected == 1.0);
  CHECK(*order_effects(one, others, kDraws)->class_before.p == 1.0);
}

TEST_CASE("a catch trial and a missing answer are followed by nothing that can be repeated") {
  FeltBlock block = block_of({{0, 0}, {1, 0}, {1, 0}});
  block[0].presented.reset();
  block[0].answered.reset();
  block[0].moves = false;
  block[1].answered.reset();
  const OrderEffects found = *order_effects(Participants{{block}}, {}, 1);
  CHECK(found.class_before.wrong == 1);  // only the last trial follows a class
  CHECK(found.answer_before.wrong == 0);
  CHECK_FALSE(found.answer_before.p.has_value());
}

TEST_CASE("order effects need trials, draws and classes") {
  CHECK_FALSE(order_effects({}, {}, 1).has_value());
  const Participants one = {{block_of({{0, 0}, {1, 1}})}};
  CHECK_THROWS_AS(order_effects(one, {}, 0), std::invalid_argument);
  CHECK_THROWS_AS(order_effects(Participants{{block_of({{-1, 0}})}}, {}, 1), std::invalid_argument);
  const ClassRedraw shorter = [](std::size_t, int) { return std::vector<int>{0}; };
  CHECK_THROWS_AS(order_effects(one, shorter, 1), std::invalid_argument);
  // One trial has no slope.
  const OrderEffects single = *order_effects(Participants{{block_of({{0, 0}})}}, {}, 1);
  CHECK_FALSE(single.slope.mean.has_value());
  CHECK_FALSE(single.slope_p.has_value());
}
