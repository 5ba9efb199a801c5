// What a study file says of a threshold, and what its participants are presented.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/threshold/study/registered_standards.hpp"
#include "protocols/threshold/study/threshold.hpp"
#include "protocols/threshold/threshold_study.hpp"
#include "study/protocol.hpp"
#include "study/study_sections.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

using nlohmann::json;

json detection_file() {
  return json::parse(R"({"study": "s", "protocol": "threshold",
    "classes": [{"label": "a", "images": ["a.png"]}], "methods": [{"name": "adaptive"}],
    "threshold": {"task": "detection", "levels": {"from": -40, "to": 0, "step": 1}}})");
}

json gain_file() {
  json file = detection_file();
  file["threshold"] = json::parse(R"({"task": "discrimination", "standards": [-18, -6],
    "levels": {"from": -30, "to": -4, "step": 2}})");
  return file;
}

json order_file() {
  json file = detection_file();
  file["methods"] = {{{"name", "fixed"}, {"radius", 3}}};
  file["threshold"] = json::parse(R"({"task": "discrimination", "along": "order",
    "question": "odd-one-out", "standards": [0.1], "levels": [0, 6, 12], "rove_db": 3})");
  return file;
}

study::Study study_of(const json& file) {
  return study::parse_study(file.dump(), ".", "s.json");
}

std::string refusal_of(const json& file) {
  return message_of<StudyError>([&] { return study_of(file); });
}

study::ScheduleDraw draw_of(std::uint64_t seed) {
  return {.secret = SeededEntropy(seed).secret("threshold_design_test")};
}

/// All trials of a participant whose answers are right where `is_right` says so.
template <typename IsRight>
std::vector<study::Trial> presented(const study::Study& study, const study::ScheduleDraw& draw,
                                    IsRight is_right) {
  const auto order = study::make_order(study, draw);
  std::vector<study::Trial> all;
  for (const study::Trial& scheduled : order->schedule().trials) {
    const study::Trial& shown = all.emplace_back(order->at(scheduled));
    const int right = shown.right.value();
    order->answered(shown, ChoiceAnswer{is_right(shown) ? right : (right == 0 ? 1 : 0)});
  }
  return all;
}

const auto kAlwaysRight = [](const study::Trial&) { return true; };

std::vector<study::Trial> with_role(const std::vector<study::Trial>& trials, study::Role role) {
  std::vector<study::Trial> all;
  std::ranges::copy_if(trials, std::back_inserter(all),
                       [&](const study::Trial& shown) { return shown.role == role; });
  return all;
}

std::vector<study::Level> levels_of(const std::vector<study::Trial>& trials) {
  std::vector<study::Level> all;
  for (const study::Trial& shown : trials) all.push_back(shown.level.value());
  return all;
}

}  // namespace

TEST_CASE("a threshold study has one class at least, and the section that it needs") {
  CHECK(refusal_of(detection_file()).empty());
  json file = detection_file();
  file.erase("threshold");
  CHECK_THAT(refusal_of(file), names("/threshold"));
  file = detection_file();
  file["protocol"] = "classification";
  file.erase("threshold");
  CHECK_THAT(refusal_of(file), names("/classes 1 2"));
}

