#include "protocols/design/enrolment_plan.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/design/refusal.hpp"
#include "protocols/design/study_examples.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

std::string refusal_of(const std::filesystem::path& path, const design::Study& study) {
  return message_of<StudyError>([&] { return design::load_plan(path, study); });
}

design::Study study_with_methods(int methods) {
  nlohmann::json study = comparison_of(2);
  study["methods"] = nlohmann::json::array();
  for (int i = 0; i < methods; ++i) {
    study["methods"].push_back(
        {{"name", "fixed"}, {"label", "m" + std::to_string(i)}, {"order", 0.1 * (i + 1)}});
  }
  return parsed(study);
}

std::vector<std::string> names(int count) {
  std::vector<std::string> all;
  for (int i = 1; i <= count; ++i) all.push_back("s" + std::to_string(i));
  return all;
}

design::EnrolmentPlan plan_of(const design::Study& study, int participants, int stations) {
  design::EnrolmentPlan plan = design::empty_plan(study, names(stations));
  design::extend_plan(plan, study, participants);
  return plan;
}

/// Which station has each number, from 1; every number has one.
std::vector<std::string> owners(const design::EnrolmentPlan& plan) {
  std::vector<std::string> owner(static_cast<std::size_t>(plan.participants()));
  for (const design::StationShare& share : plan.stations) {
    for (const design::EnrolmentRange& range : share.ranges) {
      for (int number = range.first; number <= range.last; ++number) {
        std::string& place = owner.at(static_cast<std::size_t>(number - 1));
        CHECK(place.empty());
        place = share.station;
      }
    }
  }
  CHECK(std::ranges::none_of(owner, &std::string::empty));
  return owner;
}

void check_even(const std::vector<int>& counts) {
  const auto [least, most] = std::ranges::minmax(counts);
  CAPTURE(counts.size(), least, most);
  CHECK(most - least <= 1);
}

}  // namespace

TEST_CASE("a plan gives every number to one station, as many to each as can be") {
  const design::Study study = study_with_methods(2);
  for (int participants = 1; participants <= 60; ++participants) {
    for (int stations = 1; stations <= 7; ++stations) {
      const design::EnrolmentPlan plan = plan_of(study, participants, stations);
      CHECK(plan.participants() == participants);
      CHECK(owners(plan).size() == static_cast<std::size_t>(participants));
      std::vector<int> sizes;
      for (const design::StationShare& share : plan.stations) sizes.push_back(share.size());
      check_even(sizes);
    }
  }
}

TEST_CASE("orders of methods are as even at each station as in the whole study") {
  for (int methods = 2; methods <= 5; ++methods) {
    const design::Study study = study_with_methods(methods);
    const design::EnrolmentPlan plan = plan_of(study, 37, 3);
    for (const design::StationShare& share : plan.stations) {
      const std::vector<int> counts = design::orders_of(study, share.ranges);
      CHECK(counts.size() == static_cast<std::size_t>(methods % 2 == 0 ? methods : 2 * methods));
      CHECK(std::accumulate(counts.begin(), counts.end(), 0) == share.size());
      check_even(counts);
    }
  }
}

TEST_CASE("a study of mixed blocks has one order of methods") {
  nlohmann::json study = comparison_of(2);
  study["trials"] = {{"blocks", "mixed"}};
  const std::vector<design::EnrolmentRange> range = {{3, 9}};
  CHECK(design::orders_of(parsed(study), range) == std::vector<int>{7});
}

TEST_CASE("a plan that is extended leaves every number where it was") {
  const design::Study study = study_with_methods(2);
  design::EnrolmentPlan plan = plan_of(study, 10, 4);
  const std::vector<std::string> before = owners(plan);
  design::extend_plan(plan, study, 31);
  const std::vector<std::string> after = owners(plan);
  REQUIRE(after.size() == 31);
  CHECK(std::equal(before.begin(), before.end(), after.begin()));
  std::vector<int> sizes;
  for (const design::StationShare& share : plan.stations) sizes.push_back(share.size());
  check_even(sizes);
  CHECK_THROWS_AS(design::extend_plan(plan, study, 30), std::invalid_argument);
}

