// Attacks by whoever reads what is in clear of many people, and guesses from it how well each of
// them did. Reports and exports without the key show what follows from these numbers alone.
#include "analysis/outcomes/outcomes.hpp"

#include "attacks/forger.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/confusion_of.hpp"
#include "protocols/simulation/simulation.hpp"
#include "record/payload_json.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <nlohmann/json.hpp>

using namespace touchtrial;
using namespace touchtrial::attacks;

namespace {

/// Numbers of some sessions, by name: one for each, in their order.
class Numbers {
 public:
  explicit Numbers(std::vector<int> sessions) : sessions_(std::move(sessions)) {}

  /// Adds a value to a session's sum, raises its largest, and counts it.
  void add(const std::string& name, int session, double value) {
    const auto found = std::ranges::find(sessions_, session);
    if (found == sessions_.end()) return;
    const auto i = static_cast<std::size_t>(found - sessions_.begin());
    std::vector<double>& largest = of("largest " + name);
    const bool is_first = of("number of " + name)[i]++ == 0.0;
    largest[i] = is_first ? value : std::max(largest[i], value);
    of("sum of " + name)[i] += value;
  }
  /// Numbers and truth values as they are, of texts the length, of anything within a list or an
  /// object the same.
  void add(const std::string& name, int session, const nlohmann::json& value) {
    if (value.is_structured()) {
      for (const auto& [key, member] : value.items()) {
        add(value.is_array() ? name : name + "/" + key, session, member);
      }
    } else if (value.is_boolean()) {
      add(name, session, value.get<bool>() ? 1.0 : 0.0);
    } else if (value.is_number()) {
      add(name, session, value.get<double>());
    } else if (value.is_string()) {
      add(name + ", letters", session, static_cast<double>(value.get<std::string>().size()));
    }
  }

  /// By name, without those that are the same in all sessions.
  [[nodiscard]] std::map<std::string, std::vector<double>> varying() const {
    std::map<std::string, std::vector<double>> found = by_name_;
    std::erase_if(found, [](const auto& entry) {
      return std::ranges::all_of(entry.second,
                                 [&](double value) { return value == entry.second.front(); });
    });
    return found;
  }

 private:
  std::vector<double>& of(const std::string& name) {
    return by_name_.try_emplace(name, sessions_.size()).first->second;
  }

