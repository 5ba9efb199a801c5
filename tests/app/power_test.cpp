// Power of a study, run as a user runs it: threads, shards, kills, and invalid arguments.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

#include <string>
#include <vector>

using namespace touchtrial;

namespace {

/// A power run of the small study, fast enough for a test.
ProgramResult power(const StudyFolder& study, const std::string& more,
                    const std::string& runs = "120", const std::string& seed = "5") {
  return study.type("power @cloths.json --subject @quick.json --explorations 10 --trainings 2 " +
                    more + " --runs " + runs + " --seed " + seed);
}

}  // namespace

TEST_CASE("power prints and writes the same numbers with any number of threads") {
  const StudyFolder study;
  const ProgramResult one = succeeded(power(study, "--participants 3,5 --jobs 1 --json"));
  const ProgramResult two =
      succeeded(power(study, "--participants 3,5 --jobs 3 --json --out @power"));
  CHECK(one.output == two.output);
  const json report = json::parse(one.output);
  CHECK(report.at("simulated") == true);
  CHECK(report.at("simulated_on") == "ideal device (no such device is sold)");
  CHECK(report.at("sizes").size() == 2);
  CHECK(report.at("sizes").at(0).at("type_one_error").at("runs") == 120);
  CHECK(content(study.path() / "power" / "power.json") == one.output);
  for (const char* name : {"power.csv", "power.md", "power.svg", "power.pdf"}) {
    CHECK(fs::exists(study.path() / "power" / name));
  }
  CHECK_THAT(power(study, "--participants 3,5").output,
             Catch::Matchers::StartsWith("simulated on: ideal device (no such device is sold)\n"
                                         "SIMULATED: power given the assumed sensitivity"));
}

TEST_CASE("combined shards of a power run print the same as one run") {
  const StudyFolder study;
  const ProgramResult whole = succeeded(power(study, "--participants 3,5 --json"));
  for (const std::string shard : {"1/3", "3/3"}) {
    succeeded(power(study, "--participants 3,5 --out @shards --shard " + shard));
  }
  check_refused(study.type("power --combine @shards"), 1, {"missing: 2"});
  succeeded(power(study, "--participants 3,5 --out @elsewhere --shard 2/3"));
  const std::string combine = "power --combine @shards @elsewhere --json";
  CHECK(study.type(combine).output == whole.output);

  fs::copy(study.path() / "elsewhere" / "shard-0002-of-0003.json",
           study.path() / "shards" / "shard-copy.json");
  const ProgramResult twice = study.type(combine);
  CHECK(twice.output == whole.output);
  CHECK_THAT(twice.errors, holds_text("2/3") && holds_text("used once"));

  succeeded(power(study, "--participants 3,5 --shard 2/3 --out @other --servo --no-early-stop"));
  check_refused(study.type("power --combine @shards @other"), 3, {"other", "--no-early-stop"});
}

TEST_CASE("a single shard, and more shards than runs, are combined like others") {
  const StudyFolder study;
  const auto few = [&](const std::string& more) {
    return succeeded(power(study, "--participants 3,5 " + more, "3"));
  };
  const ProgramResult whole = few("--json");
  few("--shard 1/1 --out @one");
  CHECK(study.type("power --combine @one --json").output == whole.output);
  for (const std::string shard : {"1/4", "2/4", "3/4", "4/4"}) {
    few("--out @four --shard " + shard);
  }
  CHECK(study.type("power --combine @four --json").output == whole.output);
}

TEST_CASE("the option --combine accepts no option of the plan, which the shards contain") {
  const StudyFolder study;
  for (const std::string option : {"--runs 10", "--seed 2", "--participants 3",
                                   "--subject quick.json", "--no-early-stop", "--servo"}) {
    check_refused(study.type("power --combine @shards " + option), 2,
                  {"--combine", option.substr(0, option.find(' '))});
  }
}

TEST_CASE("a power run is resumed only with its own arguments") {
  const StudyFolder study;
  const std::string run = "--participants 3,5 --out @power ";
  const ProgramResult first = succeeded(power(study, run + "--json"));
  check_refused(power(study, run), 1, {"power-progress.json", "--resume"});
  CHECK(power(study, run + "--json --resume").output == first.output);
  check_refused(power(study, "--participants 3,6 --out @power --resume"), 1, {"--participants"});
  check_refused(power(study, run + "--resume", "120", "6"), 1, {"--seed"});
  const std::string progress = content(study.path() / "power" / "power-progress.json");
  replace_file(study.path() / "power" / "power-progress.json",
               progress.substr(0, progress.size() / 2));
  check_refused(power(study, run + "--resume"), 1, {"power-progress.json", "truncated"});
}

TEST_CASE("power refuses invalid arguments in one line") {
  const StudyFolder study;
  for (const std::string sizes :
       {"1", "8,8", "1000000000", "99999999999999999999", "eight", "8,,12", "-8"}) {
    INFO(sizes);
    check_refused(power(study, "--participants " + sizes), 2, {"--participants"});
  }
  for (const char* runs : {"0", "-1", "1.5", "1000000000", "many"}) {
    check_refused(power(study, "--participants 3,5", runs), 2, {"--runs"});
  }
  for (const std::string shard :
       {"", "0/3", "4/3", "3", "a/b", "1/", "/2", "1/2/3", "1/99999999", "-1/2"}) {
    check_refused(power(study, "--out @x --shard '" + shard + "'"), 2, {"--shard"});
  }
  check_refused(power(study, "--methods adaptive,edge"), 2, {"--methods"});
  check_refused(study.type("power"), 2, {"STUDY"});
  check_refused(study.type("power @none.json"), 2, {"none.json"});
  check_refused(study.type("power --combine @nowhere"), 1, {"nowhere"});
  check_refused(study.type("power --combine @cloths.json"), 1, {"cloths.json"});
  check_refused(study.type("power @cloths.json --resume"), 2, {"--out"});
}
