// A study from its file to its tables, run as a user runs it.
#include "app/touchtrial_process.hpp"
#include "core/files.hpp"
#include "core/random.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

using namespace touchtrial;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// Rough noise, smooth noise and stripes: three textures that a hand can tell apart.
GreyImage texture_number(int number) {
  RandomStream random(7, "study test", static_cast<std::uint64_t>(number));
  GreyImage image(120, 120);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const auto noise = static_cast<int>(random.below(number == 0 ? 200 : 20));
      const int stripes = number == 2 ? 120 * ((x / 9) % 2) : 60 * ((x / 3 + y / 3) % 2);
      image.at(y, x) = static_cast<std::uint8_t>(number == 0 ? noise : 40 + stripes + noise);
    }
  }
  return image;
}

const std::vector<std::string> kLabels = {"granite", "linen", "corduroy"};

json study_of(const std::string& protocol) {
  json classes = json::array();
  for (const std::string& label : kLabels) {
    classes.push_back({{"label", label}, {"images", {label + "-photo.png"}}});
  }
  json methods = json::array({{{"name", "adaptive"}}});
  if (protocol == "comparison") methods.push_back({{"name", "fixed"}, {"order", 0.3}});
  return {{"study", "cloths"},
          {"protocol", protocol},
          {"classes", classes},
          {"methods", methods},
          {"trials", {{"repeats", 2}, {"explore_limit_s", 2.0}}},
          {"seed", 11}};
}

/// A folder with a study file, its pictures, and a quick subject.
struct StudyFolder {
  explicit StudyFolder(const std::string& protocol = "classification") {
    for (std::size_t i = 0; i < kLabels.size(); ++i) {
      write_png(path() / (kLabels[i] + "-photo.png"), texture_number(static_cast<int>(i)));
    }
    replace_file(path() / "cloths.json", study_of(protocol).dump());
    replace_file(path() / "quick.json",
                 R"({"weber": 0.1, "explore_s": 1.5, "training_passes": 2})");
  }
  [[nodiscard]] const fs::path& path() const { return folder.path(); }
  [[nodiscard]] std::string in(const std::string& name) const { return (path() / name).string(); }

