/// \file The study file's "registration".
#include "core/named.hpp"
#include "core/text.hpp"
#include "study/deviation_codes.hpp"
#include "study/protocol.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace touchtrial::study {
namespace {

constexpr std::size_t kLongestStatement = 4000;  // bytes
constexpr int kMaxParticipants = 100'000;
constexpr std::size_t kMaxLooks = 20;
constexpr std::size_t kMaxCodes = 64;
constexpr std::size_t kLongestCode = 64;  // bytes
constexpr int kMaxCatchTrials = 1000;
constexpr std::size_t kMaxStandards = 64;
constexpr NumberRange kStandardRange{-200.0, 200.0};
constexpr NumberRange kDecibels{0.0, 200.0, true};  ///< of an effect or a margin
constexpr double kMinAlpha = 1e-6;

/// The number of an item of the study's own day sheet: 3 of "no-day-sheet-3".
std::optional<int> day_sheet_item(std::string_view code) {
  const std::string beginning = "no-day-sheet-";
  if (!code.starts_with(beginning)) return std::nullopt;
  const std::optional<int> item = number_in<int>(code.substr(beginning.size()));
  const bool is_one = item && *item > 0 && code == beginning + std::to_string(*item);
  return is_one ? item : std::nullopt;
}

void read_statement(const JsonObject& object, std::string_view key, std::string& statement) {
  if (const auto member = object.find(key)) statement = read_paragraphs(*member, kLongestStatement);
}

ExclusionRules read_exclusion_rules(const JsonValue& place) {
  const JsonObject object =
      place.object({"deviations", "own_deviations", "invalid_trials", "missed_catch"});
  ExclusionRules rules;
  if (const auto member = object.find("deviations")) {
    for (const JsonValue& code : member->items(0, kMaxCodes)) {
      rules.deviations.push_back(read_line(code, kLongestCode));
      if (is_deviation_code(rules.deviations.back())) continue;
      code.refuse("is no code that the program records, which are " + listed(kDeviationCodes) +
                  " and no-day-sheet-1, ..; a code that experimenters enter belongs in "
                  "\"own_deviations\"");
    }
  }
  if (const auto member = object.find("own_deviations")) {
    for (const JsonValue& code : member->items(0, kMaxCodes)) {
      rules.deviations.push_back(read_line(code, kLongestCode));
    }
  }
  std::stable_partition(rules.deviations.begin(), rules.deviations.end(), is_deviation_code);
  if (const auto member = object.find("invalid_trials")) {
    rules.invalid_trials = member->number({.low = 0.0, .high = 1.0});
  }
  if (const auto member = object.find("missed_catch")) {
    rules.missed_catch = static_cast<int>(member->integer(0, kMaxCatchTrials));
  }
  return rules;
}

std::vector<std::string> read_pair(const JsonValue& place) {
  std::vector<std::string> methods;
  for (const JsonValue& label : place.items(0, 2)) methods.push_back(read_plain_name(label));
  return methods;
}

std::vector<RegisteredStandard> read_standards(const JsonValue& place) {
  std::vector<RegisteredStandard> standards;
  for (const JsonValue& item : place.items(0, kMaxStandards)) {
    const JsonObject object = item.object({"class", "value"});
    RegisteredStandard& standard = standards.emplace_back();
    if (const auto member = object.find("class")) standard.label = read_plain_name(*member);
    if (const auto member = object.find("value")) standard.value = member->number(kStandardRange);
  }
  return standards;
}

std::vector<int> read_looks(const JsonValue& place) {
  std::vector<int> looks;
  for (const JsonValue& look : place.items(0, kMaxLooks)) {
    const int participants = static_cast<int>(look.integer(2, kMaxParticipants));
    if (!looks.empty() && participants <= looks.back()) {
      look.refuse("is not more than the look before; list looks in ascending order");
    }
    looks.push_back(participants);
  }
  return looks;
}

constexpr std::string_view kAnalysisKeys[] = {
    "methods",         "standards", "test",           "sides",    "alpha",
    "smallest_effect", "margin",    "looks",          "spending", "smallest_effect_db",
    "margin_db",       "visits",    "exclusion_rules"};

/// The keys of some estimands alone.
constexpr std::string_view kKeysOfAccuracies[] = {"methods", "smallest_effect", "margin"};
constexpr std::string_view kKeysOfThresholds[] = {"standards", "smallest_effect_db", "margin_db"};
constexpr std::string_view kKeysOfTests[] = {"test",     "sides",     "looks",
                                             "spending", "margin_db", "smallest_effect_db"};

void refuse_keys(const JsonObject& object, std::span<const std::string_view> keys,
                 const std::string& what) {
  for (const std::string_view key : keys) {
    if (const auto member = object.find(key)) member->refuse(what);
  }
}

/// Refuses keys that mean nothing for the estimand.
void check_keys(const JsonObject& object, Estimand estimand) {
  const std::string of = " \"" + std::string(name_of(estimand)) + "\"; remove it";
  if (!is_of_thresholds(estimand)) {
    return refuse_keys(object, kKeysOfThresholds, "is about thresholds, and not about" + of);
  }
  refuse_keys(object, kKeysOfAccuracies, "is about right answers, and not about" + of);
  if (estimand == Estimand::mean_threshold) {
    return refuse_keys(
        object, kKeysOfTests,
        "belongs to a test; \"mean-threshold\" is an estimate without one: remove it");
  }
  const auto refuse = [&](const char* key, const char* what) {
    if (const auto member = object.find(key)) member->refuse(what);
  };
  if (estimand == Estimand::threshold_difference) {
    return refuse("margin_db", "belongs to \"threshold-equality\"; remove it, or register that");
  }
  refuse("sides", "belongs to no equality, which is two one-sided tests; remove it");
  refuse("smallest_effect_db", "is given for an equality, whose size is \"margin_db\"; remove it");
  static_cast<void>(object.at("margin_db"));
}

/// The usual test of an estimand. Flips of signs are about 0, so a margin needs a t test.
RegisteredAnalysis usual_analysis(Estimand estimand, bool has_margin, RegisteredTest usual_test) {
  RegisteredAnalysis analysis;
  analysis.estimand = estimand;
  if (estimand == Estimand::mean_accuracy) return analysis;
  if (is_of_thresholds(estimand)) {
    analysis.one_sided = estimand == Estimand::threshold_equality;
    return analysis;
  }
  analysis.test =
      has_margin && usual_test == RegisteredTest::sign_flip ? RegisteredTest::t : usual_test;
  analysis.one_sided = has_margin;
  return analysis;
}

std::optional<RegisteredAnalysis> read_analysis(const JsonObject& object,
                                                RegisteredTest usual_test) {
  const auto estimand = object.find("estimand");
  if (!estimand) {
    for (const std::string_view key : kAnalysisKeys) {
      if (const auto member = object.find(key)) {
        member->refuse("is given without \"estimand\"; say what is estimated, or remove it");
      }
    }
    return std::nullopt;
  }
  const Estimand estimated = estimand->choice(kEstimandNames);
  check_keys(object, estimated);
  RegisteredAnalysis analysis =
      usual_analysis(estimated, object.find("margin").has_value(), usual_test);
  if (const auto member = object.find("methods")) analysis.methods = read_pair(*member);
  if (const auto member = object.find("standards")) analysis.standards = read_standards(*member);
  if (const auto member = object.find("test")) analysis.test = member->choice(kRegisteredTestNames);
  if (const auto member = object.find("sides")) analysis.one_sided = member->choice(kSidesNames);
  if (const auto member = object.find("alpha")) {
    analysis.alpha = member->number({.low = kMinAlpha, .high = 0.5});
  }
  if (const auto member = object.find("smallest_effect")) {
    analysis.smallest_effect = member->number({.low = 0.0, .high = 1.0, .open_low = true});
  }
  if (const auto member = object.find("margin")) {
    analysis.margin = member->number({.low = 0.0, .high = 1.0, .open_low = true});
  }
  if (const auto member = object.find("smallest_effect_db")) {
    analysis.smallest_effect = member->number(kDecibels);
  }
  if (const auto member = object.find("margin_db")) analysis.margin = member->number(kDecibels);
  if (const auto member = object.find("looks")) analysis.looks = read_looks(*member);
  if (const auto member = object.find("spending")) {
    analysis.spending = member->choice(kSpendingNames);
  }
  if (const auto member = object.find("exclusion_rules")) {
    analysis.exclusion_rules = read_exclusion_rules(*member);
  }
  if (const auto member = object.find("visits")) {
    analysis.visits = member->choice(kRegisteredVisitsNames);
  }
  return analysis;
}

nlohmann::json to_json(const ExclusionRules& rules) {
  const auto own = std::ranges::find_if_not(rules.deviations, is_deviation_code);
  nlohmann::json text = {{"deviations", std::vector(rules.deviations.begin(), own)}};
  if (own != rules.deviations.end()) {
    text["own_deviations"] = std::vector(own, rules.deviations.end());
  }
  if (rules.invalid_trials) text["invalid_trials"] = *rules.invalid_trials;
  if (rules.missed_catch) text["missed_catch"] = *rules.missed_catch;
  return text;
}

nlohmann::json to_json(const std::vector<RegisteredStandard>& standards) {
  nlohmann::json all = nlohmann::json::array();
  for (const RegisteredStandard& one : standards) {
    nlohmann::json standard = nlohmann::json::object();
    if (!one.label.empty()) standard["class"] = one.label;
    if (one.value) standard["value"] = *one.value;
    all.push_back(std::move(standard));
  }
  return all;
}

/// The keys of the analysis that say what is estimated, and by which test.
void put_question(nlohmann::json& text, const RegisteredAnalysis& analysis) {
  const bool of_thresholds = is_of_thresholds(analysis.estimand);
  const std::string unit = of_thresholds ? "_db" : "";
  text["estimand"] = name_in(kEstimandNames, analysis.estimand);
  if (of_thresholds) {
    text["standards"] = to_json(analysis.standards);
  } else {
    text["methods"] = analysis.methods;
  }
  text["alpha"] = analysis.alpha;
  if (analysis.smallest_effect) text["smallest_effect" + unit] = *analysis.smallest_effect;
  if (analysis.margin) text["margin" + unit] = *analysis.margin;
  if (analysis.estimand == Estimand::mean_threshold) return;
  text["test"] = name_in(kRegisteredTestNames, analysis.test);
  if (analysis.estimand != Estimand::threshold_equality) {
    text["sides"] = name_in(kSidesNames, analysis.one_sided);
  }
  text["looks"] = analysis.looks;
  text["spending"] = name_in(kSpendingNames, analysis.spending);
}

void check_methods(const JsonValue& file, const Study& study) {
  const std::vector<std::string>& methods = study.registration.analysis->methods;
  const auto place = [](std::size_t i) {
    return "/registration/methods" + (i < 2 ? "/" + std::to_string(i) : std::string());
  };
  if (methods.size() == 1) file.refuse_below(place(2), "has one method; name two, or none");
  const auto presented =
      std::span(study.methods).first(static_cast<std::size_t>(study.presented_methods()));
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (std::ranges::count(presented, methods[i], &StudyMethod::label) == 0) {
      file.refuse_below(
          place(i), in_quotes(methods[i]) + " is no method that the study presents; use its label");
    }
  }
  if (methods.size() == 2 && methods[0] == methods[1]) {
    file.refuse_below(place(1), "is the same method twice; name two");
  }
  if (methods.empty() && presented.size() > 2) {
    file.refuse_below("/registration/estimand", "is a difference, but the study presents " +
                                                    std::to_string(presented.size()) +
                                                    " methods; name the two in \"methods\"");
  }
}