  std::vector<int> sessions_;
  std::map<std::string, std::vector<double>> by_name_;
};

/// The sessions whose end does not say that one key was pressed throughout. docs/evidence.md,
/// "Answers", says openly that an end in clear names those people; nothing else is excused.
std::vector<int> sessions_not_named(const record::StudyStore& store) {
  std::vector<int> sessions;
  for (const record::SessionRow& row : store.sessions()) {
    const bool is_named =
        std::ranges::any_of(store.events(row.session), [](const record::Event& event) {
          return event.kind == record::EventKind::closed &&
                 record::from_json<record::ClosedBody>(event.body).one_key;
        });
    if (!is_named) sessions.push_back(row.session);
  }
  return sessions;
}

nlohmann::json value_of(const SQLite::Column& column) {
  if (column.isInteger() || column.isFloat()) return column.getDouble();
  return column.getBytes();
}

/// Every column of every table that names sessions, and every member of every body, whatever they
/// are called.
void add_database(const fs::path& path, Numbers& seen) {
  SQLite::Database database(path.string(), SQLite::OPEN_READONLY);
  SQLite::Statement tables(database, "SELECT name FROM sqlite_schema WHERE type = 'table'");
  while (tables.executeStep()) {
    const std::string table = tables.getColumn(0).getString();
    SQLite::Statement rows(database, "SELECT * FROM " + table);
    while (rows.executeStep()) {
      int session = rows.getColumn("session").getInt();
      std::string name = table;
      if (table == "events") {
        const auto body = nlohmann::json::parse(rows.getColumn("body").getString());
        if (session == 0) session = body.value("session", 0);
        if (session == 0) continue;
        name += " " + rows.getColumn("kind").getString();
        seen.add(name + " body", session, body);
      }
      for (int i = 0; i < rows.getColumnCount(); ++i) {
        seen.add(name + " " + rows.getColumn(i).getName(), session, value_of(rows.getColumn(i)));
      }
    }
  }
}

/// How well each person did: the share of right answers in all trials, in those of a kind, of a
/// class, and with one right answer; which answers they gave; and how high tracks were. And what is
/// sealed since it tells that.
void open(const record::StudyStore& store, const study::StudyKey& key, Numbers& truth,
          Numbers& sealed) {
  std::map<int, study::Schedule> schedules;
  for (const record::SessionRow& row : store.sessions()) {
    schedules[row.session] = schedule_of_session(store, key, row.session);
  }
  std::map<std::pair<int, int>, double> answers;
  for (const record::TrialRow& row : opened_trials(store, key)) {
    const study::Schedule& schedule = schedules.at(row.session);
    const auto place = static_cast<std::size_t>(row.trial - 1);
    const study::Trial& shown = schedule.trials.at(place);
    const int answer =
        schedule.layout.at(static_cast<std::size_t>(position_of(row.answer).value()));
    const bool is_blank = !row.target && shown.role == study::Role::catch_trial;
    const int target = is_blank ? -1 : row.target.value_or(shown.field().class_index);
    const double right = answer == target ? 1.0 : 0.0;
    truth.add("right", row.session, right);
    truth.add("right in block " + std::to_string(row.block), row.session, right);
    truth.add("right of track " + std::to_string(row.track.value_or(-1)), row.session, right);
    truth.add("right where right is " + std::to_string(target), row.session, right);
    truth.add("answer " + std::to_string(answer), row.session, 1.0);
    ++answers[{row.session, *position_of(row.answer)}];
    if (!row.level) continue;
    truth.add("level", row.session, *row.level);
    truth.add("level of track " + std::to_string(*row.track), row.session, *row.level);
  }
  for (const auto& [session, schedule] : schedules) {
    double share = 0.0;
    for (const auto& [id, count] : answers) {
      if (id.first == session) share = std::max(share, count);
    }
    sealed.add("answers at one position", session, share);
    for (const record::Event& event :
         as_recorded(store.events(session), key_of_session(store, key, session))) {
      if (event.kind != record::EventKind::trace_stored) continue;
      sealed.add("saturated", session,
                 record::from_json<record::TraceBody>(event.body).saturated ? 1.0 : 0.0);
    }
  }
}

/// Ranks less their mean, over the root of the sum of their squares. Equal values have equal ranks.
std::vector<double> ranked(const std::vector<double>& values) {
  std::vector<double> ranks;
  double squares = 0.0;
  for (const double value : values) {
    const auto below = std::ranges::count_if(values, [=](double other) { return other < value; });
    const auto above = std::ranges::count_if(values, [=](double other) { return other > value; });
    ranks.push_back(static_cast<double>(below - above));
    squares += ranks.back() * ranks.back();
  }
  for (double& rank : ranks) rank /= std::sqrt(squares);
  return ranks;
}

using Ranks = std::map<std::vector<double>, std::string>;  ///< of equal ones one name

Ranks ranks_of(const Numbers& numbers) {
  Ranks all;
  for (const auto& [name, values] : numbers.varying()) all.emplace(ranked(values), name);
  return all;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// The names of the numbers whose rank correlation with any outcome is larger than the largest of
/// all pairs is in any of 999 other orders of the people: by chance, one study in a thousand has
/// any.
std::set<std::string> telling(const Numbers& numbers, const Numbers& truth) {
  const Ranks seen = ranks_of(numbers);
  std::vector<std::size_t> order;
  double null = 0.0;
  const Ranks outcomes = ranks_of(truth);
  RandomStream random(43, "orders of people");
  for (std::size_t i = 0; i < outcomes.begin()->first.size(); ++i) order.push_back(i);
  std::vector<double> shuffled(order.size());
  constexpr int kOrders = 999;
  for (int i = 0; i < kOrders; ++i) {
    shuffle(std::span(order), random);
    for (const auto& [outcome, outcome_name] : outcomes) {
      std::ranges::transform(order, shuffled.begin(), [&](std::size_t j) { return outcome[j]; });
      for (const auto& [number, name] : seen) {
        null = std::max(null, std::abs(correlation(number, shuffled)));
      }
    }
  }
  std::set<std::string> found;
  for (const auto& [number, name] : seen) {
    for (const auto& [outcome, outcome_name] : outcomes) {
      const double rho = correlation(number, outcome);
      if (std::abs(rho) <= null) continue;
      UNSCOPED_INFO(name << " with " << outcome_name << ": " << rho << ", beyond " << null);
      found.insert(name);
    }
  }
  return found;
}

/// People who differ much in how well they feel, in how often they lapse and in what they prefer.
simulation::SubjectModel people() {
  return {.sense = engine::ThresholdCurve::israr_2006,
          .threshold_spread_db = 6.0,
          .feature_noise = 0.25,
          .feature_noise_spread = 1.0,
          .lapse = 0.05,
          .lapse_spread = 1.0,
          .position_bias_spread = 0.3,
          .explore_s = 0.6,
          .training_passes = 2};
}

/// \param telling_if_clear  of what is sealed
void attack(const std::string& protocol, const TinyStudyOptions& options,
            const std::set<std::string>& telling_if_clear) {
  constexpr int kPeopleOfCTest = 60;
  constexpr int kMaxPeople = 200;
  const int sessions = std::min(kMaxPeople, places(kPeopleOfCTest));
  TinyStudy tiny(options);
  const fs::path path = tiny.next_database();
  record::StudyStore store = record::StudyStore::create(
      path, session::commitment_of(tiny.key(), tiny.pack(), true, false), {}, tiny.key().signer());
  static_cast<void>(simulation::simulate_study(
      tiny.key(), tiny.pack(), people(), {.participants = sessions, .seed = 5, .jobs = 2}, store));
  const std::vector<int> compared = sessions_not_named(store);
  Numbers seen(compared);
  add_database(path, seen);
  Numbers truth(compared);
  Numbers sealed(compared);
  open(store, tiny.key(), truth, sealed);
  CHECK(telling(seen, truth).empty());
  const std::set<std::string> told = telling(sealed, truth);
  for (const std::string& name : telling_if_clear) {
    INFO(name);
    CHECK(std::ranges::any_of(told, [&](const auto& one) { return one.ends_with(name); }));
  }
  note("outcomes from what is in clear, " + protocol, Outcome::refused,
       static_cast<int>(seen.varying().size()));
}

constexpr const char* kWeakWall = R"({"max_force_n": 0.8})";

TinyStudyOptions threshold(const std::string& section) {
  return {.protocol = "threshold",
          .section = R"({"interval_s": 0.3, )" + section + "}",
          .trials = R"({"explore_limit_s": 4,
                        "validity": {"exploring_s": 0.5, "contact_s": 0.5, "path_mm": 10}})",
          .rendering = kWeakWall};
}

}  // namespace

