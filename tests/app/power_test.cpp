// Power of a study, run as a user runs it: threads and invalid arguments.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

#include <string>

using namespace touchtrial;

namespace {

/// A power run of the small study, fast enough for a test.
ProgramResult power(const StudyFolder& study, const std::string& more,
                    const std::string& runs = "120", const std::string& seed = "5") {
  return study.type("power @cloths.json --subject @quick.json --explorations 10 --trainings 2 " +
                    more + " --runs " + runs + " --seed " + seed);
}

}  // namespace

TEST_CASE("power prints the same numbers with any number of threads") {
  const StudyFolder study;
  const ProgramResult one = succeeded(power(study, "--participants 3,5 --jobs 1 --json"));
  const ProgramResult two = succeeded(power(study, "--participants 3,5 --jobs 3 --json"));
  CHECK(one.output == two.output);
  const json report = json::parse(one.output);
  CHECK(report.at("simulated") == true);
  CHECK(names(report.at("simulated_on"), "ideal"));
  CHECK(report.at("sizes").size() == 2);
  CHECK(report.at("sizes").at(0).at("type_one_error").at("runs") == 120);
  CHECK_THAT(power(study, "--participants 3,5").output,
             Catch::Matchers::StartsWith("simulated on: ideal ") && holds_text("\nSIMULATED: "));
}

TEST_CASE("power refuses invalid arguments in one line") {
  const StudyFolder study;
  for (const std::string sizes :
       {"1", "8,8", "1000000000", "99999999999999999999", "eight", "8,,12"}) {
    INFO(sizes);
    check_refused(power(study, "--participants " + sizes), 2, {"--participants"});
  }
  check_refused(power(study, "--participants -8"), 2, {"--participants"});
  for (const char* runs : {"0", "-1", "1.5", "1000000000", "many"}) {
    check_refused(power(study, "--participants 3,5", runs), 2, {"--runs"});
  }
  check_refused(power(study, "--methods adaptive,edge"), 2, {"--methods"});
  check_refused(study.type("power"), 2, {"STUDY"});
  check_refused(study.type("power @none.json"), 2, {"none.json"});
}

TEST_CASE("power writes its curve into a folder and keeps foreign files there") {
  const StudyFolder study;
  succeeded(power(study, "--participants 3,5 --figure @curve"));
  const std::filesystem::path folder = study.path() / "curve";
  for (const char* ending : {"csv", "gp", "py", "r"}) {
    CHECK(std::filesystem::exists(folder / ("power-curve." + std::string(ending))));
  }
  CHECK_THAT(content(folder / "power-curve.csv"), holds_text(",interval,simulated studies,3,"));
  replace_file(folder / "power-curve.csv", "mine");
  check_refused(power(study, "--participants 3,5 --figure @curve"), 1, {"power-curve.csv"});
  CHECK(content(folder / "power-curve.csv") == "mine");
}
