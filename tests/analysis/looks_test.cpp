#include "analysis/looks.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/outcomes.hpp"
#include "support/catch.hpp"

#include <string>

namespace touchtrial {
namespace {

using std::chrono::seconds;

constexpr auto kNoon = std::chrono::seconds(1'769'860'800);  // 2026-01-31 12:00 UTC

void add_sessions(FakeStudy& study, int first, int last) {
  for (int i = first; i <= last; ++i) {
    study.add({.participant = "P" + std::to_string(i),
               .enrolment = i,
               .answers = FakeStudy::always_right()});
  }
}

analysis::LookRecord record_of(FakeStudy& study) {
  return analysis::load_outcomes(study.store(), study.key()).looked;
}

}  // namespace

TEST_CASE("every look is kept with its date, its participants and its reason") {
  FakeStudy study(design::identification::classification());
  add_sessions(study, 1, 2);
  study.store().unblind(kNoon, "curious", true);
  add_sessions(study, 3, 3);
  study.store().exclude(1, kNoon + seconds(60), "asleep");
  study.store().unblind(kNoon + seconds(90), "again", true);
  study.store().close_study(kNoon + seconds(120));
  study.store().unblind(kNoon + seconds(180), "the end", false);
  const analysis::LookRecord record = record_of(study);
  REQUIRE(record.looks.size() == 3);
  CHECK(record.looks[0].participants == 2);
  CHECK(record.looks[0].reason == "curious");
  CHECK(record.looks[0].kind == analysis::LookKind::unregistered);
  CHECK(analysis::date_text(record.looks[0].at) == "2026-01-31 12:00 UTC");
  CHECK(analysis::iso_date(record.looks[1].at) == "2026-01-31T12:01:30Z");
  CHECK(record.looks[1].participants == 2);  // three, less the excluded one
  CHECK(record.looks[2].kind == analysis::LookKind::final);
  CHECK_FALSE(record.looks[2].is_unregistered());
  CHECK(record.excluded_afterwards == std::set<int>{1});
}

TEST_CASE("an exclusion before any look is not one with knowledge of outcomes") {
  FakeStudy study(design::identification::classification());
  add_sessions(study, 1, 3);
  study.store().exclude(2, kNoon, "asleep");
  study.close_and_unblind();
  CHECK(record_of(study).excluded_afterwards.empty());
  study.store().exclude(3, kNoon, "guessed");
  study.store().withdraw(1, kNoon, "asked to");
  CHECK(record_of(study).excluded_afterwards == std::set<int>{3});
  CHECK(record_of(study).erased_afterwards == std::set<int>{1});
}

TEST_CASE("looks at two participants or more, one by one, are an unregistered look") {
  FakeStudy study(design::identification::classification());
  add_sessions(study, 1, 3);
  study.store().look_at("P1", kNoon, "asked for it");
  CHECK_FALSE(analysis::look_record(study.store(), {}).looks.at(0).is_unregistered());
  study.store().look_at("P1", kNoon + seconds(1), "asked again");
  CHECK_FALSE(analysis::look_record(study.store(), {}).looks.at(1).is_unregistered());
  study.store().look_at("P2", kNoon + seconds(2), "asked too");
  study.store().close_study(kNoon + seconds(3));
  study.store().look_at("P3", kNoon + seconds(4), "after the end");
  const analysis::LookRecord record = analysis::look_record(study.store(), {});
  REQUIRE(record.looks.size() == 4);
  CHECK(record.looks[0].is_unregistered());
  CHECK(record.looks[2].is_unregistered());
  CHECK_FALSE(record.looks[3].is_unregistered());
}

TEST_CASE("a look at a registered number of participants is registered") {
  FakeStudy study(
      design::identification::classification(),
      {.registration = R"({"participants": 4, "estimand": "mean-accuracy", "looks": [2]})"});
  add_sessions(study, 1, 1);
  study.store().unblind(kNoon, "too early", true);
  add_sessions(study, 2, 2);
  study.store().unblind(kNoon, "as registered", true);
  const analysis::LookRecord record = record_of(study);
  CHECK(record.looks.at(0).kind == analysis::LookKind::unregistered);
  CHECK(record.looks.at(1).kind == analysis::LookKind::registered);
}

}  // namespace touchtrial
