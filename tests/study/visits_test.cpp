/// Several visits of a participant, and groups: the study file, what is dealt, and schedules.
#include "core/errors.hpp"
#include "study/protocol.hpp"
#include "study/station.hpp"
#include "study/study_examples.hpp"
#include "study/study_key.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <vector>

namespace touchtrial {
namespace {

using nlohmann::json;
using study::Draws;

json visiting(const json& visits, json study = comparison_of(3)) {
  study["visits"] = visits;
  return study;
}

json grouped(const json& groups, json study = comparison_of(3)) {
  study["groups"] = groups;
  return study;
}

study::StudyKey key_of(const json& study, std::uint64_t secret = 1) {
  SeededEntropy entropy(secret);
  return study::make_study_key(parsed(study), entropy, false);
}

study::Schedule schedule_at(const study::StudyKey& key, int enrolment, int visit) {
  return study::make_schedule(key.study, key.draw_of(enrolment, Draws::people, visit));
}

std::vector<int> groups_dealt(const study::StudyKey& key, int participants) {
  std::vector<int> dealt;
  for (int number = 1; number <= participants; ++number) {
    dealt.push_back(key.group_of(number, Draws::people).value());
  }
  return dealt;
}

/// By how much the sizes of two groups ever differ.
int largest_lead(const std::vector<int>& dealt) {
  int lead = 0;
  int largest = 0;
  for (const int group : dealt) {
    lead += group == 0 ? 1 : -1;
    largest = std::max(largest, std::abs(lead));
  }
  return largest;
}

}  // namespace

TEST_CASE("visits and groups are read, and a study without them has one visit and no groups") {
  const study::Study study =
      parsed(visiting({{"count", 2}, {"least_days", 6.5}, {"most_days", 8}},
                      grouped({{"labels", {"trained", "control"}}, {"open", true}})));
  CHECK(study.visits.count == 2);
  CHECK(study.visits.min_days == 6.5);
  CHECK(study.visits.max_days == 8.0);
  CHECK(study.visits.methods == study::VisitMethods::all);
  CHECK(study.groups.labels == std::vector<std::string>{"trained", "control"});
  CHECK(study.groups.open);
  CHECK(study.scored_trials() == 2 * parsed(comparison_of(3)).scored_trials());
  CHECK(parsed(comparison_of(3)).visits == study::VisitPlan{});
  CHECK(parsed(comparison_of(3)).groups == study::GroupPlan{});
}

TEST_CASE("impossible visits, groups and registered visits are refused with their place") {
  CHECK(refused(visiting({{"count", 1}}), "/visits/count"));
  CHECK(
      refused(visiting({{"count", 2}, {"least_days", 7}, {"most_days", 6}}), "/visits/most_days"));
  CHECK(refused(visiting({{"count", 3}, {"methods", "divided"}}), "/visits/methods divided 2"));
  json mixed = visiting({{"count", 2}, {"methods", "divided"}});
  mixed["trials"] = {{"blocks", "mixed"}};
  CHECK(refused(mixed, "/visits/methods divided"));
  CHECK(refused(grouped({{"labels", {"one", "one"}}}), "/groups/labels/1 one"));
  CHECK(refused(grouped({{"labels", {"one"}}}), "/groups/labels"));
  json registered = comparison_of(3);
  registered["registration"] = {{"estimand", "difference"}, {"visits", "last"}};
  CHECK(refused(registered, "/registration/visits"));
  CHECK(refused(visiting({{"count", 2}, {"methods", "divided"}}, registered),
                "/registration/visits"));
  CHECK(parsed(visiting({{"count", 2}}, registered)).enters_analysis(2));
  CHECK_FALSE(parsed(visiting({{"count", 2}}, registered)).enters_analysis(1));
}

TEST_CASE("the seal commits to visits and groups, and not to what a study does not have") {
  const auto seal = [](const json& study) { return study::study_seal(key_of(study)); };
  CHECK(seal(visiting({{"count", 2}})) != seal(comparison_of(3)));
  CHECK(seal(visiting({{"count", 2}})) != seal(visiting({{"count", 2}, {"least_days", 1}})));
  CHECK(seal(grouped({{"labels", {"a", "b"}}})) != seal(comparison_of(3)));
  const json clear = json::parse(key_of(comparison_of(3)).configuration);
  CHECK_FALSE(clear.contains("visits"));
  CHECK_FALSE(clear.contains("groups"));
  CHECK_FALSE(study::are_same(parsed(visiting({{"count", 2}})), parsed(comparison_of(3))));
}

TEST_CASE("every visit presents all methods in the participant's order, and trials in a new one") {
  const study::StudyKey key = key_of(visiting({{"count", 3}}));
  const study::StudyKey alone = key_of(comparison_of(3));
  for (int number = 1; number <= 6; ++number) {
    CHECK(schedule_at(key, number, 1) == schedule_at(alone, number, 1));
    std::set<int> first_methods;
    for (int visit = 1; visit <= 3; ++visit) {
      const study::Schedule schedule = schedule_at(key, number, visit);
      CHECK(schedule.trials.size() == schedule_at(alone, number, 1).trials.size());
      first_methods.insert(schedule.trials.front().field().method);
    }
    CHECK(first_methods.size() == 1);
    CHECK_FALSE(schedule_at(key, number, 1) == schedule_at(key, number, 2));
    CHECK_FALSE(schedule_at(key, number, 2) == schedule_at(key, number, 3));
  }
  CHECK_THROWS_AS(key.draw_of(1, Draws::people, 4), UsageError);
  CHECK_THROWS_AS(key.draw_of(1, Draws::people, 0), UsageError);
}

TEST_CASE("methods that are divided between visits are those of one long session, block by block") {
  const study::StudyKey key = key_of(visiting({{"count", 2}, {"methods", "divided"}}));
  const study::StudyKey alone = key_of(comparison_of(3));
  CHECK(key.study.scored_trials() == alone.study.scored_trials());
  std::map<int, int> first_method;
  for (int number = 1; number <= 8; ++number) {
    const std::vector<study::Trial> whole = schedule_at(alone, number, 1).trials;
    std::vector<study::Trial> visits;
    for (int visit = 1; visit <= 2; ++visit) {
      const std::vector<study::Trial> own = schedule_at(key, number, visit).trials;
      CHECK(own.front().place.trial == 1);
      for (const study::Trial& shown : own) CHECK(shown.place.block == visit - 1);
      visits.insert(visits.end(), own.begin(), own.end());
    }
    REQUIRE(visits.size() == whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) CHECK(visits[i].planes == whole[i].planes);
    ++first_method[whole.front().field().method];
    const study::ScheduleDraw second = key.draw_of(number, Draws::people, 2);
    const auto again = study::make_order(key.study, second)->redraw_block(1, 0, 100);
    CHECK(again.size() == visits.size() / 2);
  }
  CHECK(first_method == std::map<int, int>{{0, 4}, {1, 4}});
}

TEST_CASE("groups are dealt at random, and never differ by more than one") {
  std::set<std::vector<int>> dealings;
  for (std::uint64_t secret = 1; secret <= 8; ++secret) {
    const study::StudyKey key = key_of(grouped({{"labels", {"a", "b"}}}), secret);
    const std::vector<int> dealt = groups_dealt(key, 40);
    CHECK(std::ranges::count(dealt, 0) == 20);
    CHECK(largest_lead(dealt) == 1);
    dealings.insert(dealt);
    CHECK(dealt != groups_dealt(key_of(grouped({{"labels", {"a", "b"}}}), secret + 100), 40));
    std::vector<int> rehearsed;
    for (int number = 1; number <= 40; ++number) {
      rehearsed.push_back(key.group_of(number, Draws::rehearsal).value());
    }
    CHECK(rehearsed != dealt);
  }
  CHECK(dealings.size() == 8);
  CHECK_FALSE(key_of(comparison_of(3)).group_of(1, Draws::people));
}

TEST_CASE(
    "open groups come in blocks of two lengths, so that what was dealt does not tell what comes") {
  // With blocks of two alone, the second of two numbers would always be in the other group.
  const study::StudyKey key = key_of(grouped({{"labels", {"a", "b"}}, {"open", true}}));
  const std::vector<int> dealt = groups_dealt(key, 400);
  CHECK(largest_lead(dealt) == 2);
  int same = 0;
  for (std::size_t i = 0; i + 1 < dealt.size(); i += 2) same += dealt[i] == dealt[i + 1] ? 1 : 0;
  CHECK(same > 20);
}

TEST_CASE("orders of methods are balanced in each group of each station") {
  json document = grouped({{"labels", {"a", "b", "c"}}});
  SeededEntropy entropy(3);
  study::StudyKey key = study::make_study_key(parsed(document), entropy, false);
  std::vector<study::Station> stations =
      study::stations_named(std::vector<std::string>{"north", "south"});
  study::assign_enrolments(stations, 48);
  study::assign_stations(key, std::move(stations));
  const int rows = study::method_orders(key.study);
  REQUIRE(rows == 2);
  std::map<std::pair<int, int>, std::map<int, int>> orders;  // by station and group
  std::map<int, std::set<int>> in_block;
  for (int number = 1; number <= 48; ++number) {
    const int station = number <= 24 ? 1 : 2;
    const int order = key.draw_of(number, Draws::people).method_order;
    ++orders[{station, key.group_of(number, Draws::people).value()}][order];
    const int block = study::order_block_of(key.study, key.stations, number, Draws::people);
    CHECK(in_block[block].insert(order).second);
  }
  REQUIRE(orders.size() == 6);
  for (const auto& [place, own] : orders) CHECK(own == std::map<int, int>{{0, 4}, {1, 4}});
  CHECK(in_block.size() == 24);
}

}  // namespace touchtrial