  ProgramResult run(const std::vector<std::string>& arguments) const {
    return run_touchtrial(path(), arguments);
  }
  ProgramResult simulate(const std::string& db, const std::vector<std::string>& more = {},
                         const std::string& seed = "3") const {
    std::vector<std::string> arguments = {
        "simulate", in("cloths.json"), "--participants", "4", "--seed", seed, "--db",
        in(db),     "--subject",       in("quick.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  TempFolder folder;
};

std::string content(const fs::path& path) {
  return text_of(read_file(path));
}

}  // namespace

TEST_CASE("a study goes from its file to an accuracy table that adds up") {
  const StudyFolder study;
  const ProgramResult simulated = study.simulate("a.db");
  INFO(simulated.errors);
  REQUIRE(simulated.exit_code == 0);
  CHECK(simulated.output.find("SIMULATED") != std::string::npos);

  const ProgramResult reported = study.run({"report", study.in("a.db"), "--json"});
  REQUIRE(reported.exit_code == 0);
  const json report = json::parse(reported.output);
  CHECK(report.at("participants") == 4);
  CHECK(report.at("trials") == 4 * 6);
  CHECK(report.at("classes") == json(kLabels));
  CHECK(report.at("simulated") == true);
  const json& method = report.at("methods").at(0);
  int correct = 0;
  for (std::size_t i = 0; i < kLabels.size(); ++i) {
    int row = method.at("no_response").at(i).get<int>();
    for (const json& count : method.at("confusion").at(i)) row += count.get<int>();
    CHECK(row == 8);  // every class twice for each participant
    correct += method.at("confusion").at(i).at(i).get<int>();
  }
  CHECK(method.at("overall").at("correct") == correct);
  CHECK(method.at("overall").at("n") == 24);

  const ProgramResult text = study.run({"report", study.in("a.db")});
  CHECK(text.exit_code == 0);
  CHECK(text.output.find("SIMULATED") != std::string::npos);
  CHECK(text.output.find("corduroy") != std::string::npos);
}

TEST_CASE("exports and reports are the same bytes for a seed, whatever the number of jobs") {
  const StudyFolder study("comparison");
  REQUIRE(study.simulate("one.db", {"--jobs", "1"}).exit_code == 0);
  REQUIRE(study.simulate("three.db", {"--jobs", "3"}).exit_code == 0);
  for (const std::string format : {"csv", "json"}) {
    REQUIRE(study.run({"export", study.in("one.db"), "--format", format, "--out", study.in("1")})
                .exit_code == 0);
    REQUIRE(study.run({"export", study.in("three.db"), "--format", format, "--out", study.in("3")})
                .exit_code == 0);
  }
  int files = 0;
  for (const auto& entry : fs::directory_iterator(study.path() / "1")) {
    INFO(entry.path());
    CHECK(content(entry.path()) == content(study.path() / "3" / entry.path().filename()));
    ++files;
  }
  CHECK(files >= 5);
  CHECK(study.run({"report", study.in("one.db"), "--json"}).output ==
        study.run({"report", study.in("three.db"), "--json"}).output);
}

TEST_CASE("another seed gives other answers") {
  const StudyFolder study;
  REQUIRE(study.simulate("a.db").exit_code == 0);
  REQUIRE(study.simulate("b.db", {}, "4").exit_code == 0);
  for (const std::string name : {"a", "b"}) {
    REQUIRE(study.run({"export", study.in(name + ".db"), "--out", study.in(name)}).exit_code == 0);
  }
  CHECK(content(study.path() / "a" / "trials.csv") != content(study.path() / "b" / "trials.csv"));
}

TEST_CASE("a blind study's database and pack name no class and no picture") {
  const StudyFolder study;
  REQUIRE(study.simulate("a.db", {"--keep-blind"}).exit_code == 0);
  std::vector<fs::path> files = {study.path() / "a.db"};
  for (const auto& entry : fs::directory_iterator(study.path() / "cloths.sim.pack")) {
    files.push_back(entry.path());
  }
  REQUIRE(files.size() >= 1 + 1 + kLabels.size());
  for (const fs::path& file : files) {
    const std::string bytes = content(file);
    for (const std::string& label : kLabels) {
      INFO(file << " and " << label);
      CHECK(bytes.find(label) == std::string::npos);
      CHECK(file.filename().string().find(label) == std::string::npos);
    }
    CHECK(bytes.find("photo") == std::string::npos);
  }
}

TEST_CASE("before unblinding, report and export show quality and no outcome") {
  const StudyFolder study;
  REQUIRE(study.simulate("a.db", {"--keep-blind"}).exit_code == 0);
  const ProgramResult reported = study.run({"report", study.in("a.db"), "--json"});
  REQUIRE(reported.exit_code == 0);
  const json quality = json::parse(reported.output);
  CHECK(quality.at("participants") == 4);
  CHECK_FALSE(quality.contains("methods"));
  for (const std::string& label : kLabels) {
    CHECK(reported.output.find(label) == std::string::npos);
  }
  REQUIRE(study.run({"export", study.in("a.db"), "--out", study.in("csv")}).exit_code == 0);
  const std::string trials = content(study.path() / "csv" / "trials.csv");
  const std::string header = trials.substr(0, trials.find('\n'));
  for (const std::string column : {"class", "exemplar", "method", "response", "correct"}) {
    CHECK(("," + header + ",").find("," + column + ",") == std::string::npos);
  }
  CHECK_FALSE(fs::exists(study.path() / "csv" / "confusion_adaptive.csv"));
}

TEST_CASE("outcomes show only after closing and unblinding, which are recorded") {
  const StudyFolder study;
  REQUIRE(study.simulate("a.db", {"--keep-blind"}).exit_code == 0);
  CHECK(study.run({"unblind", study.in("a.db"), "--reason", "curious"}).exit_code == 1);
  CHECK(study.run({"unblind", study.in("a.db")}).exit_code == 2);
  CHECK(study.run({"close", study.in("a.db")}).exit_code == 0);
  CHECK(study.run({"close", study.in("a.db")}).exit_code == 1);
  CHECK(study.run({"unblind", study.in("a.db"), "--reason", "collection is over"}).exit_code == 0);
  const json report = json::parse(study.run({"report", study.in("a.db"), "--json"}).output);
  CHECK(report.contains("methods"));
  CHECK(study.run({"verify", study.in("a.db")}).exit_code == 0);
}

TEST_CASE("an interim look is possible before closing, if it is called one") {
  const StudyFolder study;
  REQUIRE(study.simulate("a.db", {"--keep-blind"}).exit_code == 0);
  CHECK(study.run({"unblind", study.in("a.db"), "--reason", "safety", "--interim"}).exit_code == 0);
  CHECK(json::parse(study.run({"report", study.in("a.db"), "--json"}).output).contains("methods"));
}

TEST_CASE("outcomes need the study's own key") {
  const StudyFolder study;
  REQUIRE(study.simulate("a.db").exit_code == 0);
  fs::rename(study.path() / "a.db.key", study.path() / "elsewhere.key");
  const ProgramResult missing = study.run({"report", study.in("a.db")});
  CHECK(missing.exit_code == 1);
  CHECK(line_count(missing.errors) == 1);
  CHECK(study.run({"report", study.in("a.db"), "--key", study.in("elsewhere.key")}).exit_code == 0);

  replace_file(study.path() / "other.json", [] {
    json other = study_of("classification");
    other["seed"] = 12;
    return other.dump();
  }());
  REQUIRE(study
              .run({"simulate", study.in("other.json"), "--participants", "1", "--db",
                    study.in("other.db"), "--subject", study.in("quick.json")})
              .exit_code == 0);
  const ProgramResult wrong =
      study.run({"report", study.in("a.db"), "--key", study.in("other.db.key")});
  CHECK(wrong.exit_code == 3);
  CHECK(line_count(wrong.errors) == 1);
  CHECK(study.run({"verify", study.in("a.db"), "--key", study.in("other.db.key")}).exit_code == 3);
}

TEST_CASE("verify finds a field that was tampered with") {
  const StudyFolder study;
  REQUIRE(study.simulate("a.db").exit_code == 0);
  REQUIRE(study.run({"verify", study.in("a.db")}).exit_code == 0);
  for (const auto& entry : fs::directory_iterator(study.path() / "cloths.sim.pack")) {
    if (entry.path().extension() != ".field") continue;
    Bytes bytes = read_file(entry.path());
    bytes[bytes.size() / 2] ^= 1U;
    replace_file(entry.path(), ByteView(bytes));
    break;
  }
  const ProgramResult result = study.run({"verify", study.in("a.db")});
  CHECK(result.exit_code == 3);
  CHECK(result.output.find("pack") != std::string::npos);
}

TEST_CASE("verify calls a truncated database and an altered key findings, with exit 3") {
  const StudyFolder study;
  REQUIRE(study.simulate("a.db").exit_code == 0);
  const auto verified = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"verify", study.in("a.db"), "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return study.run(arguments);
  };
  const json whole = json::parse(verified({}).output);
  CHECK(whole.at("complete") == true);
  const std::string head = whole.at("head").at("hash");
  CHECK(verified({"--head", head}).exit_code == 0);
  CHECK(verified({"--head", std::string(64, '0')}).exit_code == 3);
  CHECK(verified({"--head", "12"}).exit_code == 2);

  replace_file(study.path() / "a.db.key", content(study.path() / "a.db.key") + " ");
  const ProgramResult altered = verified({});
  CHECK(altered.exit_code == 3);
  CHECK(json::parse(altered.output).at("checks").at(0).at("state") == "passed");
  CHECK(json::parse(altered.output).at("checks").at(1).at("state") == "failed");

  fs::resize_file(study.path() / "a.db", fs::file_size(study.path() / "a.db") / 2);
  const ProgramResult cut = verified({});
  CHECK(cut.exit_code == 3);
  CHECK(json::parse(cut.output).at("checks").at(0).at("state") == "failed");
  CHECK(study.run({"verify", study.in("none.db")}).exit_code == 1);
}

TEST_CASE("simulate never overwrites a database") {
  const StudyFolder study;
  replace_file(study.path() / "a.db", "precious");
  const ProgramResult result = study.simulate("a.db");
  CHECK(result.exit_code == 1);
  CHECK(line_count(result.errors) == 1);
  CHECK(content(study.path() / "a.db") == "precious");
}

TEST_CASE("a bad study file is refused with exit 2, its name and the place") {
  const StudyFolder study;
  json misspelt = study_of("classification");
  misspelt["trials"]["repeat"] = 5;
  replace_file(study.path() / "bad.json", misspelt.dump());
  for (const std::string command : {"prepare", "simulate"}) {
    std::vector<std::string> arguments = {command, study.in("bad.json")};
    if (command == "simulate") {
      arguments.emplace_back("--db");
      arguments.push_back(study.in("bad.db"));
    }
    const ProgramResult result = study.run(arguments);
    INFO(result.errors);
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.errors) == 1);
    CHECK(result.errors.find("bad.json") != std::string::npos);
    CHECK(result.errors.find("/trials/repeat") != std::string::npos);
    CHECK(result.errors.find("repeats") != std::string::npos);
  }
  CHECK_FALSE(fs::exists(study.path() / "bad.db"));
}

