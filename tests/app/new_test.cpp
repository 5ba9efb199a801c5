// A new study, from a few answers to its report.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

#include <filesystem>
#include <string>
#include <vector>

using namespace touchtrial;

namespace {

/// A folder in which `touchtrial new` is started.
struct Desk {
  [[nodiscard]] std::string in(const std::string& name) const {
    return (folder.path() / name).string();
  }
  [[nodiscard]] ProgramResult run(const std::vector<std::string>& arguments,
                                  const std::string& input = "") const {
    return run_touchtrial(folder.path(), arguments, input);
  }
  /// Pictures of a few pixels, which are made quickly.
  [[nodiscard]] ProgramResult make(const std::string& name, const std::vector<std::string>& more,
                                   const std::string& input = "") const {
    std::vector<std::string> arguments = {"new", in(name), "--size", "48"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, input);
  }
  [[nodiscard]] json study(const std::string& name) const {
    return json::parse(content(folder.path() / name), nullptr, true, true);
  }

  TempFolder folder;
};

void check_refused(const ProgramResult& result, const std::string& reason) {
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.errors, holds_text(reason));
}

}  // namespace

TEST_CASE("a new study is prepared, registered, simulated and reported as it was written") {
  for (const std::string protocol : {"classification", "comparison"}) {
    const Desk desk;
    const ProgramResult made = desk.make("felt", {"--yes", "--protocol", protocol});
    INFO(made.errors);
    REQUIRE(made.exit_code == 0);
    CHECK_THAT(made.output, holds_text("touchtrial prepare " + desk.in("felt/felt.json")));
    CHECK_THAT(made.output,
               holds_text("touchtrial preview ") && holds_text("touchtrial simulate "));
    REQUIRE(desk.run({"prepare", desk.in("felt/felt.json")}).exit_code == 0);
    const ProgramResult page = desk.run({"prereg", desk.in("felt/felt.json")});
    CHECK(page.exit_code == 0);
    CHECK(page.errors.empty());
    const ProgramResult simulated =
        desk.run({"simulate", desk.in("felt/felt.json"), "--participants", "2", "--seed", "1",
                  "--db", desk.in("felt/rehearsal.db")});
    INFO(simulated.errors);
    REQUIRE(simulated.exit_code == 0);
    const ProgramResult reported = desk.run({"report", desk.in("felt/rehearsal.db"), "--json"});
    REQUIRE(reported.exit_code == 0);
    const json report = json::parse(reported.output);
    CHECK(report.at("study") == "felt");
    CHECK(report.at("protocol") == protocol);
    CHECK(report.at("classes").size() == 5);
    // The registration is complete: the report decides on it, whatever the answer.
    CHECK(report.contains("registered"));
  }
}

TEST_CASE("every line of a new study has its comment, and its answers stand in it") {
  const Desk desk;
  const ProgramResult made =
      desk.make("felt", {"--yes", "--name", "cloths", "--people", "31", "--worth", "12.5",
                         "--language", "de", "--consent", "2026-03 {seed}"});
  INFO(made.errors);
  REQUIRE(made.exit_code == 0);
  const json study = desk.study("felt/cloths.json");
  CHECK(study.at("study") == "cloths");
  CHECK(study.at("session").at("language") == "de");
  CHECK(study.at("session").at("consent_version") == "2026-03 {seed}");
  CHECK(study.at("registration").at("participants") == 31);
  CHECK(study.at("registration").at("smallest_effect") == 0.325);  // one in five, and 12.5 points
  CHECK(study.at("rendering").at("model") == "paper");
  CHECK_FALSE(study.at("rendering").contains("device"));
  CHECK(study.at("practice").at("classes").size() == 3);
  CHECK(study.at("trials").at("practice") == 5);
  const std::string text = content(desk.folder.path() / "felt/cloths.json");
  for (const auto& [key, section] : study.items()) {
    const std::size_t at = text.find("\n  \"" + key + "\":");
    REQUIRE(at != std::string::npos);
    const std::size_t before = text.rfind('\n', at - 1);
    INFO(key);
    CHECK(text.compare(before + 1, 4, "  //") == 0);
  }
}

TEST_CASE("what no option answers is asked, and a wrong answer is asked for again") {
  const Desk desk;
  // Name, protocol, pictures, device twice, people twice, worth, language, consent, visits, groups
  // twice.
  const ProgramResult made =
      desk.make("linen", {}, "linen\n\n\ntuch\nomega\nmany\n12\n\nfr-klingon\nen\n\n\none\n\n");
  INFO(made.errors);
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.errors, holds_text("Number of participants [20]: "));
  CHECK_THAT(made.errors, holds_text("many: must be a number from 2 to 100000"));
  CHECK_THAT(made.errors, holds_text("fr-klingon: "));
  CHECK_THAT(made.errors, holds_text("tuch: ") && holds_text("touch_x"));
  CHECK_THAT(made.errors, holds_text("one: must be 2 to 16 names"));
  CHECK_THAT(made.errors, !holds_text("Least days between"));
  const json study = desk.study("linen/linen.json");
  CHECK(study.at("registration").at("participants") == 12);
  CHECK(study.at("registration").at("smallest_effect") == 0.4);
  CHECK(study.at("session").at("consent_version") == "");
  CHECK(study.at("rendering").at("device") == "omega");
  CHECK_FALSE(study.contains("visits"));
  CHECK_FALSE(study.contains("groups"));
}

