/// Limits of runs, Williams blocks, catch trials and restarted blocks in whole schedules.
#include "core/errors.hpp"
#include "study/order_test_support.hpp"
#include "study/protocol.hpp"
#include "study/study_examples.hpp"
#include "study/study_key.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <set>

namespace touchtrial {
namespace {

using nlohmann::json;

study::Study study_with(json document, const json& trials) {
  document["trials"] = trials;
  document["seed"] = 5;
  return parsed(document);
}

std::string rule_of(const study::Study& study) {
  return study.task->rule(study);
}

bool refused(const json& document, const json& trials, const std::string& part) {
  return refuses<StudyError>([&] { return study_with(document, trials); }, part);
}

/// The longest run of a class within a block, catch trials left out.
int longest_run(const std::vector<study::Trial>& trials) {
  int longest = 0;
  int run = 0;
  const study::Trial* before = nullptr;
  for (const study::Trial& shown : trials) {
    if (shown.role == study::Role::catch_trial) continue;
    const bool same = before != nullptr && before->place.block == shown.place.block &&
                      before->field().class_index == shown.field().class_index;
    run = same ? run + 1 : 1;
    longest = std::max(longest, run);
    before = &shown;
  }
  return longest;
}

std::map<study::StimulusIndex, int> scored_counts(const std::vector<study::Trial>& trials) {
  std::map<study::StimulusIndex, int> counts;
  for (const study::Trial& shown : trials) {
    if (shown.role == study::Role::scored) ++counts[shown.field()];
  }
  return counts;
}

std::vector<study::Trial> without_catch(std::vector<study::Trial> trials) {
  std::erase_if(trials,
                [](const study::Trial& shown) { return shown.role == study::Role::catch_trial; });
  for (std::size_t i = 0; i < trials.size(); ++i) {
    trials[i].place.trial = static_cast<int>(i) + 1;
  }
  return trials;
}

std::vector<study::Trial> restarted(const study::Study& study, int enrolment, int block,
                                    int restarts_before, int first_trial) {
  return study::make_order(study, drawn(study, enrolment))
      ->redraw_block(block, restarts_before, first_trial);
}

}  // namespace

TEST_CASE("every schedule keeps the limit of runs and its balance") {
  for (const char* blocks : {"by-method", "mixed"}) {
    for (const int max_run : {1, 2, 3}) {
      const study::Study study = study_with(
          comparison_of(3),
          {{"repeats", 4}, {"max_run", max_run}, {"blocks", blocks}, {"lead_in", 2}, {"catch", 3}});
      for (int enrolment = 1; enrolment <= 50; ++enrolment) {
        const study::Schedule schedule = schedule_of(study, enrolment);
        CHECK(schedule.trials.size() ==
              24 + 2 * (study.trials.blocks == study::Blocks::mixed ? 1 : 2) + 3);
        CHECK(longest_run(schedule.trials) <= max_run);
        const auto counts = scored_counts(schedule.trials);
        CHECK(counts.size() == 6);
        for (const auto& [stimulus, count] : counts) CHECK(count == 4);
      }
    }
  }
}

TEST_CASE("independent draws keep the limit of runs too") {
  const study::Study study =
      study_with(study_of(2), {{"order", "uniform"}, {"repeats", 20}, {"max_run", 2}});
  for (int enrolment = 1; enrolment <= 50; ++enrolment) {
    CHECK(longest_run(schedule_of(study, enrolment).trials) <= 2);
  }
}

TEST_CASE("schedules with limited runs are uniform over all allowed orders") {
  const study::Study study = study_with(study_of(3), {{"repeats", 2}, {"max_run", 1}});
  std::map<std::vector<int>, int> counts;
  for (int enrolment = 1; enrolment <= 6000; ++enrolment) {
    std::vector<int> order;
    for (const auto& shown : schedule_of(study, enrolment).trials) {
      order.push_back(shown.field().class_index);
    }
    ++counts[order];
  }
  CHECK(counts.size() == 30);  // of 90 orders of aabbcc, those without equal neighbours
  CHECK(chi_square_uniform(counts, 30) < 29 + 4 * 7.7);
}

TEST_CASE("a limit that no run can reach leaves the order as it was") {
  const json trials = {{"repeats", 4}};
  const study::Study free = study_with(study_of(4), trials);
  const study::Study limited = study_with(study_of(4), {{"repeats", 4}, {"max_run", 4}});
  CHECK(schedule_of(limited, 3) == schedule_of(free, 3));
}

TEST_CASE("options that cannot be combined with a limit of runs are refused with the reason") {
  CHECK(refused(study_of(3), {{"order", "de-bruijn"}, {"repeats", 3}, {"max_run", 1}},
                "/trials/max_run 1"));
  const study::Study kept =
      study_with(study_of(3), {{"order", "de-bruijn"}, {"repeats", 3}, {"max_run", 2}});
  CHECK(longest_run(schedule_of(kept, 1).trials) == 2);
  CHECK(refused(study_of(2), {{"order", "williams"}, {"max_run", 1}}, "/trials/max_run 1 2"));
  CHECK(refused(study_of(64), {{"repeats", 100}, {"max_run", 2}}, "/trials/max_run 2 64 100"));
  CHECK(refused(comparison_of(3), {{"order", "williams"}, {"blocks", "mixed"}},
                "/trials/blocks by-method"));
}

TEST_CASE("a Williams block is permutations, balanced over places with as many as classes") {
  const study::Study study =
      study_with(comparison_of(4), {{"order", "williams"}, {"repeats", 4}, {"max_run", 1}});
  for (int enrolment = 1; enrolment <= 20; ++enrolment) {
    const auto trials = schedule_of(study, enrolment).trials;
    REQUIRE(trials.size() == 32);
    CHECK(longest_run(trials) == 1);
    for (std::size_t block = 0; block < 2; ++block) {
      std::set<std::pair<std::size_t, int>> places;
      for (std::size_t i = 0; i < 16; ++i) {
        places.insert({i % 4, trials[16 * block + i].field().class_index});
      }
      CHECK(places.size() == 16);
    }
  }
}

TEST_CASE("catch trials come at any place but the first, and change nothing else") {
  const study::Study plain = study_with(study_of(2, 3), {{"repeats", 2}});
  const study::Study caught = study_with(study_of(2, 3), {{"repeats", 2}, {"catch", 2}});
  std::map<std::pair<int, int>, int> places;
  for (int enrolment = 1; enrolment <= 3000; ++enrolment) {
    const study::Schedule schedule = schedule_of(caught, enrolment);
    REQUIRE(schedule.trials.size() == 6);
    std::vector<int> at;
    for (const study::Trial& shown : schedule.trials) {
      if (shown.role == study::Role::catch_trial) at.push_back(shown.place.trial);
    }
    REQUIRE(at.size() == 2);
    CHECK(at[0] > 1);
    ++places[{at[0], at[1]}];
    const study::Schedule without = schedule_of(plain, enrolment);
    CHECK(without_catch(schedule.trials) == without.trials);
    CHECK(schedule.layout == without.layout);
  }
  CHECK(places.size() == 10);  // two of five
  CHECK(chi_square_uniform(places, 10) < 9 + 4 * 4.3);
}

TEST_CASE("a catch trial belongs to the block of the presentation before it") {
  const study::Study study = study_with(comparison_of(2), {{"repeats", 2}, {"catch", 5}});
  for (int enrolment = 1; enrolment <= 30; ++enrolment) {
    const auto trials = schedule_of(study, enrolment).trials;
    for (std::size_t i = 1; i < trials.size(); ++i) {
      CHECK(trials[i].place.trial == static_cast<int>(i) + 1);
      if (trials[i].role == study::Role::catch_trial) {
        CHECK(trials[i].place.block == trials[i - 1].place.block);
      }
    }
  }
}

TEST_CASE("a schedule with catch trials is read as it was written, with a code like the others") {
  SeededEntropy entropy(1);
  const study::StudyKey key = study::make_study_key(
      study_with(study_of(3), {{"catch", 2}, {"rove_db", 6}}), entropy, false);
  const study::Schedule schedule = schedule_of(key.study, 1);
  const std::string text = study::schedule_to_json(schedule, key);
  CHECK(study::schedule_from_json(text, key) == schedule);
  CHECK(key.catch_code.size() == key.stimuli.front().code.size());
  CHECK_FALSE(key.stimulus_of(key.catch_code));
  json changed = json::parse(text);
  const auto give_catch_trials = [&](const std::string& code) {
    for (json& shown : changed["presentations"]) {
      if (shown["kind"] == "catch") shown["code"] = code;
    }
    return changed.dump();
  };
  CHECK_FALSE(study::schedule_from_json(give_catch_trials(key.stimuli.front().code), key) ==
              schedule);
  CHECK_THROWS_AS(study::schedule_from_json(give_catch_trials("unknown"), key), StoreError);
  give_catch_trials(key.catch_code);
  changed["presentations"][0]["kind"] = "other";
  CHECK_THROWS_AS(study::schedule_from_json(changed.dump(), key), StoreError);
}

TEST_CASE("the schedule rule names limits and catch trials only where there are some") {
  const std::string plain = rule_of(study_with(study_of(3), {{"repeats", 5}}));
  CHECK(plain.ends_with("; lead_in=0"));
  CHECK(rule_of(study_with(study_of(3), {{"max_run", 2}, {"rove_db", 1.5}, {"catch", 4}})) ==
        plain + "; max_run=2; rove_db=1.5; catch=4");
}

TEST_CASE("roved gains are uniform below the pack's, and tell nothing of class and method") {
  const json trials = {{"repeats", 4}, {"catch", 2}, {"lead_in", 1}};
  json roved = trials;
  roved["rove_db"] = 6;
  const study::Study study = study_with(comparison_of(3), roved);
  std::map<int, int> by_gain;
  std::map<std::tuple<int, int, bool>, int> by_stimulus_and_half;
  for (int enrolment = 1; enrolment <= 200; ++enrolment) {
    for (const study::Trial& shown : schedule_of(study, enrolment).trials) {
      if (shown.role == study::Role::catch_trial) {
        CHECK(shown.planes.front().gain_db == 0.0);
        continue;
      }
      REQUIRE(shown.planes.front().gain_db <= 0.0);
      REQUIRE(shown.planes.front().gain_db >= -6.0);
      ++by_gain[static_cast<int>(-2.0 * shown.planes.front().gain_db)];
      if (shown.role != study::Role::scored) continue;
      const auto& [class_index, exemplar, method] = shown.field();
      ++by_stimulus_and_half[{class_index, method, shown.planes.front().gain_db < -3.0}];
    }
  }
  // 99.9999 % with 11 degrees of freedom each.
  CHECK(chi_square_uniform(by_gain, 12) < 50.0);
  CHECK(chi_square_uniform(by_stimulus_and_half, 12) < 50.0);
  study::Schedule schedule = schedule_of(study, 1);
  for (study::Trial& shown : schedule.trials) shown.planes.front().gain_db = 0.0;
  CHECK(schedule == schedule_of(study_with(comparison_of(3), trials), 1));
}

TEST_CASE("a restarted block has new gains") {
  const study::Study study = study_with(comparison_of(3), {{"rove_db", 6}});
  std::set<double> gains;
  std::size_t presentations = 0;
  const auto add = [&](const std::vector<study::Trial>& block) {
    presentations += block.size();
    for (const study::Trial& shown : block) gains.insert(shown.planes.front().gain_db);
  };
  add(schedule_of(study, 2).trials);
  for (int restart = 0; restart < 2; ++restart) {
    for (int block = 0; block < 2; ++block) {
      add(restarted(study, 2, block, restart, 101));
    }
  }
  CHECK(gains.size() == presentations);
  CHECK(*gains.begin() >= -6.0);
  CHECK(*gains.rbegin() <= 0.0);
}

TEST_CASE("a restarted block is a fresh order of the same block under new numbers") {
  const study::Study study =
      study_with(comparison_of(3, 2), {{"repeats", 4}, {"max_run", 2}, {"catch", 4}});
  const study::Schedule schedule = schedule_of(study, 2);
  for (int block = 0; block < 2; ++block) {
    std::vector<study::Trial> before;
    std::ranges::copy_if(schedule.trials, std::back_inserter(before),
                         [block](const auto& shown) { return shown.place.block == block; });
    const auto again = restarted(study, 2, block, 0, 101);
    CHECK(again == restarted(study, 2, block, 0, 101));
    REQUIRE(again.size() == before.size());
    CHECK(again.front().place.trial == 101);
    CHECK(again.back().place.trial == 100 + static_cast<int>(again.size()));
    CHECK(again.front().role != study::Role::catch_trial);
    CHECK(scored_counts(again) == scored_counts(before));
    CHECK(longest_run(again) <= 2);
    const auto third = restarted(study, 2, block, 1, 101);
    CHECK_FALSE(third == again);
    CHECK(scored_counts(third) == scored_counts(before));
    CHECK(restarted(study, 2, block, 0, 201).front().field() == again.front().field());
  }
  CHECK_THROWS_AS(restarted(study, 2, 2, 0, 1), std::invalid_argument);
  CHECK_THROWS_AS(restarted(study, 2, 0, -1, 1), std::invalid_argument);
}

TEST_CASE("a restarted block is read as it was written") {
  SeededEntropy entropy(1);
  const study::StudyKey key = study::make_study_key(
      study_with(study_of(3), {{"catch", 2}, {"order", "williams"}}), entropy, false);
  const auto block = restarted(key.study, 1, 0, 0, 18);
  CHECK(study::block_from_json(study::block_to_json(block, key), key) == block);
  CHECK_THROWS_AS(study::block_from_json("{", key), StoreError);
  CHECK_THROWS_AS(study::block_from_json("[{}]", key), StoreError);
}

}  // namespace touchtrial
