#include "record/merging/enrolment_balance.hpp"

#include "support/catch.hpp"

#include <stdexcept>

using namespace touchtrial;
using namespace touchtrial::merging;
using namespace touchtrial::record;

namespace {

EnrolledSession completed(int station, int enrolment) {
  return {.station = station, .enrolment = enrolment, .state = SessionState::completed};
}

}  // namespace

TEST_CASE("a study whose places are filled evenly has no imbalance") {
  const std::vector<EnrolledSession> sessions = {completed(1, 1), completed(2, 2), completed(1, 3),
                                                 completed(2, 4)};
  const EnrolmentBalance balance = enrolment_balance(sessions);
  CHECK(balance.stations == std::map<int, int>{{1, 2}, {2, 2}});
  CHECK(balance.gap_count == 0);
  CHECK(balance.highest == 4);
  CHECK(imbalances(balance).empty());
}

TEST_CASE("stations and numbers that lag behind are reported") {
  const std::vector<EnrolledSession> sessions = {completed(1, 2), completed(1, 4), completed(1, 6),
                                                 completed(2, 7)};
  const EnrolmentBalance balance = enrolment_balance(sessions);
  CHECK(balance.gaps == std::vector<int>{1, 3, 5});
  const std::vector<std::string> lines = imbalances(balance);
  REQUIRE(lines.size() == 2);
  CHECK_THAT(lines[0], holds_text("station 1 has 3, station 2 has 1"));
  CHECK_THAT(lines[1], holds_text("1, 3, 5"));
}

TEST_CASE("sessions that do not count leave their number open") {
  std::vector<EnrolledSession> sessions = {completed(1, 1), completed(1, 2), completed(2, 3)};
  sessions[0].state = SessionState::stopped;
  sessions[1].counts = false;
  const EnrolmentBalance balance = enrolment_balance(sessions);
  CHECK(balance.stations == std::map<int, int>{{1, 0}, {2, 1}});
  CHECK(balance.gaps == std::vector<int>{1, 2});
}

TEST_CASE("only the first of very many gaps are named") {
  const std::vector<EnrolledSession> sessions = {completed(1, 1000)};
  const EnrolmentBalance balance = enrolment_balance(sessions);
  CHECK(balance.gap_count == 999);
  CHECK(balance.gaps.size() == kMaxGaps);
  CHECK_THAT(imbalances(balance).front(), holds_text("and 979 more"));
}

TEST_CASE("a number that is absurdly high is counted at once") {
  std::vector<EnrolledSession> sessions = {completed(1, 2000000000), completed(1, 1),
                                           completed(2, 3)};
  sessions[0].counts = false;
  sessions.push_back(completed(1, 2));
  sessions.push_back(completed(1, 4));
  const EnrolmentBalance balance = enrolment_balance(sessions);
  CHECK(balance.gap_count == 1999999995);
  CHECK(balance.gaps.front() == 5);
  CHECK_THAT(imbalances(balance).front(), holds_text("station 1 has 3, station 2 has 1"));
}

TEST_CASE("an empty study is balanced") {
  CHECK(imbalances(enrolment_balance({})).empty());
}

TEST_CASE("balance refuses impossible numbers") {
  const std::vector<EnrolledSession> sessions = {completed(1, 0)};
  CHECK_THROWS_AS(enrolment_balance(sessions), std::invalid_argument);
}
