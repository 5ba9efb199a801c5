// References: R 4.2 (qbeta, pbinom).
#include "analysis/choices/answers.hpp"
#include "analysis/choices/people_report.hpp"
#include "analysis/choices/preferences.hpp"
#include "core/random.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <deque>
#include <numeric>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using namespace choices;

/// People and their answers. The trials must not be copied, because people refer to them.
class MadePeople {
 public:
  MadePeople() = default;
  MadePeople(const MadePeople&) = delete;
  MadePeople& operator=(const MadePeople&) = delete;

  void person() { people.push_back({"P" + std::to_string(people.size() + 1), {}}); }
  /// Of the last person.
  void answer(int target, int response, int times = 1, std::optional<int> place = std::nullopt) {
    for (int i = 0; i < times; ++i) {
      TrialOutcome& trial = trials_.emplace_back();
      trial.row.session = static_cast<int>(people.size());
      trial.right = target;
      trial.response = response;
      if (place) trial.row.answer = ChoiceAnswer{*place};
      people.back().trials.push_back(&trial);
    }
  }
  /// Somebody with these right answers of `n`; targets in turn.
  void right_of(int right, int n) {
    person();
    for (int i = 0; i < n; ++i) answer(i % 2, i < right ? i % 2 : 1 - i % 2);
  }

  std::vector<Person> people;

 private:
  std::deque<TrialOutcome> trials_;
};

bool every(const TrialOutcome& /*trial*/) {
  return true;
}

GuessingTests guessing_of(const MadePeople& made) {
  return test_against_guessing(made.people, 0.5, every).value();
}

/// In 60 trials right in 48: whoever prefers the first interval is wrong towards it.
void prefers(MadePeople& made, int towards_first) {
  made.person();
  made.answer(0, 0, 24 + (towards_first - 6) / 2);
  made.answer(1, 1, 24 - (towards_first - 6) / 2);
  made.answer(1, 0, towards_first);
  made.answer(0, 1, 12 - towards_first);
}

const std::vector<std::string> kIntervals{"first", "second"};

/// In each of five classes five trials, of which `wrong` name the next class, or `favourite`.
void identifies(MadePeople& made, int wrong, std::optional<int> favourite,
                const std::vector<int>& layout) {
  made.person();
  const auto answer = [&](int target, int response) {
    const auto place = std::ranges::find(layout, response) - layout.begin();
    made.answer(target, response, 1, static_cast<int>(place));
  };
  for (int target = 0; target < 5; ++target) {
    for (int i = 0; i < 5; ++i) {
      const int other = favourite && *favourite != target ? *favourite : (target + 1 + i) % 5;
      answer(target, i < wrong && other != target ? other : target);
    }
  }
}

std::vector<int> layout_from(int first) {
  std::vector<int> layout(5);
  for (int i = 0; i < 5; ++i) layout[static_cast<std::size_t>(i)] = (first + i) % 5;
  return layout;
}

}  // namespace

TEST_CASE("one who hears everything is found among many who guess, whom the pooled number hides") {
  MadePeople made;
  for (int i = 0; i < 11; ++i) made.right_of(10, 20);
  made.right_of(20, 20);
  const GuessingTests answers = guessing_of(made);
  CHECK(answers.pooled.p.value() > 0.1);
  const GlobalNullResult global_null = test_anyone_above_chance(answers, 0.5);
  CHECK(global_null.found());
  CHECK(global_null.alone == 1);
  CHECK(people_above_chance(answers, global_null) == std::vector<std::string>{"P12"});
}

TEST_CASE("whoever stands out by Holm makes it found") {
  MadePeople made;
  for (int i = 0; i < 29; ++i) made.right_of(i % 2 == 0 ? 9 : 10, 20);
  made.right_of(17, 20);
  const GuessingTests answers = guessing_of(made);
  CHECK(answers.people.back().p_holm.value() == Approx(0.0386524200439454).epsilon(1e-9));
  const GlobalNullResult global_null = test_anyone_above_chance(answers, 0.5);
  CHECK(global_null.p <= answers.people.back().p_holm.value());
  CHECK(people_above_chance(answers, global_null) == std::vector<std::string>{"P30"});
}

