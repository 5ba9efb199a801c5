#include "protocols/simulation/level_gains.hpp"

#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/stimulus_levels.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <vector>

namespace touchtrial {
namespace {

using engine::ThresholdCurve;
using simulation::GainsAtLevel;
using simulation::LevelCurve;

/// A tiny study that wants a level on a Touch X.
class WantedStudy {
 public:
  explicit WantedStudy(double level_db, bool all_alike = false, const std::string& trials = "{}")
      : study_({.trials = trials,
                .rendering = R"({"device": "touch_x", "gains": {"level_db": )" +
                             std::to_string(level_db) + R"(, "curve": "israr_2006"})" +
                             (all_alike ? R"(, "equalise": "level"})" : "}")}) {
    for (const study::KeyedStimulus& stimulus : study_.key().stimuli) {
      mapped_.push_back(study_.pack().map(stimulus.code));
      views_.push_back(mapped_.back().view());
    }
  }
  [[nodiscard]] GainsAtLevel gains(LevelCurve curve = {ThresholdCurve::israr_2006, {}}) const {
    return simulation::gains_at_level(study_.key(), views_, device(), curve, 2);
  }
  /// Levels of stimuli with these gains, as the tables state them.
  [[nodiscard]] std::vector<double> levels(const std::vector<engine::Gains>& gains) const {
    std::vector<engine::FieldWithGains> fields;
    for (std::size_t i = 0; i < views_.size(); ++i) fields.push_back({views_[i], gains[i]});
    std::vector<double> levels;
    for (const auto& plane :
         simulation::levels_of_fields(fields, study_.key().study, {device()}, 2).levels) {
      levels.push_back(plane[0].db);
    }
    return levels;
  }
  [[nodiscard]] std::vector<engine::Gains> largest_gains() const {
    return engine::choose_gains(views_, study_.key().study.rendering).per_field;
  }
  static device::DeviceModel device() { return device::device_model("touch_x"); }

 private:
  TinyStudy study_;
  std::vector<engine::MappedField> mapped_;
  std::vector<engine::FieldView> views_;
};

}  // namespace

TEST_CASE("the weakest stimulus has the study's level, and gains stay alike") {
  const WantedStudy study(2.0);
  const GainsAtLevel found = study.gains();
  CHECK(found.remarks.empty());
  const std::vector<double> levels = study.levels(found.gains.per_field);
  CHECK(std::ranges::min(levels) == Approx(2.0).margin(0.1));
  CHECK(std::ranges::max(levels) > 2.5);
  CHECK(std::ranges::all_of(found.gains.per_field, [&](const engine::Gains& gains) {
    return gains == found.gains.per_field.front();
  }));
}

TEST_CASE("with equalise level every stimulus has the study's level") {
  const WantedStudy study(2.0, true);
  const GainsAtLevel found = study.gains();
  for (const double level : study.levels(found.gains.per_field)) {
    CHECK(level == Approx(2.0).margin(0.1));
  }
}

TEST_CASE("a level out of reach gets the largest gains, and a line with its key and two levers") {
  const WantedStudy study(40.0);
  const GainsAtLevel found = study.gains();
  CHECK(found.gains.per_field == study.largest_gains());
  REQUIRE(found.remarks.size() == 1);
  CHECK_THAT(found.remarks[0], holds_text("/rendering/gains/level_db"));
  CHECK_THAT(found.remarks[0], holds_text("/rendering/texture_stiffness_n_per_mm 0.48"));
  CHECK_THAT(found.remarks[0], holds_text("/rendering/pitch_mm 0.4"));
}

TEST_CASE("stimuli out of reach are alike at the level that the weakest can have") {
  const WantedStudy study(40.0, true);
  const std::vector<double> levels = study.levels(study.gains().gains.per_field);
  CHECK(std::ranges::max(levels) - std::ranges::min(levels) < 0.2);
  CHECK(std::ranges::min(levels) ==
        Approx(std::ranges::min(study.levels(study.largest_gains()))).margin(0.2));
}

TEST_CASE(
    "a roved study has its level in the middle, and the largest gain within the same bounds") {
  const WantedStudy roved(0.0, false, R"({"rove_db": 4})");
  const std::vector<engine::Gains> gains = roved.gains().gains.per_field;
  CHECK(std::ranges::min(roved.levels(gains)) == Approx(0.0).margin(0.1));
  // The strongest presentation is as strong as that of a study with 2 dB more.
  const double highest = WantedStudy(2.0).gains().gains.per_field[0].tangential_n;
  CHECK(20.0 * std::log10(gains[0].tangential_n / highest) == Approx(0.0).margin(0.6));
  const WantedStudy too_far(40.0, false, R"({"rove_db": 4})");
  const GainsAtLevel found = too_far.gains();
  CHECK(found.gains.per_field == too_far.largest_gains());
  REQUIRE(found.remarks.size() == 1);
  CHECK_THAT(found.remarks[0], names("/trials/rove_db 0 2.0"));
}

TEST_CASE("less sensitive pilots get larger gains, by as many decibels") {
  const WantedStudy study(0.0);
  const double usual = study.gains().gains.per_field[0].tangential_n;
  const double more =
      study.gains({ThresholdCurve::israr_2006, 2.0}).gains.per_field[0].tangential_n;
  CHECK(20.0 * std::log10(more / usual) == Approx(2.0).margin(0.5));
}

TEST_CASE("levels by pilots are one number for both curves, and no longer provisional") {
  simulation::StimulusLevels levels;
  levels.levels = {{{"touch", ThresholdCurve::israr_2006, 12.0, {}},
                    {"touch", ThresholdCurve::tan_1994, 3.0, {}}}};
  REQUIRE(levels.provisional);
  simulation::apply({ThresholdCurve::israr_2006, 2.5}, levels);
  CHECK(levels.levels[0][0].db == 9.5);
  CHECK(levels.levels[0][1].db == 9.5);
  CHECK_FALSE(levels.provisional);
}

}  // namespace touchtrial