/// A crossover compares two periods, each of one method.
void check_crossover(const JsonValue& file, const Study& study) {
  const char* const place = "/registration/test";
  if (study.presented_methods() != 2) {
    file.refuse_below(place, "adjusts two methods for two periods, but the study presents " +
                                 std::to_string(study.presented_methods()) +
                                 "; use \"sign-flip\" or \"t\"");
  }
  if (study.trials.blocks == Blocks::mixed) {
    file.refuse_below(
        place,
        "adjusts for periods, but the trials' blocks are \"mixed\", so that there are "
        "none; use \"sign-flip\" or \"t\"");
  }
}

void check_margin(const JsonValue& file, const RegisteredAnalysis& analysis) {
  if (!analysis.margin) return;
  if (analysis.estimand == Estimand::threshold_equality) {
    if (analysis.alpha >= 0.5) {
      file.refuse_below("/registration/alpha", "must be less than 0.5 with a margin");
    }
    return;
  }
  if (analysis.estimand != Estimand::difference) {
    file.refuse_below("/registration/margin", "belongs to a difference of methods; remove it");
  }
  if (analysis.smallest_effect) {
    file.refuse_below("/registration/margin",
                      "is given beside \"smallest_effect\"; register one question: that the first "
                      "method is better, or that it is as good");
  }
  if (!analysis.one_sided) {
    file.refuse_below("/registration/sides",
                      "must be \"one\" with a margin: the first method may be better");
  }
  if (analysis.alpha >= 0.5) {
    file.refuse_below("/registration/alpha", "must be less than 0.5 with a margin");
  }
  if (analysis.test == RegisteredTest::sign_flip) {
    file.refuse_below("/registration/test",
                      "flips signs about 0, not about a margin; use \"crossover\" for blocks by "
                      "method, else \"t\"");
  }
}

