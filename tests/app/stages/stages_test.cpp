// Sessions of every protocol that are paused, stopped, left, killed, resumed and begun again at
// every stage of theirs, from the experimenter's terminal and window. What a script wrote down of
// its own deeds is held against the exported tables alone.
#include "analysis/exports/csv_cells.hpp"
#include "analysis/exports/csv_reading.hpp"
#include "app/stages/scripted_session.hpp"
#include "app/study_folder.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <sys/wait.h>
#include <unistd.h>

namespace touchtrial {
namespace {

/// A presentation as the participant lived through it.
struct Lived {
  bool practice = false;
  bool hand_off = false;
  bool was_paused = false;  ///< while the answer was awaited
  double ms = 0.0;          ///< from the first plane to the answer, without pauses
  std::vector<double> felt_n;
  int trial = 0;  ///< as it was acknowledged; 0: it was not
  int position = 0;
  std::string response;
  std::optional<int> first;
  std::optional<int> confidence;
};

/// A session as both people lived through it.
struct Sitting {
  std::vector<Lived> presentations;
  std::vector<std::string> deeds;
  std::map<std::string, int> answered_questions;  ///< by questionnaire
  int resumed = 0;
  int practised = 0;
  bool is_over = false;
  bool was_asked_untouched = false;

  [[nodiscard]] bool did(const std::string& deed) const {
    return std::ranges::find(deeds, deed) != deeds.end();
  }
  [[nodiscard]] std::vector<Lived> acknowledged() const {
    std::vector<Lived> kept;
    for (const Lived& one : presentations) {
      if (one.trial > 0) kept.push_back(one);
    }
    return kept;
  }
};

std::vector<json> lines_of(const fs::path& log) {
  std::vector<json> lines;
  std::ifstream in(log);
  for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
  return lines;
}

std::vector<Sitting> sittings_of(const fs::path& log) {
  std::vector<Sitting> all;
  std::vector<std::string> labels;
  Lived now;
  for (const json& line : lines_of(log)) {
    const std::string is = line.at("is");
    if (is == "session") all.emplace_back();
    Sitting& sitting = all.back();
    if (is == "resumed") ++sitting.resumed;
    if (is == "labels") labels = line.at("labels").get<std::vector<std::string>>();
    if (is == "ready") {
      now = Lived();
      now.practice = line.at("practice");
      now.hand_off = line.at("hand_off");
    }
    if (is == "lifted" && !now.felt_n.empty()) now.ms += line.at("ms").get<double>();
    if (is == "felt") {
      now.ms += line.at("ms").get<double>();
      if (line.at("touched")) now.felt_n.push_back(line.at("n"));
    }
    if (is == "asked") sitting.was_asked_untouched |= now.felt_n.empty();
    if (is == "deed") {
      sitting.deeds.push_back(line.at("what"));
      const std::string stage = line.at("stage");
      now.was_paused |= line.at("what") == "pause" && stage.starts_with("answering");
    }
    if (is == "again" || is == "answer") now.ms += line.at("ms").get<double>();
    if (is == "questions") {
      const auto& given = line.at("answers");
      sitting.answered_questions[line.at("name")] =
          static_cast<int>(given.size() - std::ranges::count(given, json("")));
    }
    if (is == "answer") {
      if (line.at("practice")) ++sitting.practised;
      now.position = line.at("position");
      now.response = labels.at(line.at("position"));
      if (!line.at("first").is_null()) now.first = line.at("first");
      if (!line.at("confidence").is_null()) now.confidence = line.at("confidence");
      sitting.presentations.push_back(now);
    }
    if (is == "acknowledged") sitting.presentations.back().trial = line.at("trial");
    if (is == "end") sitting.is_over = !line.at("left");
  }
  return all;
}

/// One participant's way through a session.
struct History {
  std::string participant;
  Deed deed;
  std::string then;  ///< "resume", "restart" or "": what follows a session that broke off
};

/// A study of one protocol, and everybody's sessions in it: as their histories have it in
/// `study.db`, and undisturbed, with the same schedules, in `calm.db`.
class Laboratory {
 public:
  explicit Laboratory(const json& changes) {
    json file = study_of(changes.value("protocol", "classification"));
    file.merge_patch(changes);
    replace_file(study_.path() / "cloths.json", file.dump());
    study_.done("prepare @cloths.json");
  }

