
#include "core/errors.hpp"
#include "study/order_test_support.hpp"
#include "study/protocol.hpp"
#include "study/random_orders.hpp"
#include "study/study_examples.hpp"
#include "support/catch.hpp"

#include <set>
#include <utility>

namespace touchtrial {
namespace {

using nlohmann::json;

study::Study seeded(json document, std::uint64_t seed) {
  document["seed"] = seed;
  return parsed(document);
}

std::string rule_of(const study::Study& study) {
  return study.task->rule(study);
}

std::vector<int> classes_of(const study::Schedule& schedule) {
  std::vector<int> classes;
  for (const study::Trial& shown : schedule.trials) {
    classes.push_back(shown.field().class_index);
  }
  return classes;
}

/// How often each class and method is scored.
std::map<std::pair<int, int>, int> scored_counts(const study::Schedule& schedule) {
  std::map<std::pair<int, int>, int> counts;
  for (const study::Trial& shown : schedule.trials) {
    if (shown.role == study::Role::lead_in) continue;
    ++counts[{shown.field().class_index, shown.field().method}];
  }
  return counts;
}

}  // namespace

TEST_CASE("schedules of seed 31875542 are the same on every platform") {
  const study::Study study = seeded(study_of(5), 31875542);
  const study::Schedule first = schedule_of(study, 1);
  CHECK(classes_of(first) == std::vector<int>{4, 4, 4, 3, 2, 2, 0, 1, 1, 2, 0, 4, 4,
                                              3, 0, 3, 2, 2, 0, 3, 1, 0, 1, 1, 3});
  CHECK(first.layout == std::vector<int>{4, 2, 1, 0, 3});
  const study::Schedule twentieth = schedule_of(study, 20);
  CHECK(classes_of(twentieth) == std::vector<int>{1, 4, 3, 0, 4, 2, 1, 3, 2, 4, 2, 4, 0,
                                                  3, 1, 3, 1, 2, 4, 3, 0, 2, 1, 0, 0});
  CHECK(twentieth.layout == std::vector<int>{1, 4, 0, 2, 3});
}

TEST_CASE("orders de-bruijn and uniform, lead-ins and exemplars are the same on every platform") {
  json document = study_of(3, 3);
  document["trials"] = {{"order", "de-bruijn"}, {"repeats", 3}};
  const study::Schedule cycle = schedule_of(seeded(document, 7), 2);
  CHECK(classes_of(cycle) == std::vector<int>{0, 2, 1, 1, 0, 1, 2, 2, 0, 0});
  std::vector<int> exemplars;
  for (const study::Trial& shown : cycle.trials) {
    exemplars.push_back(shown.field().exemplar);
  }
  CHECK(exemplars == std::vector<int>{1, 0, 1, 2, 0, 0, 2, 1, 2, 0});
  document["trials"] = {{"order", "uniform"}, {"repeats", 3}, {"lead_in", 2}};
  CHECK(classes_of(schedule_of(seeded(document, 7), 2)) ==
        std::vector<int>{2, 1, 2, 2, 2, 2, 2, 0, 1, 1, 2});
}

TEST_CASE("a shuffled schedule presents every class equally often to every participant") {
  const study::Study study = seeded(study_of(5), 3);
  for (int enrolment = 1; enrolment <= 50; ++enrolment) {
    const study::Schedule schedule = schedule_of(study, enrolment);
    REQUIRE(schedule.trials.size() == 25);
    for (std::size_t i = 0; i < 25; ++i) {
      CHECK(schedule.trials[i].place.trial == static_cast<int>(i) + 1);
      CHECK(schedule.trials[i].role == study::Role::scored);
    }
    const auto counts = scored_counts(schedule);
    CHECK(counts.size() == 5);
    for (const auto& [item, count] : counts) CHECK(count == 5);
  }
}

TEST_CASE("each order of two classes twice is equally likely over enrolments") {
  json document = study_of(2);
  document["trials"] = {{"repeats", 2}};
  const study::Study study = seeded(document, 11);
  std::map<std::vector<int>, int> counts;
  for (int enrolment = 1; enrolment <= 6000; ++enrolment) {
    ++counts[classes_of(schedule_of(study, enrolment))];
  }
  CHECK(counts.size() == 6);                    // 4! / (2! 2!)
  CHECK(chi_square_uniform(counts, 6) < 35.9);  // 99.9999 % with 5 degrees of freedom
}

TEST_CASE("each layout of four pictures is equally likely over enrolments") {
  const study::Study study = seeded(study_of(4), 12);
  std::map<std::vector<int>, int> counts;
  for (int enrolment = 1; enrolment <= 4800; ++enrolment) {
    ++counts[schedule_of(study, enrolment).layout];
  }
  CHECK(counts.size() == 24);
  CHECK(chi_square_uniform(counts, 24) < 69.0);  // 99.9999 % with 23 degrees of freedom
}

TEST_CASE("uniform draws have the same number of trials, each class equally likely at each") {
  json document = study_of(4);
  document["trials"] = {{"order", "uniform"}, {"repeats", 2}};
  const study::Study study = seeded(document, 13);
  std::map<std::pair<int, int>, int> first_and_last;
  bool unbalanced = false;
  for (int enrolment = 1; enrolment <= 3200; ++enrolment) {
    const study::Schedule schedule = schedule_of(study, enrolment);
    REQUIRE(schedule.trials.size() == 8);
    const std::vector<int> classes = classes_of(schedule);
    ++first_and_last[{classes.front(), classes.back()}];
    unbalanced = unbalanced || scored_counts(schedule) != scored_counts(schedule_of(study, 1));
  }
  CHECK(first_and_last.size() == 16);
  CHECK(chi_square_uniform(first_and_last, 16) < 55.5);  // 99.9999 %, 15 degrees of freedom
  CHECK(unbalanced);
}

TEST_CASE("a de-bruijn schedule has every transition once, after one lead-in") {
  json document = study_of(5);
  document["trials"] = {{"order", "de-bruijn"}, {"repeats", 5}};
  const study::Study study = seeded(document, 14);
  std::set<std::vector<int>> orders;
  for (int enrolment = 1; enrolment <= 30; ++enrolment) {
    const study::Schedule schedule = schedule_of(study, enrolment);
    REQUIRE(schedule.trials.size() == 26);
    const std::vector<int> classes = classes_of(schedule);
    orders.insert(classes);
    std::set<std::pair<int, int>> transitions;
    for (std::size_t i = 1; i < classes.size(); ++i) {
      transitions.emplace(classes[i - 1], classes[i]);
      CHECK(schedule.trials[i].role == study::Role::scored);
    }
    CHECK(transitions.size() == 25);
    CHECK(schedule.trials[0].role == study::Role::lead_in);
    for (const auto& [item, count] : scored_counts(schedule)) CHECK(count == 5);
  }
  CHECK(orders.size() == 30);
}

TEST_CASE("an impossible order is refused when the schedule is made") {
  study::Study study = seeded(study_of(5), 1);
  study.trials.order = study::TrialOrder::de_bruijn;
  study.trials.repeats = 4;
  CHECK_THROWS_AS(schedule_of(study, 1), StudyError);
}

TEST_CASE("lead-ins open each block, are not scored, and leave the scored order as it was") {
  json document = comparison_of(4);
  const study::Schedule without = schedule_of(seeded(document, 15), 3);
  document["trials"] = {{"lead_in", 2}};
  const study::Schedule with = schedule_of(seeded(document, 15), 3);
  REQUIRE(with.trials.size() == without.trials.size() + 4);
  std::vector<study::StimulusIndex> scored;
  for (std::size_t i = 0; i < with.trials.size(); ++i) {
    const study::Trial& shown = with.trials[i];
    const bool opens_block = i % 22 < 2;
    CHECK((shown.role == study::Role::lead_in) == opens_block);
    CHECK(shown.place.block == static_cast<int>(i) / 22);
    if (!opens_block) scored.push_back(shown.field());
  }
  std::vector<study::StimulusIndex> expected;
  for (const study::Trial& shown : without.trials) expected.push_back(shown.field());
  CHECK(scored == expected);
}

TEST_CASE("blocks by method follow the Williams row of the enrolment") {
  const study::Study study = seeded(comparison_of(4), 16);
  for (int enrolment = 1; enrolment <= 6; ++enrolment) {
    const study::Schedule schedule = schedule_of(study, enrolment);
    const std::vector<int> row = study::williams_row(2, enrolment);
    for (const study::Trial& shown : schedule.trials) {
      CHECK(shown.field().method == row[static_cast<std::size_t>(shown.place.block)]);
    }
    for (const auto& [item, count] : scored_counts(schedule)) CHECK(count == 5);
  }
}

TEST_CASE("methods of one participant have orders of their own") {
  const study::Schedule schedule = schedule_of(seeded(comparison_of(4), 17), 1);
  const std::vector<int> classes = classes_of(schedule);
  CHECK(std::vector<int>(classes.begin(), classes.begin() + 20) !=
        std::vector<int>(classes.begin() + 20, classes.end()));
}

TEST_CASE("a mixed block has every class and method equally often, interleaved") {
  json document = comparison_of(4);
  document["trials"] = {{"blocks", "mixed"}};
  const study::Schedule schedule = schedule_of(seeded(document, 18), 1);
  REQUIRE(schedule.trials.size() == 40);
  const auto counts = scored_counts(schedule);
  CHECK(counts.size() == 8);
  for (const auto& [item, count] : counts) CHECK(count == 5);
  int changes = 0;
  for (std::size_t i = 1; i < 40; ++i) {
    CHECK(schedule.trials[i].place.block == 0);
    const auto& [before, now] = std::pair(schedule.trials[i - 1], schedule.trials[i]);
    changes += before.field().method != now.field().method ? 1 : 0;
  }
  CHECK(changes > 5);
}

TEST_CASE("all images of a class are used before any repeats, for each method anew") {
  json document = comparison_of(3, 4);
  document["trials"] = {{"repeats", 10}};
  const study::Study study = seeded(document, 19);
  std::set<std::vector<int>> decks;
  for (int enrolment = 1; enrolment <= 10; ++enrolment) {
    std::map<std::pair<int, int>, std::vector<int>> dealt;
    for (const study::Trial& shown : schedule_of(study, enrolment).trials) {
      dealt[{shown.field().class_index, shown.field().method}].push_back(shown.field().exemplar);
    }
    CHECK(dealt.size() == 6);
    for (const auto& [item, exemplars] : dealt) {
      REQUIRE(exemplars.size() == 10);
      const std::set<int> first(exemplars.begin(), exemplars.begin() + 4);
      const std::set<int> second(exemplars.begin() + 4, exemplars.begin() + 8);
      CHECK(first == std::set<int>{0, 1, 2, 3});
      CHECK(second == first);
      CHECK(exemplars[8] != exemplars[9]);
      decks.insert(exemplars);
    }
  }
  CHECK(decks.size() > 50);
}

TEST_CASE("the number of images does not change which classes come when") {
  const study::Schedule one = schedule_of(seeded(study_of(4, 1), 20), 5);
  const study::Schedule many = schedule_of(seeded(study_of(4, 6), 20), 5);
  CHECK(classes_of(one) == classes_of(many));
  CHECK(one.layout == many.layout);
}

TEST_CASE("a schedule depends on seed and enrolment") {
  const study::Study study = seeded(study_of(5), 21);
  CHECK(schedule_of(study, 4) == schedule_of(study, 4));
  CHECK_FALSE(schedule_of(study, 4) == schedule_of(study, 5));
  CHECK_FALSE(schedule_of(study, 4) == schedule_of(seeded(study_of(5), 22), 4));
}

TEST_CASE("a schedule does not depend on names, rendering or methods that are not presented") {
  json document = study_of(5);
  const study::Schedule before = schedule_of(seeded(document, 23), 4);
  document["study"] = "renamed";
  document["classes"][0]["label"] = "other";
  document["rendering"] = {{"pitch_mm", 0.1}};
  document["methods"].push_back({{"name", "tv-gabor"}});
  CHECK(schedule_of(seeded(document, 23), 4) == before);
}

TEST_CASE("a Williams design has each method in each place, and after each other, equally often") {
  for (int methods = 1; methods <= 9; ++methods) {
    const int rows = methods % 2 == 0 ? methods : 2 * methods;
    std::map<std::pair<int, int>, int> places;
    std::map<std::pair<int, int>, int> neighbours;
    for (int enrolment = 1; enrolment <= rows; ++enrolment) {
      const std::vector<int> row = study::williams_row(methods, enrolment);
      REQUIRE(row.size() == static_cast<std::size_t>(methods));
      for (int i = 0; i < methods; ++i) ++places[{i, row[static_cast<std::size_t>(i)]}];
      for (std::size_t i = 1; i < row.size(); ++i) ++neighbours[{row[i - 1], row[i]}];
    }
    INFO(methods << " methods");
    CHECK(places.size() == static_cast<std::size_t>(methods) * methods);
    for (const auto& [place, count] : places) CHECK(count == rows / methods);
    CHECK(neighbours.size() == static_cast<std::size_t>(methods) * (methods - 1));
    for (const auto& [pair, count] : neighbours) CHECK(count == rows / methods);
  }
}

TEST_CASE("williams_row follows the published square of four") {
  CHECK(study::williams_row(4, 4) == std::vector<int>{0, 1, 3, 2});
  CHECK(study::williams_rows(4) == 4);
  CHECK(study::williams_rows(3) == 6);
  CHECK_THROWS_AS(study::williams_rows(0), std::invalid_argument);
  CHECK(study::williams_row(4, 1) == std::vector<int>{1, 2, 0, 3});
  CHECK(study::williams_row(4, 5) == study::williams_row(4, 1));
  CHECK(study::williams_row(3, 3) == std::vector<int>{2, 1, 0});
  CHECK_THROWS_AS(study::williams_row(0, 1), std::invalid_argument);
}

TEST_CASE("the schedule rule names everything that decides a schedule but the seed") {
  const std::string rule = rule_of(seeded(study_of(5), 1));
  CHECK(rule == rule_of(seeded(study_of(5), 2)));
  CHECK(rule.find("touchtrial schedule 2: ") == 0);
  CHECK(rule.find("classes=5; exemplars=1,1,1,1,1; methods=1; repeats=5; order=shuffled; "
                  "blocks=by-method; lead_in=0") != std::string::npos);
  std::set<std::string> rules = {rule, rule_of(parsed(study_of(4))),
                                 rule_of(parsed(study_of(5, 2))),
                                 rule_of(parsed(comparison_of(5)))};
  const json changes = {{"repeats", 4}, {"order", "uniform"}, {"blocks", "mixed"}, {"lead_in", 1}};
  for (const auto& [key, value] : changes.items()) {
    json document = study_of(5);
    document["trials"][key] = value;
    rules.insert(rule_of(parsed(document)));
  }
  CHECK(rules.size() == 8);
}

}  // namespace touchtrial