TEST_CASE("what cannot be presented or answered is refused with its place and a remedy") {
  const json huge = {{"slopes", {{"from", 1}, {"to", 200}, {"step", 1}}},
                     {"lapses", {{"from", 0}, {"to", 0.4}, {"step", 0.0021}}}};
  const json tiny_steps = {{"from", -40}, {"to", 0}, {"step", 1e-9}};
  const json falling = {{"from", 0}, {"to", -40}, {"step", 1}};
  const json methods = {{{"name", "adaptive"}}, {{"name", "edge"}}};
  struct Refused {
    json file;
    const char* pointer;
    json value;
    const char* places;
  };
  const std::vector<Refused> all = {
      {detection_file(), "/threshold/along", "pitch", "/threshold/along gain"},
      {detection_file(), "/threshold/levels", {-3, 3}, "/threshold/levels"},
      {detection_file(), "/threshold/levels", {-3, -3}, "/threshold/levels"},
      {detection_file(), "/threshold/levels", tiny_steps, "/threshold/levels 200"},
      {detection_file(), "/threshold/levels", falling, "/threshold/levels"},
      {detection_file(), "/threshold/standards", {-6}, "/threshold/standards"},
      {detection_file(), "/threshold/procedure", "questplus", "/threshold/procedure quest-plus"},
      {detection_file(), "/threshold/tracks", 9, "/threshold/tracks"},
      {detection_file(), "/threshold/rove_db", 3, "/threshold/levels"},
      {detection_file(), "/threshold/question", "same-different", "/threshold/question"},
      {detection_file(), "/threshold/catch", 50, "/threshold"},
      {detection_file(), "/threshold/windows", {{"slowest_mm_s", 300}}, "/threshold/windows"},
      {detection_file(), "/trials/on_interruption", "leave-out", "/trials/on_interruption repeat"},
      {detection_file(), "/trials/explore_limit_s", 1, "/trials/explore_limit_s"},
      {detection_file(), "/trials/practice", 3, "/threshold/practice"},
      {detection_file(), "/trials/rove_db", 3, "/trials/rove_db"},
      {detection_file(), "/rendering/reference_grey", 0, "/rendering/reference_grey 128"},
      {detection_file(), "/methods", methods, "/methods 2"},
      {gain_file(), "/threshold/levels", {6, 12}, "/threshold/levels"},
      {gain_file(), "/threshold/procedure", "constant-stimuli", "/threshold"},
      {gain_file(), "/threshold/up_down", {{"first_level", -5}}, "/threshold/up_down/first_level"},
      {order_file(), "/threshold/levels", {0, 20}, "/threshold/levels 1"},
      {order_file(), "/threshold/question", "which-interval", "odd-one-out same-different"},
      {order_file(), "/methods/0", {{"name", "adaptive"}}, "/methods/0 fixed"},
      {detection_file(), "/threshold/grid", huge, "/threshold/grid"}};
  for (auto [file, pointer, value, places] : all) {
    file[json::json_pointer(pointer)] = value;
    INFO(pointer << " = " << value.dump());
    CHECK_THAT(refusal_of(file), names(places));
  }
}

TEST_CASE("a registered question is one that a report of thresholds answers") {
  const auto with = [](const json& registration, json file = detection_file()) {
    file["registration"] = registration;
    return refusal_of(file);
  };
  CHECK(with({{"estimand", "mean-threshold"}}).empty());
  CHECK_THAT(with({{"estimand", "mean-accuracy"}, {"participants", 12}, {"looks", {6}}}),
             names("s.json /registration/estimand mean-accuracy mean-threshold "
                   "threshold-difference threshold-equality"));
  CHECK_THAT(with({{"estimand", "mean-threshold"}, {"participants", 12}, {"looks", {6}}}),
             names("/registration/looks"));
  CHECK_THAT(with({{"estimand", "mean-threshold"}, {"margin_db", 3}}),
             names("/registration/margin_db"));
  CHECK_THAT(with({{"estimand", "threshold-difference"}}), names("/registration/estimand 1"));
  const json difference = {{"estimand", "threshold-difference"},
                           {"smallest_effect_db", 2},
                           {"participants", 12},
                           {"looks", {6}}};
  CHECK(with(difference, gain_file()).empty());
  CHECK_THAT(with({{"estimand", "threshold-equality"}}, gain_file()),
             names("/registration/margin_db"));
  const json equality = {{"estimand", "threshold-equality"}, {"margin_db", 3}};
  CHECK(with(equality, gain_file()).empty());
  const auto refused = [&](const char* key, const json& value) {
    json more = equality;
    more[key] = value;
    return with(more, gain_file());
  };
  CHECK_THAT(refused("sides", "one"), names("/registration/sides"));
  CHECK_THAT(refused("margin", 0.1), names("/registration/margin"));
  CHECK_THAT(refused("test", "sign-flip"), names("/registration/test"));
  CHECK_THAT(refused("smallest_effect_db", 1), names("/registration/smallest_effect_db margin_db"));
  json alike = detection_file();
  alike["threshold"].update(
      {{"question", "same-different"}, {"procedure", "constant-stimuli"}, {"levels", {-10, 0}}});
  CHECK_THAT(with({{"estimand", "mean-threshold"}}, alike),
             names("/registration/estimand same-different"));
}

