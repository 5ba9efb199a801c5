// Power of a study, run as a user runs it: threads and invalid arguments.
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

TEST_CASE("power prints the same numbers with any number of threads") {
  const StudyFolder study;
  const ProgramResult one = succeeded(run_power(study, with_sizes({"--jobs", "1", "--json"})));
  const ProgramResult two = run_power(study, with_sizes({"--jobs", "3", "--json"}));
  INFO(two.errors);
  CHECK(one.output == two.output);
  const json report = json::parse(one.output);
  CHECK(report.at("simulated") == true);
  CHECK(report.at("simulated_on") == "ideal device (no such device is sold)");
  CHECK(report.at("sizes").size() == 2);
  CHECK(report.at("sizes").at(0).at("type_one_error").at("runs") == 120);
  const ProgramResult text = run_power(study, kSizes);
  CHECK_THAT(text.output,
             Catch::Matchers::StartsWith("simulated on: ideal device (no such device is sold)\n"
                                         "SIMULATED: power given the assumed sensitivity"));
}

TEST_CASE("power refuses invalid arguments in one line") {
  const StudyFolder study;
  for (const char* sizes : {"1", "8,8", "1000000000", "99999999999999999999", "eight", "8,,12"}) {
    check_refused(run_power(study, {"--participants", sizes}), 2, {"--participants"});
  }
  check_refused(run_power(study, {"--participants", "-8"}), 2, {});
  for (const char* runs : {"0", "-1", "1.5", "1000000000", "many"}) {
    Words words = power_of(study, kSizes);
    words[5] = runs;
    check_refused(study.run(words), 2, {"--runs"});
  }
  check_refused(run_power(study, {"--methods", "adaptive,edge"}), 2, {"--methods"});
  check_refused(study.type("power"), 2, {"STUDY"});
  check_refused(study.type("power @none.json"), 2, {"none.json"});
}