TEST_CASE("visits and groups that are wished for stand in a new study, and it runs") {
  const Desk desk;
  const ProgramResult made = desk.make(
      "felt", {"--yes", "--visits", "2", "--between", "6.5", "--groups", "trained, control"});
  INFO(made.errors);
  REQUIRE(made.exit_code == 0);
  const json study = desk.study("felt/felt.json");
  CHECK(study.at("visits") == json({{"count", 2}, {"least_days", 6.5}}));
  CHECK(study.at("groups").at("labels") == json({"trained", "control"}));
  CHECK_THAT(study.at("registration").at("stopping_rule").get<std::string>(),
             holds_text("have completed all 2 visits"));
  CHECK(desk.run({"prepare", desk.in("felt/felt.json")}).exit_code == 0);
  check_refused(desk.make("other", {"--yes", "--groups", "one,one"}), "--groups");
}

TEST_CASE("without answers, or in a folder with something in it, nothing is written") {
  const Desk desk;
  check_refused(desk.make("felt", {}, "felt\n"), "there is no answer for --protocol");
  CHECK_FALSE(is_there(desk.in("felt")));
  fs::create_directory(desk.in("full"));
  replace_file(desk.in("full/notes.txt"), "mine");
  check_refused(desk.make("full", {"--yes"}), "exists already");
  check_refused(desk.make("felt", {"--yes", "--name", "a b"}), "--name");
  check_refused(desk.make("felt", {"--yes", "--worth", "51"}), "--worth");
  check_refused(desk.make("felt", {"--yes", "--pictures", desk.in("nowhere")}), "--pictures");
  check_refused(desk.make("felt", {"--yes", "--device", "tuch"}), "--device");
  check_refused(desk.make("felt", {"--yes", "--device", "my/own.json"}), "--device");
  CHECK_FALSE(is_there(desk.in("felt")));
}

TEST_CASE("photographs become the classes, and practice has none of their labels") {
  const Desk desk;
  fs::create_directory(desk.in("album"));
  const std::vector<std::string> labels = {"cork", "felt", "leather", "silk"};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    engine::write_png(desk.folder.path() / "album" / (labels[i] + ".png"),
                      texture_number(static_cast<int>(i)));
  }
  const ProgramResult made =
      desk.make("mine", {"--yes", "--crops", "1", "--pictures", desk.in("album")});
  INFO(made.errors);
  REQUIRE(made.exit_code == 0);
  const json study = desk.study("mine/mine.json");
  CHECK(study.at("classes").size() == 4);
  CHECK(study.at("classes")[1].at("label") == "felt");
  CHECK_FALSE(study.contains("practice"));  // sand alone would be left
  CHECK(study.at("trials").at("practice") == 0);
  CHECK(desk.run({"prepare", desk.in("mine/mine.json")}).exit_code == 0);
}

TEST_CASE("photographs are tried when they are named, and what they lack is asked for") {
  const Desk desk;
  for (const std::string folder : {"album", "empty"}) fs::create_directory(desk.in(folder));
  for (int i = 0; i < 3; ++i) {
    engine::write_png(desk.folder.path() / "album" / ("cloth" + std::to_string(i) + ".png"),
                      texture_number(i));
  }
  // 120 pixels are too few for a crop of 200.
  const std::vector<std::string> size = {"--size", "200", "--crops", "1"};
  std::vector<std::string> at_once = {"new", desk.in("deep/mine"), "--yes", "--pictures",
                                      desk.in("album")};
  at_once.insert(at_once.end(), size.begin(), size.end());
  const ProgramResult refused = desk.run(at_once);
  CHECK(refused.exit_code == 1);
  CHECK(line_count(refused.errors) == 1);
  CHECK_THAT(refused.errors,
             holds_text("too few for a crop of 200 x 200") && holds_text("--size 120"));
  CHECK_FALSE(is_there(desk.in("deep")));

  // Name, protocol, pictures twice, size and crops, device, people, worth, language, consent,
  // visits, groups.
  std::vector<std::string> asked = {"new", desk.in("mine")};
  asked.insert(asked.end(), size.begin(), size.end());
  const ProgramResult made = desk.run(
      asked, "mine\n\n" + desk.in("empty") + "\n" + desk.in("album") + "\n48\n1\n\n12\n\n\n\n\n\n");
  INFO(made.errors);
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.errors, holds_text("Side of a picture, pixels [120]: "));
  const json study = desk.study("mine/mine.json");
  CHECK(study.at("classes").size() == 3);
  CHECK(study.at("registration").at("participants") == 12);
}

TEST_CASE("a new study that fails leaves no folder behind") {
  const Desk desk;
  // No file may have more than one block of 512 bytes: the first picture does not fit.
  const ProgramResult limited = run_touchtrial_limited(
      desk.folder.path(), "-f 1", {"new", desk.in("above/felt"), "--yes", "--size", "48"});
  INFO(limited.errors);
  CHECK(limited.exit_code == 1);
  CHECK(line_count(limited.errors) == 1);
  CHECK_FALSE(is_there(desk.in("above")));
}
