// A new study, from a few answers to its report.
#include "app/study_folder.hpp"
#include "support/catch.hpp"

using namespace touchtrial;

namespace {

/// A folder in which `touchtrial new` is started.
struct Desk : ProgramFolder {
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
};

}  // namespace

TEST_CASE("a new study is prepared, registered, simulated and reported as it was written") {
  for (const std::string protocol : {"classification", "comparison"}) {
    const Desk desk;
    const ProgramResult made = succeeded(desk.make("felt", {"--yes", "--protocol", protocol}));
    CHECK_THAT(made.output, holds_text("touchtrial prepare " + desk.in("felt/felt.json")));
    CHECK_THAT(made.output, holds_text("touchtrial preview ") && holds_text("trial simulate "));
    desk.done("prepare @felt/felt.json");
    const ProgramResult page = desk.done("prereg @felt/felt.json");
    CHECK(page.errors.empty());
    desk.done("simulate @felt/felt.json --participants 2 --seed 1 --db @felt/rehearsal.db");
    const json report = desk.printed("report @felt/rehearsal.db --json");
    CHECK(report.at("study") == "felt");
    CHECK(report.at("protocol") == protocol);
    CHECK(report.at("classes").size() == 5);
    // The registration is complete: the report decides on it, whatever the answer.
    CHECK(report.contains("registered"));
  }
}

TEST_CASE("every line of a new study has its comment, and its answers stand in it") {
  const Desk desk;
  succeeded(desk.make("felt", {"--yes", "--name", "cloths", "--people", "31", "--worth", "12.5",
                               "--language", "de", "--consent", "2026-03 {seed}"}));
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

TEST_CASE("questions without an option are asked, and asked again after an invalid answer") {
  const Desk desk;
  // Name, protocol, device twice, pictures, people twice, worth, language, consent, visits, groups
  // twice.
  const ProgramResult made = succeeded(
      desk.make("linen", {}, "linen\n\ntuch\nomega\n\nmany\n12\n\nfr-klingon\nen\n\n\none\n\n"));
  CHECK_THAT(made.errors, holds_text("[20]: "));
  CHECK_THAT(made.errors, holds_text("many") && holds_text("100000"));
  CHECK_THAT(made.errors, holds_text("fr-klingon: "));
  CHECK_THAT(made.errors, holds_text("tuch: ") && holds_text("touch_x"));
  CHECK_THAT(made.errors, holds_text("one: ") && holds_text("16"));
  CHECK_THAT(made.errors, !holds_text("Minimum days between"));
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
  succeeded(desk.make(
      "felt", {"--yes", "--visits", "2", "--between", "6.5", "--groups", "trained, control"}));
  const json study = desk.study("felt/felt.json");
  CHECK(study.at("visits") == json({{"count", 2}, {"least_days", 6.5}}));
  CHECK(study.at("groups").at("labels") == json({"trained", "control"}));
  CHECK_THAT(study.at("registration").at("stopping_rule").get<std::string>(),
             holds_text("2 visits"));
  desk.done("prepare @felt/felt.json");
  check_refused(desk.make("other", {"--yes", "--groups", "one,one"}), 2, {"--groups"});
}

TEST_CASE("without answers, or in a folder with something in it, nothing is written") {
  const Desk desk;
  const ProgramResult unanswered = desk.make("felt", {}, "felt\n");  // the questions too
  CHECK(unanswered.exit_code == 2);
  CHECK_THAT(unanswered.errors, holds_text("--protocol"));
  CHECK_FALSE(path_exists(desk.in("felt")));
  fs::create_directory(desk.in("full"));
  replace_file(desk.in("full/notes.txt"), "mine");
  check_refused(desk.make("full", {"--yes"}), 2, {"full"});
  check_refused(desk.make("felt", {"--yes", "--name", "a b"}), 2, {"--name"});
  check_refused(desk.make("felt", {"--yes", "--worth", "51"}), 2, {"--worth"});
  check_refused(desk.make("felt", {"--yes", "--pictures", desk.in("nowhere")}), 2, {"--pictures"});
  check_refused(desk.make("felt", {"--yes", "--device", "tuch"}), 2, {"--device"});
  check_refused(desk.make("felt", {"--yes", "--device", "my/own.json"}), 2, {"--device"});
  CHECK_FALSE(path_exists(desk.in("felt")));
}

TEST_CASE("pictures of a study for a device are as large as the device's room for them") {
  const Desk desk;
  succeeded(desk.run({"new", desk.in("felt"), "--yes", "--device", "touch"}));
  succeeded(desk.type("device fit @felt/felt.json"));
  const json fit = json::parse(succeeded(desk.type("device fit @felt/felt.json --json")).output);
  CHECK(fit.at("plane").at("width_px") > 200);
}

TEST_CASE("photographs become the classes, and practice has none of their labels") {
  const Desk desk;
  fs::create_directory(desk.in("album"));
  const std::vector<std::string> labels = {"cork", "felt", "leather", "silk"};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    engine::write_png(desk.folder.path() / "album" / (labels[i] + ".png"),
                      texture_number(static_cast<int>(i)));
  }
  succeeded(desk.make("mine", {"--yes", "--crops", "1", "--pictures", desk.in("album")}));
  const json study = desk.study("mine/mine.json");
  CHECK(study.at("classes").size() == 4);
  CHECK(study.at("classes")[1].at("label") == "felt");
  CHECK_FALSE(study.contains("practice"));  // sand alone would be left
  CHECK(study.at("trials").at("practice") == 0);
  desk.done("prepare @mine/mine.json");
}