  [[nodiscard]] const StudyFolder& folder() const { return study_; }
  [[nodiscard]] fs::path log_of(const std::string& database, const std::string& participant) const {
    return study_.path() / (database + "-" + participant + ".log");
  }
  /// Lets a participant go through it, each start of the program in a process of its own.
  void live(const std::string& database, const History& history) const {
    const auto sit = [&](const Deed& deed, app::OnExisting policy) {
      const pid_t child = ::fork();
      if (child == 0) ::_exit(work(database, history.participant, deed, policy));
      int status = 0;
      REQUIRE(::waitpid(child, &status, 0) == child);
      INFO(history.participant << " " << deed.what << " at " << deed.stage);
      if (deed.what == "kill") {
        CHECK((WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL));
      } else {
        CHECK((WIFEXITED(status) && WEXITSTATUS(status) == 0));
      }
    };
    sit(history.deed, app::OnExisting::refuse);
    if (history.then == "resume") sit({}, app::OnExisting::resume);
    if (history.then == "restart") sit({}, app::OnExisting::restart);
  }
  /// The stages that an undisturbed session went through, and how often each came.
  [[nodiscard]] std::vector<std::pair<std::string, int>> stages_of(
      const std::string& participant) const {
    std::vector<std::pair<std::string, int>> found;
    for (const json& line : lines_of(log_of("calm.db", participant))) {
      if (line.at("is") != "stage") continue;
      const std::string stage = line.at("stage");
      const auto known = std::ranges::find(found, stage, &std::pair<std::string, int>::first);
      if (known == found.end()) {
        found.emplace_back(stage, 1);
      } else {
        ++known->second;
      }
    }
    return found;
  }
  /// Closes and unblinds a database, and exports it.
  /// \return the folder of the tables
  [[nodiscard]] fs::path exported(const std::string& database) const {
    study_.done("close @" + database + " --key @cloths.key --yes");
    study_.done("unblind @" + database + " --key @cloths.key --reason planned --yes");
    study_.done("export @" + database + " --key @cloths.key --format csv --out @" + database +
                ".out");
    return study_.path() / (database + ".out");
  }

 private:
  int work(const std::string& database, const std::string& participant, const Deed& deed,
           app::OnExisting policy) const try {
    constexpr unsigned kHangsAfterS = 120;
    ::alarm(kHangsAfterS);
    app::RunOptions options;
    options.study = study_.path() / "cloths.json";
    options.participant = participant;
    options.database = study_.path() / database;
    options.subject = "default";
    options.yes = true;
    options.on_existing = policy;
    run_scripted(options, deed, log_of(database, participant));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", participant.c_str(), error.what());
    return 1;
  }

  StudyFolder study_;
};

/// The exported tables.
struct Exported {
  explicit Exported(const fs::path& folder)
      : participants(rows_of(folder / "participants.csv")),
        trials(rows_of(folder / "trials.csv")),
        answers(rows_of(folder / "answers.csv")),
        deviations(rows_of(folder / "deviations.csv")) {
    for (const CsvRow& row : rows_of(folder / "unscored_trials.csv")) trials.push_back(row);
    std::ranges::stable_sort(trials, {}, [](const CsvRow& row) {
      return std::pair(std::stoi(row.at("session")), number(row, "presented_at_s"));
    });
  }
  static double number(const CsvRow& row, const std::string& column) {
    return row.at(column).empty() ? -1.0 : std::stod(row.at(column));
  }
  [[nodiscard]] static std::vector<CsvRow> of(const std::vector<CsvRow>& table,
                                              const std::string& column, const std::string& value) {
    std::vector<CsvRow> found;
    for (const CsvRow& row : table) {
      if (row.at(column) == value) found.push_back(row);
    }
    return found;
  }