/// Whether the protocol answers what is registered. Which standards there are is its own matter.
void check_protocol(const JsonValue& file, const Study& study) {
  const Estimand estimand = study.registration.analysis->estimand;
  const std::span<const Estimand> kept = study.protocol->estimands;
  if (std::ranges::find(kept, estimand) != kept.end()) return;
  const std::string what = in_quotes(name_of(estimand)) + " is no question that the protocol " +
                           study.protocol_name() + " answers";
  const char* const place = "/registration/estimand";
  if (kept.empty()) {
    file.refuse_below(place, what +
                                 "; leave estimand and what belongs to it out, and state the test "
                                 "in primary_test");
  }
  std::vector<std::string> names;
  for (const Estimand one : kept) names.emplace_back(name_of(one));
  file.refuse_below(place, what + "; register one that it does: " + listed(names));
}

void check_estimand(const JsonValue& file, const Study& study) {
  const RegisteredAnalysis& analysis = *study.registration.analysis;
  const char* const place = "/registration/estimand";
  if (is_of_thresholds(analysis.estimand)) {
    if (analysis.test == RegisteredTest::t) return;
    file.refuse_below("/registration/test",
                      "is about right answers; use \"t\" for thresholds, or leave it out");
  }
  const bool several = study.presented_methods() > 1;
  if (analysis.estimand == Estimand::difference) {
    if (!several) {
      file.refuse_below(place,
                        "is a difference of methods, but the study presents one; use "
                        "\"mean-accuracy\"");
    }
    check_methods(file, study);
    if (analysis.test == RegisteredTest::crossover) check_crossover(file, study);
    return;
  }
  if (several) {
    file.refuse_below(place,
                      "is the accuracy with one method, but the study compares several; use "
                      "\"difference\"");
  }
  if (!analysis.methods.empty()) {
    file.refuse_below("/registration/methods", "belongs to a difference; remove it");
  }
  if (analysis.test != RegisteredTest::t) {
    file.refuse_below("/registration/test",
                      "is about differences, but the study compares no methods; use "
                      "\"t\"");
  }
  const double chance = 1.0 / static_cast<double>(choices_of(study).size());
  if (analysis.smallest_effect && *analysis.smallest_effect <= chance) {
    file.refuse_below("/registration/smallest_effect",
                      "is " + number_text(*analysis.smallest_effect) +
                          ", not above chance, which is " + number_text(chance) +
                          "; give the smallest accuracy worth having");
  }
}

