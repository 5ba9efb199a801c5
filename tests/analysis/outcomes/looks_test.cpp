#include "analysis/outcomes/looks.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "core/errors.hpp"
#include "support/catch.hpp"

#include <string>

namespace touchtrial {
namespace {

using std::chrono::seconds;

constexpr auto kNoon = std::chrono::seconds(1'769'860'800);  // 2026-01-31 12:00 UTC

void add_sessions(FakeStudy& study, int first, int last) {
  for (int i = first; i <= last; ++i) {
    study.add({.participant = "P" + std::to_string(i), .enrolment = i});
  }
}

analysis::LookRecord record_of(FakeStudy& study) {
  return analysis::load_outcomes(study.store(), study.key()).look_record;
}

}  // namespace

TEST_CASE("every look is kept with its date, its participants and its reason") {
  FakeStudy study(study::identification::classification());
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
  CHECK(record.looks[0].at == kNoon);
  CHECK(record.looks[1].at == kNoon + seconds(90));
  CHECK(record.looks[1].participants == 2);  // three, less the excluded one
  CHECK(record.looks[2].kind == analysis::LookKind::final);
  CHECK_FALSE(record.looks[2].is_unregistered());
  CHECK(record.excluded_afterwards == std::set<int>{1});
}

TEST_CASE("an exclusion before any look is not one with knowledge of outcomes") {
  FakeStudy study(study::identification::classification());
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
  FakeStudy study(study::identification::classification());
  add_sessions(study, 1, 3);
  study.store().look_at("P1", kNoon, "asked for it");
  CHECK_FALSE(analysis::look_record(study.store(), study.key()).looks.at(0).is_unregistered());
  study.store().look_at("P1", kNoon + seconds(1), "asked again");
  CHECK_FALSE(analysis::look_record(study.store(), study.key()).looks.at(1).is_unregistered());
  study.store().look_at("P2", kNoon + seconds(2), "asked too");
  study.store().close_study(kNoon + seconds(3));
  study.store().look_at("P3", kNoon + seconds(4), "after the end");
  const analysis::LookRecord record = analysis::look_record(study.store(), study.key());
  REQUIRE(record.looks.size() == 4);
  CHECK(record.looks[0].is_unregistered());
  CHECK(record.looks[2].is_unregistered());
  CHECK_FALSE(record.looks[3].is_unregistered());
}

namespace {

FakeStudy study_with_looks(const std::vector<std::string>& stations = {}) {
  return FakeStudy(
      study::identification::classification(),
      {.registration = R"({"participants": 4, "estimand": "mean-accuracy", "looks": [2]})",
       .stations = stations});
}

}  // namespace

TEST_CASE("a look at the question alone, at a registered number of participants, is registered") {
  FakeStudy study = study_with_looks();
  add_sessions(study, 1, 1);
  CHECK_FALSE(analysis::look_record(study.store(), study.key()).may_look);
  study.store().unblind(kNoon, "too early", true);
  add_sessions(study, 2, 2);
  CHECK(analysis::look_record(study.store(), study.key()).may_look);
  study.store().unblind(kNoon + seconds(1), "at everything", true);
  study.store().look_at_question(kNoon + seconds(2), "as registered");
  study.store().look_at_question(kNoon + seconds(3), "again, at the same");
  study.store().exclude(1, kNoon + seconds(4), "asleep");
  add_sessions(study, 3, 3);
  CHECK_FALSE(analysis::look_record(study.store(), study.key()).may_look);
  study.store().look_at_question(kNoon + seconds(5), "at two others");
  add_sessions(study, 4, 4);
  study.store().look_at_question(kNoon + seconds(6), "at three");
  const analysis::LookRecord record = analysis::look_record(study.store(), study.key());
  using enum analysis::LookKind;
  std::vector<analysis::LookKind> kinds;
  for (const analysis::Look& look : record.looks) kinds.push_back(look.kind);
  CHECK(kinds == std::vector{unregistered, unregistered, registered, registered, unregistered,
                             unregistered});
  CHECK(record.participants == 3);
}

TEST_CASE("a station's file has no registered look") {
  FakeStudy study = study_with_looks({"north", "south"});
  add_sessions(study, 1, 2);
  CHECK_FALSE(analysis::look_record(study.store(), study.key()).may_look);
}

TEST_CASE("after a look at the question alone, everything else stays blind") {
  FakeStudy study = study_with_looks();
  add_sessions(study, 1, 2);
  CHECK_THROWS_AS(analysis::load_outcomes_for_question(study.store(), study.key()), StoreError);
  study.store().look_at_question(kNoon, "as registered");
  add_sessions(study, 3, 3);
  CHECK_FALSE(study.store().state().unblinded);
  CHECK(study.store().state().shows(2));
  CHECK_FALSE(study.store().state().shows(3));
  CHECK_THROWS_AS(analysis::load_outcomes(study.store(), study.key()), StoreError);
  CHECK_THROWS_AS(analysis::load_outcomes(study.store(), study.key(), "P1"), StoreError);
  const analysis::Outcomes outcomes =
      analysis::load_outcomes_for_question(study.store(), study.key());
  CHECK(outcomes.sessions.size() == 2);
  CHECK(outcomes.collection.flow.unseen == 1);
  study.store().look_at("P1", kNoon, "asked for it");
  CHECK(analysis::load_outcomes(study.store(), study.key(), "P1").sessions.size() == 1);
  study.store().exclude(2, kNoon, "guessed");
  CHECK(analysis::look_record(study.store(), study.key()).excluded_afterwards == std::set<int>{2});
  study.close_and_unblind();
  CHECK(analysis::load_outcomes(study.store(), study.key()).sessions.size() == 3);
}

}  // namespace touchtrial