  std::vector<CsvRow> participants;
  std::vector<CsvRow> trials;  ///< scored or not, in order of session and presentation
  std::vector<CsvRow> answers;
  std::vector<CsvRow> deviations;
};

/// What a row says was presented. A study of levels has one class here.
std::string stimulus_of(const CsvRow& row) {
  if (row.contains("level_db")) return row.at("level_db");
  return row.at("class") + " " + row.at("method") + " " + row.at("exemplar");
}

std::vector<std::string> stimuli_of(const std::vector<CsvRow>& rows) {
  std::vector<std::string> stimuli;
  for (const CsvRow& row : rows) stimuli.push_back(stimulus_of(row));
  return stimuli;
}

bool are_alike(const Lived& lived) {
  const auto [min, max] = std::ranges::minmax(lived.felt_n);
  return max - min < 1e-6;
}

/// Whether an answer about several planes was right, by what the hand felt.
bool was_right(const Lived& lived) {
  if (lived.response == "same") return are_alike(lived);
  if (lived.response == "different") return !are_alike(lived);
  return std::ranges::max_element(lived.felt_n) - lived.felt_n.begin() == lived.position;
}

/// What was felt against what is said to have been presented, over the whole study.
class Feelings {
 public:
  void add(const CsvRow& row, const Lived& lived) {
    if (lived.felt_n.size() > 1 && are_alike(lived)) return;  // two blank planes, or the same twice
    const double felt = *std::ranges::max_element(lived.felt_n);
    const auto known = felt_.emplace(stimulus_of(row), felt);
    INFO(stimulus_of(row));
    CHECK(std::abs(known.first->second - felt) < 1e-6);
  }
  [[nodiscard]] bool are_distinct() const {
    std::set<long> different;
    for (const auto& [stimulus, n] : felt_) different.insert(std::lround(1e6 * n));
    return different.size() == felt_.size();
  }