TEST_CASE("three of twelve with 15 of 20 are found, though none stands out") {
  MadePeople made;
  for (int i = 0; i < 9; ++i) made.right_of(10, 20);
  for (int i = 0; i < 3; ++i) made.right_of(15, 20);
  const GuessingTests answers = guessing_of(made);
  CHECK(answers.people.back().p_holm.value() > 0.2);
  const GlobalNullResult global_null = test_anyone_above_chance(answers, 0.5);
  CHECK(global_null.found());
  CHECK(global_null.alone == 3);
  CHECK(global_null.alone_by_chance == Approx(12 * 0.0206947).margin(0.02));
  CHECK(people_above_chance(answers, global_null).size() == 3);
}

TEST_CASE("everybody a little better than guessing is found, and nobody is named") {
  MadePeople made;
  for (int i = 0; i < 40; ++i) made.right_of(12, 20);
  const GuessingTests answers = guessing_of(made);
  const GlobalNullResult global_null = test_anyone_above_chance(answers, 0.5);
  CHECK(global_null.p < 0.001);
  CHECK(people_above_chance(answers, global_null).empty());
}

TEST_CASE("people who guess are not found, and the same answers give the same p") {
  MadePeople made;
  for (int i = 0; i < 12; ++i) made.right_of(8 + i % 5, 20);
  const GuessingTests answers = guessing_of(made);
  const GlobalNullResult global_null = test_anyone_above_chance(answers, 0.5);
  CHECK(global_null.p > 0.2);
  CHECK(global_null == test_anyone_above_chance(answers, 0.5));
  CHECK(people_above_chance(answers, global_null).empty());
}

TEST_CASE("a block says what it could have found") {
  MadePeople made;
  for (int i = 0; i < 12; ++i) made.right_of(10, 20);
  const DetectableAccuracy found = detectable_accuracy(guessing_of(made), 0.5);
  CHECK(found.trials == 20);
  CHECK(found.right == 17);
  CHECK(found.share.value() == Approx(0.882953171453178).epsilon(1e-9));
  MadePeople few;
  for (int i = 0; i < 12; ++i) few.right_of(4, 6);
  CHECK_FALSE(detectable_accuracy(guessing_of(few), 0.5).share);
  MadePeople one;
  one.right_of(3, 5);
  CHECK(detectable_accuracy(guessing_of(one), 0.5).right == 5);
}

TEST_CASE("one slip in four catch trials is no lack of attention, three among twelve people are") {
  MadePeople made;
  for (int i = 0; i < 10; ++i) made.right_of(4, 4);
  made.right_of(3, 4);
  made.right_of(1, 4);
  const std::vector<Attention> attention = attention_of(guessing_of(made));
  REQUIRE(attention.size() == 12);
  CHECK(attention[0].p == 1.0);
  CHECK(attention[10].p == Approx(0.18549375).epsilon(1e-12));
  CHECK_FALSE(attention[10].is_doubtful());
  CHECK(attention[11].participant == "P12");
  CHECK(attention[11].p == Approx(0.00048125).epsilon(1e-12));
  CHECK(attention[11].p_holm == Approx(12 * 0.00048125).epsilon(1e-12));
  CHECK(attention[11].is_doubtful());
}

TEST_CASE("of values that are all alike p is that of sign flips, and says so") {
  const GroupTest same = group_test(std::vector(5, 0.25));
  CHECK(same.p == 2.0 / 32.0);
  CHECK(same.all_equal);
  CHECK_FALSE(group_test(std::vector{0.2, 0.25, 0.3}).all_equal);
  CHECK_FALSE(group_test(std::vector{0.25}).all_equal);
}

TEST_CASE("preferences for different intervals are found, though they cancel out in the mean") {
  MadePeople made;
  for (int i = 0; i < 6; ++i) prefers(made, 6);
  for (int i = 0; i < 3; ++i) prefers(made, 12);
  for (int i = 0; i < 3; ++i) prefers(made, 0);
  const std::vector<ChoiceUse> use = choice_use_of(made.people, kIntervals, every);
  CHECK(use[0].excess.p.value() == 1.0);
  const Preferences found = preferences_by_target(made.people, 2, every);
  CHECK(found.global_null.found());
  CHECK(found.global_null.alone == 6);
  REQUIRE(found.people_with_preference().size() == 6);
  const Preference& first = found.people[6];
  CHECK(first.choice == 0);
  CHECK(first.answers == 60);
  CHECK(first.named_count == 27 + 12);
  CHECK(first.right_there == analysis::Proportion{27, 27});
  CHECK(first.right_elsewhere == analysis::Proportion{33, 21});
  CHECK(first.p_holm < 0.05);
  CHECK_FALSE(first.place);
  CHECK(found.people[9].choice == 1);
  CHECK(found.people[0].p > 0.5);
  const auto json = nlohmann::json::parse(preferences_json(found, kIntervals));
  CHECK(json.at("anybody").at("found") == true);
  CHECK(json.at("those_who_prefer").size() == 6);
  CHECK(json.at("participants").at(9).at("preferred") == "second");
  CHECK(json.at("participants").at(6).at("right_elsewhere").at("right") == 21);
}

