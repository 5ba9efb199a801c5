// What a study file says of a threshold, and what its participants are presented.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/threshold/study/threshold.hpp"
#include "protocols/threshold/threshold_study.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"

#include <cmath>
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
  try {
    static_cast<void>(study_of(file));
  } catch (const StudyError& error) {
    return error.what();
  }
  return "";
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
    order->answered(shown, Chosen{is_right(shown) ? right : (right == 0 ? 1 : 0)});
  }
  return all;
}

const auto kAlwaysRight = [](const study::Trial&) { return true; };

}  // namespace

TEST_CASE("a threshold study has one class at least, and the section that it needs") {
  CHECK(refusal_of(detection_file()).empty());
  json file = detection_file();
  file.erase("threshold");
  CHECK_THAT(refusal_of(file), holds_text("/threshold: is missing"));
  file = detection_file();
  file["protocol"] = "classification";
  file.erase("threshold");
  CHECK_THAT(refusal_of(file), holds_text("/classes: has 1 entries, must have from 2"));
}

TEST_CASE("what cannot be presented or answered is refused with its place and a remedy") {
  const auto refused = [](json file, const std::string& pointer, const json& value,
                          const std::string& text) {
    file[json::json_pointer(pointer)] = value;
    INFO(pointer << " = " << value.dump());
    CHECK_THAT(refusal_of(file), holds_text(text));
  };
  refused(detection_file(), "/threshold/along", "pitch", "/threshold/along: must be \"gain\"");
  refused(detection_file(), "/threshold/levels", {-3, 3}, "exceed the pack's gain");
  refused(detection_file(), "/threshold/levels", {-3, -3}, "must ascend");
  refused(detection_file(), "/threshold/levels", {{"from", -40}, {"to", 0}, {"step", 1e-9}},
          "more than 200 values");
  refused(detection_file(), "/threshold/levels", {{"from", 0}, {"to", -40}, {"step", 1}},
          "must not end below");
  refused(detection_file(), "/threshold/standards", {-6}, "belongs to discrimination");
  refused(detection_file(), "/threshold/procedure", "questplus", "quest-plus");
  refused(detection_file(), "/threshold/tracks", 9, "/threshold/tracks");
  refused(detection_file(), "/threshold/rove_db", 3, "with its rove");
  refused(detection_file(), "/threshold/question", "same-different", "no fixed guess rate");
  refused(detection_file(), "/threshold/catch", 50, "catch trials are at most");
  refused(detection_file(), "/threshold/windows", {{"slowest_mm_s", 300}}, "no speed between");
  refused(detection_file(), "/trials/on_interruption", "leave-out", "must be \"repeat\"");
  refused(detection_file(), "/trials/explore_limit_s", 1, "shorter than an interval");
  refused(detection_file(), "/trials/practice", 3, "/threshold/practice");
  refused(detection_file(), "/trials/rove_db", 3, "/trials/rove_db: belongs to other protocols");
  refused(detection_file(), "/rendering/reference_grey", 0, "reference_grey: must be 128");
  refused(detection_file(), "/methods", {{{"name", "adaptive"}}, {{"name", "edge"}}},
          "has 2 entries; a threshold is of one method");
  refused(gain_file(), "/threshold/levels", {6, 12},
          "exceed the pack's gain, the stiffness ceiling");
  refused(gain_file(), "/threshold/procedure", "constant-stimuli", "equally often");
  refused(gain_file(), "/threshold/up_down", {{"first_level", -5}}, "is none of the levels");
  refused(order_file(), "/threshold/levels", {0, 20}, "orders are below 1");
  refused(order_file(), "/threshold/question", "which-interval", "odd-one-out or same-different");
  refused(order_file(), "/methods/0", {{"name", "adaptive"}}, "must be \"fixed\"");
  const json huge = {{"slopes", {{"from", 1}, {"to", 200}, {"step", 1}}},
                     {"lapses", {{"from", 0}, {"to", 0.4}, {"step", 0.0021}}}};
  refused(detection_file(), "/threshold/grid", huge, "million numbers");
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

TEST_CASE("levels follow the answers, and a trial that comes again has the same level") {
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

TEST_CASE("the section's schema and its reader have the same keys, words and bounds") {
  const std::filesystem::path root = TOUCHTRIAL_SOURCE_DIR;
  const json schema = json::parse(text_of(read_file(root / "config/schema/study.schema.json")))
                          .at("properties")
                          .at("threshold");
  const auto with = [](const json::json_pointer& at, const json& value) {
    json file = detection_file();
    // Staircases read every key; the practice needs its number.
    file["threshold"]["procedure"] = "up-down";
    file["threshold"]["practice"] = {{"trials", 10}};
    file[json::json_pointer("/threshold") / at] = value;
    return refusal_of(file);
  };
  const std::function<void(const json&, const json::json_pointer&)> walk =
      [&](const json& object, const json::json_pointer& at) {
        std::string known;
        if (at.empty()) {
          json file = detection_file();
          file["threshold"]["zzzzzzzzz"] = 1;
          known = refusal_of(file);
        } else {
          known = with(at, {{"zzzzzzzzz", 1}});
        }
        for (const auto& [key, property] : object.at("properties").items()) {
          INFO((at / key).to_string());
          CHECK_THAT(known, holds_text(key));
          if (property.contains("properties")) walk(property, at / key);
          if (property.contains("enum")) {
            for (const json& word : property.at("enum")) {
              CHECK_THAT(with(at / key, "zzzzzzz"), holds_text(word.get<std::string>()));
            }
          }
          if (!property.contains("maximum")) continue;
          const double step = property.at("type") == "integer" ? 1.0 : 1e-6;
          const std::string above = with(at / key, property.at("maximum").get<double>() + step);
          CHECK_THAT(above, holds_text((at / key).to_string() + ": ") && holds_text("must be"));
          if (property.contains("minimum")) {
            const std::string below = with(at / key, property.at("minimum").get<double>() - step);
            CHECK_THAT(below, holds_text((at / key).to_string() + ": ") && holds_text("must be"));
          }
        }
      };
  walk(schema, json::json_pointer());
}

TEST_CASE("the studies of thresholds that ship can be read, and say what they present") {
  const std::filesystem::path config = std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config";
  for (const char* name : {"detection", "discrimination", "discrimination-order"}) {
    const study::Study study = study::load_study(config / (std::string(name) + ".json"));
    CHECK(study.trials.break_after_min == 8.0);
    CHECK(study::threshold::options_of(study).control_trials > 0);
    CHECK(study::threshold::options_of(study).practice_trials > 0);
    CHECK(json::parse(study.task->in_clear()).size() == 19);
  }
}

}  // namespace touchtrial
