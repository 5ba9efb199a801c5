// Whole sessions of thresholds: what they present, store, and how they are checked.
#include "analysis/checkers/checkers.hpp"
#include "analysis/exports/bids/export_bids.hpp"
#include "analysis/exports/csv_reading.hpp"
#include "analysis/exports/export_psych_ds.hpp"
#include "analysis/outcomes/sealed_sessions.hpp"
#include "analysis/verification/verification.hpp"
#include "core/errors.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/session/plane_run.hpp"
#include "protocols/session/stimulus_source.hpp"
#include "protocols/simulation/simulation.hpp"
#include "protocols/threshold/study/threshold.hpp"
#include "protocols/threshold/threshold_study.hpp"
#include "record/payload_json.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <cmath>
#include <map>

namespace touchtrial {
namespace {

/// A simulated study, closed and unblinded.
class SimulatedThresholds {
 public:
  explicit SimulatedThresholds(const TinyStudyOptions& options, int participants = 2,
                               const simulation::SubjectModel& subject = felt_well())
      : tiny_(options),
        store_(record::StudyStore::create(
            tiny_.next_database(), session::commitment_of(tiny_.key(), tiny_.pack(), true, false),
            std::chrono::nanoseconds(0), tiny_.key().signer())) {
    report_ = simulation::simulate_study(tiny_.key(), tiny_.pack(), subject,
                                         {.participants = participants, .seed = 4}, store_);
    store_.close_study(store_.events(0).back().at);
    store_.unblind(store_.events(0).back().at, "the end", false);
  }

  /// By published thresholds, with little noise.
  static simulation::SubjectModel felt_well() {
    return {
        .sense = engine::ThresholdCurve::israr_2006, .feature_noise = 0.05, .training_passes = 2};
  }

  [[nodiscard]] const TinyStudy& tiny() const { return tiny_; }
  [[nodiscard]] record::StudyStore& store() { return store_; }
  [[nodiscard]] const simulation::SimulationReport& report() const { return report_; }
  [[nodiscard]] analysis::Outcomes outcomes() const {
    return analysis::load_outcomes(store_, tiny_.key());
  }

 private:
  TinyStudy tiny_;
  record::StudyStore store_;
  simulation::SimulationReport report_;
};

double share_right(const analysis::Outcomes& outcomes, double least_db, double most_db) {
  const auto& options = study::threshold::options_of(outcomes.design);
  int right = 0;
  int n = 0;
  for (const analysis::TrialOutcome& trial : outcomes.trials) {
    if (!trial.scored) continue;
    const double level = options.track.levels.at(static_cast<std::size_t>(trial.chosen->level));
    if (level < least_db || level > most_db) continue;
    right += trial.correct() ? 1 : 0;
    ++n;
  }
  return n == 0 ? -1.0 : static_cast<double>(right) / n;
}

const std::string kConstant =
    R"("task": "detection", "interval_s": 1.2, "procedure": "constant-stimuli", "trials": 20,
       "levels": [-120, 0], "catch": 3, "control": 10)";

}  // namespace

TEST_CASE("simulated participants feel strong textures, guess at the weakest, and hear nothing") {
  SimulatedThresholds study(threshold_options(kConstant), 6);
  const analysis::Outcomes outcomes = study.outcomes();
  CHECK(share_right(outcomes, -10.0, 0.0) > 0.9);
  CHECK(share_right(outcomes, -130.0, -110.0) == Approx(0.5).margin(0.1));
  int heard = 0;
  int control = 0;
  int caught = 0;
  for (const analysis::TrialOutcome& trial : outcomes.trials) {
    if (trial.row.block == 1) {
      ++control;
      heard += trial.correct() ? 1 : 0;
      CHECK_FALSE(trial.scored);
    } else if (trial.role == study::Role::catch_trial) {
      ++caught;
      CHECK_FALSE(trial.counted);
    }
  }
  CHECK(control == 60);
  CHECK(caught == 18);
  CHECK(std::abs(heard - 30) < 16);
}