void check_day_sheet(const JsonValue& file, const Study& study) {
  const auto& rules = study.registration.analysis->exclusion_rules;
  if (!rules) return;
  const std::size_t items = study.session.day_sheet.size();
  for (std::size_t i = 0; i < rules->deviations.size(); ++i) {
    const std::optional<int> item = day_sheet_item(rules->deviations[i]);
    if (!item || static_cast<std::size_t>(*item) <= items) continue;
    file.refuse_below("/registration/exclusion_rules/deviations/" + std::to_string(i),
                      "is about item " + std::to_string(*item) + " of \"day_sheet\", which has " +
                          std::to_string(items) + "; name an item that it has, or add this one");
  }
}

/// Nobody can miss more catch trials than there are.
void check_missed_catch(const JsonValue& file, const Study& study) {
  const auto& rules = study.registration.analysis->exclusion_rules;
  if (!rules || !rules->missed_catch) return;
  const char* const place = "/registration/exclusion_rules/missed_catch";
  const int trials = study.task->answered_catches(study);
  if (trials == 0) {
    file.refuse_below(place,
                      "is about catch trials with a right answer, of which the study has "
                      "none; remove it");
  }
  if (*rules->missed_catch >= trials) {
    file.refuse_below(place, "is " + std::to_string(*rules->missed_catch) + ", but a session has " +
                                 counted(trials, "catch trial") +
                                 ", so that nobody misses more; lower it, or remove it");
  }
}