TEST_CASE("prepare builds once, reuses afterwards, and rebuilds what changed") {
  const StudyFolder study;
  const auto prepared = [&] { return study.run({"prepare", study.in("cloths.json")}); };
  const ProgramResult first = prepared();
  INFO(first.errors);
  REQUIRE(first.exit_code == 0);
  CHECK(first.output.find("built 3, reused 0") != std::string::npos);
  CHECK(fs::exists(study.path() / "cloths.key"));
  const std::string manifest = content(study.path() / "cloths.pack" / "pack.json");
  CHECK(prepared().output.find("built 0, reused 3") != std::string::npos);
  CHECK(content(study.path() / "cloths.pack" / "pack.json") == manifest);
  write_png(study.path() / "linen-photo.png", texture_number(5));
  CHECK(prepared().output.find("built 1, reused 2") != std::string::npos);
}

TEST_CASE("prepare says which method the protocol does not present, and does not compute it") {
  const StudyFolder study;
  json two = study_of("classification");
  two["methods"].push_back({{"name", "tv-gabor"}});
  replace_file(study.path() / "cloths.json", two.dump());
  const ProgramResult result = study.run({"prepare", study.in("cloths.json")});
  REQUIRE(result.exit_code == 0);
  CHECK(result.output.find("built 3") != std::string::npos);
  CHECK(result.output.find("skipped") != std::string::npos);
  CHECK(result.output.find("tv-gabor") != std::string::npos);
}

