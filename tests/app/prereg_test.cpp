// The page to deposit, made as a user makes it.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

#include <string>

using namespace touchtrial;

namespace {

json registered_study() {
  json study = study_of("classification");
  study["registration"] = {
      {"hypothesis", "Hands tell cloths apart."},
      {"participants", 12},
      {"stopping_rule", "At twelve."},
      {"exclusions", "Withdrawals."},
      {"primary_test", "A t test."},
      {"estimand", "mean-accuracy"},
      {"smallest_effect", 0.5},
      {"looks", {6}},
      {"exclusion_rules", {{"deviations", {"asleep"}}, {"invalid_trials", 0.2}}}};
  return study;
}

}  // namespace

TEST_CASE("prereg writes the registration, the design and the hashes, and no secret") {
  const StudyFolder study;
  replace_file(study.path() / "cloths.json", registered_study().dump());
  REQUIRE(study.run({"prepare", study.in("cloths.json")}).exit_code == 0);
  const ProgramResult result = study.run({"prereg", study.in("cloths.json")});
  INFO(result.errors);
  REQUIRE(result.exit_code == 0);
  CHECK(result.errors.empty());
  for (const char* part :
       {"# Preregistration of the study cloths", "Hands tell cloths apart.", "12 participants.",
        "At twelve.", "Withdrawals.", "A t test.",
        "- estimand: mean over participants of the share of right answers, against chance",
        "- test: Student's t test over participants, one-sided", "- alpha: 0.05",
        "- smallest worth having: 50 % right", "- interim looks: at 6 participants",
        "- exclusion rules: a session with a deviation \"asleep\" or more than 20 % of trials not "
        "valid",
        "3 (corduroy, granite, linen)", "scored trials a participant: 6", "at least 300 mm",
        "- seal: `", "- pack: `"}) {
    CHECK_THAT(result.output, holds_text(part));
  }
  const json key = json::parse(content(study.path() / "cloths.key"));
  for (const std::string& secret :
       {key["master"].get<std::string>(), key["stimuli"][0]["code"].get<std::string>(),
        std::string(".png")}) {
    CHECK(result.output.find(secret) == std::string::npos);
  }
  CHECK(study.run({"prereg", study.in("cloths.json")}).output == result.output);
  REQUIRE(study.run({"prereg", study.in("cloths.json"), "-o", study.in("page.md")}).exit_code == 0);
  CHECK(content(study.path() / "page.md") == result.output);
  const ProgramResult again =
      study.run({"prereg", study.in("cloths.json"), "-o", study.in("page.md")});
  CHECK(again.exit_code == 2);
  CHECK_THAT(again.errors, holds_text("exists already"));
}

TEST_CASE("prereg refuses a study that is not prepared, or has changed since") {
  const StudyFolder study;
  const auto page = [&] { return study.run({"prereg", study.in("cloths.json")}); };
  CHECK(page().exit_code == 2);
  CHECK_THAT(page().errors, holds_text("is not prepared"));
  REQUIRE(study.run({"prepare", study.in("cloths.json")}).exit_code == 0);
  CHECK_THAT(page().errors, holds_text("/registration/hypothesis is not stated"));
  CHECK(page().exit_code == 0);
  replace_file(study.path() / "cloths.json", registered_study().dump());
  CHECK(page().exit_code == 2);
  CHECK_THAT(page().errors, holds_text("has changed since it was prepared"));
}
