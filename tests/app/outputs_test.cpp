// Every option that names a place to write to, of every command: what another wrote there stays.
#include "app/study_folder.hpp"
#include "support/catch.hpp"
#include "support/environment.hpp"

#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;

namespace {

/// How much of a command a test can afford, or has what it needs for.
enum class Runs { to_the_end, to_refusal };

struct Output {
  const char* command;  ///< as typed, up to its arguments
  const char* option;
  const char* line;   ///< the rest of the line
  const char* place;  ///< the file, or one of several
  Runs runs = Runs::to_the_end;
};

/// Replaced if this program wrote it; with --force what another wrote is kept.
const std::vector<Output> kReplaced = {
    {"extract", "--output", "@photo.png --output @o.png", "o.png"},
    {"extract", "--arrows", "@photo.png --arrows @a.png", "a.png"},
    {"extract", "--dump", "@photo.png --dump @d", "d/texture.npy"},
    {"paper", "--out", "@photo.png --out @p", "p/paper.html", Runs::to_refusal},
    {"fit", "--out", "@cloths.db --out @o.json", "o.json", Runs::to_refusal},
    {"stimuli generate", "--out", "--size 64 --exemplars 1 --out @g", "g/manifest.json"},
    {"stimuli sheet", "--output", "@cloths.json --output @s.html", "s.html"},
    {"export", "--out", "@cloths.db --out @e", "e/trials.csv"},
    {"report", "--out", "@cloths.db --cues no --out @r", "r/report.html"},
    {"power", "--figure",
     "@cloths.json --mean 0.5 --sd-between 0.1 --participants 3,4 --runs 10 --figure @c",
     "c/power-curve.csv"},
    {"device accept", "--certificate", "--emulate touch --certificate @c.json", "c.html"},
    {"device test", "--fault-record", "falcon --fault-record @o.csv", "o.csv", Runs::to_refusal},
};

/// Never replaced, and without --force.
const std::vector<Output> kNeverReplaced = {
    {"prereg", "--output", "@cloths.json --output @o.md", "o.md"},
    {"simulate", "--db", "@cloths.json --participants 1 --db @o.db", "o.db"},
    {"run", "--db", "@cloths.json --participant P01 --subject @quick.json --db @o.db", "o.db"},
    {"merge", "--out", "@cloths.db --out @o.db", "o.db"},
    {"key copy", "--out", "@cloths.key --out @o.key", "o.key"},
    {"device bring-up", "--out", "falcon --out @o.json", "o.json"},
};

/// Tested elsewhere: they need a screen, or write several things.
const std::set<std::pair<std::string, std::string>> kElsewhere = {
    {"preview", "--png"}, {"stimuli import", "--study"}, {"stimuli import", "--out"}};

/// Options of this name are read, folders with rules of their own (--pack, --heads), or no places,
/// in every command without a line above.
const std::string kNotWritten =
    "--accept-clock --accept-loss --accuracies --accuracy --answers --author "
    "--between --bits --bootstraps --certificate --components --consent --console-monitor "
    "--crops --db --deviation --device --difference --divisor --emulate --enrolment "
    "--exemplars --explorations --first-participant --groups --head "
    "--head-file --heads --heights --institution --jobs --key --lambda --levels --licence "
    "--license --margin --mean --monitor --name --names --neighbourhood "
    "--new-passphrase-file --order --pack --participant --participants --passphrase-file "
    "--people --photographs --pictures --pitch-mm --pixels-per-mm --pool --radius "
    "--rate --reason --runs --screen --sd-between --seconds --seed --settings --sigma "
    "--size --source --station --station-file --stations --study --subject "
    "--text-scale --threshold --track --trainings --trial --trials --version --visit "
    "--visits --what-if --width --window --with --worth";

/// The options of all commands that take any text: command and long name.
std::set<std::pair<std::string, std::string>> options_with_text(const std::string& table) {
  std::set<std::pair<std::string, std::string>> options;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> parts;
    std::istringstream columns(line);
    for (std::string part; parts.size() < 3 && std::getline(columns, part, '|');) {
      parts.push_back(part);
    }
    if (parts.size() == 3 && parts[2].empty() && parts[1].starts_with("--")) {
      options.emplace(parts[0], parts[1]);
    }
  }
  return options;
}

struct Workshop : StudyFolder {
  Workshop() {
    GreyImage photo(180, 180);
    for (int y = 0; y < 180; ++y) {
      for (int x = 0; x < 180; ++x) photo.at(y, x) = texture_number(2).at(y % 120, x % 120);
    }
    engine::write_png(path() / "photo.png", photo);
    done("prepare @cloths.json");
    succeeded(simulate("cloths.db"));
  }
  [[nodiscard]] ProgramResult write(const Output& output,
                                    const std::vector<std::string>& more = {}) const {
    return type(std::string(output.command) + " " + output.line, more);
  }
};

const std::string kMine = "written by hand\n";

void scribble(const fs::path& file) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << kMine;
}

/// One line that names the place, nothing on standard output, and the place as it was.
void check_kept(const ProgramResult& result, const fs::path& place, const std::string& named) {
  INFO(result.output << result.errors);
  CHECK(result.exit_code > 0);
  CHECK(result.output.empty());
  CHECK(line_count(result.errors) == 1);
  CHECK_THAT(result.errors, holds_text(place.filename().string()) && holds_text(named));
}

/// Every name below a folder.
std::set<std::string> names_below(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    names.insert(entry.path().lexically_relative(folder).string());
  }
  for (const char* of_test : {"stdout.txt", "stderr.txt"}) names.erase(of_test);
  return names;
}