TEST_CASE("prepare explains stage by stage, in text and as JSON, without a code") {
  const StudyFolder study;
  json two = study_of("comparison");
  two["methods"] = {{{"name", "adaptive"}}, {{"name", "adaptive"}, {"control", "phase-scrambled"}}};
  replace_file(study.path() / "cloths.json", two.dump());
  const ProgramResult text = study.run({"prepare", study.in("cloths.json"), "--explain"});
  INFO(text.errors);
  REQUIRE(text.exit_code == 0);
  CHECK_THAT(text.output, holds_text("linen, exemplar 1, adaptive-phase-scrambled: built"));
  CHECK_THAT(text.output, holds_text("taken for another stimulus of this image"));
  CHECK_THAT(text.output, holds_text("computed "));
  const ProgramResult result =
      study.run({"prepare", study.in("cloths.json"), "--explain", "--json"});
  REQUIRE(result.exit_code == 0);
  const json object = json::parse(result.output);
  REQUIRE(object["stimuli"].size() == 6);
  CHECK(object["stimuli"][1]["method"] == "adaptive-phase-scrambled");
  CHECK(object["stimuli"][1]["state"] == "reused");
  CHECK(object["stimuli"][1]["stages"][1]["stage"] == "field");
  CHECK(object["totals"]["bytes_written"] == 0);
  CHECK(object["totals"]["reused"]["stages"] == 6 + 3 + 1);
  const json manifest = json::parse(content(study.path() / "cloths.pack" / "pack.json"));
  for (const json& field : manifest["fields"]) {
    CHECK(text.output.find(field["code"].get<std::string>()) == std::string::npos);
    CHECK(result.output.find(field["code"].get<std::string>()) == std::string::npos);
  }
}