TEST_CASE("catch trials are sealed as such with the track that they count for") {
  SimulatedThresholds study(
      threshold_options(R"("task": "discrimination", "interval_s": 0.4, "trials": 6, "catch": 8,
                           "levels": [-20, -10, 0, 10], "standards": [-6])"),
      1);
  CHECK(analysis::verify_study(study.store(), &study.tiny().key(), &study.tiny().pack()).holds());
  const analysis::Outcomes outcomes = study.outcomes();
  std::map<int, int> scored;  // by track
  std::map<int, int> caught;
  for (const analysis::TrialOutcome& trial : outcomes.trials) {
    if (!trial.response) continue;
    if (trial.scored) ++scored[trial.chosen->track];
    if (trial.role != study::Role::catch_trial) continue;
    CHECK_FALSE(trial.counted);
    CHECK(trial.chosen->level == 1);  // a standard of -6 dB has no level above -1 dB
    ++caught[trial.chosen->track];
  }
  CHECK(scored == std::map<int, int>{{1, 6}, {2, 6}, {3, 6}, {4, 6}, {5, 6}});
  std::map<int, int> tracks;  // by their number of catch trials
  for (const auto& [track, n] : caught) ++tracks[n];
  CHECK(tracks == std::map<int, int>{{1, 2}, {2, 3}});
  std::size_t sealed = 0;
  for (const record::Event& event : study.store().events(1)) {
    if (event.kind != record::EventKind::answered) continue;
    CHECK(event.body.find("kind") == std::string::npos);
    if (sealed == 0) sealed = event.sealed.size();
    CHECK(event.sealed.size() == sealed);
  }
  CHECK(sealed > 0);
}

TEST_CASE("an adaptive threshold study is complete and passes every check") {
  SimulatedThresholds study(threshold_options(kTinyDetection));
  CHECK(study.report().sessions == 2);
  CHECK(study.report().presentations >= 2 * 5 * 8);
  const analysis::Verification verification =
      analysis::verify_study(study.store(), &study.tiny().key(), &study.tiny().pack());
  for (const analysis::Check& check : verification.checks) {
    INFO(check.name << ": " << check.detail);
    CHECK(check.state == analysis::CheckState::passed);
  }
  int scored = 0;
  for (const analysis::TrialOutcome& trial : study.outcomes().trials) {
    CHECK(trial.chosen.has_value());
    scored += trial.counted ? 1 : 0;
  }
  CHECK(scored == 2 * 5 * 8);
}

TEST_CASE("datasets of a threshold study keep to BIDS and Psych-DS, and tell intervals apart") {
  SimulatedThresholds study(threshold_options(kTinyDetection), 1);
  const analysis::Outcomes outcomes = study.outcomes();
  const analysis::DatasetSource source{study.store(), &outcomes, &study.tiny().key()};
  const TempFolder folder;
  const std::filesystem::path bids = folder.path() / "bids";
  const std::filesystem::path psych = folder.path() / "psych";
  analysis::export_bids(source, {.traces = true}, bids);
  analysis::export_psych_ds(source, {}, psych);
  CHECK(bids_faults(bids) == std::vector<std::string>{});
  CHECK(psych_ds_faults(psych) == std::vector<std::string>{});
  const record::PersonKeys keys =
      analysis::person_keys(study.store(), study.tiny().key(), study.store().sessions().at(0));
  int trials = 0;
  study.store().for_each(record::EventKind::trace_stored, [&](const record::Event& stored) {
    const record::TraceBody body = record::from_json<record::TraceBody>(
        analysis::open_event(stored, keys.participant.value()).event.body);
    REQUIRE(body.explorations.size() == 2);
    REQUIRE(body.began_ns.size() == 2);
    CHECK(body.began_ns[0] == 0);
    const double first_s = static_cast<double>(body.explorations[0]) / body.rate_hz;
    CHECK(static_cast<double>(body.began_ns[1]) > 1e9 * first_s);
    ++trials;
  });
  CHECK(trials > 8);
  const std::string events =
      text_of_file(bids / "sub-P001/motion/sub-P001_task-tiny_tracksys-stylus_run-001_events.tsv");
  CHECK(events.find("\tplane-on\t1\n") < events.find("\tplane-on\t2\n"));
  CHECK(events.find("\tplane-on\t2\n") != std::string::npos);
}

TEST_CASE("nothing in clear of an adaptive study tells a level, or whether answers were right") {
  SimulatedThresholds study(threshold_options(kTinyDetection + R"(, "catch": 6)"), 1);
  for (const record::Event& event : study.store().events(1)) {
    for (const char* word : {"\"level\"", "\"track\"", "\"target\"", "\"position\"", "\"gain",
                             "\"catch\"", "\"scored\""}) {
      CHECK(event.body.find(word) == std::string::npos);
    }
  }
}

TEST_CASE("odd ones, same or different, pitch and blend run through the same session") {
  const std::string sections[] = {
      R"("task": "discrimination", "question": "odd-one-out", "interval_s": 0.4, "trials": 4,
         "levels": [-12, -6], "standards": [-6])",
      R"("task": "discrimination", "question": "same-different", "procedure": "constant-stimuli",
         "interval_s": 0.4, "trials": 4, "levels": [-12, -6], "standards": [-6])",
      R"("task": "discrimination", "along": "pitch", "interval_s": 0.4, "trials": 4,
         "levels": [-12, 0], "intervals": 3, "rove_db": 3)"};
  for (const std::string& section : sections) {
    INFO(section);
    SimulatedThresholds study(threshold_options(section), 1);
    int counted = 0;
    for (const analysis::TrialOutcome& trial : study.outcomes().trials) {
      counted += trial.counted ? 1 : 0;
    }
    CHECK(counted == 5 * 4);
  }
}