void check_looks(const JsonValue& file, const Registration& registration) {
  const std::vector<int>& looks = registration.analysis->looks;
  if (looks.empty() || looks.back() < registration.participants) return;
  const char* const place = "/registration/looks";
  if (registration.participants == 0) {
    file.refuse_below(place, "is given without \"participants\"; state the planned number");
  }
  file.refuse_below(place, "has a look at " + std::to_string(looks.back()) + " participants, but " +
                               std::to_string(registration.participants) +
                               " are planned; look earlier, or state more \"participants\"");
}

}  // namespace

RegisteredTest usual_test_of(const Study& study) {
  return study.presented_methods() == 2 && study.trials.blocks == Blocks::by_method
             ? RegisteredTest::crossover
             : RegisteredTest::sign_flip;
}

std::string_view name_of(Estimand estimand) {
  return name_in(kEstimandNames, estimand);
}

std::string_view name_of(RegisteredTest test) {
  return name_in(kRegisteredTestNames, test);
}

std::string_view name_of(Spending spending) {
  return name_in(kSpendingNames, spending);
}

Registration read_registration(const JsonValue& place, RegisteredTest usual_test) {
  const JsonObject object = place.object({"hypothesis",
                                          "participants",
                                          "stopping_rule",
                                          "exclusions",
                                          "primary_test",
                                          "estimand",
                                          "methods",
                                          "standards",
                                          "test",
                                          "sides",
                                          "alpha",
                                          "smallest_effect",
                                          "margin",
                                          "smallest_effect_db",
                                          "margin_db",
                                          "looks",
                                          "spending",
                                          "exclusion_rules",
                                          "safety_record_years",
                                          "visits"});
  Registration registration;
  read_statement(object, "hypothesis", registration.hypothesis);
  if (const auto member = object.find("participants")) {
    registration.participants = static_cast<int>(member->integer(0, kMaxParticipants));
  }
  read_statement(object, "stopping_rule", registration.stopping_rule);
  read_statement(object, "exclusions", registration.exclusions);
  read_statement(object, "primary_test", registration.primary_test);
  if (const auto member = object.find("safety_record_years")) {
    registration.safety_record_years = static_cast<int>(member->integer(0, 100));
  }
  registration.analysis = read_analysis(object, usual_test);
  return registration;
}