TEST_CASE("a slight preference that all share is found") {
  MadePeople made;
  for (int i = 0; i < 12; ++i) prefers(made, 8);
  const Preferences found = preferences_by_target(made.people, 2, every);
  CHECK(found.global_null.found());
  CHECK(found.global_null.p < 0.01);
  CHECK(found.people_with_preference().empty());
}

TEST_CASE("answers without a preference keep the test's level, in two intervals and in three") {
  for (const int choices : {2, 3}) {
    int found = 0;
    for (int study = 0; study < 200; ++study) {
      RandomStream random(4, "no preference", static_cast<std::uint64_t>(100 * study + choices));
      MadePeople made;
      for (int i = 0; i < 5; ++i) {
        made.person();
        for (int trial = 0; trial < 30; ++trial) {
          const auto m = static_cast<std::uint64_t>(choices);
          const std::uint64_t target = random.below(m);
          const bool right = random.uniform() < 0.7;
          const std::uint64_t response = right ? target : (target + 1 + random.below(m - 1)) % m;
          made.answer(static_cast<int>(target), static_cast<int>(response));
        }
      }
      found += preferences_by_target(made.people, choices, every, 199).global_null.found() ? 1 : 0;
    }
    INFO(choices);
    CHECK(found < 24);  // 10 expected, standard deviation 3.1, and that of 199 deals
  }
}

TEST_CASE("who is always right shows no preference") {
  MadePeople made;
  made.person();
  made.answer(0, 0, 10);
  made.answer(1, 1, 2);
  const Preferences found = preferences_by_target(made.people, 2, every);
  REQUIRE(found.people.size() == 1);
  CHECK(found.people[0].p == 1.0);
  CHECK(found.global_null.people == 0);
  CHECK_FALSE(found.global_null.found());
}

TEST_CASE("who names one picture for all others is found by where the mistakes go") {
  MadePeople made;
  for (int i = 0; i < 7; ++i) identifies(made, 2, std::nullopt, layout_from(i));
  identifies(made, 4, 3, layout_from(2));
  const auto found = answers_by_place(made.people, 5);
  REQUIRE(found);
  CHECK(found->preferences.global_null.found());
  const Preference& one = found->preferences.people.back();
  CHECK(one.choice == 3);
  CHECK(one.place == 1);
  CHECK(one.p_holm < 0.02);
  CHECK(one.right_there.n == 5);
  CHECK(one.right_elsewhere == analysis::Proportion{20, 4});
  CHECK(found->preferences.people_with_preference().size() == 1);
  int named = 0;
  for (const PlaceUse& place : found->places) named += place.named_count;
  CHECK(named == 8 * 25);
}

TEST_CASE("a place that all prefer is told from the picture that lies there") {
  MadePeople made;
  for (int i = 0; i < 10; ++i) identifies(made, 2, i % 5, layout_from(i % 5));
  const auto places = answers_by_place(made.people, 5);
  CHECK(places->p < 0.01);
  CHECK(places->places[0].named_count > 2 * places->places[1].named_count);
  CHECK(places->places[0].excess.mean.mean.value() > 0.2);
  // The same answers, for one picture that lies somewhere else for everybody.
  MadePeople others;
  for (int i = 0; i < 10; ++i) identifies(others, 2, 3, layout_from(i % 5));
  const auto picture = answers_by_place(others.people, 5);
  CHECK(picture->p > 0.5);
  CHECK_FALSE(picture->preferences.global_null.found());
}

TEST_CASE("answers without places, and nobody, have no report by place") {
  MadePeople made;
  CHECK_FALSE(answers_by_place(made.people, 5));
  made.person();
  made.answer(0, 1);
  CHECK_FALSE(answers_by_place(made.people, 5));
}

}  // namespace touchtrial
