#include "analysis/planning/fit_report.hpp"
#include "analysis/planning/power_report.hpp"
#include "analysis/planning/rehearsed_tiny_study.hpp"
#include "analysis/planning/uncertain_subject.hpp"
#include "analysis/planning/what_if.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

namespace touchtrial {
namespace {

using planning::Hypothesis;

std::vector<int> positions_of(const analysis::Outcomes& outcomes) {
  std::vector<int> positions;
  for (const auto& trial : outcomes.trials) positions.push_back(*trial.row.position);
  return positions;
}

simulation::SubjectModel with_lapse(simulation::SubjectModel subject, double lapse) {
  subject.lapse = lapse;
  return subject;
}

TEST_CASE("each study has one draw of the fit, which its seed alone decides") {
  const RehearsedTinyStudy study;
  const planning::BankedFeelings bank = study.bank();
  const std::vector<simulation::SubjectModel> draws{with_lapse(study.subject, 0.0),
                                                    with_lapse(study.subject, 1.0)};
  const design::Study& design = study.tiny.key().study;
  const planning::RehearsedStudy over(design, study.subject, study.test, bank, 6, {.draws = draws});
  const planning::RehearsedStudy able(design, draws[0], study.test, bank, 6);
  const planning::RehearsedStudy guessing(design, draws[1], study.test, bank, 6);
  std::set<bool> chosen;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto of = [&](const planning::RehearsedStudy& one) {
      return positions_of(one.outcomes(6, Hypothesis::population, seed));
    };
    const bool is_able = of(over) == of(able);
    CHECK((is_able || of(over) == of(guessing)));
    CHECK(of(over) == of(over));
    chosen.insert(is_able);
  }
  CHECK(chosen.size() == 2);
}

TEST_CASE("assurance lies between the powers of the draws, and keeps the type-I error") {
  const RehearsedTinyStudy study;
  const planning::BankedFeelings bank = study.bank(30, 4);
  planning::PowerPlan plan;
  plan.participants = {6};
  plan.runs = 400;
  plan.stop_early = false;
  const auto report_of = [&](const std::vector<simulation::SubjectModel>& draws) {
    planning::PowerSetting setting;
    setting.draws = static_cast<int>(draws.size());
    planning::PowerProgress progress = planning::new_progress(setting, plan, {});
    const planning::RehearsedStudy over(study.tiny.key().study, study.subject, study.test, bank, 6,
                                        {.draws = draws});
    planning::make_runs(over, study.test, {.jobs = 2}, progress);
    return planning::make_power_report(progress);
  };
  const auto poor = with_lapse(study.subject, 0.95);
  const auto able = with_lapse(study.subject, 0.4);
  const auto power = [](const planning::PowerReport& report) {
    return report.rows.front().estimated_power();
  };
  const planning::PowerReport over = report_of({poor, able});
  const double between = 0.5 * (power(report_of({poor})) + power(report_of({able})));
  CHECK(std::abs(power(over) - between) < 0.1);
  CHECK(over.rows.front().type_one.low < 0.05);
  CHECK(planning::power_text(over).find("(assurance)") != std::string::npos);
  CHECK(planning::power_json(over).find("\"draws\": 2") != std::string::npos);
}

planning::SubjectFit fit_with_draws(const simulation::SubjectModel& subject) {
  planning::SubjectFit fit;
  fit.subject = subject;
  fit.draws = {with_lapse(subject, 0.125), with_lapse(subject, 0.25)};
  fit.draws[1].class_bias = {{"bark", -0.5}, {"straw", 0.5}};
  return fit;
}

TEST_CASE("a fit's JSON gives back its subject, its device and every draw") {
  const TempFolder folder;
  simulation::SubjectModel subject = hasty_subject();
  const bool on_touch = GENERATE(true, false);
  if (on_touch) subject.device = device::device_model("touch");
  const planning::SubjectFit fit = fit_with_draws(subject);
  const auto file = folder.path() / "fit.json";
  replace_file(file, planning::fit_json(fit, {}));
  const planning::UncertainSubject read = planning::load_uncertain_subject(file);
  REQUIRE(read.draws.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(simulation::subject_model_json(read.draws[i]) ==
          simulation::subject_model_json(fit.draws[i]));
    CHECK(read.draws[i].device.name == (on_touch ? "touch" : ""));
  }
  CHECK(simulation::subject_model_json(read.subject) == simulation::subject_model_json(subject));
  CHECK(planning::words_of(read).find("one of 2 draws") != std::string::npos);
}

TEST_CASE("what is not a fit with draws is refused in one line that names the file") {
  const TempFolder folder;
  const auto file = folder.path() / "fit.json";
  const auto refuse = [&](const std::string& text, const char* words) {
    replace_file(file, text);
    CHECK_THROWS_WITH(planning::load_uncertain_subject(file), holds_text(words));
    CHECK_THROWS_WITH(planning::load_uncertain_subject(file), holds_text("fit.json"));
  };
  const std::string whole = planning::fit_json(fit_with_draws(hasty_subject()), {});
  refuse(whole.substr(0, whole.size() / 2), "truncated");
  refuse(std::string(R"({"fitted":)") + std::string(200'000, '[') + std::string(200'000, ']') +
             R"(,"device":null,"draws":[]})",
         "is not what");
  refuse(R"({"fitted": {}, "device": null, "draws": [{}]})", "is not what");
  refuse("[1, 2]", "is not what `touchtrial fit DB --json` prints");
  refuse(R"({"accuracies": []})", "published accuracies have none");
  planning::SubjectFit without = fit_with_draws(hasty_subject());
  without.draws.clear();
  refuse(planning::fit_json(without, {}), "--bootstraps 0");
  std::string wrong = whole;
  wrong.replace(wrong.find("0.125"), 5, "7.125");
  refuse(wrong, "/draws/0: /lapse");
  CHECK_THROWS_AS(planning::load_uncertain_subject(folder.path() / "none.json"), FileError);
}

TEST_CASE(
    "the effect of interest takes the place of the people's own, and the null keeps its level") {
  TinyStudyOptions options;
  options.comparison = GENERATE(false, true);
  options.side_px = 60;
  options.trials = R"({"repeats":2})";
  const RehearsedTinyStudy study(options, with_lapse(hasty_subject(), 0.0));
  const planning::BankedFeelings bank = study.bank(30, 4);
  const auto rehearsed = [&](std::optional<double> effect) {
    return std::make_unique<planning::RehearsedStudy>(study.tiny.key().study, study.subject,
                                                      study.test, bank, 40,
                                                      planning::RehearsalOptions{.effect = effect});
  };
  const auto estimand = [&](const planning::RehearsedStudy& one, Hypothesis hypothesis) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 25; ++seed) {
      sum += planning::judged(study.test, one.outcomes(40, hypothesis, seed), false).estimate / 25;
    }
    return sum;
  };
  const double whole = estimand(*rehearsed({}), Hypothesis::population);
  const double none = estimand(*rehearsed({}), Hypothesis::null);
  const double wanted = none + 0.5 * (whole - none);
  REQUIRE(std::abs(whole - none) > 0.05);
  const auto dulled = rehearsed(wanted);
  INFO(none << " " << whole);
  CHECK(estimand(*dulled, Hypothesis::population) == Approx(wanted).margin(0.02));
  CHECK(estimand(*dulled, Hypothesis::null) == Approx(none).margin(1e-12));
  CHECK_THROWS_WITH(rehearsed(whole + (whole > none ? 0.1 : -0.1)),
                    holds_text("does not lie between"));
}