 private:
  std::map<std::string, double> felt_;
};

/// The acknowledged answers of a sitting against its exported rows.
void check_trials(const Sitting& sitting, const std::vector<CsvRow>& rows, bool has_planes,
                  Feelings& feelings) {
  std::vector<CsvRow> answered;
  for (const CsvRow& row : rows) {
    const bool has_answer = row.at("state") == "answered" || row.at("state") == "voided";
    if (has_answer && !row.at("response").empty()) answered.push_back(row);
    if (!has_answer) CHECK(row.at("response").empty());
  }
  const std::vector<Lived> lived = sitting.acknowledged();
  REQUIRE(answered.size() == lived.size());
  for (std::size_t i = 0; i < lived.size(); ++i) {
    const CsvRow& row = answered[i];
    const Lived& one = lived[i];
    INFO("trial " << one.trial);
    CHECK(row.at("trial") == std::to_string(one.trial));
    CHECK(row.at("response") == one.response);
    CHECK(row.at("first_position") == (one.first ? std::to_string(*one.first) : ""));
    CHECK(row.at("confidence") == (one.confidence ? std::to_string(*one.confidence) : ""));
    CHECK(row.at("paused") == (one.was_paused ? "1" : "0"));
    if (one.was_paused) {
      CHECK(row.at("reaction_time_s").empty());
      CHECK(row.at("from_contact_s").empty());
    } else {
      CHECK(std::abs(Exported::number(row, "reaction_time_s") - one.ms / 1000.0) < 0.002);
    }
    REQUIRE(!one.felt_n.empty());
    if (!one.hand_off) feelings.add(row, one);
    if (has_planes && !one.hand_off) CHECK(row.at("correct") == (was_right(one) ? "1" : "0"));
    if (row.at("state") == "voided") {
      CHECK(row.at("correct").empty());
    } else if (!has_planes && !row.at("class").empty()) {
      CHECK(row.at("correct") == (row.at("class") == one.response ? "1" : "0"));
    }
  }
}

/// What one participant's rows must come to.
void check_person(const History& history, const std::vector<Sitting>& sittings,
                  const Exported& exported, const std::vector<CsvRow>& calm, bool has_planes,
                  Feelings& feelings) {
  const std::vector<CsvRow> people =
      Exported::of(exported.participants, "participant", history.participant);
  REQUIRE(people.size() == sittings.size());
  std::map<std::string, int> questions;
  for (std::size_t i = 0; i < sittings.size(); ++i) {
    const Sitting& sitting = sittings[i];
    const CsvRow& person = people[i];
    const std::vector<CsvRow> rows = Exported::of(exported.trials, "session", person.at("session"));
    CHECK_FALSE(sitting.was_asked_untouched);
    check_trials(sitting, rows, has_planes, feelings);

    const bool is_at_end = history.deed.stage == "end";
    // A session whose trials are done stays complete.
    const bool is_stopped =
        sitting.did("abort") && sitting.acknowledged().size() < calm.size() && !is_at_end;
    const bool is_given_up = i + 1 < sittings.size();
    const std::string state = is_stopped || is_given_up ? "stopped" : "completed";
    if (sitting.is_over || is_given_up) CHECK(person.at("state") == state);
    CHECK(person.at("resumed") == std::to_string(sitting.resumed));
    CHECK(person.at("practice_presentations") ==
          (sitting.practised > 0 ? std::to_string(sitting.practised) : ""));
    const bool counts = person.at("state") == "completed";
    CHECK(person.at("counted") == (counts ? "1" : "0"));
    for (const CsvRow& row : rows) {
      const bool is_scored = row.at("kind") == "scored";
      CHECK(row.at("counted") ==
            (counts && is_scored && row.at("state") == "answered" ? "1" : "0"));
    }
    const bool only_waited = std::ranges::all_of(
        sitting.deeds, [](const std::string& deed) { return deed == "pause" || deed == "note"; });
    if (only_waited && sitting.resumed == 0 && sitting.is_over) {
      CHECK(person.at("pauses") == (sitting.did("pause") && !is_at_end ? "1" : "0"));
      CHECK(person.at("interruptions") == "0");
      CHECK(stimuli_of(rows) == stimuli_of(calm));
      CHECK(stimuli_of(Exported::of(rows, "state", "answered")) == stimuli_of(calm));
    } else if (counts && !has_planes) {
      // What was interrupted came again: everybody answered the whole schedule.
      std::vector<std::string> done = stimuli_of(Exported::of(rows, "state", "answered"));
      std::vector<std::string> planned = stimuli_of(calm);
      std::ranges::sort(done);
      std::ranges::sort(planned);
      CHECK(done == planned);
    } else if (counts) {
      CHECK(Exported::of(rows, "state", "answered").size() == calm.size());
    }
    if (sitting.did("note") && !is_at_end) CHECK(person.at("notes") == "1");
    for (const auto& [name, count] : sitting.answered_questions) questions[name] += count;
  }
  std::map<std::string, int> exported_questions;
  for (const CsvRow& row : Exported::of(exported.answers, "participant", history.participant)) {
    ++exported_questions[row.at("questionnaire")];
  }
  CHECK(exported_questions == questions);
  for (const CsvRow& row : Exported::of(exported.deviations, "participant", history.participant)) {
    CHECK(row.at("code") != "no-curtain");  // which somebody began to type
  }
}

constexpr std::size_t kFirstNumber = 100;
constexpr const char* kFirst = "P100";

std::vector<History> histories_for(const std::vector<std::pair<std::string, int>>& stages) {
  const std::vector<std::array<const char*, 2>> deeds = {
      {"pause", ""}, {"stop", ""},        {"own-stop", ""},   {"abort", ""},
      {"note", ""},  {"leave", "resume"}, {"kill", "resume"}, {"kill", "restart"}};
  std::vector<History> all;
  for (const auto& [stage, times] : stages) {
    for (const auto& [what, then] : deeds) {
      const bool is_on = stage.starts_with("exploring") && !stage.ends_with("between planes");
      if (std::string(what) == "own-stop" && !is_on) continue;
      // Nothing is taken up again after the end, nor begun anew once the trials are done.
      std::string next = stage == "end" ? "" : then;
      if (stage == "questions" && next == "restart") next = "resume";
      // Everybody pauses from both faces, and stops from one or the other.
      const bool is_even = all.size() % 2 == 0;
      for (const bool at_console : {false, true}) {
        const bool pauses = std::string(what) == "pause";
        const bool stops = std::string(what) == "stop";
        if (stops ? at_console != is_even : at_console && !pauses) continue;
        all.push_back({"P" + std::to_string(kFirstNumber + all.size()),
                       {what, stage, std::min(times, 2), at_console},
                       next});
      }
    }
  }
  return all;
}

/// Takes one sealed answer for another; the rules of the file are there again afterwards.
void forge_answer(const std::string& database) {
  SQLite::Database forger(database, SQLite::OPEN_READWRITE);
  const std::string rule =
      forger.execAndGet("SELECT sql FROM sqlite_master WHERE name = 'events_no_update'");
  forger.exec("DROP TRIGGER events_no_update");
  REQUIRE(forger.exec("UPDATE events SET sealed = (SELECT sealed FROM events WHERE kind = "
                      "'answered' ORDER BY session DESC LIMIT 1) WHERE kind = 'answered' AND "
                      "session = 1") > 0);
  forger.exec(rule);
}

/// \param changes  to the study file of a classification of three textures
void check_protocol(const json& changes) {
  const Laboratory lab(changes);
  lab.live("calm.db", {kFirst, {}, ""});
  const auto stages = lab.stages_of(kFirst);
  CHECK(stages.size() >= 10);
  const std::vector<History> histories = histories_for(stages);
  for (const History& history : histories) {
    if (history.participant != kFirst) lab.live("calm.db", {history.participant, {}, ""});
    lab.live("study.db", history);
  }
  lab.live("study.db", {"gone", {}, ""});
  const StudyFolder& study = lab.folder();
  study.done("withdraw @study.db --participant gone --erase --reason asked --yes");
  const Exported undisturbed(lab.exported("calm.db"));
  const Exported exported(lab.exported("study.db"));
  study.done("verify @study.db --key @cloths.key");

  const bool has_planes = exported.trials.front().contains("level_db");
  Feelings feelings;
  for (const History& history : histories) {
    INFO(history.participant << ": " << history.deed.what << " at " << history.deed.stage << " ("
                             << (history.deed.at_console ? "window" : "terminal") << "), "
                             << history.then);
    const std::vector<CsvRow> calm =
        Exported::of(undisturbed.trials, "participant", history.participant);
    const auto lived = sittings_of(lab.log_of("calm.db", history.participant));
    check_trials(lived.front(), calm, has_planes, feelings);
    check_person(history, sittings_of(lab.log_of("study.db", history.participant)), exported, calm,
                 has_planes, feelings);
  }
  CHECK(feelings.are_distinct());
  CHECK(Exported::of(exported.trials, "participant", "gone").empty());
  CHECK(Exported::of(exported.answers, "participant", "gone").empty());
  CHECK(Exported::of(exported.participants, "participant", "gone").at(0).at("erased") == "1");

  forge_answer(study.in("study.db"));
  CHECK(study.type("verify @study.db --key @cloths.key").exit_code == 3);
}

json threshold_of(const json& section) {
  json threshold = {{"task", "detection"},
                    {"interval_s", 0.3},
                    {"trials", 3},
                    {"catch", 1},
                    {"control", 1},
                    {"levels", {-20, -10, 0}},
                    {"practice", {{"trials", 2}, {"criterion", 2}, {"rounds", 1}}}};
  threshold.merge_patch(section);
  return {
      {"protocol", "threshold"},
      {"classes", {{{"label", "granite"}, {"images", {"granite-photo.png"}}}}},
      {"threshold", threshold},
      {"trials",
       {{"repeats", nullptr}, {"break_every", 2}, {"explore_limit_s", 2}, {"validity", nullptr}}}};
}

}  // namespace

TEST_CASE(
    "classification: the tables agree with the participants' actions, despite interruptions") {
  check_protocol({{"trials", {{"repeats", 1}, {"break_every", 2}, {"catch", 1}}},
                  {"session", {{"confidence", 4}}}});
}

TEST_CASE("comparison with restarted blocks: the tables agree with the participants' actions") {
  check_protocol(
      {{"protocol", "comparison"},
       {"trials", {{"repeats", 1}, {"break_every", 2}, {"on_interruption", "restart-block"}}}});
}

TEST_CASE("thresholds by QUEST+: the tables agree with the participants' actions") {
  check_protocol(threshold_of({{"procedure", "quest-plus"}, {"feedback", true}}));
}

TEST_CASE("thresholds by a staircase: the tables agree with the participants' actions") {
  check_protocol(threshold_of({{"procedure", "up-down"}, {"trials", 4}}));
}

TEST_CASE("thresholds by constant stimuli: the tables agree with the participants' actions") {
  check_protocol(threshold_of(
      {{"procedure", "constant-stimuli"}, {"question", "same-different"}, {"trials", 6}}));
}

}  // namespace touchtrial