TEST_CASE("registered standards are named as in the study file, each once") {
  const auto with = [](const json& standards, const char* estimand, json file = gain_file()) {
    file["registration"] = {{"estimand", estimand}, {"standards", standards}};
    return refusal_of(file);
  };
  const json low = {{"value", -18}};
  const json high = {{"class", "a"}, {"value", -6}};
  CHECK(with(json::array({low}), "mean-threshold").empty());
  CHECK(with({high, low}, "threshold-difference").empty());
  CHECK_THAT(with(json::array(), "mean-threshold"),
             names("s.json /registration/estimand standards 2 -18 -6"));
  CHECK_THAT(with({low, high}, "mean-threshold"), names("/registration/standards 2"));
  CHECK_THAT(with({{{"value", -12}}}, "mean-threshold"), names("/registration/standards/0"));
  CHECK_THAT(with({{{"class", "a"}}}, "mean-threshold"), names("/registration/standards/0 2"));
  CHECK_THAT(with({low, low}, "threshold-difference"), names("/registration/standards/1"));
  json file = gain_file();
  file["registration"] = {{"estimand", "threshold-difference"}, {"standards", {high, low}}};
  const study::Study study = study_of(file);
  CHECK(study::threshold::registered_standards(study) == std::vector<std::size_t>{1, 0});
  file["registration"] = study::to_json(study.registration);
  CHECK(study_of(file).registration == study.registration);
  const auto fields = study::fields_of(study.registration);
  CHECK_THAT(fields.front().second, names("a -6 -18"));
}

TEST_CASE("a rule on missed catch trials leaves somebody out only if there are more of them") {
  const auto with = [](int catch_trials, int most) {
    json file = detection_file();
    file["threshold"]["catch"] = catch_trials;
    file["registration"] = {{"estimand", "mean-threshold"},
                            {"exclusion_rules", {{"missed_catch", most}}}};
    return refusal_of(file);
  };
  CHECK(with(6, 2).empty());
  CHECK_THAT(with(0, 2), names("/registration/exclusion_rules/missed_catch"));
  CHECK_THAT(with(6, 6), names("/registration/exclusion_rules/missed_catch 6"));
}

TEST_CASE("of two intervals the target alone has the texture, each equally often") {
  const study::Study study = study_of(detection_file());
  std::map<int, int> targets;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const study::Trial& shown : presented(study, draw_of(seed), kAlwaysRight)) {
      REQUIRE(shown.planes.size() == 2);
      const auto target = static_cast<std::size_t>(shown.right.value());
      CHECK_FALSE(shown.planes[target].blank);
      CHECK(shown.planes[1 - target].blank);
      CHECK(shown.planes[target].gain_db == -40.0 + shown.level->level);
      ++targets[shown.right.value()];
    }
  }
  CHECK(targets[0] + targets[1] == 600);
  CHECK(std::abs(targets[0] - 300) < 60);
}

TEST_CASE("the comparison is stronger by the level's share of the standard, up to the ceiling") {
  const study::Study study = study_of(gain_file());
  const auto& options = study::threshold::options_of(study);
  CHECK(study::threshold::comparison_at(options, {0, -6.0}, 0.0) ==
        Approx(-6.0 + 20.0 * std::log10(2.0)));
  for (const study::Trial& shown : presented(study, draw_of(3), kAlwaysRight)) {
    const auto target = static_cast<std::size_t>(shown.right.value());
    const double standard = shown.level->track == 1 ? -18.0 : -6.0;
    const double level = -30.0 + 2.0 * shown.level->level;
    CHECK(shown.planes[1 - target].gain_db == standard);
    CHECK(shown.planes[target].gain_db ==
          Approx(standard + 20.0 * std::log10(1.0 + std::pow(10.0, level / 20.0))));
  }
}

TEST_CASE("a track has the levels up to its own standard's ceiling, and no others") {
  json file = gain_file();
  file["threshold"]["levels"] = {{"from", -30}, {"to", 20}, {"step", 1}};
  file["threshold"]["catch"] = 20;
  const study::Study study = study_of(file);
  const auto block = study::threshold::block_settings(study);
  REQUIRE(block.tracks.size() == 2);
  CHECK(block.tracks[0].levels.back() == 16.0);  // 20 log10(10^(18/20) - 1) = 16.83
  CHECK(block.tracks[1].levels.back() == -1.0);  // 20 log10(10^(6/20) - 1) = -0.04
  for (const study::Trial& shown :
       presented(study, draw_of(4), [](const study::Trial&) { return false; })) {
    for (const study::Plane& one : shown.planes) CHECK(one.gain_db <= 1e-9);
  }
}