TEST_CASE("a plane's forces are those of the prepared field times its gain, about the blank wall") {
  const std::string model = GENERATE("paper", "surface");
  TinyStudyOptions options = threshold_options(kTinyDetection);
  options.rendering = R"({"model": ")" + model + R"("})";
  const TinyStudy study(options);
  const session::StimulusSource source(study.pack(), study.key());
  study::Plane plane;
  const engine::RenderingModel whole = source.plane_of(plane, study.key());
  plane.gain_db = -20.0;
  const engine::RenderingModel weak = source.plane_of(plane, study.key());
  plane.blank = true;
  const engine::RenderingModel blank = source.plane_of(plane, study.key());
  double sum_whole = 0.0;
  double sum_weak = 0.0;
  double normal_n = 0.0;
  int points = 0;
  engine::Bristle touch;
  for (double x = 0.5; x < 23.5; x += 0.37) {
    for (double y = 0.5; y < 23.5; y += 0.41) {
      const Vec3 at{x, y, -2.0};
      const Vec3 strong_n = whole.force_n(at, {}, touch);
      const Vec3 weak_n = weak.force_n(at, {}, touch);
      const Vec3 blank_n = blank.force_n(at, {}, touch);
      CHECK(blank_n.x == 0.0);
      CHECK(blank_n.y == 0.0);
      CHECK(blank_n.z == Approx(0.8));
      sum_whole += strong_n.x * strong_n.x + strong_n.y * strong_n.y;
      sum_weak += weak_n.x * weak_n.x + weak_n.y * weak_n.y;
      normal_n += strong_n.z;
      ++points;
    }
  }
  const double db = 10.0 * std::log10(sum_weak / sum_whole);
  // Exact for the paper's model; a relief's forces are also slightly larger on its hills.
  CHECK(db == Approx(-20.0).margin(model == "paper" ? 1e-4 : 0.3));
  CHECK(normal_n / points == Approx(0.8).margin(0.02));
}

TEST_CASE("an interval's clock runs in contact and inside the windows alone, after a lift-off") {
  const engine::RenderingOptions rendering;
  const engine::TextureField field = engine::make_texture_field(Plane<double>(60, 60), rendering);
  const engine::RenderingModel model(field.view(), rendering, {});
  const study::HandRange range;
  session::IntervalForce force(model, 0.4, range, 3);
  const auto tick = [&force](double z_mm, double speed_mm_s) {
    return force.force_n({.position_mm = {5.0, 5.0, z_mm}, .velocity_mm_s = {speed_mm_s, 0, 0}});
  };
  CHECK(tick(-2.0, 100.0) == Vec3{});  // inside the wall, and not yet lifted
  CHECK(tick(1.5, 100.0) == Vec3{});
  CHECK(tick(-2.0, 100.0).z == Approx(0.8));
  CHECK_FALSE(force.is_done());
  for (int i = 0; i < 10; ++i) {
    static_cast<void>(tick(-2.0, 5.0));     // too slow
    static_cast<void>(tick(-2.0, 500.0));   // too fast
    static_cast<void>(tick(-0.1, 100.0));   // too light
    static_cast<void>(tick(-20.0, 100.0));  // too hard
    static_cast<void>(tick(0.5, 100.0));    // above
  }
  CHECK_FALSE(force.is_done());
  static_cast<void>(tick(-1.0, -50.0));
  CHECK_FALSE(force.is_done());
  static_cast<void>(tick(-1.0, 50.0));
  CHECK(force.is_done());
}

TEST_CASE("trials whose intervals are not explored come again, and at last end the session") {
  simulation::SubjectModel subject = SimulatedThresholds::felt_well();
  subject.slowest_mm_s = subject.fastest_mm_s = 10.0;  // below the window
  SimulatedThresholds study(threshold_options(kTinyDetection), 1, subject);
  const record::SessionRow row = study.store().sessions().front();
  CHECK(row.state != record::SessionState::completed);
  int again = 0;
  for (const record::Event& event : study.store().events(1)) {
    if (event.kind != record::EventKind::interrupted) continue;
    ++again;
  }
  CHECK(again == 41);
  CHECK(analysis::verify_study(study.store(), &study.tiny().key(), &study.tiny().pack()).holds());
}

}  // namespace touchtrial
