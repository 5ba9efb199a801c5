// Studies with several visits and groups, as the program runs them.
#include "app/study_folder.hpp"
#include "record/study_store.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <map>

namespace touchtrial {
namespace {

/// A study of two visits, a week apart, and two groups.
struct VisitFolder : StudyFolder {
  explicit VisitFolder(bool open = false) {
    write_study({{"visits", {{"count", 2}, {"least_days", 7}}},
                 {"groups", {{"labels", {"trained", "control"}}, {"open", open}}}});
  }
  [[nodiscard]] ProgramResult visit(const std::string& participant, const std::string& number,
                                    std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--visit", number});
    return session(participant, more);
  }
  void simulate_two(const std::string& db, const std::string& first) const {
    done("simulate @cloths.json --participants 2 --seed 3 --subject @quick.json --db @" + db +
         " --first-participant " + first);
  }
  [[nodiscard]] json checks(const std::string& db) const {
    return printed("verify @" + db + " --json");
  }
};

bool says(const ProgramResult& result, const std::string& words) {
  INFO(result.output << result.errors);
  return names_in_order(result.output + result.errors, words);
}

}  // namespace

TEST_CASE("simulated participants have the planned number of visits") {
  const VisitFolder study;
  const ProgramResult simulated = succeeded(study.simulate("all.db", {"--json"}));
  CHECK(json::parse(simulated.output)["sessions"] == 8);
  CHECK(study.checks("all.db")["complete"] == true);
  const json report = study.printed("report @all.db --json");
  CHECK(report["participants"] == 4);
  CHECK(report["methods"][0]["breakdowns"]["visit"].size() == 2);
  CHECK(report["methods"][0]["breakdowns"]["group"].size() == 2);
  study.done("export @all.db --format csv --out @out");
  CHECK(content(study.path() / "out" / "trials.csv").find(",visit,group\n") != std::string::npos);
  const auto store =
      record::StudyStore::open(study.path() / "all.db", record::StudyStore::Access::read_only);
  for (const record::SessionRow& row : store.sessions()) {
    CHECK(row.visit == (row.session > 4 ? 2 : 1));
    CHECK(row.enrolment == (row.session - 1) % 4 + 1);
  }
}

TEST_CASE("after a visit with a wrong clock the next one requires a reason, which is recorded") {
  const VisitFolder study;
  ::setenv("FAKE_CLOCK_AHEAD_S", "100000000", 1);
  ::setenv("LD_PRELOAD", TOUCHTRIAL_FAKE_MACHINE, 1);
  const ProgramResult first = study.visit("P01", "1", {"--real-time"});
  ::unsetenv("LD_PRELOAD");
  ::unsetenv("FAKE_CLOCK_AHEAD_S");
  succeeded(first);
  const ProgramResult refused = study.visit("P01", "2", {"--real-time"});
  CHECK(refused.exit_code == 1);
  CHECK(says(refused, "--accept-clock"));
  succeeded(study.visit("P01", "2", {"--real-time", "--accept-clock", "battery"}));
  study.done("export @study.db --format csv --out @out");
  CHECK(content(study.path() / "out" / "incidents.csv").find("wrong-clock") != std::string::npos);
}

TEST_CASE("merged stations of a study with visits equal one simulation") {
  const VisitFolder study;
  succeeded(study.simulate("all.db"));
  study.simulate_two("a.db", "1");
  study.simulate_two("b.db", "3");
  const ProgramResult merged = study.done("merge @a.db @b.db --out @merged.db");
  static_cast<void>(study.checks("merged.db"));
  const auto sessions = [&](const std::string& db) {
    std::vector<std::string> all;
    for (const record::SessionRow& row :
         record::StudyStore::open(study.path() / db, record::StudyStore::Access::read_only)
             .sessions()) {
      all.push_back(row.participant + " " + std::to_string(row.visit));
    }
    return all;
  };
  CHECK(sessions("merged.db") == sessions("all.db"));
}

TEST_CASE("a visit is requested by its number, and must follow the previous one") {
  const VisitFolder study;
  CHECK(says(study.visit("P07", "2"), "P07"));
  fs::remove(study.path() / "study.db");
  fs::remove(study.path() / "study.db.head");
  succeeded(study.visit("P07", "1"));
  const ProgramResult again = study.visit("P07", "1");
  CHECK(again.exit_code == 1);
  CHECK(says(again, "--visit 2"));
  CHECK(study.visit("P07", "3").exit_code == 2);
  // Where time is real, a simulated participant has to wait as a person has.
  const ProgramResult early = study.visit("P07", "2", {"--real-time"});
  CHECK(early.exit_code == 1);
  CHECK(says(early, "0.0 1 7"));
  const ProgramResult second = succeeded(study.visit("P07", "2"));
  CHECK(says(study.visit("P07", "1"), "2 2"));
  CHECK_FALSE(says(second, "trained"));
  CHECK_FALSE(says(second, "control"));
  static_cast<void>(study.checks("study.db"));
}

TEST_CASE("an exclusion is of the participant, with all visits, and ends them") {
  const VisitFolder study;
  succeeded(study.visit("P07", "1"));
  succeeded(study.visit("P07", "2"));
  succeeded(study.visit("P08", "1"));
  for (const std::string participant : {"P07", "P08"}) {
    study.done("exclude @study.db --reason asleep --participant " + participant);
  }
  const auto store =
      record::StudyStore::open(study.path() / "study.db", record::StudyStore::Access::read_only);
  for (const record::SessionRow& row : store.sessions()) CHECK(row.excluded);
  CHECK(says(study.visit("P08", "2"), "3"));
}

TEST_CASE("open groups are printed when a session begins, and the key's holder sees all groups") {
  const VisitFolder study(true);
  const ProgramResult first = study.visit("P01", "1");
  CHECK((says(first, "P01 trained") || says(first, "P01 control")));
  const VisitFolder hidden;
  hidden.done("prepare @cloths.json");
  const ProgramResult dealt = hidden.done("plan @cloths.json --groups --participants 10 --json");
  std::map<std::string, int> sizes;
  const json document = json::parse(dealt.output);
  for (const json& one : document["groups"]) ++sizes[one["group"]];
  CHECK(sizes == std::map<std::string, int>{{"control", 5}, {"trained", 5}});
  CHECK(hidden.type("plan @cloths.json --groups --participants 3").exit_code == 0);
}

}  // namespace touchtrial
