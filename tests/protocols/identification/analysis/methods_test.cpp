// The methods of a report: facts stand there when they were set or recorded, and only then.
#include "protocols/identification/analysis/methods.hpp"

#include "analysis/fake_study.hpp"
#include "analysis/outcomes/identities.hpp"
#include "analysis/report/page/study_document.hpp"
#include "analysis/report/results.hpp"
#include "analysis/text_matching.hpp"
#include "core/version.hpp"
#include "protocols/identification/analysis/page/sections.hpp"
#include "protocols/threshold/analysis/methods.hpp"
#include "study/deviation_codes.hpp"
#include "support/catch.hpp"

#include <variant>

#include <fmt/format.h>

namespace touchtrial {
namespace {

using namespace analysis;

std::string text_of(const Section& section) {
  std::string text;
  for (const Block& block : section.blocks) {
    if (const auto* paragraph = std::get_if<CitedText>(&block)) text += paragraph->text + '\n';
  }
  return text;
}

/// The methods of a study with two people.
std::string methods_text(const FakeOptions& options, FakeSession session = {}) {
  FakeStudy study(options);
  session.participant = "P01";
  study.add(session);
  session.participant = "P02";
  session.enrolment = 2;
  study.add(session);
  study.close_and_unblind();
  const Outcomes outcomes = load_outcomes(study.store(), study.key());
  study::StudyKey key = study.key();
  key.pack_folder = study.pack_folder();
  const identification::StudyReport report = identification::make_report(outcomes);
  return text_of(methods_section(report, outcomes, recorded_study(study.store(), key),
                                 identification::protocol_methods(report, outcomes)));
}

void check_only_in(const std::string& with, const std::string& without,
                   const std::vector<std::string>& facts) {
  for (const std::string& fact : facts) {
    INFO(fact);
    CHECK(contains(with, fact));
    CHECK_FALSE(contains(without, fact));
  }
}

}  // namespace

TEST_CASE("methods: what the study file sets stands there, and only then") {
  const std::string plain = methods_text({});
  const std::string rich = methods_text(
      {.trials = R"({"catch": 3, "lead_in": 2, "max_run": 2, "explore_limit_s": 47,
                     "break_after_min": 13, "rove_db": 4.5,
                     "validity": {"exploring_s": 6.5, "path_mm": 271}})",
       .session = R"({"masking": {"wanted": true, "level_dbfs": -27.5}, "confidence": 7})",
       .sections = R"({"rendering": {"stiffness_n_per_mm": 0.37, "damping_n_s_per_mm": 0.0017,
                                     "pitch_mm": 0.23, "filter_mm": 0.41, "max_force_n": 2.9,
                                     "texture_stiffness_n_per_mm": 0.33},
                       "methods": [{"name": "adaptive", "radius": 11}]})"});
  check_only_in(rich, plain,
                {"3 catch trials", "2 presentations", "at most 2 of", "47 s", "13 min", "4.5 dB",
                 "6.5 s", "271 mm", "-27.5 dB", " 7 (certain)", "0.37 N/mm", "0.0017 N s/mm",
                 "0.23 mm", "0.41 mm", "2.9 N", "0.33 N/mm", "K = 11"});
  check_only_in(plain, rich, {"K = 2,", "0.4 N/mm", "60 s", "300 mm", "without damping"});
}

TEST_CASE("methods: the mask of the fractional differential has its formula") {
  const auto with_mask = [](const char* mask) {
    return methods_text({.sections = fmt::format(
                             R"({{"methods": [{{"name": "adaptive", "norm": "{}"}}]}})", mask)});
  };
  check_only_in(with_mask("sum"), with_mask("additive"), {"T / P"});
  check_only_in(with_mask("none"), with_mask("sum"), {"T + P (I − mean of I)"});
}

TEST_CASE("methods: trials that were not valid are counted") {
  check_only_in(methods_text({}, {.participant = {}, .valid = false}), methods_text({}),
                {"24 of 24 scored trials"});
  CHECK(contains(methods_text({}), "0 of 24 scored trials"));
}

TEST_CASE("methods: what was registered stands there, and only then") {
  const std::string without = methods_text({});
  const std::string with = methods_text({.registration = R"({
    "participants": 17, "stopping_rule": "At seventeen.", "estimand": "mean-accuracy",
    "alpha": 0.031, "smallest_effect": 0.47, "looks": [9],
    "exclusion_rules": {"deviations": ["no-curtain"], "invalid_trials": 0.35}})"});
  check_only_in(with, without,
                {"of 17 ", "At seventeen.", "0.031", "47 %", "at 9 participants", "no-curtain",
                 "35 %", "DeMets"});
  const std::string said = methods_text({.registration = R"({"primary_test": "By <b>eye</b>."})"});
  check_only_in(said, without, {"By <b>eye</b>."});
}

