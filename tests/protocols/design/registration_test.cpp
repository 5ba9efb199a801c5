#include "core/errors.hpp"
#include "protocols/design/study_examples.hpp"
#include "protocols/design/study_key.hpp"
#include "support/catch.hpp"

#include <string>

namespace touchtrial {
namespace {

using nlohmann::json;

std::string refusal_of(const json& registration, json study = study_of(5)) {
  study["registration"] = registration;
  try {
    static_cast<void>(parsed(study));
  } catch (const StudyError& error) {
    return error.what();
  }
  return "";
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
  const design::RegisteredAnalysis mean = parsed(study).registration.analysis.value();
  CHECK(mean == design::RegisteredAnalysis{});
  CHECK(mean.test == design::RegisteredTest::t);
  CHECK(mean.one_sided);
  study = comparison_of(3);
  study["registration"] = {{"estimand", "difference"}, {"alpha", 0.01}};
  const design::RegisteredAnalysis difference = parsed(study).registration.analysis.value();
  CHECK(difference.test == design::RegisteredTest::sign_flip);
  CHECK_FALSE(difference.one_sided);
  CHECK(difference.alpha == 0.01);
}

TEST_CASE("a registration must be one of this study") {
  CHECK_THAT(refusal_of({{"alpha", 0.05}}), holds_text("/registration/alpha: is given without"));
  CHECK_THAT(refusal_of({{"estimand", "means"}}), holds_text("possible: "));
  CHECK_THAT(refusal_of({{"estimand", "difference"}}), holds_text("the study presents one"));
  CHECK_THAT(refusal_of({{"estimand", "mean-accuracy"}}, comparison_of(3)),
             holds_text("use \"difference\""));
  CHECK_THAT(refusal_of({{"estimand", "mean-accuracy"}, {"test", "sign-flip"}}),
             holds_text("/registration/test: flips the signs"));
  CHECK_THAT(refusal_of({{"estimand", "mean-accuracy"}, {"smallest_effect", 0.2}}),
             holds_text("is 0.2, not above chance, which is 0.2"));
  CHECK_THAT(refusal_of({{"estimand", "mean-accuracy"}, {"methods", {"adaptive"}}}),
             holds_text("belongs to a difference"));
}

TEST_CASE("a registered difference names two methods that are presented") {
  const json pair = {{"estimand", "difference"}, {"methods", {"edge", "adaptive"}}};
  CHECK(refusal_of(pair, controls()).empty());
  CHECK_THAT(refusal_of({{"estimand", "difference"}}, controls()),
             holds_text("presents 3 methods; name the two"));
  const auto with = [](const json& methods) {
    return refusal_of({{"estimand", "difference"}, {"methods", methods}}, controls());
  };
  CHECK_THAT(with({"edge"}), holds_text("has one method"));
  CHECK_THAT(with({"edge", "edge"}), holds_text("the same method twice"));
  CHECK_THAT(with({"edge", "gaussian"}), holds_text("/registration/methods/1: \"gaussian\""));
}

TEST_CASE("registered looks come before the planned end, in order") {
  const auto with = [](const json& looks) {
    return refusal_of({{"estimand", "mean-accuracy"}, {"participants", 20}, {"looks", looks}});
  };
  CHECK(with({8, 14}).empty());
  CHECK_THAT(with({8, 20}), holds_text("look at 20 participants, but 20 are planned"));
  CHECK_THAT(with({8, 8}), holds_text("/registration/looks/1: is not more than the look before"));
}

TEST_CASE("a registration without the fields is written as it always was") {
  const design::Study study = parsed(planned_study());
  CHECK_FALSE(study.registration.analysis);
  json fields = planned_study();
  fields["registration"]["estimand"] = "mean-accuracy";
  SeededEntropy one(1);
  SeededEntropy other(1);
  const auto texts = [](const design::StudyKey& key) {
    return json::parse(design::blinded_configuration(key))["texts"];
  };
  CHECK(texts(design::make_study_key(study, one, false)) !=
        texts(design::make_study_key(parsed(fields), other, false)));
  CHECK_FALSE(design::are_same(study, parsed(fields)));
}

}  // namespace touchtrial