TEST_CASE("a plan that is extended makes orders even again that an odd number left uneven") {
  const design::Study study = study_with_methods(2);
  design::EnrolmentPlan plan = plan_of(study, 6, 2);
  design::extend_plan(plan, study, 7);
  design::extend_plan(plan, study, 12);
  for (const design::StationShare& share : plan.stations) {
    CHECK(design::orders_of(study, share.ranges) == std::vector<int>{3, 3});
  }
}

TEST_CASE("a plan is read as it was written") {
  const TempFolder folder;
  const design::Study study = study_with_methods(2);
  design::EnrolmentPlan plan = plan_of(study, 10, 4);
  design::extend_plan(plan, study, 17);
  const std::filesystem::path path = folder.path() / "cloths.plan.json";
  design::save_plan(path, plan);
  CHECK(design::load_plan(path, study) == plan);
  CHECK(design::plan_path_for(folder.path() / "cloths.json") == path);
}

TEST_CASE("a plan that does not deal each number once is refused at its place") {
  const TempFolder folder;
  const design::Study study = study_with_methods(2);
  const std::filesystem::path path = folder.path() / "p.json";
  const auto refusal_of_stations = [&](const std::string& stations,
                                       const std::string& name = "small") {
    replace_file(path, R"({"study": ")" + name + R"(", "stations": )" + stations + "}");
    return refusal_of(path, study);
  };
  using Catch::Contains;
  CHECK_THAT(refusal_of_stations(R"([{"station": "a", "enrolments": [[1, 4]]},
                                     {"station": "b", "enrolments": [[4, 6]]}])"),
             Contains("/stations") && Contains("number 4 is two stations'"));
  CHECK_THAT(refusal_of_stations(R"([{"station": "a", "enrolments": [[1, 4], [6, 7]]}])"),
             Contains("number 5 is no station's"));
  CHECK_THAT(refusal_of_stations(R"([{"station": "a", "enrolments": [[2, 4]]}])"),
             Contains("number 1 is no station's"));
  CHECK_THAT(refusal_of_stations(R"([{"station": "a", "enrolments": [[4, 1]]}])"),
             Contains("/stations/0/enrolments/0") && Contains("end before they begin"));
  CHECK_THAT(refusal_of_stations(R"([{"station": "a", "enrolments": [[1, 2000000000]]}])"),
             Contains("/stations/0/enrolments/0/1"));
  CHECK_THAT(refusal_of_stations(R"([{"station": "a b", "enrolments": []}])"),
             Contains("no name of a station"));
  CHECK_THAT(refusal_of_stations(R"([{"station": "a", "enrolments": []},
                                     {"station": "a", "enrolments": []}])"),
             Contains("named twice"));
  CHECK_THAT(refusal_of_stations("[]"), Contains("/stations"));
  CHECK_THAT(refusal_of_stations(R"([{"station": "a", "enrolments": [[1, 2]]}])", "other"),
             Contains("/study") && Contains("not of \"small\""));
}

TEST_CASE("a station takes its smallest number that nobody has") {
  const design::Study study = study_with_methods(2);
  design::EnrolmentPlan plan = plan_of(study, 6, 2);
  CHECK(design::next_of_station(plan, "s2", {}, "p.json") == 4);
  CHECK(design::next_of_station(plan, "s2", {4, 1}, "p.json") == 5);
  CHECK(design::next_of_station(plan, "s1", {1, 3}, "p.json") == 2);
  CHECK_THAT(message_of<StudyError>([&] {
               return design::next_of_station(plan, "s1", {1, 2, 3}, "p.json");
             }),
             Catch::Contains("p.json: all numbers of station s1 are taken"));
  CHECK_THAT(
      message_of<StudyError>([&] { return design::next_of_station(plan, "s3", {}, "p.json"); }),
      Catch::Contains("has no station \"s3\"; it has s1, s2"));
  design::extend_plan(plan, study, 8);
  // 7 would be the third of one order at s1, and makes s2 even.
  CHECK(design::next_of_station(plan, "s1", {1, 2, 3}, "p.json") == 8);
}

TEST_CASE("names of stations are simple, and each is one station's") {
  const design::Study study = study_with_methods(2);
  const auto refused = [&](const std::vector<std::string>& stations) {
    CHECK_THROWS_AS(design::empty_plan(study, stations), UsageError);
  };
  refused({});
  refused({""});
  refused({"lab/2"});
  refused({std::string(33, 'a')});
  refused({"a", "a"});
  refused(std::vector<std::string>(design::kMostStations + 1, "a"));
}

}  // namespace touchtrial
