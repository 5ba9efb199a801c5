// Packs and keys, made as a user makes them.
#include "app/study_folder.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::engine;

TEST_CASE("prepare builds once, reuses afterwards, and rebuilds what changed") {
  const StudyFolder study;
  const auto prepared = [&] { return study.type("prepare @cloths.json"); };
  const ProgramResult first = succeeded(prepared());
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
  study.write_study({{"methods", {{{"name", "adaptive"}}, {{"name", "tv-gabor"}}}}});
  const ProgramResult result = study.done("prepare @cloths.json");
  for (const char* part : {"built 3", "skipped", "tv-gabor"}) {
    CHECK_THAT(result.output, holds_text(part));
  }
}

TEST_CASE("prepare keeps the key of a study that changed, and refuses that of another study") {
  const StudyFolder study;
  study.done("prepare @cloths.json");
  const std::string key = content(study.path() / "cloths.key");
  study.write_study({{"trials", {{"repeats", 3}}}});
  study.done("prepare @cloths.json");
  bool kept = false;
  for (const auto& entry : fs::directory_iterator(study.path())) {
    kept = kept ||
           (entry.path().filename() != "cloths.key" &&
            entry.path().filename().string().starts_with("cloths.key.") &&
            json::parse(content(entry.path())).at("study_id") == json::parse(key).at("study_id"));
  }
  CHECK(kept);

  study.write_study({{"study", "other"}, {"trials", {{"repeats", 3}}}}, "other.json");
  const std::string present = content(study.path() / "cloths.key");
  const ProgramResult other = study.type("prepare @other.json --pack @cloths.pack");
  CHECK(other.exit_code == 2);
  CHECK(content(study.path() / "cloths.key") == present);
}

TEST_CASE("prepare touches nothing when a picture of the study is missing") {
  const StudyFolder study;
  fs::remove(study.path() / "linen-photo.png");
  check_refused(study.type("prepare @cloths.json"), 2, {"/classes/1/images/0", "cloths.json"});
  CHECK_FALSE(fs::exists(study.path() / "cloths.key"));
}

namespace {

/// The files of a folder and below, by their paths in it.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && !name.starts_with("std")) found[name] = content(entry.path());
  }
  return found;
}

/// A quickly prepared study, of the levels on one device.
void write_quick_study(const StudyFolder& study, int repeats = 2,
                       const std::string& file = "cloths.json") {
  study.write_study({{"rendering", {{"device", "ideal"}}}, {"trials", {{"repeats", repeats}}}},
                    file);
}

/// Cuts a picture, so that its size can still be read.
void cut(const fs::path& picture) {
  fs::resize_file(picture, fs::file_size(picture) / 2);
}

}  // namespace

TEST_CASE("a prepare that fails leaves the study as it was, and no key of a new one") {
  const StudyFolder study;
  write_quick_study(study);
  const Bytes picture = read_file(study.path() / "linen-photo.png");
  cut(study.path() / "linen-photo.png");
  const auto before = contents(study.path());
  check_refused(study.type("prepare @cloths.json"), 2, {"/classes/1/images/0", "linen-photo.png"});
  CHECK(contents(study.path()) == before);
  CHECK_FALSE(fs::exists(study.path() / "cloths.pack"));

  replace_file(study.path() / "linen-photo.png", ByteView(picture));
  study.done("prepare @cloths.json");
  write_quick_study(study, 3);
  cut(study.path() / "linen-photo.png");
  const auto prepared = contents(study.path());
  check_refused(study.type("prepare @cloths.json --passphrase --passphrase-file @pass.txt"), 1,
                {"pass.txt"});
  CHECK(contents(study.path()) == prepared);
  CHECK(study.type("prepare @cloths.json").exit_code == 2);
  CHECK(contents(study.path()) == prepared);
}

TEST_CASE("the next prepare uses or removes the files of a killed one") {
  const StudyFolder study;
  write_quick_study(study);
  study.done("prepare @cloths.json");
  const auto whole = contents(study.path());
  for (const char* left :
       {"cloths.key.unfinished", "cloths.key.unfinished.tmp12", "cloths.key.lock",
        "cloths.key.0123abcd.unfinished", "cloths.station.unfinished"}) {
    replace_file(study.path() / left, std::string("left"), FileMode::owner_only);
  }
  fs::create_directory(study.path() / "cloths.pack/prepare.drafts");
  replace_file(study.path() / "cloths.pack/prepare.drafts/pack.json", std::string("left"));
  study.done("prepare @cloths.json");
  CHECK(contents(study.path()) == whole);
}

