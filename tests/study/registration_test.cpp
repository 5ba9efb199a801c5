#include "core/errors.hpp"
#include "study/deviation_codes.hpp"
#include "study/study_examples.hpp"
#include "study/study_key.hpp"
#include "study/study_sections.hpp"
#include "support/catch.hpp"

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
  CHECK_THAT(refusal(crossover, mixed), holds_text("/registration/test: adjusts for periods"));
  CHECK_THAT(
      refusal(
          {{"estimand", "difference"}, {"test", "crossover"}, {"methods", {"edge", "adaptive"}}},
          controls()),
      holds_text("the study presents 3"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"test", "crossover"}}),
             holds_text("/registration/test: is about differences"));
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
  CHECK(study::fields_of(parsed(study).registration)[3].second ==
        "as good if worse by less than 7 points; decided by the 90 % t interval, and only if both "
        "methods are above chance");
  CHECK_THAT(with({{"smallest_effect", 0.1}}), holds_text("register one question"));
  CHECK_THAT(with({{"sides", "two"}}), holds_text("/registration/sides: must be \"one\""));
  CHECK_THAT(with({{"test", "sign-flip"}}), holds_text("flips signs about 0"));
  CHECK_THAT(with({{"alpha", 0.5}}), holds_text("less than 0.5"));
  CHECK_THAT(with({{"margin", 0.0}}), holds_text("/registration/margin"));
  CHECK_THAT(with({{"margin", 1.01}}), holds_text("/registration/margin"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"margin", 0.07}}),
             holds_text("/registration/margin: belongs to a difference"));
  CHECK_THAT(refusal({{"margin", 0.07}}), holds_text("is given without \"estimand\""));
}

TEST_CASE("a registration must be one of this study") {
  CHECK_THAT(refusal({{"alpha", 0.05}}), holds_text("/registration/alpha: is given without"));
  CHECK_THAT(refusal({{"estimand", "means"}}), holds_text("possible: "));
  CHECK_THAT(refusal({{"estimand", "difference"}}), holds_text("the study presents one"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}}, comparison_of(3)),
             holds_text("use \"difference\""));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"test", "sign-flip"}}),
             holds_text("/registration/test: is about differences"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"smallest_effect", 0.2}}),
             holds_text("is 0.2, not above chance, which is 0.2"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"methods", {"adaptive"}}}),
             holds_text("belongs to a difference"));
}

TEST_CASE("a registered difference names two methods that are presented") {
  const json pair = {{"estimand", "difference"}, {"methods", {"edge", "adaptive"}}};
  CHECK(refusal(pair, controls()).empty());
  CHECK_THAT(refusal({{"estimand", "difference"}}, controls()),
             holds_text("presents 3 methods; name the two"));
  const auto with = [](const json& methods) {
    return refusal({{"estimand", "difference"}, {"methods", methods}}, controls());
  };
  CHECK_THAT(with({"edge"}), holds_text("has one method"));
  CHECK_THAT(with({"edge", "edge"}), holds_text("the same method twice"));
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
  CHECK_THAT(refused, holds_text("/registration/exclusion_rules/deviations/1: is no code that the "
                                 "program records, which are answers-lost, clock-set-back, "));
  CHECK_THAT(refused, holds_text("wrong-clock and no-day-sheet-1, ..; a code that "
                                 "experimenters enter belongs in \"own_deviations\""));
  CHECK(with({{"own_deviations", {"no-curtan"}}}).empty());
  const json two = {"Door shut", "Phone off"};
  CHECK(with({{"deviations", {"no-day-sheet-2"}}}, two).empty());
  CHECK_THAT(with({{"deviations", {"no-day-sheet-3"}}}, two),
             holds_text("/registration/exclusion_rules/deviations/0: is about item 3 of "
                        "\"day_sheet\", which has 2"));
  for (const char* code : {"no-day-sheet-", "no-day-sheet-0", "no-day-sheet-02"}) {
    CHECK_THAT(with({{"deviations", {code}}}, two), holds_text("is no code"));
  }
}

TEST_CASE("a question, or a rule, that the protocol cannot keep is refused") {
  CHECK_THAT(refusal({{"estimand", "mean-threshold"}}),
             holds_text("/registration/estimand: \"mean-threshold\" is no question that the "
                        "protocol classification answers; register one that it does: "
                        "mean-accuracy, difference"));
  CHECK_THAT(refusal({{"estimand", "mean-accuracy"}, {"margin_db", 3}}),
             holds_text("/registration/margin_db: is about thresholds"));
  CHECK_THAT(
      refusal({{"estimand", "mean-accuracy"}, {"exclusion_rules", {{"missed_catch", 1}}}}),
      holds_text("/registration/exclusion_rules/missed_catch: is about catch trials with a right "
                 "answer, of which the study has none"));
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
             holds_text("/registration/looks: is given without \"participants\""));
  CHECK_THAT(with({1, 8}), holds_text("/registration/looks/0"));
  CHECK_THAT(with({8, 20}), holds_text("look at 20 participants, but 20 are planned"));
  CHECK_THAT(with({8, 8}), holds_text("/registration/looks/1: is not more than the look before"));
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
