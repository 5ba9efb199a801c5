// Fitting a subject model as its user does it.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

using namespace touchtrial;

namespace {

/// Few explorations: these tests check the command, not the estimates.
ProgramResult fit(const StudyFolder& study, const std::vector<std::string>& more) {
  return study.type("fit @s.db --subject @quick.json --explorations 16 --bootstraps 9", more);
}

}  // namespace

TEST_CASE("fit prints tables, writes a subject file that simulate reads, and stamps both") {
  const StudyFolder study;
  succeeded(study.simulate("s.db"));
  const ProgramResult ran = succeeded(fit(study, {"-o", study.in("fitted.json")}));
  CHECK_THAT(ran.output, holds_text("SIMULATED"));
  CHECK_THAT(ran.output, Catch::Matchers::StartsWith("simulated on: "));
  CHECK(names_in_order(ran.output, "ideal ideal"));
  CHECK_THAT(ran.output, holds_text("corduroy"));
  const json fitted = json::parse(content(study.path() / "fitted.json"));
  CHECK(fitted.at("explore_s") == 1.5);
  CHECK(fitted.at("feature_noise").get<double>() > 0.0);
  study.done("simulate @cloths.json --participants 1 --db @again.db --subject @fitted.json");
  const ProgramResult as_json = succeeded(fit(study, {"--json", "--fix", "lapse,classes,swaps"}));
  const json object = json::parse(as_json.output);
  CHECK(object.at("stamp") == "SIMULATED");
  CHECK(names(object.at("simulated_on"), "ideal"));
  CHECK(object.at("bank").at("simulated_on") == object.at("simulated_on"));
  CHECK(object.at("participants") == 4);
  CHECK(object.at("trials") == 24);
  REQUIRE(object.at("estimates").size() == 2);
  CHECK(object.at("estimates")[0].at("name") == "feature_noise");
  CHECK(object.at("estimates")[1].at("name") == "position");
  CHECK(object.at("label_swaps").at("tried").empty());
  // The result does not depend on the number of threads.
  CHECK(fit(study, {"--json", "--fix", "lapse,classes,swaps", "--jobs", "1"}).output ==
        as_json.output);
}

TEST_CASE("fit takes two methods, and the sessions that the report takes") {
  const StudyFolder study("comparison");
  succeeded(study.simulate("s.db"));
  study.done("exclude @s.db --participant P002 --reason ill --after-outcomes");
  const ProgramResult ran = succeeded(fit(study, {"--json"}));
  const json object = json::parse(ran.output);
  CHECK(object.at("participants") == 3);
  CHECK(object.at("confusions").size() == 2);
  for (const char* id : {"P001", "P003", "P004"}) {
    succeeded(study.run(
        {"exclude", study.in("s.db"), "--participant", id, "--reason", "ill", "--after-outcomes"}));
  }
  check_refused(fit(study, {}), 2, {study.in("s.db")});
}

TEST_CASE("fit refuses blind studies, strange labels, and absurd numbers, in one line each") {
  const StudyFolder study;
  succeeded(study.simulate("s.db", {"--keep-blind"}));
  check_refused(fit(study, {}), 2, {"s.db", "touchtrial unblind"});
  study.done("close @s.db --yes");
  study.done("unblind @s.db --reason test --yes");
  replace_file(study.path() / "strange.json",
               std::string(R"({"label_swap": [["linen", "velvet"]]})"));
  check_refused(study.type("fit @s.db --subject @strange.json"), 2, {"velvet"});
  check_refused(fit(study, {"--fix", "everything"}), 2, {"everything"});
  for (const char* number : {"0", "-5", "1e9", "99999999999999999999"}) {
    check_refused(study.run({"fit", study.in("s.db"), "--explorations", number}), 2,
                  {"--explorations"});
  }
  check_refused(study.type("fit @nowhere.db"), 1, {"nowhere.db"});
  fs::rename(study.path() / "s.db.key", study.path() / "moved.key");
  check_refused(fit(study, {}), 1, {"key"});
  succeeded(fit(study, {"--key", study.in("moved.key")}));
}

TEST_CASE("fit --accuracies makes a subject for published accuracies, and refuses others") {
  const StudyFolder study;
  const auto published = [&](const std::string& text) {
    return study.run({"fit", study.in("cloths.json"), "--accuracies", text, "--subject",
                      study.in("quick.json"), "--explorations", "40", "--participants", "4",
                      "--fix", "lapse,position", "--json"});
  };
  const ProgramResult ran = succeeded(published("granite=0.9,linen=0.7,corduroy=0.8"));
  const json object = json::parse(ran.output);
  CHECK(object.at("parameters") == 3);
  for (const json& one : object.at("accuracies")) {
    CHECK(one.at("reached").get<double>() == Approx(one.at("wanted").get<double>()).margin(0.03));
  }
  check_refused(published("granite=0.9,linen=0.7"), 2, {"corduroy"});
  check_refused(published("granite=0.9,linen=0.7,corduroy=1.8"), 2, {"corduroy=1.8"});
  check_refused(published("granite=0.9,linen=0.7,corduroy=0.8,velvet=0.5"), 2, {"velvet"});
  check_refused(published("granite=0.9,granite=0.8,linen=0.7,corduroy=0.8"), 2, {"twice"});
  check_refused(published("granite"), 2, {"granite"});
}

TEST_CASE("fit replaces subject files only, and nothing that it reads") {
  const StudyFolder study;
  succeeded(study.simulate("s.db"));
  const auto unharmed = [&](const std::string& name, const std::vector<std::string>& arguments,
                            const std::string& words, int exit_code = 2) {
    const std::string before = content(study.path() / name);
    check_refused(study.run(arguments), exit_code, {words});
    CHECK(content(study.path() / name) == before);
  };
  for (const char* name : {"s.db", "s.db.key"}) {
    unharmed(name, {"fit", study.in("s.db"), "-o", study.in(name)}, study.in(name));
  }
  for (const char* ending : {"-wal", "-shm"}) {
    const std::string name = study.in("s.db") + ending;
    const bool was_there = fs::exists(name);
    check_refused(fit(study, {"-o", name}), 2, {name});
    CHECK(fs::exists(name) == was_there);
  }
  fs::create_hard_link(study.path() / "s.db", study.path() / "linked.db");
  unharmed("linked.db", {"fit", study.in("s.db"), "-o", study.in("linked.db")},
           study.in("linked.db"));
  unharmed("cloths.json", {"fit", study.in("s.db"), "-o", study.in("cloths.json")}, "--force", 1);
  const std::string accuracies = "granite=0.9,linen=0.7,corduroy=0.8";
  unharmed(
      "cloths.json",
      {"fit", study.in("cloths.json"), "--accuracies", accuracies, "-o", study.in("cloths.json")},
      study.in("cloths.json"));
  unharmed("s.db", {"fit", study.in("s.db"), "--accuracies", accuracies}, "s.db");
  fs::copy_file(study.path() / "quick.json", study.path() / "old.json");
  check_refused(fit(study, {"-o", study.in("old.json")}), 1, {"old.json", "--force"});
  succeeded(fit(study, {"-o", study.in("old.json"), "--force"}));
  CHECK(content(study.path() / "old.json.1") == content(study.path() / "quick.json"));
  CHECK(content(study.path() / "old.json") != content(study.path() / "quick.json"));
}