TEST_CASE("of two prepares at once none is mixed with the other") {
  const StudyFolder study;
  write_quick_study(study);
  write_quick_study(study, 5, "other.json");
  constexpr int kPairs = 20;
  for (int pair = 0; pair < kPairs; ++pair) {
    const std::string pack = "p" + std::to_string(pair) + ".pack";
    // Another name of a pack has the same key.
    const std::string second = pair % 2 == 0 ? pack : "p" + std::to_string(pair);
    const std::string file = pair % 4 < 2 ? "other.json" : "cloths.json";
    const ProgramResult both = run_program(
        "/bin/sh", study.path(),
        {"-c",
         "cd \"$4\"; (\"$0\" prepare cloths.json --pack $1; echo $? >first.rc) 2>first.txt & "
         "(\"$0\" prepare $3 --pack $2; echo $? >second.rc) 2>second.txt; wait",
         TOUCHTRIAL_PROGRAM, study.in(pack), study.in(second), file, study.path().string()});
    INFO(pair << both.errors << content(study.path() / "first.txt")
              << content(study.path() / "second.txt"));
    const std::string codes =
        content(study.path() / "first.rc") + content(study.path() / "second.rc");
    CHECK(codes.find('0') != std::string::npos);
    CHECK(codes.find_first_not_of("01\n") == std::string::npos);
    const ProgramResult held = study.type("key check @p" + std::to_string(pair) + ".key");
    INFO(held.output << held.errors);
    CHECK(held.exit_code == 0);
  }
}

TEST_CASE("prepare refuses pictures of unequal size, with the remedy, and writes nothing") {
  const StudyFolder study;
  write_png(study.path() / "corduroy-photo.png", GreyImage(60, 120, 90));
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"prepare", study.in("cloths.json")},
        std::vector<std::string>{"simulate", study.in("cloths.json"), "--participants", "1", "--db",
                                 study.in("study.db")}}) {
    const ProgramResult result = study.run(command);
    INFO(result.errors);
    CHECK(result.exit_code == 2);
    CHECK(line_count(result.errors) == 1);
    CHECK_THAT(result.errors, names("cloths.json /classes/2/images/0 corduroy-photo.png 60 120"));
    CHECK_THAT(result.errors, holds_text("touchtrial stimuli import"));
  }
  CHECK_FALSE(fs::exists(study.path() / "cloths.key"));
  CHECK_FALSE(fs::exists(study.path() / "cloths.pack"));
  CHECK_FALSE(fs::exists(study.path() / "study.db"));
}

TEST_CASE("one run of prepare names all pictures that cannot be read") {
  const StudyFolder study;
  json document = json::parse(content(study.path() / "cloths.json"));
  const auto image = [&](std::size_t place) {
    return study.path() / document.at("classes")[place].at("images")[0].get<std::string>();
  };
  // Of the first, the header is as it should be.
  replace_file(image(0), content(image(0)).substr(0, 200));
  replace_file(image(1), "no picture");
  replace_file(image(2), "");
  check_refused(study.type("prepare @cloths.json"), 2,
                {"/classes/0/images/0", "; " + study.in("cloths.json"), "PGM file; ", "(3 "});
}

TEST_CASE("prepare refuses a practice picture that is smaller than the plane") {
  const StudyFolder study;
  study.write_study(json::parse(R"({"trials": {"practice": 1}, "practice": {"criterion": 1,
    "classes": [{"label": "felt", "images": ["felt.png"]},
                {"label": "silk", "images": ["silk.png"]}]}})"));
  write_png(study.path() / "silk.png", GreyImage(120, 120, 90));
  write_png(study.path() / "felt.png", GreyImage(119, 120, 90));
  check_refused(study.type("prepare @cloths.json"), 2, {"/practice/classes/0/images/0"});
  CHECK_FALSE(fs::exists(study.path() / "cloths.key"));
}

TEST_CASE("fields of practice are made, checked and listed apart from the study's") {
  const StudyFolder study;
  study.write_study(json::parse(R"({"trials": {"practice": 1}, "practice": {"criterion": 1,
    "classes": [{"label": "felt", "images": ["felt.png"]},
                {"label": "silk", "images": ["silk.png"]}]}})"));
  write_png(study.path() / "felt.png", texture_number(6));
  write_png(study.path() / "silk.png", texture_number(7));
  CHECK_THAT(study.done("prepare @cloths.json").output,
             holds_text("practice:\nfelt") && holds_text("built 5, reused 0"));
  const json again = study.printed("prepare @cloths.json --json");
  CHECK(again["stimuli"].size() == 3);
  REQUIRE(again["practice"].size() == 2);
  CHECK(again["practice"][1]["class"] == "silk");
  CHECK(again["practice"][1]["state"] == "reused");
  CHECK_FALSE(again["practice"][1].contains("levels"));

  study.done("key check @cloths.json");
  study.done("stimuli sheet @cloths.json -o @sheet.html");
  const std::string sheet = content(study.path() / "sheet.html");
  const json station = json::parse(content(study.path() / "cloths.station"));
  CHECK(station["stimuli"].size() == 3);
  REQUIRE(station["practice"].size() == 2);
  for (const json& field : station["practice"]) {
    const auto code = field["code"].get<std::string>();
    CHECK(fs::exists(study.path() / "cloths.pack" / (code + ".field")));
    CHECK_THAT(sheet, holds_text(code));
  }

  succeeded(study.simulate("s.db"));
  CHECK_THAT(study.done("verify @s.db").output, holds_text(" 5 "));

  write_png(study.path() / "silk.png", texture_number(8));
  CHECK_THAT(study.done("prepare @cloths.json").output, holds_text("built 1, reused 4"));
}

