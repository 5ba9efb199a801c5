#include "core/errors.hpp"
#include "study/deviation_codes.hpp"
#include "study/study_examples.hpp"
#include "study/study_key.hpp"
#include "study/study_sections.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <string_view>
#include <vector>

namespace touchtrial {
namespace {

using nlohmann::json;

std::string refusal(const json& registration, json study = study_of(5)) {
  study["registration"] = registration;
  return refusal_of(study);
}

json controls() {
  json study = comparison_of(3);
  study["methods"].push_back({{"name", "edge"}});
  return study;
}

}  // namespace

TEST_CASE("a registration has the usual test of its estimand unless it says otherwise") {
  json study = study_of(5);
  study["registration"] = {{"estimand", "mean-accuracy"}};
  const study::RegisteredAnalysis mean = parsed(study).registration.analysis.value();
  CHECK(mean == study::RegisteredAnalysis{});
  CHECK(mean.test == study::RegisteredTest::t);
  CHECK(mean.one_sided);
  study = comparison_of(3);
  study["registration"] = {{"estimand", "difference"}, {"alpha", 0.01}};
  const study::RegisteredAnalysis difference = parsed(study).registration.analysis.value();
  CHECK(difference.test == study::RegisteredTest::crossover);
  CHECK_FALSE(difference.one_sided);
  CHECK(difference.alpha == 0.01);
  study["trials"] = {{"blocks", "mixed"}};
  CHECK(parsed(study).registration.analysis->test == study::RegisteredTest::sign_flip);
  json three = controls();
  three["registration"] = {{"estimand", "difference"}, {"methods", {"edge", "adaptive"}}};
  CHECK(parsed(three).registration.analysis->test == study::RegisteredTest::sign_flip);
}

TEST_CASE("a crossover needs two methods, one after the other") {
  const json crossover = {{"estimand", "difference"}, {"test", "crossover"}};
  CHECK(refusal(crossover, comparison_of(3)).empty());
  json mixed = comparison_of(3);
  mixed["trials"] = {{"blocks", "mixed"}};
  CHECK_THAT(refusal(crossover, mixed), names("/registration/test"));
  CHECK_THAT(
      refusal(
          {{"estimand", "difference"}, {"test", "crossover"}, {"methods", {"edge", "adaptive"}}},
          controls()),
      names("/registration/test 3"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"test", "crossover"}}),
             names("/registration/test"));
}

TEST_CASE("a margin is one-sided, decided by a t test, and in place of a smallest effect") {
  const auto with = [](const json& more) {
    json registration = {{"estimand", "difference"}, {"margin", 0.07}};
    registration.update(more);
    return refusal(registration, comparison_of(3));
  };
  json study = comparison_of(3);
  study["registration"] = {{"estimand", "difference"}, {"margin", 0.07}};
  study::RegisteredAnalysis analysis = parsed(study).registration.analysis.value();
  CHECK(analysis.margin == 0.07);
  CHECK(analysis.one_sided);
  CHECK(analysis.test == study::RegisteredTest::crossover);
  study["trials"] = {{"blocks", "mixed"}};
  CHECK(parsed(study).registration.analysis->test == study::RegisteredTest::t);
  CHECK_THAT(study::fields_of(parsed(study).registration)[3].second, names("7 90 %"));
  CHECK_THAT(with({{"smallest_effect", 0.1}}), names("/registration/margin smallest_effect"));
  CHECK_THAT(with({{"sides", "two"}}), names("/registration/sides one"));
  CHECK_THAT(with({{"test", "sign-flip"}}), names("/registration/test"));
  CHECK_THAT(with({{"alpha", 0.5}}), names("/registration/alpha 0.5"));
  CHECK_THAT(with({{"margin", 0.0}}), holds_text("/registration/margin"));
  CHECK_THAT(with({{"margin", 1.01}}), holds_text("/registration/margin"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"margin", 0.07}}),
             names("/registration/margin"));
  CHECK_THAT(refusal({{"margin", 0.07}}), names("/registration/margin estimand"));
}

TEST_CASE("a registration must be one of this study") {
  CHECK_THAT(refusal({{"alpha", 0.05}}), names("/registration/alpha"));
  CHECK_THAT(refusal({{"estimand", "means"}}),
             names("/registration/estimand mean-accuracy difference"));
  CHECK_THAT(refusal({{"estimand", "difference"}}), names("/registration/estimand"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}}, comparison_of(3)),
             names("/registration/estimand difference"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"test", "sign-flip"}}),
             names("/registration/test"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"smallest_effect", 0.2}}),
             names("/registration/smallest_effect 0.2"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"methods", {"adaptive"}}}),
             names("/registration/methods"));
}

