// The screens of a study as whoever designs it looks at them.
#include "app/texts/study_texts.hpp"
#include "app/touchtrial_process.hpp"
#include "app/windows/participant/preview_screens.hpp"
#include "core/files.hpp"
#include "engine/image_file.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"
#include "support/temp_folder.hpp"
#include "windows/virtual_screen.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <variant>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

/// The shipped study, with everything that a study may ask.
std::string study_with_everything() {
  std::string text =
      text_of(read_file(fs::path(TOUCHTRIAL_SOURCE_DIR) / "config/classification.json"));
  const std::string plain = "\"confidence\": 0";
  text.replace(text.find(plain), plain.size(), "\"confidence\": 5");
  return text;
}

std::vector<std::string> names_of(const std::vector<app::PreviewScreen>& screens) {
  std::vector<std::string> names;
  for (const app::PreviewScreen& screen : screens) names.push_back(screen.name);
  return names;
}

std::set<std::size_t> kinds_of(const std::vector<app::PreviewScreen>& screens) {
  std::set<std::size_t> kinds;
  for (const app::PreviewScreen& screen : screens) {
    if (screen.step) kinds.insert(screen.step->index());
  }
  return kinds;
}

TEST_CASE("a preview has every kind of screen, each under a name of its own") {
  const study::Study study = study::parse_study(
      study_with_everything(), fs::path(TOUCHTRIAL_SOURCE_DIR) / "config", "study.json");
  const session::SessionTexts texts = app::session_texts(study);
  const std::vector<app::PreviewScreen> screens = app::preview_screens(study, texts);
  // Only a trial with several planes says which comes next.
  CHECK(kinds_of(screens).size() == std::variant_size_v<session::Step> - 1);
  const std::vector<std::string> names = names_of(screens);
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  for (const std::string name : {"welcome", "handedness-2", "practice-explore", "ready", "explore",
                                 "answer", "confidence", "break", "closing", "thanks"}) {
    INFO(name);
    CHECK(std::ranges::count(names, name) == 1);
  }
}

TEST_CASE("a preview of trials with several planes has every kind of screen") {
  const study::Study study =
      study::load_study(fs::path(TOUCHTRIAL_SOURCE_DIR) / "config/detection.json");
  const session::SessionTexts texts = app::session_texts(study);
  const std::vector<app::PreviewScreen> screens = app::preview_screens(study, texts);
  CHECK(kinds_of(screens).size() == std::variant_size_v<session::Step>);
  const std::vector<std::string> names = names_of(screens);
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  for (const std::string name :
       {"practice-interval", "practice-explore", "practice-wrong", "practice-over", "ready",
        "interval", "explore", "answer", "not-explored", "hand-off", "hand-off-interval", "break",
        "stopped"}) {
    INFO(name);
    CHECK(std::ranges::count(names, name) == 1);
  }
  for (const app::PreviewScreen& screen : screens) {
    CHECK(app::preview_labels(study, screen) == std::vector<std::string>{"first", "second"});
    if (!screen.step) CHECK(screen.interval);
  }
}

TEST_CASE("a preview of ratings shows a picture with the scales, and no answer") {
  const study::Study study =
      study::load_study(fs::path(TOUCHTRIAL_SOURCE_DIR) / "config/realism.json");
  const session::SessionTexts texts = app::session_texts(study);
  std::vector<std::string> pictures;
  for (const app::PreviewScreen& screen : app::preview_screens(study, texts)) {
    if (!screen.step) continue;
    CHECK_FALSE(std::holds_alternative<session::FeedbackStep>(*screen.step));
    const auto* const answer = std::get_if<session::AnswerStep>(&*screen.step);
    if (answer == nullptr) continue;
    CHECK(std::holds_alternative<study::RatingQuestion>(answer->question));
    pictures.push_back(answer->picture);
  }
  // Of practice, a trial, and a trial whose time is up.
  const std::string& first = study.classes.front().label;
  CHECK(pictures == std::vector<std::string>{study.practice.classes.front().label, first, first});
}

/// A folder with the study that asks everything.
struct Drawer {
  Drawer() {
    fs::create_directory(folder.path() / "config");
    fs::copy(fs::path(TOUCHTRIAL_SOURCE_DIR) / "stimuli", folder.path() / "stimuli",
             fs::copy_options::recursive);
    replace_file(study(), study_with_everything());
  }
  [[nodiscard]] std::string study() const { return (folder.path() / "config/study.json").string(); }
  [[nodiscard]] ProgramResult preview(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"preview", study()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_touchtrial(folder.path(), arguments);
  }

  TempFolder folder;
};

TEST_CASE("screens are drawn into files, one or all, each of them another picture") {
  const auto screen = VirtualScreen::open("1280x720");
  const Drawer drawer;
  const std::string file = (drawer.folder.path() / "answer.png").string();
  const ProgramResult one =
      drawer.preview({"--screen", "answer", "--png", file, "--window", "800x600"});
  INFO(one.errors);
  REQUIRE(one.exit_code == 0);
  const GreyImage answer = engine::read_grey_image(file);
  CHECK(answer.width() == 800);
  CHECK(answer.height() == 600);
  const fs::path all = drawer.folder.path() / "all";
  REQUIRE(drawer.preview({"--png", all.string(), "--window", "640x480", "--console"}).exit_code ==
          0);
  CHECK(path_exists(all / "console.png"));
  std::set<Bytes> pictures;
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(all)) {
    ++files;
    pictures.insert(read_file(entry.path()));
  }
  CHECK(files > 25);
  CHECK(pictures.size() == files);
  CHECK_FALSE(path_exists(drawer.folder.path() / "config/study.pack"));

  const std::vector<std::string> again = {"--screen", "answer", "--png", file};
  CHECK(drawer.preview(again).exit_code == 0);
  std::ofstream(file) << "mine";
  CHECK(drawer.preview(again).exit_code == 1);
  CHECK(text_of(read_file(file)) == "mine");
  std::vector<std::string> forced = again;
  forced.emplace_back("--force");
  CHECK(drawer.preview(forced).exit_code == 0);
  CHECK(text_of(read_file(file + ".1")) == "mine");
  const ProgramResult unknown = drawer.preview({"--screen", "anwser"});
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.errors, holds_text("answer"));
}

TEST_CASE("keys page through the screens of a preview") {
  const auto screen = VirtualScreen::open("1280x720");
  const Drawer drawer;
  const study::Study study = study::load_study(drawer.study());
  const std::vector<std::string> names =
      names_of(app::preview_screens(study, app::session_texts(study)));
  const auto line_of = [&](const std::string& name) {
    const auto at = std::ranges::find(names, name) - names.begin();
    return name + " (" + std::to_string(at + 1) + " of " + std::to_string(names.size()) + ")\n";
  };
  testing::ChildProcess program(
      {TOUCHTRIAL_PROGRAM, "preview", drawer.study(), "--screen", "ready"}, {});
  REQUIRE(program.says(line_of("ready")));
  screen->type("Next");
  REQUIRE(program.says(line_of("explore")));
  screen->type("Next");
  REQUIRE(program.says(line_of("answer")));
  screen->type("Prior");
  REQUIRE(program.says(line_of("answer") + line_of("explore")));
  screen->type("Escape");
  CHECK(program.finish() == 0);
}

}  // namespace
}  // namespace touchtrial