TEST_CASE("prepare says how large the plane is, and whether it is a hand's") {
  const StudyFolder study;
  const auto prepared = [&](double pitch_mm, bool as_json) {
    study.write_study({{"rendering", {{"pitch_mm", pitch_mm}}}});
    return study.type(std::string("prepare @cloths.json") + (as_json ? " --json" : "")).output;
  };
  CHECK_THAT(prepared(0.2, false),
             holds_text("24 x 24 mm") && holds_text("120 x 120") && holds_text("0.2 mm\n"));
  CHECK_THAT(prepared(0.1, false), holds_text("12 x 12 mm"));
  CHECK_THAT(prepared(5.0, false), holds_text("600 x 600 mm"));
  const json plane = json::parse(prepared(0.2, true)).at("plane");
  CHECK(plane.at("width_mm") == Approx(24.0));
  CHECK(plane.at("height_mm") == Approx(24.0));
  CHECK(plane.at("remark") == "");
}

TEST_CASE("prepare prints the gain of the study's model, even if it is zero") {
  const StudyFolder study;
  study.write_study({{"rendering", {{"model", "surface"}, {"gains", {{"height_mm", 0}}}}}});
  const ProgramResult result = study.done("prepare @cloths.json");
  CHECK(result.output.find(" 0 mm ") != std::string::npos);
}

TEST_CASE("gains follow from the level that a study states, and say where it is out of reach") {
  const StudyFolder study;
  const auto prepared = [&](const json& rendering) {
    study.write_study({{"rendering", rendering}});
    return study.printed("prepare @cloths.json --json");
  };
  const json budget = prepared(R"({"device": "ideal", "pitch_mm": 0.5})"_json);
  const json low = prepared(R"({"device": "ideal", "pitch_mm": 0.5,
                                "gains": {"level_db": 0, "curve": "israr_2006"}})"_json);
  CHECK(low["stimuli"][0]["gains"]["tangential_n"] < budget["stimuli"][0]["gains"]["tangential_n"]);
  CHECK(low["provisional"] == true);
  double weakest_db = 100.0;
  for (const json& stimulus : low["stimuli"]) {
    weakest_db = std::min(weakest_db, stimulus["levels"][0]["db"].get<double>());
  }
  CHECK(weakest_db == Approx(0.0).margin(0.2));
  const json falcon = R"({"device": "falcon", "pitch_mm": 0.5,
                          "gains": {"level_db": 40, "curve": "tan_1994"}})"_json;
  const json out_of_reach = prepared(falcon);
  CHECK(out_of_reach["stimuli"][0]["gains"] == budget["stimuli"][0]["gains"]);
  CHECK_THAT(out_of_reach["warnings"].dump(), holds_text("/rendering/gains/level_db"));
  // The line is said again by a run that has nothing to do.
  CHECK(prepared(falcon)["warnings"] == out_of_reach["warnings"]);
}

TEST_CASE("thresholds of pilots replace the curve, and an invalid file is refused") {
  const StudyFolder study;
  json pilots = study_of("classification");
  pilots["classes"] = {pilots["classes"][0]};
  pilots.update(json::parse(R"({"study": "pilots", "protocol": "threshold",
    "trials": {"explore_limit_s": 15},
    "threshold": {"task": "detection", "question": "which-interval", "along": "gain",
      "intervals": 2, "procedure": "quest-plus", "trials": 40,
      "levels": {"from": -40, "to": 0, "step": 2}}})"));
  replace_file(study.path() / "pilots.json", pilots.dump());
  study.done("simulate @pilots.json --on ideal --participants 4 --db @pilots.db");
  const auto prepare = [&](const std::string& curve, const std::string& device = "ideal") {
    study.write_study(
        {{"rendering", {{"device", device}, {"gains", {{"level_db", 3}, {"curve", curve}}}}}});
    return study.type("prepare @cloths.json --json");
  };
  const ProgramResult by_pilots = succeeded(prepare("pilots.db"));
  const json prepared = json::parse(by_pilots.output);
  CHECK(prepared["provisional"] == true);  // as the pilots are simulated
  CHECK(prepared["stimuli"][0]["levels"][0]["db"] == prepared["stimuli"][0]["levels"][1]["db"]);
  check_refused(prepare("pilots.db", "touch"), 2, {"/rendering/gains/curve", "/rendering/device"});
  const ProgramResult missing = prepare("missing.db");
  CHECK(missing.exit_code != 0);
  CHECK_THAT(missing.errors, holds_text("missing.db"));
  std::filesystem::rename(study.path() / "pilots.db.key", study.path() / "elsewhere.key");
  const ProgramResult without_key = prepare("pilots.db");
  CHECK(without_key.exit_code == 2);
  CHECK_THAT(without_key.errors, holds_text("/rendering/gains/curve: ") &&
                                     holds_text(study.in("pilots.db.key")) && !holds_text("--key"));
}
