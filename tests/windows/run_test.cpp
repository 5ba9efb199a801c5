// "touchtrial run" as experimenter and participant have it, on a screen that nobody sees.
#include "analysis/outcomes/collection.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "app/touchtrial_process.hpp"
#include "app/windows/participant/participant_window.hpp"
#include "core/files.hpp"
#include "record/study_store.hpp"
#include "support/catch.hpp"
#include "support/child_process.hpp"
#include "support/environment.hpp"
#include "support/temp_folder.hpp"
#include "windows/virtual_screen.hpp"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The default study of 25 trials, without questions and practice.
struct Laboratory {
  Laboratory() {
    const fs::path source = TOUCHTRIAL_SOURCE_DIR;
    fs::create_directory(folder.path() / "config");
    fs::copy(source / "stimuli", folder.path() / "stimuli", fs::copy_options::recursive);
    json study = json::parse(text_of(read_file(source / "config/classification.json", 1U << 20U)));
    study["trials"]["practice"] = 0;
    study["trials"]["break_every"] = 0;
    study["trials"]["answer_after"] = {{"contact_s", 0}, {"path_mm", 0}};
    study.erase("practice");
    study["session"] = {{"handedness", false}, {"closing", false}};
    replace_file(in("config/study.json"), study.dump());
    succeeded(run_touchtrial(folder.path(), {"prepare", in("config/study.json")}));
  }