nlohmann::json to_json(const Registration& registration) {
  nlohmann::json text = {{"hypothesis", registration.hypothesis},
                         {"participants", registration.participants},
                         {"stopping_rule", registration.stopping_rule},
                         {"exclusions", registration.exclusions},
                         {"primary_test", registration.primary_test},
                         {"safety_record_years", registration.safety_record_years}};
  if (!registration.analysis) return text;
  const RegisteredAnalysis& analysis = *registration.analysis;
  put_question(text, analysis);
  if (analysis.exclusion_rules) text["exclusion_rules"] = to_json(*analysis.exclusion_rules);
  if (analysis.visits != RegisteredVisits::all) {
    text["visits"] = name_in(kRegisteredVisitsNames, analysis.visits);
  }
  return text;
}

void check_registration(const JsonValue& file, const Study& study) {
  const Registration& registration = study.registration;
  if (!registration.analysis) return;
  check_protocol(file, study);
  check_estimand(file, study);
  check_margin(file, *registration.analysis);
  if (registration.analysis->visits != RegisteredVisits::all) {
    const char* const place = "/registration/visits";
    if (study.visits.count < 2) {
      file.refuse_below(place, "chooses a visit, but the study has one; remove it");
    }
    if (study.visits.methods == VisitMethods::divided) {
      file.refuse_below(place, "must be \"all\": each visit has other methods");
    }
  }
  check_looks(file, registration);
  check_day_sheet(file, study);
  check_missed_catch(file, study);
}