TEST_CASE("along the order every level has a method, and either kind is odd equally often") {
  const study::Study study = study_of(order_file());
  REQUIRE(study.methods.size() == 4);
  const std::vector<double> orders = {0.1, 0.2, 0.1 * (1.0 + std::pow(10.0, 0.3)),
                                      0.1 * (1.0 + std::pow(10.0, 0.6))};
  for (std::size_t i = 0; i < orders.size(); ++i) {
    CHECK(study.methods[i].order == Approx(orders[i]));
    CHECK(study.methods[i].radius == 3);
  }
  int standards_odd = 0;
  int all = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const study::Trial& shown : presented(study, draw_of(seed), kAlwaysRight)) {
      std::map<int, int> methods;
      for (const study::Plane& one : shown.planes) ++methods[one.field.method];
      REQUIRE(methods.size() == 2);
      const auto target = static_cast<std::size_t>(shown.right.value());
      CHECK(methods[shown.planes[target].field.method] == 1);
      standards_odd += shown.planes[target].field.method == 0 ? 1 : 0;
      ++all;
      std::set<double> gains;
      for (const study::Plane& one : shown.planes) {
        CHECK(one.gain_db <= 0.0);
        CHECK(one.gain_db >= -3.0);
        gains.insert(one.gain_db);
      }
      CHECK(gains.size() == 3);
    }
  }
  CHECK(std::abs(standards_odd - all / 2) < all / 8);
}

TEST_CASE("same or different: half of the trials differ, and both kinds of pairs are the same") {
  json file = gain_file();
  file["threshold"]["question"] = "same-different";
  file["threshold"]["procedure"] = "constant-stimuli";
  file["threshold"]["trials"] = 140;
  const study::Study study = study_of(file);
  std::map<std::pair<int, bool>, int> seen;
  for (const study::Trial& shown : presented(study, draw_of(5), kAlwaysRight)) {
    const double standard = shown.level->track == 1 ? -18.0 : -6.0;
    const bool first = shown.planes[0].gain_db > standard;
    const bool second = shown.planes[1].gain_db > standard;
    CHECK((first != second) == (shown.right.value() == 1));
    ++seen[{shown.right.value(), first}];
  }
  for (const auto& [kind, count] : seen) CHECK(std::abs(count - 70) < 30);
  CHECK(seen.size() == 4);
}

TEST_CASE("levels follow the answers, and a repeated trial has the same level") {
  const study::Study study = study_of(detection_file());
  const auto low = presented(study, draw_of(1), kAlwaysRight);
  const auto high =
      presented(study, draw_of(1), [](const study::Trial& p) { return p.place.trial % 2 == 0; });
  CHECK(low.front().level->level == high.front().level->level);
  CHECK(low.back().level->level < high.back().level->level);

  const auto order = study::make_order(study, draw_of(1));
  const study::Trial first = order->at(order->schedule().trials.front());
  CHECK(order->at(order->schedule().trials.front()) == first);
  std::set<int> differing;
  std::set<int> of_others;
  for (std::size_t i = 1; i < 35; ++i) {
    const study::Trial other = order->at(order->schedule().trials[i]);
    CHECK(other.level == first.level);
    of_others.insert(other.right.value());
    order->interrupted(first);
    const study::Trial again = order->at(order->schedule().trials.front());
    CHECK(again.place == first.place);
    CHECK(again.level == first.level);
    differing.insert(again.right.value());
  }
  CHECK(of_others.size() == 2);
  CHECK(differing.size() == 2);  // what was felt before the interruption tells nothing
}

TEST_CASE("catch trials are at the highest level, and control trials come last without the hand") {
  json file = detection_file();
  file["threshold"]["catch"] = 6;
  file["threshold"]["control"] = 9;
  const study::Study study = study_of(file);
  CHECK(study.scored_trials() == 60);
  const auto all = presented(study, draw_of(2), kAlwaysRight);
  REQUIRE(all.size() == 75);
  int caught = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(all[i].place.hand_off == (i >= 66));
    CHECK(all[i].place.block == (i >= 66 ? 1 : 0));
    if (all[i].role == study::Role::catch_trial) ++caught;
    if (all[i].role != study::Role::scored) CHECK(all[i].level->level == 40);
  }
  CHECK(caught == 6);
}

TEST_CASE("catch trials are dealt evenly to the tracks, each at its standard's highest level") {
  json file = gain_file();
  file["threshold"]["levels"] = {{"from", -30}, {"to", 20}, {"step", 1}};
  file["threshold"]["catch"] = 13;
  const study::Study study = study_of(file);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const auto caught =
        with_role(presented(study, draw_of(seed), kAlwaysRight), study::Role::catch_trial);
    std::map<int, int> of_track;
    for (const study::Trial& shown : caught) {
      const bool is_first = shown.level->track == 1;
      ++of_track[shown.level->track];
      CHECK(shown.level->level == (is_first ? 46 : 29));  // 16 and -1 dB
      const auto target = static_cast<std::size_t>(shown.right.value());
      CHECK(shown.planes[1 - target].gain_db == (is_first ? -18.0 : -6.0));
      CHECK(shown.planes[target].gain_db <= 1e-9);
      CHECK(shown.planes[target].gain_db > -1.0);
    }
    CHECK(of_track.size() == 2);
    CHECK(of_track[1] + of_track[2] == 13);
    CHECK(std::abs(of_track[1] - of_track[2]) == 1);
  }
}