TEST_CASE("simulate does not replace a key that belongs to something else") {
  const StudyFolder study;
  REQUIRE(study.run({"prepare", study.in("cloths.json")}).exit_code == 0);
  const std::string key = content(study.path() / "cloths.key");
  const ProgramResult result = study.simulate("cloths");  // its key would be cloths.key
  CHECK(result.exit_code == 1);
  CHECK(line_count(result.errors) == 1);
  CHECK(content(study.path() / "cloths.key") == key);
  CHECK_FALSE(fs::exists(study.path() / "cloths"));
}

TEST_CASE("a removed database can be made again beside the key it left") {
  const StudyFolder study;
  REQUIRE(study.simulate("a.db").exit_code == 0);
  fs::remove(study.path() / "a.db");
  CHECK(study.simulate("a.db").exit_code == 0);
}

TEST_CASE("prepare keeps the key of a study that changed, and refuses that of another study") {
  const StudyFolder study;
  REQUIRE(study.run({"prepare", study.in("cloths.json")}).exit_code == 0);
  const std::string key = content(study.path() / "cloths.key");
  json changed = study_of("classification");
  changed["trials"]["repeats"] = 3;
  replace_file(study.path() / "cloths.json", changed.dump());
  const ProgramResult again = study.run({"prepare", study.in("cloths.json")});
  CHECK(again.exit_code == 0);
  bool kept = false;
  for (const auto& entry : fs::directory_iterator(study.path())) {
    kept = kept ||
           (entry.path().filename() != "cloths.key" &&
            entry.path().filename().string().starts_with("cloths.key.") &&
            json::parse(content(entry.path())).at("study_id") == json::parse(key).at("study_id"));
  }
  CHECK(kept);

  changed["study"] = "other";
  replace_file(study.path() / "other.json", changed.dump());
  const std::string present = content(study.path() / "cloths.key");
  const ProgramResult other =
      study.run({"prepare", study.in("other.json"), "--pack", study.in("cloths.pack")});
  CHECK(other.exit_code == 2);
  CHECK(content(study.path() / "cloths.key") == present);
}

TEST_CASE("prepare touches nothing when a picture of the study is missing") {
  const StudyFolder study;
  fs::remove(study.path() / "linen-photo.png");
  const ProgramResult result = study.run({"prepare", study.in("cloths.json")});
  CHECK(result.exit_code == 2);
  CHECK(line_count(result.errors) == 1);
  CHECK(result.errors.find("/classes/1/images/0") != std::string::npos);
  CHECK(result.errors.find("cloths.json") != std::string::npos);
  CHECK_FALSE(fs::exists(study.path() / "cloths.key"));
}

TEST_CASE("prepare explains what it did for each stimulus") {
  const StudyFolder study;
  const ProgramResult result = study.run({"prepare", study.in("cloths.json"), "--explain"});
  CHECK(result.exit_code == 0);
  CHECK(result.output.find(" kB  ") != std::string::npos);
  CHECK(result.output.find("the pack had none of this picture and these options") !=
        std::string::npos);
}

TEST_CASE("prepare prints the gain of the study's model, zero too") {
  const StudyFolder study;
  json document = study_of("classification");
  document["rendering"] = {{"model", "surface"}, {"gains", {{"height_mm", 0}}}};
  replace_file(study.path() / "cloths.json", document.dump());
  const ProgramResult result = study.run({"prepare", study.in("cloths.json")});
  CHECK(result.exit_code == 0);
  CHECK(result.output.find("gain: height 0 mm per grey level") != std::string::npos);
}

TEST_CASE("a seed that is no whole number of 64 bits is refused") {
  const StudyFolder study;
  for (const std::string seed : {"-1", "18446744073709551616", "0x10", "1.5", ""}) {
    const ProgramResult result = study.simulate("a.db", {}, seed);
    INFO(seed);
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.errors) == 1);
  }
}

TEST_CASE("a misspelt command is answered with the nearest one") {
  const StudyFolder study;
  const ProgramResult result = study.run({"simulat"});
  CHECK(result.exit_code == 2);
  CHECK(result.errors.find("did you mean simulate") != std::string::npos);
}