TEST_CASE("a registered difference names two methods that are presented") {
  const json pair = {{"estimand", "difference"}, {"methods", {"edge", "adaptive"}}};
  CHECK(refusal(pair, controls()).empty());
  CHECK_THAT(refusal({{"estimand", "difference"}}, controls()), names("/registration/estimand 3"));
  const auto with = [](const json& methods) {
    return refusal({{"estimand", "difference"}, {"methods", methods}}, controls());
  };
  CHECK_THAT(with({"edge"}), names("/registration/methods"));
  CHECK_THAT(with({"edge", "edge"}), names("/registration/methods/1"));
  CHECK_THAT(with({"edge", "gaussian"}), holds_text("/registration/methods/1: \"gaussian\""));
}

TEST_CASE("a rule about deviations names codes that can occur") {
  const auto with = [](const json& rules, const json& day_sheet = json::array()) {
    json study = study_of(5);
    study["session"] = {{"day_sheet", day_sheet}};
    return refusal({{"estimand", "mean-accuracy"}, {"exclusion_rules", rules}}, study);
  };
  for (const std::string_view code : study::kDeviationCodes) {
    CHECK(with({{"deviations", {code}}}).empty());
  }
  const std::string refused = with({{"deviations", {"no-curtain", "no-curtan"}}});
  CHECK_THAT(refused, names("/registration/exclusion_rules/deviations/1 "));
  CHECK_THAT(refused, names("no-day-sheet-1 own_deviations"));
  CHECK(with({{"own_deviations", {"no-curtan"}}}).empty());
  const json two = {"Door shut", "Phone off"};
  CHECK(with({{"deviations", {"no-day-sheet-2"}}}, two).empty());
  CHECK_THAT(with({{"deviations", {"no-day-sheet-3"}}}, two),
             names("/registration/exclusion_rules/deviations/0 3 day_sheet 2"));
  for (const char* code : {"no-day-sheet-", "no-day-sheet-0", "no-day-sheet-02"}) {
    CHECK_THAT(with({{"deviations", {code}}}, two),
               names("/registration/exclusion_rules/deviations/0"));
  }
}

TEST_CASE("a question, or a rule, that the protocol cannot keep is refused") {
  CHECK_THAT(refusal({{"estimand", "mean-threshold"}}),
             names("/registration/estimand mean-threshold"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"margin_db", 3}}),
             names("/registration/margin_db"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"exclusion_rules", {{"missed_catch", 1}}}}),
             names("/registration/exclusion_rules/missed_catch"));
}

TEST_CASE("codes of the program and of the study are read as they were written") {
  json study = study_of(5);
  study["registration"] = {
      {"estimand", "mean-accuracy"},
      {"exclusion_rules", {{"deviations", {"no-consent"}}, {"own_deviations", {"asleep"}}}}};
  const study::Registration registration = parsed(study).registration;
  CHECK(registration.analysis->exclusion_rules->deviations ==
        std::vector<std::string>{"no-consent", "asleep"});
  study["registration"] = study::to_json(registration);
  CHECK(parsed(study).registration == registration);
  CHECK(study["registration"]["exclusion_rules"]["own_deviations"] == json{"asleep"});
}

TEST_CASE("alpha is neither nothing nor more than a half") {
  for (const double alpha : {0.0, 1e-320, 9e-7, 0.51}) {
    CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"alpha", alpha}}),
               holds_text("/registration/alpha"));
  }
  CHECK(refusal({{"estimand", "mean-accuracy"}, {"alpha", 1e-6}}).empty());
}

TEST_CASE("registered looks come before the planned end, in order") {
  const auto with = [](const json& looks) {
    return refusal({{"estimand", "mean-accuracy"}, {"participants", 20}, {"looks", looks}});
  };
  CHECK(with({8, 14}).empty());
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"looks", {8}}}),
             names("/registration/looks participants"));
  CHECK_THAT(with({1, 8}), holds_text("/registration/looks/0"));
  CHECK_THAT(with({8, 20}), names("/registration/looks 20"));
  CHECK_THAT(with({8, 8}), names("/registration/looks/1"));
}

TEST_CASE("a registration without the fields is written as it always was") {
  const study::Study study = parsed(planned_study());
  CHECK_FALSE(study.registration.analysis);
  json fields = planned_study();
  fields["registration"]["estimand"] = "mean-accuracy";
  SeededEntropy one(1);
  SeededEntropy other(1);
  const auto texts = [](const study::StudyKey& key) {
    return json::parse(study::blinded_configuration(key))["texts"];
  };
  CHECK(texts(study::make_study_key(study, one, false)) !=
        texts(study::make_study_key(parsed(fields), other, false)));
  CHECK_FALSE(study::are_same(study, parsed(fields)));
}

}  // namespace touchtrial