TEST_CASE("methods: what was recorded stands there, and only then") {
  const std::string without = methods_text({.simulated = false});
  record::StationRecord station;
  station.model = "Novint Falcon";
  station.firmware = "fw9";
  station.max_force_n = 8.75;
  station.rate_hz = 1000.0;
  station.scheduling = "fifo 80, memory locked";
  station.screen = record::ScreenRecord{0.2731, "measured"};
  station.calibration = std::string(64, 'c');
  station.force_scale = {1.03, 1.0, 1.0};
  record::ServoHealth servo;
  servo.rate_hz = 998.4;
  servo.lateness_p99_us = 37.0;
  const std::string with = methods_text({.simulated = false, .with_pack = true},
                                        {.participant = {}, .station = station, .servo = servo});
  check_only_in(
      with, without,
      {"Novint Falcon", "fw9", "8.75 N", "cccccccccccccccc", "998.4", "37 µs", "1.03", "0.01 N",
       "0.02 N", "0.4 mm x 0.4 mm", "an rms of", "fifo 80, memory locked", "0.273 mm (measured)"});
  CHECK(contains(with, "Touchtrial 0.0.0"));
  CHECK(contains(with, std::string(program_version())));
  station.calibration = study::kUnverifiedDevice;
  const std::string unverified =
      methods_text({.simulated = false}, {.participant = {}, .station = station});
  CHECK_FALSE(contains(unverified, study::kUnverifiedDevice));
}

TEST_CASE("methods: simulated participants are called that") {
  CHECK(methods_text({}) != methods_text({.simulated = false}));
  CHECK_FALSE(contains(methods_text({.simulated = false}), "simulated"));
}

TEST_CASE("methods: sessions without noise and practice that was not passed are counted") {
  const auto deviating = [](record::SessionRecorder& recorder) {
    recorder.add(std::chrono::milliseconds(10), record::EventKind::deviated,
                 record::DeviationBody{"no-masking-noise", ""});
  };
  check_only_in(methods_text({}, {.participant = {}, .before_trials = deviating}), methods_text({}),
                {"in 2 sessions"});
}

TEST_CASE("methods: they are the page's last section and a file of their own, escaped") {
  FakeStudy study(FakeOptions{});
  study.add({.participant = "P01"});
  study.close_and_unblind();
  Outcomes outcomes = load_outcomes(study.store(), study.key());
  outcomes.design.classes[0].label = "<i>bark</i> *x* |y|";
  outcomes.design.registration.primary_test = "<script>alert(1)</script>\nthen [stop](x)";
  const TraceSource source{study.store(), study.key()};
  const ProtocolAnalysis& analysis = analysis_of(outcomes.design);
  const auto plain = analysis.results(outcomes, {});
  const auto whole = analysis.results(outcomes, {.source = &source, .page = true});
  const Provenance provenance = provenance_of(study.store(), "study.db");
  const Document document = whole->document(provenance, {});
  REQUIRE(document.sections.back().id == "methods");
  const std::string page = page_html(document);
  CHECK(contains(page, "id=\"methods\""));
  CHECK(contains(page, "alert(1)"));
  CHECK_FALSE(contains(page, "<script>alert"));
  CHECK_FALSE(contains(page, "<i>bark"));
  CHECK_FALSE(contains(document_text(document), "Apparatus"));
  const std::string file = methods_markdown(document);
  CHECK(contains(file, "SIMULATED"));
  CHECK(contains(file, "References"));
  CHECK_FALSE(contains(file, "<script>"));
  CHECK_FALSE(contains(file, "[stop](x)"));
  CHECK_FALSE(contains(file, " *x* "));
  CHECK(methods_markdown(plain->document(provenance, {})).empty());
}

TEST_CASE("methods: a look at the registered question has none") {
  FakeStudy study(FakeOptions{});
  study.add({.participant = "P01"});
  study.close_and_unblind();
  const Outcomes outcomes = load_outcomes(study.store(), study.key());
  const TraceSource source{study.store(), study.key()};
  const auto all =
      analysis_of(outcomes.design).results(outcomes, {.source = &source, .page = true});
  const Provenance provenance = provenance_of(study.store(), "study.db");
  REQUIRE_FALSE(methods_markdown(all->document(provenance, {})).empty());
  const auto question = registered_answer_only(*all, study.store());
  CHECK(methods_markdown(question->document(provenance, {})).empty());
}

namespace {

/// The methods of a shipped threshold study without data.
std::string shipped_threshold_text(const char* file) {
  Outcomes outcomes;
  outcomes.design =
      study::load_study(std::filesystem::path(TOUCHTRIAL_SOURCE_DIR) / "config" / file);
  threshold::ThresholdReport report;
  report.design = outcomes.design;
  report.criterion = 0.816;
  return text_of(methods_section(report, outcomes, {}, threshold::protocol_methods(report)));
}

void check_facts(const std::string& text, const std::vector<std::string>& facts) {
  for (const std::string& fact : facts) {
    INFO(fact);
    CHECK(contains(text, fact));
  }
}

}  // namespace

TEST_CASE("methods: an author and a year name a publication") {
  check_facts(shipped_threshold_text("detection.json"),
              {"QUEST+",        "(Watson, 2017)", "60 trials",    "-40 to 0 in steps of 1",
               "6 catch",       "20 trials",      "2.5 s",        "81.6%",
               "0.15 to 2.5 N", "15 s",           "2 to 60 dB",   "up to 0.5",
               "w^0.5",         "Beta(1, 3)",     "median 10 dB", "Beta(1, 10)",
               "100 mm/s",      "0.7 N",          "100 ms",       "“Which surface had a texture?”",
               "MT19937-64"});
}

TEST_CASE("methods: every standard has its own levels") {
  check_facts(shipped_threshold_text("discrimination.json"),
              {"-20 to 16 in steps of 1 dB for bark, standard -18 dB",
               "-20 to 9 in steps of 1 dB for bark, standard -12 dB",
               "-20 to -1 in steps of 1 dB for bark, standard -6 dB"});
}

}  // namespace touchtrial
