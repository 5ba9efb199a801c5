#include "protocols/identification/analysis/cues/cue_report.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/outcomes/outcomes.hpp"
#include "core/errors.hpp"
#include "core/random.hpp"
#include "protocols/identification/analysis/cues/cue_measures.hpp"
#include "protocols/identification/analysis/felt_fixtures.hpp"
#include "support/catch.hpp"

#include <algorithm>

#include <SQLiteCpp/Database.h>

namespace touchtrial {
namespace {

using namespace analysis::identification;

/// The same wave, stronger for each class and a little different in each trial.
record::Trace stronger_by_class(const study::Trial& shown) {
  const double strength_n = 0.05 * (1 << shown.field().class_index);
  return stroking_over_wave(3.0, strength_n * (1.0 + 0.001 * shown.place.trial));
}

/// An octave shorter for each class; of any strength.
record::Trace shorter_by_class(const study::Trial& shown) {
  RandomStream random(1, "cue_report_test", static_cast<std::uint64_t>(shown.place.trial));
  return stroking_over_wave(12.0 / (1 << shown.field().class_index), random.uniform(0.1, 0.4));
}

/// Everyone answers alike.
class FeltStudy : public FakeStudy {
 public:
  FeltStudy(const FakeTraces& traces, const FakeAnswers& answers, int participants = 3,
            bool with_pack = true)
      : FakeStudy(study::identification::classification(), {.with_pack = with_pack}) {
    for (int i = 1; i <= participants; ++i) {
      add({.participant = "P0" + std::to_string(i),
           .enrolment = i,
           .answers = answers,
           .traces = traces});
    }
    close_and_unblind();
  }
};

CueReport cues_of(FakeStudy& study, const CueOptions& options = {}) {
  CueOptions with_pack = options;
  with_pack.pack = study.pack_folder();
  return make_cues(study.store(), study.key(), analysis::load_outcomes(study.store(), study.key()),
                   with_pack);
}

/// Changes the file as somebody would who may write to it.
void alter(const FakeStudy& study, const std::string& statement) {
  SQLite::Database database(study.database().string(), SQLite::OPEN_READWRITE);
  for (const char* trigger : {"traces_no_delete", "traces_no_update"}) {
    database.exec(std::string("DROP TRIGGER ") + trigger);
  }
  database.exec(statement);
}

bool any_holds(const std::vector<std::string>& texts, const std::string& part) {
  return std::ranges::any_of(
      texts, [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

TEST_CASE("strength, and not shape, distinguishes traces of stronger waves") {
  FeltStudy study(stronger_by_class, FakeStudy::always_right());
  const CueReport report = cues_of(study);
  REQUIRE(report.methods.size() == 1);
  const MethodCues& cues = report.methods[0];
  CHECK(cues.trials == 36);
  CHECK(cues.min_per_class == 4);
  CHECK(cues.participants == std::vector<std::string>{"P01", "P02", "P03"});
  CHECK(cues.participant_trials == std::vector<int>{12, 12, 12});
  CHECK(cues.human_mean.mean == 1.0);
  REQUIRE(cues.observers.size() == 3);
  CHECK(cues.observers[0].mean.mean == 1.0);
  CHECK(cues.observers[0].confusion[1] == std::vector<double>{0.0, 12.0, 0.0});
  CHECK(cues.observers[0].efficiency.value == 1.0);
  CHECK_FALSE(report.plane_source.empty());
}

TEST_CASE("shape, and not strength, distinguishes traces of shorter waves") {
  FeltStudy study(shorter_by_class, FakeStudy::always_right());
  const MethodCues cues = cues_of(study).methods.at(0);
  CHECK(cues.observers.at(1).mean.mean == 1.0);
  CHECK(cues.observers.at(2).mean.mean == 1.0);
  CHECK(cues.observers.at(0).mean.mean.value() < 0.7);
}

TEST_CASE("participants who swap two labels achieve a third of what is available") {
  const FakeAnswers swapped = [](const study::Trial& shown) {
    const int own = shown.field().class_index;
    return own < 2 ? 1 - own : own;
  };
  FeltStudy study(stronger_by_class, swapped);
  const MethodCues cues = cues_of(study).methods.at(0);
  CHECK(cues.human_mean.mean.value() == Approx(1.0 / 3.0));
  CHECK(cues.observers.at(0).mean.mean == 1.0);
  CHECK(cues.observers.at(0).efficiency.value.value() == Approx(1.0 / 3.0));
  CHECK(cues.observers.at(0).corrected_efficiency.value.value() == Approx(0.0).margin(1e-12));
  CHECK(cues.observers.at(0).divergence.value.value() == Approx(2.0 / 3.0));
}

TEST_CASE("a trial without its trace is left out, counted and mentioned") {
  FeltStudy study(stronger_by_class, FakeStudy::always_right());
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  CHECK(traces_to_read(outcomes) == 36);
  alter(study, "DELETE FROM traces WHERE session = 2 AND trial IN (3, 4)");
  const CueReport report = make_cues(study.store(), study.key(), outcomes);
  CHECK(report.methods.at(0).without_trace == 2);
  CHECK(report.methods.at(0).trials == 34);
  CHECK(report.methods.at(0).participant_trials == std::vector<int>{12, 10, 12});
  CHECK(any_holds(report.warnings, "2 trials"));
}

TEST_CASE("an altered trace is named, and no number is shown") {
  FeltStudy study(stronger_by_class, FakeStudy::always_right());
  const analysis::Outcomes outcomes = analysis::load_outcomes(study.store(), study.key());
  alter(study, "UPDATE traces SET box = zeroblob(length(box)) WHERE session = 2 AND trial >= 7");
  REQUIRE_THROWS_WITH(make_cues(study.store(), study.key(), outcomes),
                      holds_text("session 2, trial 7"));
}

TEST_CASE("without pack and images the plane is as large as hands reached, with a warning") {
  FeltStudy study(stronger_by_class, FakeStudy::always_right(), 3, false);
  const CueReport report = cues_of(study);
  CHECK(report.plane_source == kPlaneFromTraces);
  CHECK_FALSE(report.warnings.empty());
  CHECK(report.methods.at(0).observers.at(0).mean.mean == 1.0);
}

TEST_CASE("cues do not depend on the number of threads") {
  FeltStudy study(stronger_by_class, FakeStudy::confusing(0, 2));
  const std::string one = cues_object(cues_of(study, {.jobs = 1})).dump();
  CHECK(cues_object(cues_of(study, {.jobs = 2})).dump() == one);
  CHECK(cues_object(cues_of(study)).dump() == one);
}

TEST_CASE("the report warns of few participants, and has no intervals for one") {
  FeltStudy study(stronger_by_class, FakeStudy::always_right(), 1);
  const CueReport report = cues_of(study);
  CHECK(any_holds(report.warnings, "1 participant"));
  CHECK_FALSE(report.methods.at(0).observers.at(0).efficiency.interval);
  CHECK_FALSE(report.methods.at(0).match.value().is_distinct);
}

TEST_CASE("touches too short to feel anything leave every observer at chance") {
  FeltStudy study({}, FakeStudy::always_right());
  const CueReport report = cues_of(study);
  for (const ObserverFigures& one : report.methods.at(0).observers) {
    CHECK(one.mean.mean.value() == Approx(1.0 / 3.0));
    CHECK_FALSE(one.corrected_efficiency.value);
  }
  CHECK_FALSE(report.warnings.empty());
}

TEST_CASE("a study without counted trials has no numbers and says so") {
  FeltStudy study(stronger_by_class, FakeStudy::always_right(), 0);
  const CueReport report = cues_of(study);
  CHECK(report.methods.at(0).trials == 0);
  CHECK(report.methods.at(0).observers.empty());
  CHECK_FALSE(report.methods.at(0).match);
  CHECK_FALSE(report.warnings.empty());
  CHECK(cues_object(report)["methods"][0]["match"].is_null());
}

TEST_CASE("cues in JSON are stamped, and tell how each number is computed") {
  FeltStudy study(stronger_by_class, FakeStudy::always_right());
  const auto object = cues_object(cues_of(study));
  CHECK(object["stamp"] == "SIMULATED");
  const auto& method = object["methods"][0];
  CHECK(method["observers"][0]["cue"] == "rms");
  CHECK(method["observers"][0]["available"]["mean"] == 1.0);
  CHECK(method["per_participant"][2]["available"]["rms"] == 1.0);
  for (const char* figure : {"available", "human", "efficiency", "efficiency_above_chance",
                             "divergence_bits", "matched", "difference_bits"}) {
    INFO(figure);
    CHECK(object["by"].contains(figure));
  }
}

}  // namespace
}  // namespace touchtrial
