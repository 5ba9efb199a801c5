// Without the key, nobody at the machine can find out which texture is presented, or link two
// presentations of one texture.
#include "app/study_folder.hpp"
#include "core/bytes.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

using namespace touchtrial;
using namespace touchtrial::engine;

namespace {

/// Words that only the study file, its images and its key may contain.
const std::vector<std::string> kOddLabels = {"zyxquartz", "vkjlinen", "wqxbark", "jzkmoss",
                                             "xqzgravel"};
const std::vector<std::string> kOddImages = {"qwkvelvet", "kzzriver", "jqqplume", "wxvtin",
                                             "vqkember"};
const std::string kOddSeed = "907431586";
constexpr int kRepeats = 5;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// A prepared study with unique words; its first texture is rough, the others are smooth.
struct OddStudy : StudyFolder {
  explicit OddStudy(int catch_trials = 0) {
    json classes = json::array();
    for (std::size_t i = 0; i < kOddLabels.size(); ++i) {
      const std::string image = kOddImages[i] + ".png";
      write_png(path() / image, texture_number(static_cast<int>(i)));
      classes.push_back({{"label", kOddLabels[i]}, {"images", {image}}});
    }
    json odd = study_of("classification");
    odd["classes"] = classes;
    odd["trials"] = {{"repeats", kRepeats},
                     {"explore_limit_s", 2.0},
                     {"catch", catch_trials},
                     {"validity", {{"exploring_s", 2.0}, {"contact_s", 2.0}}}};
    odd["seed"] = std::stoll(kOddSeed);
    replace_file(path() / "cloths.json", odd.dump());
    replace_file(path() / "quick.json",
                 R"({"feature_noise": 0.1, "explore_s": 0.5, "training_passes": 1})");
    done("prepare @cloths.json");
  }
  [[nodiscard]] std::vector<std::string> session(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {
        "run",  in("cloths.json"), "--participant", "P01",
        "--db", in("db"),          "--subject",     in("quick.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  /// Names and content of the files in a folder whose names begin so.
  [[nodiscard]] static std::string files(const fs::path& folder, const std::string& prefix) {
    std::string all;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(prefix)) all += name + "\n" + content(entry.path());
    }
    return all;
  }
};

/// The words that must not be found, with their meanings.
std::map<std::string, std::string> secrets_of(const OddStudy& study) {
  std::map<std::string, std::string> secrets = {{"the seed", kOddSeed}};
  for (const std::string& label : kOddLabels) secrets["the label " + label] = label;
  for (const std::string& image : kOddImages) secrets["the image " + image] = image;
  const json key = json::parse(content(study.path() / "cloths.key"));
  for (const std::string name : {"master", "station's secret"}) {
    const std::string hex =
        name == "master" ? key.at("master")
                         : json::parse(content(study.path() / "cloths.station")).at("secret");
    REQUIRE(hex.size() == 64);
    secrets[name + ", its first half"] = hex.substr(0, 32);
    secrets[name + ", its second half"] = hex.substr(32);
    const std::string raw = text_of(*from_hex(hex));
    secrets[name + ", its first bytes"] = raw.substr(0, 16);
    secrets[name + ", its last bytes"] = raw.substr(16);
  }
  return secrets;
}

/// \return the words that were found in any case, one on each line
std::string found_in(const std::string& text, const std::map<std::string, std::string>& secrets) {
  std::string found;
  const std::string lowered = lower(text);
  for (const auto& [what, secret] : secrets) {
    if (lowered.find(lower(secret)) != std::string::npos) found += what + "\n";
  }
  return found;
}

/// Presents in real time, inspects the program repeatedly from the first response on, and kills it
/// after the sixth. The program is stopped during each inspection, so that none takes time from the
/// session. Leaves `out`, `cmdline`, `fd`, `maps` and `stored`.
void look_while_it_runs(const OddStudy& study) {
  std::string command = TOUCHTRIAL_PROGRAM;
  for (const std::string& argument : study.session({"--real-time"})) {
    command += " '" + argument + "'";
  }
  const std::string script = command + R"( > out 2>&1 & p=$!
      until grep -q 'trial 1 acknowledged' out; do sleep 0.02; [ -e /proc/$p/fd/1 ] || exit 9; done
      while kill -STOP $p && [ -e /proc/$p/fd/1 ]; do
        cat /proc/$p/cmdline >> cmdline; ls -l /proc/$p/fd >> fd; cat /proc/$p/maps >> maps
        ls db* >> stored; cat db* >> stored
        if grep -q 'trial 6 acknowledged' out; then kill -9 $p; wait $p; exit 0; fi
        kill -CONT $p; sleep 0.2
      done
      exit 9)";
  const std::string there = "cd '" + study.path().string() + "' || exit 9; ";
  succeeded(run_program("/bin/sh", study.path(), {"-c", there + script}));
}

/// The fields of the pack that a list of a program's open files names.
std::size_t fields_named(const OddStudy& study, const std::string& list) {
  std::size_t named = 0;
  for (const auto& entry : fs::directory_iterator(study.path() / "cloths.pack")) {
    const bool is_field = entry.path().extension() == ".field";
    named += is_field && list.find(entry.path().filename().string()) != std::string::npos ? 1 : 0;
  }
  return named;
}

/// Everything of one trial that can be read without the key, except its number, its times, its
/// answer, and the hash of the encrypted data.
using VisibleTrials = std::map<int, std::string>;

VisibleTrials visible_trials(const OddStudy& study) {
  VisibleTrials trials;
  const SQLite::Database database(study.in("db"), SQLite::OPEN_READONLY);
  SQLite::Statement events(database,
                           "SELECT kind, body, length(sealed) FROM events WHERE session = 1 "
                           "ORDER BY sequence");
  while (events.executeStep()) {
    json body = json::parse(events.getColumn(1).getString());
    if (!body.contains("trial")) continue;
    const int trial = body.at("trial");
    // What the hand did by itself (decision 54) differs between trials, whatever was felt.
    for (const char* own : {"trial", "trace", "contact_ok", "force_ok", "path_ok", "speed_ok"}) {
      body.erase(own);
    }
    trials[trial] += events.getColumn(0).getString() + body.dump() +
                     std::to_string(events.getColumn(2).getInt()) + "\n";
  }
  SQLite::Statement traces(database, "SELECT trial, length(box) FROM traces WHERE session = 1");
  while (traces.executeStep()) {
    trials[traces.getColumn(0).getInt()] += std::to_string(traces.getColumn(1).getInt());
  }
  return trials;
}

}  // namespace