TEST_CASE("every assumption is changed alone, and only what is felt asks for feelings anew") {
  const simulation::SubjectModel base = hasty_subject();
  simulation::SubjectModel other = base;
  other.lapse = 0.2;
  other.training_passes = 2;
  other.position_bias = 1.0;
  other.thought.emplace();
  const std::vector<planning::Assumption> all = planning::assumptions_about(base, other);
  const auto named = [&](const std::string& name) {
    return std::ranges::count(all, name, &planning::Assumption::name);
  };
  CHECK(named("sense") == 2);
  CHECK(named("hand") == 1);
  CHECK(named("device") == std::ssize(device::shipped_device_models()) - 1);
  CHECK(named("lapse") == 1);
  CHECK(named("bias") == 1);
  CHECK(named("training_passes") == 1);
  CHECK(named("thought") == 0);
  CHECK(named("feature_noise") == 0);
  for (const planning::Assumption& one : all) {
    const bool answers_alone = one.name == "lapse" || one.name == "bias";
    CHECK(planning::feel_alike(base, one.subject) == answers_alone);
    if (one.name == "bias") {
      CHECK(one.from == "position 0.3");
      CHECK(one.to == "position 1.0");
    }
  }
}

TEST_CASE("keys that belong together are changed together, and a hand's spread without its model") {
  const simulation::SubjectModel base = hasty_subject();
  simulation::SubjectModel other = base;
  other.source = "other.json";
  other.slowest_mm_s = 200.0;
  other.fastest_mm_s = 300.0;
  other.hand_spread = 0.5;
  int speeds = 0;
  int hands = 0;
  for (const planning::Assumption& one : planning::assumptions_about(base, other)) {
    if (one.name == "speeds") {
      ++speeds;
      CHECK(one.subject.slowest_mm_s == 200.0);
      CHECK(one.subject.fastest_mm_s == 300.0);
      CHECK(one.subject.hand_spread == base.hand_spread);
      CHECK(one.subject.source == "other.json");
    }
    if (one.name == "hand" && one.subject.hand == base.hand) {
      ++hands;
      CHECK(one.subject.hand_spread == 0.5);
    }
  }
  CHECK(speeds == 1);
  CHECK(hands == 1);
  simulation::SubjectModel thinks = base;
  thinks.thought.emplace();
  for (const planning::Assumption& one : planning::assumptions_about(base, thinks)) {
    CHECK(one.name != "all of the other subject");
  }
}

TEST_CASE("an assumption that changes nothing changes no study, and lapses take power away") {
  const RehearsedTinyStudy study;
  planning::PowerPlan plan;
  plan.participants = {4};
  plan.runs = 60;
  const std::vector<planning::Assumption> assumptions{
      {"nothing", "", "", study.subject}, {"lapse", "0.05", "0.9", with_lapse(study.subject, 0.9)}};
  int banks = 0;
  const auto make = [&](const simulation::SubjectModel&) {
    ++banks;
    return std::make_unique<planning::BankedFeelings>(
        study.fields, study.tiny.key().study, study.subject,
        planning::BankedFeelingsOptions{.explorations = 20, .trainings = 3});
  };
  const auto result = [&](int jobs) {
    return planning::what_if(study.tiny.key().study, study.test, study.subject, assumptions, plan,
                             {}, make, jobs);
  };
  const planning::WhatIf found = result(1);
  CHECK(banks == 1);
  REQUIRE(found.rows.size() == 2);
  CHECK(found.rows[0].name == "lapse");
  CHECK(found.rows[0].difference < -0.2);
  CHECK(found.rows[0].interval.high < 0.0);
  CHECK(found.rows[1].significant == found.base.significant);
  CHECK(found.rows[1].difference == 0.0);
  CHECK(planning::what_if_json(found) == planning::what_if_json(result(3)));
  CHECK(planning::what_if_text(found).find("Agresti") != std::string::npos);
}

}  // namespace
}  // namespace touchtrial