TEST_CASE(
    "no procedure is notified of a catch trial, and an interrupted one is repeated unchanged") {
  json file = gain_file();
  const auto scored = [&file](int catches, bool is_caught_right) {
    file["threshold"]["catch"] = catches;
    const study::Study study = study_of(file);
    const auto all = presented(study, draw_of(6), [&](const study::Trial& shown) {
      if (shown.role == study::Role::catch_trial) return is_caught_right;
      return (7 * shown.level->level + shown.level->track) % 3 != 0;
    });
    return levels_of(with_role(all, study::Role::scored));
  };
  const std::vector<study::Level> without = scored(0, true);
  CHECK(without.size() == 120);
  CHECK(scored(12, true) == without);
  CHECK(scored(12, false) == without);

  const study::Study study = study_of(file);
  const auto order = study::make_order(study, draw_of(6));
  int interrupted = 0;
  for (const study::Trial& scheduled : order->schedule().trials) {
    const study::Trial shown = order->at(scheduled);
    if (shown.role == study::Role::catch_trial) {
      order->interrupted(shown);
      const study::Trial again = order->at(scheduled);
      CHECK(again.role == shown.role);
      CHECK(again.level == shown.level);
      ++interrupted;
    }
    order->answered(shown, ChoiceAnswer{0});
  }
  CHECK(interrupted == 12);
}

TEST_CASE("a schedule does not tell which trials are catch trials") {
  json file = gain_file();
  file["threshold"]["catch"] = 12;
  const auto schedule = study::make_schedule(study_of(file), draw_of(1));
  REQUIRE(schedule.trials.size() == 132);
  for (const study::Trial& scheduled : schedule.trials) {
    study::Trial place;
    place.place.trial = scheduled.place.trial;
    CHECK(scheduled == place);
  }
}

TEST_CASE("preparing a study says how many catch trials it lacks to tell lapses") {
  const auto advice = [](json file, const json& section) {
    file["threshold"].update(section);
    const study::Study study = study_of(file);
    const std::vector<std::string> all = study.task->advice(study);
    return all.empty() ? std::string() : all.front();
  };
  CHECK_THAT(advice(detection_file(), json::object()), names("/threshold/catch 0 6"));
  CHECK_THAT(advice(detection_file(), {{"catch", 5}}), names("/threshold/catch 5 6"));
  CHECK(advice(detection_file(), {{"catch", 6}}).empty());
  CHECK_THAT(advice(detection_file(), {{"trials", 100}, {"catch", 9}}),
             names("/threshold/catch 9 10"));
  CHECK_THAT(advice(gain_file(), {{"catch", 6}}), names("/threshold/catch 6 12"));
  CHECK_THAT(advice(detection_file(), {{"trials", 8}}),
             names("/threshold/catch 0 4"));  // half, at most
  // Trials of the highest level are among those of constant stimuli.
  const json constant = {{"procedure", "constant-stimuli"}, {"levels", {-30, -20, -10, 0}}};
  json many = constant;
  many["trials"] = 24;
  CHECK(advice(detection_file(), many).empty());
  many["trials"] = 12;
  CHECK_THAT(advice(detection_file(), many), names("/threshold/catch 0 3"));
  many["question"] = "same-different";
  CHECK(advice(detection_file(), many).empty());
}

TEST_CASE("the studies of thresholds that ship can be read, and say what they present") {
  const std::filesystem::path config = std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config";
  for (const char* name : {"detection", "discrimination", "discrimination-order"}) {
    const study::Study study = study::load_study(config / (std::string(name) + ".json"));
    CHECK(study.trials.break_after_min == 8.0);
    CHECK(study::threshold::options_of(study).control_trials > 0);
    CHECK(study::threshold::options_of(study).practice_trials > 0);
    CHECK(json::parse(study.task->plaintext_settings()).size() == 19);
    CHECK(study.task->advice(study).empty());
  }
}

}  // namespace touchtrial
