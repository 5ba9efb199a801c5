// The worked example runs from its study file to its report, and breaks where it should.
#include "add_a_protocol/presence.hpp"

#include "analysis/exports/export_tables.hpp"
#include "analysis/planning/planner.hpp"
#include "analysis/report/results.hpp"
#include "analysis/verification/verification.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/simulation.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

[[maybe_unused]] const bool kRegistered = [] {
  example::register_presence();
  return true;
}();

/// A study of the example, simulated, closed and unblinded.
class SimulatedPresence {
 public:
  explicit SimulatedPresence(bool smooth)
      : tiny_({.smooth = smooth, .protocol = "presence", .section = R"({"each": 6})"}),
        store_(record::StudyStore::create(
            tiny_.next_database(), session::commitment_of(tiny_.key(), tiny_.pack(), true, false),
            std::chrono::nanoseconds(0), tiny_.key().signer())) {
    simulation::SubjectModel subject{.explore_s = 2.0};
    simulation::simulate_study(tiny_.key(), tiny_.pack(), subject, {.participants = 3, .seed = 4},
                               store_);
    store_.close_study(store_.events(0).back().at);
    store_.unblind(store_.events(0).back().at, "the end", false);
  }

  [[nodiscard]] const study::StudyKey& key() const { return tiny_.key(); }
  [[nodiscard]] const engine::Pack& pack() const { return tiny_.pack(); }
  [[nodiscard]] record::StudyStore& store() { return store_; }
  [[nodiscard]] analysis::Outcomes outcomes() const {
    return analysis::load_outcomes(store_, tiny_.key());
  }

 private:
  TinyStudy tiny_;
  record::StudyStore store_;
};

nlohmann::json report_of(const analysis::Outcomes& outcomes) {
  return nlohmann::json::parse(
      analysis::analysis_of(outcomes.design).results(outcomes, {})->json());
}

TEST_CASE("the example's participants tell textures from a smooth wall") {
  SimulatedPresence study(false);
  const nlohmann::json report = report_of(study.outcomes());
  CHECK(report.at("protocol") == "presence");
  CHECK(report.at("participants") == 3);
  CHECK(report.at("trials") == 18);
  CHECK(report.at("hits") == 18);
  CHECK(report.at("false_alarms") == 0);
}

TEST_CASE("without a texture the example's participants say smooth, and are wrong") {
  SimulatedPresence study(true);
  const analysis::Outcomes outcomes = study.outcomes();
  CHECK(report_of(outcomes).at("hits") == 0);
  for (const analysis::TrialOutcome& trial : outcomes.trials) {
    if (trial.scored) CHECK_FALSE(trial.correct());
  }
}

TEST_CASE("the frame of reports, exports and verification serves the example") {
  SimulatedPresence study(false);
  const analysis::Outcomes outcomes = study.outcomes();
  const std::string text = analysis::document_text(
      analysis::analysis_of(outcomes.design).results(outcomes, {})->document({}, {}));
  CHECK_THAT(text, holds_text("SIMULATED") && holds_text("smooth wall"));
  const TempFolder folder;
  analysis::export_csv(study.store(), outcomes, folder.path());
  const std::string trials = std::string(text_of(read_file(folder.path() / "trials.csv")));
  CHECK_THAT(trials, holds_text(",texture,1,"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "confusion_adaptive.csv"));
  const analysis::Verification verification =
      analysis::verify_study(study.store(), &study.key(), &study.pack());
  for (const analysis::Check& check : verification.checks) {
    INFO(check.name << ": " << check.detail);
    CHECK(check.state == analysis::CheckState::passed);
  }
}

TEST_CASE("a study file's section of another protocol is refused with its place") {
  const auto parse = [](const std::string& protocol, const std::string& section) {
    return study::parse_study(
        R"({"study":"s","protocol":")" + protocol +
            R"(","classes":[{"label":"a","images":["a.png"]},{"label":"b","images":["b.png"]}],)"
            R"("methods":[{"name":"adaptive"}],)" +
            section + "}",
        ".", "s.json");
  };
  CHECK_NOTHROW(parse("presence", R"("presence":{"each":3})"));
  CHECK_THROWS_WITH(parse("classification", R"("presence":{"each":3})"), names("s.json /presence"));
  CHECK_THROWS_WITH(parse("presence", R"("presence":{"each":0})"), holds_text("/presence/each"));
  CHECK_THROWS_WITH(parse("presence", R"("trials":{"catch":2})"), holds_text("/trials/catch"));
  CHECK_THROWS_WITH(parse("presense", R"("seed":1)"), holds_text("presence"));
}

TEST_CASE("the example refuses what needs a choice between classes") {
  const TinyStudy example({.protocol = "presence"});
  CHECK_THROWS_WITH(study::require_choice_of_classes(example.key().study, "power"),
                    names("power presence"));
  CHECK_NOTHROW(study::require_choice_of_classes(TinyStudy().key().study, "power"));
}

TEST_CASE("a protocol without a planner has no power") {
  const TinyStudy example({.protocol = "presence"});
  CHECK_THROWS_WITH(planning::planner_of(example.key().study, "`power`"), names("power presence"));
}

TEST_CASE("a restarted block of the example presents the same again in another order") {
  const TinyStudy tiny({.protocol = "presence", .section = R"({"each": 20})"});
  const study::Study& study = tiny.key().study;
  const auto order = study::make_order(study, tiny.key().draw_of(1, study::Draws::rehearsal));
  const std::vector<study::Trial>& first = order->schedule().trials;
  const std::vector<study::Trial> again = order->redraw_block(0, 0, 41);
  REQUIRE(again.size() == first.size());
  CHECK(again.front().place.trial == 41);
  const auto scored = [](const std::vector<study::Trial>& trials) {
    return std::ranges::count(trials, study::Role::scored, &study::Trial::role);
  };
  CHECK(scored(again) == scored(first));
}

}  // namespace
}  // namespace touchtrial
