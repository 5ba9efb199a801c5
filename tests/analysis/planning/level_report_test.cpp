#include "analysis/planning/level_report.hpp"

#include "study/study.hpp"
#include "support/catch.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

/// The share right of somebody who judges by strength alone, of classes with these levels.
double right_by_level(const std::vector<double>& levels_db, double rove_db) {
  simulation::StimulusLevels levels;
  std::string classes;
  const auto plane = [](double db) {
    return simulation::PlaneLevels{{"ideal", engine::ThresholdCurve::israr_2006, db, {}}};
  };
  for (std::size_t i = 0; i < levels_db.size(); ++i) {
    const std::string name = std::to_string(i);
    classes += std::string(i > 0 ? "," : "") + R"({"label":")" + name + R"(","images":[")" + name +
               R"(.png"]})";
    levels.stimuli.push_back({static_cast<int>(i), 0, 0});
    levels.levels.push_back(plane(levels_db[i]));
  }
  levels.blank = plane(0.0);
  const study::Study study = study::parse_study(
      R"({"study":"s","protocol":"classification","methods":[{"name":"adaptive"}],"classes":[)" +
          classes + R"(],"trials":{"rove_db":)" + std::to_string(rove_db) + "}}",
      ".", "s.json");
  return nlohmann::json::parse(planning::all_levels_json(study, levels))
      .at("by_level_alone")
      .at(0)
      .at("right")
      .get<double>();
}

}  // namespace

// Of n classes whose levels spread over S dB, roved over R dB, the ranges cover S + R: an observer
// of level alone is right in (1 + S / R) / n of answers. Green 1988, Profile analysis, for two.
TEST_CASE("level alone gives away what the range of roving leaves") {
  CHECK(right_by_level({40.0, 50.0}, 0.0) > 0.9);
  CHECK(right_by_level({40.0, 50.0}, 40.0) == Approx(0.5 * (1.0 + 10.0 / 40.0)).margin(0.01));
  CHECK(right_by_level({40.0, 42.0, 44.0, 46.0, 48.0}, 20.0) ==
        Approx(0.2 * (1.0 + 8.0 / 20.0)).margin(0.01));
  CHECK(right_by_level({40.0, 40.5}, 20.0) < 0.52);
}

}  // namespace touchtrial
