#include "analysis/planning/fit_report.hpp"
#include "analysis/planning/power_report.hpp"
#include "analysis/planning/rehearsed_tiny_study.hpp"
#include "analysis/planning/uncertain_subject.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "support/catch.hpp"
#include "support/temp_folder.hpp"

#include <cmath>
#include <memory>
#include <set>

#include <nlohmann/json.hpp>

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
  const auto report_of = [&](const std::vector<simulation::SubjectModel>& draws) {
    planning::PowerSetting setting;
    setting.draws = static_cast<int>(draws.size());
    const planning::RehearsedStudy over(study.tiny.key().study, study.subject, study.test, bank, 6,
                                        {.draws = draws});
    return planning::make_power_report(planning::make_runs(over, study.test, setting, plan, 2));
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
  CHECK(nlohmann::json::parse(planning::power_json(over)).at("draws") == 2);
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

}  // namespace
}  // namespace touchtrial