TEST_CASE("photographs of more than 8 bits are taken by the options of an import") {
  const Desk desk;
  fs::create_directory(desk.in("album"));
  for (const std::string name : {"felt", "linen", "\xd1\x81\xd0\xbe\xd1\x81\xd0\xbd\xd0\xb0"}) {
    std::string file = "P5 60 60 65535\n";  // 12 bits in 16
    for (std::size_t i = 0; i < 3600; ++i) {
      const std::size_t sample = i * (40 + name.size()) % 4096;
      file += static_cast<char>(sample / 256);
      file += static_cast<char>(sample % 256);
    }
    replace_file(desk.in("album/" + name + ".pgm"), file);
  }
  const std::vector<std::string> album = {"--yes", "--crops", "1", "--pictures", desk.in("album")};
  const ProgramResult dark = desk.make("mine", album);
  CHECK_THAT(dark.errors, holds_text("12") && holds_text("16"));
  std::vector<std::string> scaled = album;
  scaled.insert(scaled.end(), {"--bits", "12"});
  CHECK_THAT(succeeded(desk.make("mine", scaled)).errors,
             holds_text("\"felt\"") && holds_text("1"));
  CHECK_THAT(desk.done("prepare @mine/mine.json").errors, holds_text("\"felt\""));
}

TEST_CASE("photographs are checked at once, and new sizes are asked for if they do not fit") {
  const Desk desk;
  for (const std::string folder : {"album", "empty"}) fs::create_directory(desk.in(folder));
  for (int i = 0; i < 3; ++i) {
    engine::write_png(desk.folder.path() / "album" / ("cloth" + std::to_string(i) + ".png"),
                      texture_number(i));
  }
  // 120 pixels are too few for a crop of 200.
  const std::vector<std::string> size = {"--size", "200", "--crops", "1"};
  const ProgramResult small = desk.type("new @deep/mine --yes --pictures @album", size);
  CHECK(small.exit_code == 1);
  for (const char* line : {"cloth2.png 120 x 120 200 x 200", "album 3 --size 120"}) {
    CHECK(names_in_order(small.errors, line));
  }
  CHECK_FALSE(path_exists(desk.in("deep")));

  // Name, protocol, device, pictures twice, size and crops, people, worth, language, consent,
  // visits, groups.
  std::vector<std::string> asked = {"new", desk.in("mine")};
  asked.insert(asked.end(), size.begin(), size.end());
  const ProgramResult made =
      succeeded(desk.run(asked, "mine\n\n\n" + desk.in("empty") + "\n" + desk.in("album") +
                                    "\n48\n1\n12\n\n\n\n\n\n"));
  CHECK_THAT(made.errors, holds_text("[120]: "));
  const json study = desk.study("mine/mine.json");
  CHECK(study.at("classes").size() == 3);
  CHECK(study.at("registration").at("participants") == 12);
}

TEST_CASE("a new study that fails leaves no folder behind") {
  const Desk desk;
  // No file may have more than one block of 512 bytes: the first picture does not fit.
  check_refused(run_touchtrial_limited(desk.folder.path(), "-f 1",
                                       {"new", desk.in("above/felt"), "--yes", "--size", "48"}),
                1, {});
  CHECK_FALSE(path_exists(desk.in("above")));
}