void check_link(const Workshop& workshop, const Output& output) {
  const fs::path place = workshop.path() / output.place;
  const fs::path target = workshop.path() / "target";
  fs::create_symlink(target, place);
  const auto before = names_below(workshop.path());
  check_kept(workshop.write(output), place, "link");
  CHECK(names_below(workshop.path()) == before);
  scribble(target);
  const ProgramResult refused = workshop.write(output);
  INFO(refused.errors);
  CHECK(refused.exit_code > 0);
  CHECK(content(target) == kMine);
  fs::remove(target);
  fs::remove(place);
}

}  // namespace

TEST_CASE("every option with text is classified as an output or not") {
  const TempFolder folder;
  const std::string table =
      succeeded(run_touchtrial(folder.path(), {"reference", "--table"})).output;
  std::set<std::pair<std::string, std::string>> outputs = kElsewhere;
  for (const auto& list : {kReplaced, kNeverReplaced}) {
    for (const Output& output : list) outputs.emplace(output.command, output.option);
  }
  const auto options = options_with_text(table);
  for (const auto& output : outputs) {
    INFO(output.first << " " << output.second);
    CHECK(options.contains(output));
  }
  std::istringstream words(kNotWritten);
  const std::set<std::string> not_written{std::istream_iterator<std::string>(words), {}};
  for (const auto& option : options) {
    INFO(option.first << " " << option.second);
    CHECK((outputs.contains(option) || not_written.contains(option.second)));
  }
}

TEST_CASE(
    "an output takes the place of an output, and of another's file only with --force and a copy") {
  const Workshop workshop;
  for (const Output& output : kReplaced) {
    INFO(output.command << " " << output.line);
    const fs::path place = workshop.path() / output.place;
    scribble(place);
    const auto before = names_below(workshop.path());
    check_kept(workshop.write(output), place, "--force");
    CHECK(content(place) == kMine);
    CHECK(names_below(workshop.path()) == before);
    if (output.runs == Runs::to_the_end) {
      const ProgramResult forced = succeeded(workshop.write(output, {"--force"}));
      CHECK_THAT(forced.errors, holds_text(place.filename().string() + ".1"));
      CHECK(content(place.string() + ".1") == kMine);
      CHECK(content(place) != kMine);
      succeeded(workshop.write(output));
      CHECK_FALSE(path_exists(place.string() + ".2"));
      std::ofstream(place, std::ios::app) << kMine;
      check_kept(workshop.write(output), place, "--force");
    }
    fs::remove(place);
    check_link(workshop, output);
  }
}

TEST_CASE("databases, keys and deposited pages are never replaced") {
  const Workshop workshop;
  for (const Output& output : kNeverReplaced) {
    INFO(output.command << " " << output.line);
    const fs::path place = workshop.path() / output.place;
    scribble(place);
    const auto before = names_below(workshop.path());
    check_kept(workshop.write(output), place, "");
    CHECK(content(place) == kMine);
    CHECK(names_below(workshop.path()) == before);
    fs::remove(place);
    check_link(workshop, output);
  }
}

TEST_CASE(
    "an import with --force keeps a study that was edited, and pictures that somebody added to") {
  const StudyFolder workshop;
  fs::create_directory(workshop.path() / "album");
  for (const std::string& label : kLabels) {
    fs::copy_file(workshop.path() / (label + "-photo.png"),
                  workshop.path() / "album" / (label + ".png"));
  }
  const std::string line = "stimuli import @album --study @mine.json --size 60 --crops 1";
  workshop.done(line);
  workshop.done(line, {"--force"});
  CHECK_FALSE(path_exists(workshop.path() / "mine.json.1"));
  CHECK_FALSE(path_exists(workshop.path() / "mine.pictures.1"));

  scribble(workshop.path() / "mine.json");
  scribble(workshop.path() / "mine.pictures" / "notes.txt");
  const ProgramResult refused = workshop.type(line);
  check_kept(refused, workshop.path() / "mine.json", "--force");
  workshop.done(line, {"--force"});
  CHECK(content(workshop.path() / "mine.json.1") == kMine);
  CHECK(content(workshop.path() / "mine.pictures.1" / "notes.txt") == kMine);
  CHECK_FALSE(path_exists(workshop.path() / "mine.pictures" / "notes.txt"));
  workshop.done("prepare @mine.json");
}

TEST_CASE("settings are not written through a link") {
  const StudyFolder workshop;
  succeeded(workshop.simulate("cloths.db"));
  const fs::path home = workshop.path() / "home" / ".config" / "touchtrial";
  fs::create_directories(home);
  fs::create_symlink(workshop.path() / "target", home / "keys.json");
  fs::rename(workshop.path() / "cloths.db.key", workshop.path() / "moved.key");
  const EnvironmentVariable settings("XDG_CONFIG_HOME",
                                     (workshop.path() / "home" / ".config").c_str());
  workshop.done("report @cloths.db --key @moved.key");
  CHECK_FALSE(path_exists(workshop.path() / "target"));
}

TEST_CASE("a run that is refused leaves nothing: no database, no pack, no head") {
  const StudyFolder study;
  const auto before = names_below(study.path());
  for (const std::string refused :
       {"--subject @none.json", "--subject @quick.json --on nosuchdevice",
        "--subject @quick.json --visit 3", "--subject @quick.json --heads @nowhere",
        "--subject @quick.json --db @nowhere/s.db"}) {
    INFO(refused);
    const std::string db = refused.find("--db") == std::string::npos ? " --db @s.db " : " ";
    const ProgramResult result = study.type("run @cloths.json --participant P01" + db + refused);
    CHECK(result.exit_code > 0);
    CHECK(names_below(study.path()) == before);
  }
}