TEST_CASE("nothing that a session prints, stores or shows of itself names a stimulus") {
  const OddStudy study;
  const auto secrets = secrets_of(study);
  REQUIRE(found_in(content(study.path() / "cloths.key"), secrets) != "");
  CHECK(found_in(OddStudy::files(study.path() / "cloths.pack", ""), secrets) == "");

  look_while_it_runs(study);
  for (const std::string name : {"out", "cmdline", "fd", "maps", "stored"}) {
    INFO(name);
    const std::string seen = content(study.path() / name);
    CHECK_FALSE(seen.empty());
    CHECK(found_in(seen, secrets) == "");
  }
  CHECK(content(study.path() / "fd").find(".png") == std::string::npos);
  CHECK(content(study.path() / "fd").find(".key") == std::string::npos);
  // All fields are open, or none: a single open field would be the presented one.
  CHECK(fields_named(study, content(study.path() / "fd")) == 0);
  const std::size_t mapped = fields_named(study, content(study.path() / "maps"));
  CHECK((mapped == 0 || mapped == kOddLabels.size()));
  CHECK(found_in(OddStudy::files(study.path(), "db"), secrets) == "");

  const ProgramResult resumed = succeeded(study.run(study.session({"--on-existing", "resume"})));
  CHECK(found_in(resumed.output + resumed.errors, secrets) == "");
  CHECK(found_in(OddStudy::files(study.path(), "db"), secrets) == "");
}

TEST_CASE("without the key, presentations look alike, whether a texture was felt or nothing") {
  const int catch_trials = 3;
  const OddStudy study(catch_trials);
  succeeded(study.run(study.session()));
  const VisibleTrials trials = visible_trials(study);
  CHECK(trials.size() == kOddLabels.size() * kRepeats + catch_trials);
  // The simulated hand explores every plane for the same time.
  std::set<std::string> kinds;
  for (const auto& [trial, visible] : trials) kinds.insert(visible);
  std::string all;
  for (const std::string& kind : kinds) all += kind + "\n\n";
  INFO(all);
  CHECK(kinds.size() == 1);
}