namespace {

/// A hundred times the share, without the binary digits of 7.000000000000001.
std::string per_cent_text(double share) {
  return number_text(std::round(1e10 * share) / 1e8);
}

/// "bark at -18", or what of it is named.
std::string standard_words(const RegisteredStandard& standard) {
  if (!standard.value) return standard.label;
  return standard.label + (standard.label.empty() ? "" : " at ") + number_text(*standard.value);
}

std::string threshold_words(const RegisteredAnalysis& analysis) {
  std::vector<std::string> standards;
  for (const RegisteredStandard& one : analysis.standards) standards.push_back(standard_words(one));
  const std::string mean = "mean over participants of the threshold";
  switch (analysis.estimand) {
    case Estimand::mean_threshold:
      return mean + (standards.empty() ? "" : ", standard " + standards.front());
    case Estimand::threshold_difference:
      if (standards.empty()) return mean + " at the first standard less that at the second";
      return mean + ", standard " + standards.front() + " less standard " + standards.back();
    default:
      break;
  }
  return "equality of the thresholds of " +
         (standards.empty() ? "all standards" : "the standards " + listed(standards, " and ")) +
         ": means over participants of all differences of two";
}

std::string estimand_words(const RegisteredAnalysis& analysis) {
  if (is_of_thresholds(analysis.estimand)) return threshold_words(analysis);
  if (analysis.estimand == Estimand::mean_accuracy) {
    return "mean over participants of the share of right answers, against chance";
  }
  const std::string of =
      analysis.methods.empty()
          ? " with the first method less that with the second"
          : " with " + analysis.methods[0] + " less that with " + analysis.methods[1];
  return "mean over participants of the accuracy" + of;
}

std::string name_in_words(RegisteredTest test) {
  using enum RegisteredTest;
  static constexpr auto kNames = std::to_array<Named<RegisteredTest>>(
      {{"exact sign flips over participants", sign_flip},
       {"period-adjusted t test over participants (period differences compared between the "
        "two "
        "orders of methods), checked by a permutation of orders within the blocks in which "
        "they were dealt",
        crossover},
       {"Student's t test over participants", t}});
  return std::string(name_in(kNames, test));
}

std::string test_words(const RegisteredAnalysis& analysis) {
  if (analysis.estimand == Estimand::mean_threshold) return "none: an estimate with its interval";
  if (analysis.estimand == Estimand::threshold_equality) {
    return name_in_words(analysis.test) +
           ", two one-sided for every difference, all of which must reject";
  }
  return name_in_words(analysis.test) + (analysis.one_sided ? ", one-sided" : ", two-sided");
}

std::string looks_words(const RegisteredAnalysis& analysis) {
  if (analysis.looks.empty()) return "none";
  std::vector<std::string> looks;
  for (const int look : analysis.looks) looks.push_back(std::to_string(look));
  return "at " + listed(looks, " and ") + " participants; levels by Lan and DeMets, spending of " +
         (analysis.spending == Spending::pocock ? "Pocock's" : "O'Brien and Fleming's") + " kind";
}

std::string rules_words(const ExclusionRules& rules) {
  std::vector<std::string> words = rules.deviations;
  for (std::string& code : words) code = "a deviation " + in_quotes(code);
  if (rules.invalid_trials) {
    words.push_back("more than " + per_cent_text(*rules.invalid_trials) + " % of trials not valid");
  }
  if (rules.missed_catch) {
    words.push_back("more than " + counted(*rules.missed_catch, "missed catch trial"));
  }
  if (words.empty()) return "none, besides sessions stopped early and participants who withdrew";
  return "a session with " + listed(words, " or ") +
         "; besides sessions stopped early and participants who withdrew";
}

using Field = std::pair<std::string, std::string>;

Field margin_field(const RegisteredAnalysis& analysis) {
  const std::string level = per_cent_text(1.0 - 2.0 * analysis.alpha) + " %";
  if (is_of_thresholds(analysis.estimand)) {
    return {"margin", "the same if every difference is less than " + number_text(*analysis.margin) +
                          " dB either way; decided by the " + level +
                          " intervals; nothing follows if more than half of the participants have "
                          "no threshold at one of the standards"};
  }
  return {"margin", "as good if worse by less than " + per_cent_text(*analysis.margin) +
                        " points; decided by the " + level +
                        " t interval, and only if both methods are above chance"};
}

/// The margin, or what is worth having.
Field size_field(const RegisteredAnalysis& analysis) {
  if (analysis.margin) return margin_field(analysis);
  const auto worth = [&]() -> std::string {
    if (!analysis.smallest_effect) return "not stated";
    if (is_of_thresholds(analysis.estimand)) return number_text(*analysis.smallest_effect) + " dB";
    const bool accuracy = analysis.estimand == Estimand::mean_accuracy;
    return per_cent_text(*analysis.smallest_effect) + (accuracy ? " % right" : " points");
  };
  return {"smallest worth having", worth()};
}

}  // namespace

std::vector<std::pair<std::string, std::string>> fields_of(const Registration& registration) {
  if (!registration.analysis) return {};
  const RegisteredAnalysis& analysis = *registration.analysis;
  const Field size = size_field(analysis);
  std::vector<std::pair<std::string, std::string>> fields = {
      {"estimand", estimand_words(analysis)},
      {"test", test_words(analysis)},
      {"alpha", number_text(analysis.alpha)},
      size,
      {"interim looks", looks_words(analysis)},
      {"exclusion rules",
       analysis.exclusion_rules ? rules_words(*analysis.exclusion_rules) : "not stated"}};
  if (analysis.visits != RegisteredVisits::all) {
    const bool first = analysis.visits == RegisteredVisits::first;
    fields.emplace_back("visits", first ? "the first alone" : "the last alone");
  }
  return fields;
}

}  // namespace touchtrial::study
