// The page to deposit, made as a user makes it.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

using namespace touchtrial;

namespace {

const json kRegistered = {
    {"registration",
     {{"hypothesis", "Hands tell cloths apart."},
      {"participants", 12},
      {"stopping_rule", "At twelve."},
      {"exclusions", "Withdrawals."},
      {"primary_test", "A t test."},
      {"estimand", "mean-accuracy"},
      {"smallest_effect", 0.5},
      {"looks", {6}},
      {"exclusion_rules", {{"own_deviations", {"asleep"}}, {"invalid_trials", 0.2}}}}}};

}  // namespace

TEST_CASE("prereg writes the registration, the design and the hashes, and no secret") {
  const StudyFolder study;
  study.write_study(kRegistered);
  study.done("prepare @cloths.json");
  const ProgramResult result = study.done("prereg @cloths.json");
  CHECK(result.errors.empty());
  for (const char* part : {"cloths\n",
                           "Hands tell cloths apart.",
                           "12 participants.",
                           "At twelve.",
                           "Withdrawals.",
                           "A t test.",
                           "estimand",
                           "Student's t",
                           "- alpha: 0.05",
                           "50 %",
                           ": at 6 ",
                           "\"asleep\"",
                           "20 %",
                           "3 (corduroy, granite, linen)",
                           ": 6\n",
                           "300 mm",
                           "2 s",
                           "0.5 s",
                           "25 mm",
                           "(K = 2",
                           "0.4 N/mm",
                           "0.2 mm",
                           "-30 dB",
                           "\"explore_limit_s\":",
                           "- seal: `",
                           "- pack: `"}) {
    CHECK_THAT(result.output, holds_text(part));
  }
  const json key = json::parse(content(study.path() / "cloths.key"));
  for (const std::string& secret :
       {key["master"].get<std::string>(), key["stimuli"][0]["code"].get<std::string>(),
        std::string(".png")}) {
    CHECK(result.output.find(secret) == std::string::npos);
  }
  CHECK(study.type("prereg @cloths.json").output == result.output);
  study.done("prereg @cloths.json -o @page.md");
  CHECK(content(study.path() / "page.md") == result.output);
  check_refused(study.type("prereg @cloths.json -o @page.md"), 2, {"page.md"});
}

TEST_CASE("prereg refuses a study that is not prepared, or has changed since") {
  const StudyFolder study;
  const auto page = [&] { return study.type("prereg @cloths.json"); };
  CHECK(page().exit_code == 2);
  CHECK_THAT(page().errors, holds_text("prepare"));
  study.done("prepare @cloths.json");
  CHECK_THAT(page().errors, holds_text("/registration/hypothesis"));
  succeeded(page());
  study.write_study(kRegistered);
  CHECK(page().exit_code == 2);
  CHECK_THAT(page().errors, holds_text("registration"));
}

TEST_CASE("a key of another study is reported as such, without advice to prepare") {
  const StudyFolder study;
  study.done("prepare @cloths.json");
  study.write_study({{"study", "carpets"}}, "carpets.json");
  study.done("prepare @carpets.json");
  for (const std::string line :
       {"prereg @cloths.json --key @carpets.key", "key check @cloths.json --key @carpets.key",
        "stimuli sheet @cloths.json -o @sheet.html --key @carpets.key",
        "run @cloths.json --participant P01 --db @study.db --subject @quick.json "
        "--station-file @carpets.station"}) {
    const ProgramResult refused = study.type(line);
    INFO(line << ": " << refused.errors);
    CHECK(refused.exit_code != 0);
    CHECK(line_count(refused.errors) == 1);
    CHECK_THAT(refused.errors, holds_text("carpets.") && holds_text("\"carpets\"") &&
                                   holds_text("cloths.json") && holds_text("\"cloths\"") &&
                                   !holds_text("prepare"));
  }
}

TEST_CASE("draft translations are marked wherever results are shown") {
  const StudyFolder study;
  json french = kRegistered;
  french["session"]["language"] = "fr";
  study.write_study(french);
  const std::string draft = "French";
  CHECK_THAT(study.type("prepare @cloths.json").errors, holds_text(draft));
  CHECK_THAT(study.type("prereg @cloths.json").output, holds_text(draft));
  study.done(
      "simulate @cloths.json --participants 2 --seed 1 --db @study.db --subject @quick.json "
      "--keep-blind");
  CHECK_THAT(study.type("report @study.db").output, holds_text(draft));
  study.write_study(kRegistered);
  study.done("prepare @cloths.json");
  const ProgramResult english = study.type("prereg @cloths.json");
  CHECK_THAT(english.output, holds_text("- language: English\n"));
  CHECK(english.output.find("draft") == std::string::npos);
}
