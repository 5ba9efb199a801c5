// Whose data are erased takes nothing from the others: `verify` says what it said, and the exported
// rows of everybody else are the same.
#include "app/study_folder.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"

#include <csignal>
#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;
using touchtrial::testing::ChildProcess;

namespace {

/// What a study file has in place of that of StudyFolder.
const std::vector<std::pair<std::string, std::string>> kStudies = {
    {"comparison",
     R"({"trials": {"repeats": 2, "explore_limit_s": 2.0, "on_interruption": "restart-block"}})"},
    {"classification",
     R"({"trials": {"repeats": 2, "explore_limit_s": 2.0, "catch": 2, "lead_in": 1},
         "visits": {"count": 2, "least_days": 1},
         "groups": {"labels": ["trained", "control"], "open": true}})"},
    {"threshold",
     R"({"threshold": {"task": "detection", "interval_s": 0.25, "trials": 6, "catch": 2,
                       "control": 3, "levels": {"from": -40, "to": 0, "step": 4},
                       "practice": {"trials": 2, "criterion": 1, "rounds": 1}},
         "trials": {"explore_limit_s": 3}})"},
    {"threshold",
     R"({"threshold": {"task": "detection", "interval_s": 0.25, "trials": 6, "control": 2,
                       "procedure": "up-down", "question": "odd-one-out", "intervals": 3,
                       "levels": {"from": -40, "to": 0, "step": 4}},
         "trials": {"explore_limit_s": 3}})"},
};

struct ErasedFolder : StudyFolder {
  explicit ErasedFolder(const std::pair<std::string, std::string>& of) : StudyFolder(of.first) {
    json study = study_of(of.first);
    study.erase("trials");
    study.update(json::parse(of.second));
    if (of.first == "threshold") {
      study["classes"].erase(2);
      study["classes"].erase(1);
    }
    has_visits = study.contains("visits");
    replace_file(path() / "cloths.json", study.dump());
  }

  [[nodiscard]] std::vector<std::string> run_words(const std::string& participant, int visit,
                                                   const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"run",  in("cloths.json"), "--participant", participant,
                                      "--db", in("db"),          "--subject",     in("quick.json")};
    if (has_visits) words.insert(words.end(), {"--visit", std::to_string(visit)});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  void complete(const std::string& participant, const std::vector<std::string>& more = {}) const {
    succeeded(run(run_words(participant, 1, more)));
    if (has_visits) succeeded(run(run_words(participant, 2, {})));
  }
  /// Ends the program within a trial, after another one was acknowledged.
  void kill(const std::string& participant, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = run_words(participant, 1, more);
    words.insert(words.begin(), TOUCHTRIAL_PROGRAM);
    words.emplace_back("--real-time");
    ChildProcess program(words, {});
    REQUIRE(program.says(" acknowledged\n"));
    program.send_signal(SIGKILL);
    REQUIRE(program.finish() == -1);
  }

  /// The lines of trials.csv, once a copy is unblinded and reported.
  [[nodiscard]] std::vector<std::string> exported_rows() const {
    const std::string copy = "copy" + std::to_string(++copies_);
    for (const char* const beside : {"", ".key", ".head"}) {
      fs::copy_file(in("db") + beside, in(copy) + beside);
    }
    done("close @" + copy + " --yes");
    done("unblind @" + copy + " --reason test --yes");
    done("report @" + copy + " --json");
    done("export @" + copy + " --format csv --out @" + copy + "-csv");
    std::istringstream lines(content(in(copy + "-csv") + "/trials.csv"));
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line);) rows.push_back(line);
    return rows;
  }

  bool has_visits = false;

 private:
  mutable int copies_ = 0;
};

}  // namespace

TEST_CASE(
    "erasing participants leaves a valid database valid, whatever happened in their sessions") {
  for (const auto& of : kStudies) {
    INFO(of.first << " " << of.second);
    const ErasedFolder study(of);
    study.complete("P01");
    study.kill("P02");
    study.kill("P02", {"--on-existing", "resume"});
    study.complete("P02", {"--on-existing", "resume"});
    study.kill("P03");
    study.complete("P03", {"--on-existing", "restart"});
    study.kill("P04");
    study.done("verify @db");
    std::vector<std::string> rows = study.exported_rows();
    CHECK(rows.size() > 10);
    for (const std::string participant : {"P02", "P04", "P03"}) {
      INFO(participant);
      std::erase_if(rows, [&](const std::string& row) {
        return row.find(participant + ",") != std::string::npos;
      });
      study.done("withdraw @db --participant " + participant + " --reason asked --erase --yes");
      study.done("verify @db");
      study.done("status @db");
      CHECK(study.exported_rows() == rows);
    }
  }
}
