// Power of a study, run as a user runs it: threads, shards, kills, and invalid arguments.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

#include <string>
#include <vector>

using namespace touchtrial;

namespace {

using Words = std::vector<std::string>;

/// A power run of the small study, fast enough for a test.
Words power_of(const StudyFolder& study, const Words& more) {
  Words words = {"power",          study.in("cloths.json"),
                 "--subject",      study.in("quick.json"),
                 "--runs",         "120",
                 "--seed",         "5",
                 "--explorations", "10",
                 "--trainings",    "2"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

ProgramResult run_power(const StudyFolder& study, const Words& more) {
  return study.run(power_of(study, more));
}

const Words kSizes = {"--participants", "3,5"};

Words with_sizes(const Words& more) {
  Words words = kSizes;
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("power prints and writes the same numbers with any number of threads") {
  const StudyFolder study;
  const ProgramResult one = succeeded(run_power(study, with_sizes({"--jobs", "1", "--json"})));
  const ProgramResult two =
      run_power(study, with_sizes({"--jobs", "3", "--json", "--out", study.in("power")}));
  INFO(two.errors);
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
  const ProgramResult text = run_power(study, kSizes);
  CHECK_THAT(text.output,
             Catch::Matchers::StartsWith("simulated on: ideal device (no such device is sold)\n"
                                         "SIMULATED: power given the assumed sensitivity"));
}

TEST_CASE("combined shards of a power run print the same as one run") {
  const StudyFolder study;
  const ProgramResult whole = succeeded(run_power(study, with_sizes({"--json"})));
  for (const char* shard : {"1/3", "3/3"}) {
    succeeded(run_power(study, with_sizes({"--shard", shard, "--out", study.in("shards")})));
  }
  check_refused(study.type("power --combine @shards"), 1, {"missing: 2"});
  succeeded(run_power(study, with_sizes({"--shard", "2/3", "--out", study.in("elsewhere")})));
  const Words combine = {"power", "--combine", study.in("shards"), study.in("elsewhere"), "--json"};
  CHECK(study.run(combine).output == whole.output);

  fs::copy(study.path() / "elsewhere" / "shard-0002-of-0003.json",
           study.path() / "shards" / "shard-copy.json");
  const ProgramResult twice = study.run(combine);
  CHECK(twice.output == whole.output);
  CHECK_THAT(twice.errors, holds_text("2/3") && holds_text("used once"));

  succeeded(run_power(study, {"--participants", "3,5", "--shard", "2/3", "--out", study.in("other"),
                              "--servo", "--no-early-stop"}));
  check_refused(study.type("power --combine @shards @other"), 3, {"other", "--no-early-stop"});
}

TEST_CASE("a single shard, and more shards than runs, are combined like others") {
  const StudyFolder study;
  const auto few = [&](const Words& more) {
    Words words = power_of(study, with_sizes(more));
    words[5] = "3";
    return study.run(words);
  };
  const ProgramResult whole = succeeded(few({"--json"}));
  succeeded(few({"--shard", "1/1", "--out", study.in("one")}));
  CHECK(study.type("power --combine @one --json").output == whole.output);
  for (const char* shard : {"1/4", "2/4", "3/4", "4/4"}) {
    succeeded(few({"--shard", shard, "--out", study.in("four")}));
  }
  CHECK(study.type("power --combine @four --json").output == whole.output);
}

TEST_CASE("the option --combine accepts no option of the plan, which the shards contain") {
  const StudyFolder study;
  for (const Words& more :
       {Words{"--runs", "10"}, Words{"--seed", "2"}, Words{"--participants", "3"},
        Words{"--subject", "quick.json"}, Words{"--no-early-stop"}, Words{"--servo"}}) {
    Words words = {"power", "--combine", study.in("shards")};
    words.insert(words.end(), more.begin(), more.end());
    check_refused(study.run(words), 2, {"--combine", more.front()});
  }
}

TEST_CASE("a power run is resumed only with its own arguments") {
  const StudyFolder study;
  const Words out = {"--out", study.in("power")};
  const ProgramResult first = succeeded(run_power(study, with_sizes({"--json", out[0], out[1]})));
  check_refused(run_power(study, with_sizes(out)), 1, {"power-progress.json", "--resume"});
  CHECK(run_power(study, with_sizes({"--json", "--resume", out[0], out[1]})).output ==
        first.output);
  check_refused(run_power(study, {"--participants", "3,6", "--resume", out[0], out[1]}), 1,
                {"--participants"});
  Words other = power_of(study, with_sizes({"--resume", out[0], out[1]}));
  other[7] = "6";
  check_refused(study.run(other), 1, {"--seed"});
  const std::string progress = content(study.path() / "power" / "power-progress.json");
  replace_file(study.path() / "power" / "power-progress.json",
               progress.substr(0, progress.size() / 2));
  check_refused(run_power(study, with_sizes({"--resume", out[0], out[1]})), 1,
                {"power-progress.json", "truncated"});
}

TEST_CASE("power refuses invalid arguments in one line") {
  const StudyFolder study;
  check_refused(run_power(study, {"--participants", "1"}), 2, {"--participants", "1"});
  check_refused(run_power(study, {"--participants", "8,8"}), 2, {"8 is given twice"});
  check_refused(run_power(study, {"--participants", "1000000000"}), 2, {"1000000000"});
  check_refused(run_power(study, {"--participants", "99999999999999999999"}), 2,
                {"--participants"});
  check_refused(run_power(study, {"--participants", "eight"}), 2, {"--participants"});
  check_refused(run_power(study, {"--participants", "8,,12"}), 2, {"--participants"});
  check_refused(run_power(study, {"--participants", "-8"}), 2, {});
  for (const char* runs : {"0", "-1", "1.5", "1000000000", "many"}) {
    Words words = power_of(study, kSizes);
    words[5] = runs;
    check_refused(study.run(words), 2, {"--runs"});
  }
  for (const char* shard :
       {"", "0/3", "4/3", "3", "a/b", "1/", "/2", "1/2/3", "1/99999999", "-1/2"}) {
    check_refused(run_power(study, {"--shard", shard, "--out", study.in("x")}), 2, {"--shard"});
  }
  check_refused(run_power(study, {"--methods", "adaptive,edge"}), 2, {"--methods"});
  check_refused(study.type("power"), 2, {"STUDY"});
  check_refused(study.type("power @none.json"), 2, {"none.json"});
  check_refused(study.type("power --combine @nowhere"), 1, {"nowhere"});
  check_refused(study.type("power --combine @cloths.json"), 1, {"cloths.json"});
  check_refused(study.type("power @cloths.json --resume"), 2, {"--out"});
}