TEST_CASE("no number in clear tells how well somebody told textures apart") {
  attack("classification",
         {.first_gain = 4.0,
          .trials = R"({"repeats": 4, "catch": 2, "explore_limit_s": 10})",
          .rendering = kWeakWall},
         {});
}

TEST_CASE("no number in clear tells how well somebody told textures of two methods apart") {
  attack("comparison",
         {.comparison = true,
          .trials = R"({"repeats": 2, "explore_limit_s": 10})",
          .rendering = kWeakWall},
         {});
}

TEST_CASE("no number in clear tells a threshold of QUEST+, nor who heard it with the hand off") {
  attack("QUEST+ with control trials", threshold(R"("task": "detection", "trials": 8, "control": 6,
                      "levels": {"from": -40, "to": 0, "step": 4})"),
         {"saturated", "answers at one position"});
}

TEST_CASE("no number in clear tells a threshold of a staircase") {
  attack("staircase",
         threshold(R"("task": "detection", "procedure": "up-down", "trials": 8, "catch": 3,
                      "levels": {"from": -40, "to": 0, "step": 4})"),
         {"saturated"});
}

TEST_CASE("no number in clear tells who was right with constant stimuli") {
  attack("constant stimuli",
         threshold(R"("task": "detection", "procedure": "constant-stimuli", "trials": 8,
                      "levels": [-30, -20, -10, 0])"),
         {"answers at one position"});
}

TEST_CASE("no number in clear tells who said same or different") {
  attack("same or different", threshold(R"("task": "discrimination", "question": "same-different",
                      "procedure": "constant-stimuli", "standards": [-12], "trials": 8,
                      "levels": [-6, 0, 6, 8])"),
         {"answers at one position"});
}