  [[nodiscard]] std::string in(const std::string& name) const {
    return (folder.path() / name).string();
  }
  [[nodiscard]] std::vector<std::string> run_arguments(const std::string& database,
                                                       const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {
        "run", in("config/study.json"), "--participant", "P01", "--db", in(database), "--no-sound"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void verify(const std::string& database) const {
    succeeded(
        run_touchtrial(folder.path(), {"verify", in(database), "--key", in("config/study.key")}));
  }

  TempFolder folder;
};

/// The positions that were chosen, in the order of the answers.
std::vector<int> positions_as_answered(const Laboratory& lab, const std::string& database) {
  const auto store =
      record::StudyStore::open(lab.in(database), record::StudyStore::Access::read_only);
  std::vector<record::TrialRow> trials = analysis::open_trials(
      store, analysis::person_keys(store, study::load_study_key(lab.in("config/study.key"))));
  std::ranges::sort(trials, {}, &record::TrialRow::answered_at);
  std::vector<int> positions;
  for (const record::TrialRow& trial : trials)
    positions.push_back(position_of(trial.answer).value_or(-1));
  return positions;
}

/// A person with a keyboard, who reads the experimenter's status. Its "trial" counts presentations:
/// if a busy machine stops the servo, the presentation is interrupted, and its stimulus is repeated
/// under a later number.
///
/// A key that is pressed before its screen is shown does nothing: keys are pressed again until the
/// status has changed. The window has always handled all keys before the status is read, so that a
/// number reaches the screen of its own trial, or none.
class Pilot {
 public:
  Pilot(const Laboratory& lab, const VirtualScreen& screen)
      : screen_(screen), program_(command_in(lab), {"ALSA_CONFIG_PATH=" + sound_card_in(lab)}) {}

  /// \return the program's exit code
  int sit_through() {
    while (program_.listen(kBetweenKeys)) react();
    return program_.finish();
  }
  [[nodiscard]] std::vector<int> meant() const {
    std::vector<int> positions;
    for (const auto& [presentation, position] : meant_) positions.push_back(position);
    return positions;
  }
  [[nodiscard]] const std::string& output() const { return program_.output(); }

 private:
  static constexpr std::chrono::milliseconds kBetweenKeys{20};

  /// A sound card that writes what it plays to the file `played.raw`.
  static std::string sound_card_in(const Laboratory& lab) {
    replace_file(lab.in("asoundrc"),
                 "pcm.!default { type file\n slave.pcm { type null }\n file \"" +
                     lab.in("played.raw") + "\"\n format \"raw\" }\n");
    return lab.in("asoundrc");
  }
  static std::vector<std::string> command_in(const Laboratory& lab) {
    std::vector<std::string> command =
        lab.run_arguments("pilot.db", {"--device", "mouse", "--pilot", "--window", "1280x720"});
    command.insert(command.begin(), TOUCHTRIAL_PROGRAM);
    return command;
  }

  /// "P01  answering  trial 3 of 25 .."
  void react() {
    const std::string line = status();
    if (line.empty()) return;
    const std::size_t at = line.find("  trial ");
    const int presentation = at == std::string::npos ? 0 : std::atoi(line.c_str() + at + 8);
    if (presentation >= 3 && !was_paused_ && is_exploring()) return lose_keyboard();
    // Another window's last request for the keyboard may have arrived after ours.
    if (line.find("  paused  ") != std::string::npos) screen_.focus_window("Touchtrial");
    if (line.find("  answering  ") != std::string::npos && presentation > 0) {
      meant_[presentation] = presentation % 5;
      screen_.type(std::to_string(presentation % 5 + 1));
    }
    screen_.type("Return");
    // The last one closes the window.
    screen_.wait_until_heard("Touchtrial");
  }

  /// Another window takes the keyboard again and again, until the plane is off: because the session
  /// paused, or on a busy machine because the servo stopped, after which nothing need pause.
  void lose_keyboard() {
    while (is_exploring()) {
      screen_.take_focus();
      if (!program_.listen(std::chrono::milliseconds(5))) return;
    }
    was_paused_ = status().find("  paused  ") != std::string::npos;
    screen_.focus_window("Touchtrial");
  }

  [[nodiscard]] bool is_exploring() const {
    return status().find("  exploring  ") != std::string::npos;
  }

  /// The last that was written to its end; "" if there is none.
  [[nodiscard]] std::string status() const {
    std::string text = "\n" + program_.output();
    text.erase(text.rfind('\n'));
    const std::size_t begin = text.rfind("\nP01  ");
    if (begin == std::string::npos) return "";
    return text.substr(begin + 1, text.find('\n', begin + 1) - begin - 1);
  }

  const VirtualScreen& screen_;
  testing::ChildProcess program_;
  std::map<int, int> meant_;  ///< position by presentation that was answered
  bool was_paused_ = false;
};

TEST_CASE(
    "a person pilots a whole session of 25 trials from the keyboard, which another window takes "
    "once, "
    "without a sound card") {
  const auto screen = VirtualScreen::open("1280x720");
  const Laboratory lab;
  Pilot pilot(lab, *screen);
  const int code = pilot.sit_through();
  INFO(pilot.output());
  REQUIRE(code == 0);
  CHECK(pilot.meant().size() == 25);
  CHECK_THAT(pilot.output(), holds_text(".key"));
  CHECK(positions_as_answered(lab, "pilot.db") == pilot.meant());
  const analysis::SessionRecord session =
      analysis::load_collection(
          record::StudyStore::open(lab.in("pilot.db"), record::StudyStore::Access::read_only))
          .sessions.at(0);
  CHECK(std::ranges::count(session.deviations, "focus-lost", &analysis::Deviation::code) >= 1);
  CHECK(session.pauses >= 1);
  CHECK(session.opened_utc.size() == std::string("2026-01-31T14:05:09Z").size());
  REQUIRE(session.station);
  REQUIRE(session.station->screen);
  // The virtual screen states a size that follows from 96 pixels per inch, which tells nothing.
  CHECK(session.station->screen->mm_per_px == Approx(25.4 / 96.0).epsilon(0.01));
  CHECK(session.station->screen->source == "assumed");
  lab.verify("pilot.db");
  CHECK_FALSE(fs::exists(lab.in("played.raw")));
}

/// A study of six trials with two short planes each, of which the last two are only heard.
std::string study_with_intervals() {
  json study = json::parse(
      text_of(read_file(fs::path(TOUCHTRIAL_SOURCE_DIR) / "config/detection.json", 1U << 20U)));
  study["threshold"]["interval_s"] = 0.4;
  study["threshold"]["trials"] = 4;
  study["threshold"]["catch"] = 0;
  study["threshold"]["control"] = 2;
  study["threshold"]["practice"] = {{"trials", 1}, {"criterion", 1}, {"rounds", 1}};
  study["trials"]["validity"] = json::object();
  study["session"] = {{"handedness", false}, {"closing", false}};
  study.erase("registration");
  return study.dump();
}

void prepare_intervals(const Laboratory& lab) {
  replace_file(lab.in("config/intervals.json"), study_with_intervals());
  succeeded(run_touchtrial(lab.folder.path(), {"prepare", lab.in("config/intervals.json")}));
}

/// A person with a mouse, who strokes whatever plane is on: lifts off, then holds the button.
class Stroker {
 public:
  Stroker(const Laboratory& lab, const VirtualScreen& screen)
      : screen_(screen),
        program_({TOUCHTRIAL_PROGRAM, "run", lab.in("config/intervals.json"), "--participant",
                  "P01", "--db", lab.in("stroked.db"), "--no-sound", "--device", "mouse", "--pilot",
                  "--window", "1280x720"},
                 {}) {}

  /// \return the program's exit code
  int sit_through() {
    while (program_.listen(std::chrono::milliseconds(8))) react();
    return program_.finish();
  }
  [[nodiscard]] const std::string& output() const { return program_.output(); }

 private:
  void react() {
    const std::size_t last = program_.output().rfind("\nP01  ");
    const std::string line = last == std::string::npos ? "" : program_.output().substr(last + 1);
    if (line.find("  exploring") != std::string::npos) return stroke();
    if (pressed_) screen_.release();
    pressed_ = false;
    if (line.find("  answering") != std::string::npos) screen_.type("1");
    screen_.type("Return");
    screen_.wait_until_heard("Touchtrial");
  }
  /// To and fro, a few pixels at a time, with the button up for a fifth of the time.
  void stroke() {
    const int at = moves_++ % 120;
    screen_.move_pointer(540 + 4 * (at < 60 ? at : 120 - at), 300);
    const bool holds = moves_ % 150 > 30;
    if (holds && !pressed_) screen_.press();
    if (!holds && pressed_) screen_.release();
    pressed_ = holds;
    // A plane that was not explored in time leaves a page of its own; Enter ends no plane.
    if (moves_ % 100 == 0) screen_.type("Return");
  }

  const VirtualScreen& screen_;
  testing::ChildProcess program_;
  int moves_ = 0;
  bool pressed_ = false;
};

TEST_CASE("a person pilots a session whose trials have several planes with the mouse") {
  const auto screen = VirtualScreen::open("1280x720");
  const Laboratory lab;
  prepare_intervals(lab);
  Stroker person(lab, *screen);
  const int code = person.sit_through();
  INFO(person.output());
  REQUIRE(code == 0);
  CHECK(person.output().find("trial 6 acknowledged") != std::string::npos);
}

/// A study of two textures, each rated twice on two scales, and one plane without texture.
/// \param points  of the first scale; 0: a line
std::string study_of_ratings(const std::string& language, int points) {
  const fs::path source = TOUCHTRIAL_SOURCE_DIR;
  json study = json::parse(text_of(read_file(source / "config/realism.json", 1U << 20U)));
  study["classes"].erase(2);
  study["classes"].erase(2);
  study["methods"] = {{{"name", "adaptive"}}};
  const json words = {{"en", "rough"}, {"de", "rau"}};
  study["rating"]["scales"] = {
      {{"id", "fit"}, {"points", points}},
      {{"id", "rough"}, {"text", words}, {"low", words}, {"high", words}, {"points", points}}};
  study["trials"]["repeats"] = 2;
  study["trials"]["catch"] = 1;
  study["trials"]["practice"] = 1;
  study["trials"]["answer_after"] = {{"contact_s", 0}, {"path_mm", 0}};
  study["session"] = {{"handedness", false}, {"closing", false}, {"language", language}};
  study.erase("registration");
  return study.dump();
}

/// A person who rates in a window with the keyboard, or with the mouse all over it.
class Rater {
 public:
  Rater(const Laboratory& lab, const VirtualScreen& screen, bool by_mouse, const std::string& size)
      : screen_(screen),
        by_mouse_(by_mouse),
        program_({TOUCHTRIAL_PROGRAM, "run", lab.in("config/ratings.json"), "--participant", "P01",
                  "--db", lab.in("rated.db"), "--no-sound", "--device", "mouse", "--pilot",
                  "--window", size},
                 {}) {}

  /// \return the program's exit code
  int sit_through() {
    while (program_.listen(std::chrono::milliseconds(20))) react();
    return program_.finish();
  }
  [[nodiscard]] const std::string& output() const { return program_.output(); }

 private:
  void react() {
    const std::size_t last = program_.output().rfind("\nP01  ");
    const std::string line = last == std::string::npos ? "" : program_.output().substr(last + 1);
    const bool is_answering = line.find("  answering") != std::string::npos;
    if (is_answering) by_mouse_ ? click_around() : rate();
    // On a busy machine the screen may have come in the middle of the keys: rate twice before the
    // end.
    const bool is_first_look = is_answering && line != rated_;
    rated_ = is_answering ? line : "";
    if (!is_first_look) screen_.type("Return");
    screen_.wait_until_heard("Touchtrial");
  }
  /// A digit counts as a point; on a line the arrow sets the mark in its middle.
  void rate() { screen_.type("Up Up 4 Right Down 2 Right"); }
  void click_around() {
    for (int y = 200; y < 660; y += 12) {
      screen_.move_pointer(860, y);
      screen_.press();
      screen_.release();
    }
  }

  const VirtualScreen& screen_;
  bool by_mouse_;
  testing::ChildProcess program_;
  std::string rated_;  ///< the line of the trial whose rating was typed already
};

/// The ratings of all trials, those of practice left out.
std::vector<std::vector<double>> ratings_in(const Laboratory& lab) {
  const auto store =
      record::StudyStore::open(lab.in("rated.db"), record::StudyStore::Access::read_only);
  std::vector<std::vector<double>> all;
  for (const record::TrialRow& trial : analysis::open_trials(
           store,
           analysis::person_keys(store, study::load_study_key(lab.in("config/ratings.key")))))
    all.push_back(ratings_of(trial.answer));
  return all;
}

TEST_CASE("a person rates from the keyboard and with the mouse, in two languages and sizes") {
  const bool by_mouse = GENERATE(false, true);
  CAPTURE(by_mouse);
  const auto screen = VirtualScreen::open("1280x720");
  const Laboratory lab;
  replace_file(lab.in("config/ratings.json"),
               study_of_ratings(by_mouse ? "en" : "de", by_mouse ? 0 : 5));
  succeeded(run_touchtrial(lab.folder.path(), {"prepare", lab.in("config/ratings.json")}));
  Rater person(lab, *screen, by_mouse, by_mouse ? "1280x720" : "1024x700");
  const int code = person.sit_through();
  INFO(person.output());
  REQUIRE(code == 0);
  const auto ratings = ratings_in(lab);
  REQUIRE(ratings.size() == 5);
  for (const std::vector<double>& of_trial : ratings) {
    REQUIRE(of_trial.size() == 2);
    if (by_mouse) {
      CHECK(of_trial[0] > 0.0);
      CHECK(of_trial[1] < 1.0);
    }
    if (!by_mouse) CHECK(of_trial[0] >= 4.0);
  }
  succeeded(run_touchtrial(lab.folder.path(),
                           {"verify", lab.in("rated.db"), "--key", lab.in("config/ratings.key")}));
}

TEST_CASE("a screen that was measured with a card has a known scale from then on") {
  const TempFolder folder;
  const EnvironmentVariable own("XDG_CONFIG_HOME", folder.path().c_str());
  const auto screen = VirtualScreen::open("1280x720");
  app::ParticipantWindowOptions window;
  window.size_px = {640, 480};
  CHECK_FALSE(app::ParticipantWindow(window).screen().is_known);
  testing::ChildProcess program({TOUCHTRIAL_PROGRAM, "screen", "calibrate", "--window", "1280x720"},
                                {});
  // A key that is pressed before the frame is shown does nothing.
  while (program.listen(std::chrono::milliseconds(20))) screen->type("Return");
  CHECK(program.finish() == 0);
  INFO(program.output());
  const fs::path file = folder.path() / "touchtrial" / "screens.json";
  CHECK_THAT(program.output(), holds_text(file.string()));
  const json kept = json::parse(text_of(read_file(file, 1U << 20U)));
  REQUIRE(kept.at("screens").size() == 1);
  const app::ScreenScale scale = app::ParticipantWindow(window).screen();
  CHECK(scale.is_known);
  CHECK(scale.is_measured);
  CHECK(scale.monitor == kept.at("screens").at(0).at("monitor").get<std::string>());
  CHECK(scale.mm_per_unit == kept.at("screens").at(0).at("mm_per_unit").get<double>());

  replace_file(file, R"({"screens": 3})");
  CHECK_FALSE(app::ParticipantWindow(window).screen().is_known);
}

}  // namespace
}  // namespace touchtrial
