#include "analysis/outcomes/outcomes.hpp"
#include "protocols/identification/analysis/cues/cue_report.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/tiny_study.hpp"
#include "protocols/simulation/simulation.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

using namespace analysis::identification;

/// Quick explorations: 2 s, with the training that they need.
simulation::SubjectModel quick_subject(double feature_noise) {
  return {.feature_noise = feature_noise, .explore_s = 2.0, .training_passes = 6};
}

MethodCues simulated_cues(TinyStudy& study, const simulation::SubjectModel& subject) {
  record::StudyStore store = record::StudyStore::create(
      study.next_database(), session::commitment_of(study.key(), study.pack(), true, false), {},
      study.key().signer());
  static_cast<void>(simulation::simulate_study(study.key(), study.pack(), subject,
                                               {.participants = 4, .seed = 3}, store));
  store.close_study({});
  store.unblind({}, "planned", false);
  const CueReport report =
      make_cues(store, study.key(), analysis::load_outcomes(store, study.key()),
                {.pack = study.pack().folder()});
  CHECK_FALSE(report.plane_source.empty());
  return report.methods.at(0);
}

TEST_CASE("an ideal simulated participant uses everything that is available") {
  TinyStudy study;
  const MethodCues cues = simulated_cues(study, quick_subject(0.0));
  const ObserverFigures& everything = cues.observers.at(2);
  CHECK(cues.trials == 100);
  CHECK(everything.mean.mean.value() >= 0.95);
  CHECK(everything.efficiency.value.value() == Approx(1.0).margin(0.05));
}

TEST_CASE("the confusions of a noisy simulated participant show that everything is used") {
  TinyStudy study;
  const MethodCues cues = simulated_cues(study, quick_subject(0.5));
  CHECK(cues.human_mean.mean.value() < cues.observers.at(2).mean.mean.value());
  CHECK(cues.observers.at(2).matched_noise > 0.0);
  CHECK(cues.match.value().best == Cue::everything);
}

TEST_CASE("on smooth planes nothing is available to any observer") {
  TinyStudy study({.smooth = true});
  const MethodCues cues = simulated_cues(study, quick_subject(0.0));
  // 100 trials: 99.9 % of binomial draws with p = 0.2 lie between 8 and 34.
  for (const ObserverFigures& one : cues.observers) CHECK(one.mean.mean.value() <= 0.34);
}

TEST_CASE("roving takes from an observer what strength alone tells, and not what patterns tell") {
  TinyStudy plain;
  TinyStudy roved({.trials = R"({"rove_db": 20})"});
  const auto accuracy = [](const MethodCues& cues, std::size_t observer) {
    return cues.observers.at(observer).mean.mean.value();
  };
  const MethodCues strong = simulated_cues(plain, quick_subject(0.0));
  const MethodCues weak = simulated_cues(roved, quick_subject(0.0));
  INFO(accuracy(strong, 0) << ", roved " << accuracy(weak, 0));
  // As above: 99.9 % of draws at chance.
  CHECK(accuracy(strong, 0) > 0.34);
  CHECK(accuracy(weak, 0) <= 0.34);
  CHECK(accuracy(weak, 1) >= 0.6);
}

}  // namespace
}  // namespace touchtrial
