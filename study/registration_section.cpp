/// \file Describes the study file's "registration".
#include "core/text.hpp"
#include "study/deviation_codes.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <span>

namespace touchtrial::study {
namespace {

constexpr int kMaxParticipants = 100'000;
constexpr std::size_t kMaxCodes = 64;
constexpr std::size_t kMaxCodeBytes = 64;
constexpr NumberRange kShare{.low = 0.0, .high = 1.0, .open_low = true};
constexpr NumberRange kDecibels{0.0, 200.0, true};
constexpr double kMinAlpha = 1e-6;

constexpr TextRule kStatement = kParagraphs<4000>;

constexpr TextRule kDeviation{
    .check =
        [](const JsonValue& place) {
          if (is_deviation_code(read_line(place, kMaxCodeBytes))) return;
          place.refuse("is not a code that the program records; use one of " +
                       listed(kDeviationCodes) +
                       " and no-day-sheet-1, .., or list a code that experimenters enter under "
                       "\"own_deviations\"");
        },
    .min_length = 1,
    .max_length = kMaxCodeBytes};

/// Describes a list of deviation codes.
void describe_codes(ObjectIo& io, std::string_view key, const TextRule& rule, bool is_written,
                    std::vector<std::string>& codes, std::string_view meaning) {
  io.list(key, codes, {.max = kMaxCodes},
          {.meaning = meaning, .written = is_written, .range = "up to 64 codes"},
          [&rule](ValueIo& value, std::string& code) { value.text(code, rule); });
}

void describe_exclusion_rules(ObjectIo& io, ExclusionRules& rules) {
  const auto first_custom = std::ranges::find_if_not(rules.deviations, is_deviation_code);
  std::vector<std::string> built_in(rules.deviations.begin(), first_custom);
  std::vector<std::string> custom(first_custom, rules.deviations.end());
  describe_codes(io, "deviations", kDeviation, true, built_in,
                 "a session with one of these [deviations](data-dictionary.md) is excluded; only "
                 "codes that the program records are accepted");
  describe_codes(
      io, "own_deviations", kLine<kMaxCodeBytes>, !custom.empty(), custom,
      "a session with one of these custom codes is excluded; experimenters enter them during "
      "a session or with `note --deviation`");
  rules.deviations = built_in;
  rules.deviations.insert(rules.deviations.end(), custom.begin(), custom.end());
  std::stable_partition(rules.deviations.begin(), rules.deviations.end(), is_deviation_code);
  io.number("invalid_trials", rules.invalid_trials, {.low = 0.0, .high = 1.0},
            {"a session with a larger share of invalid trials is excluded"});
  io.optional(
      "missed_catch", rules.missed_catch,
      {.meaning = "a session with more wrong catch trials is excluded, in protocols whose catch "
                  "trials have a right answer (thresholds). This is known only after unblinding, "
                  "so the report excludes it from the registered question automatically",
       .range = "0 to 1,000, below the catch trials of a session"},
      [](ValueIo& value, int& trials) { value.integer(trials, 0, 1000); });
}

void describe_standard(ObjectIo& io, RegisteredStandard& standard) {
  std::optional<std::string> label;
  if (!standard.label.empty()) label = standard.label;
  io.optional("class", label, {"label of a class; can be omitted if the study has only one"},
              [](ValueIo& value, std::string& text) { value.text(text, kPlainName); });
  standard.label = label.value_or("");
  io.number("value", standard.value, {-200.0, 200.0},
            {"one of the study's `standards`; can be omitted if there is only one"});
}

constexpr std::string_view kAnalysisKeys[] = {
    "methods",         "standards", "test",           "sides",    "alpha",
    "smallest_effect", "margin",    "looks",          "spending", "smallest_effect_db",
    "margin_db",       "visits",    "exclusion_rules"};

/// Keys that apply only to some estimands.
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

/// Refuses keys that do not apply to the estimand.
void check_keys(const JsonObject& object, Estimand estimand) {
  const std::string suffix = ", not to \"" + std::string(name_of(estimand)) + "\"; remove it";
  if (!is_threshold_estimand(estimand)) {
    return refuse_keys(object, kKeysOfThresholds, "applies to thresholds" + suffix);
  }
  refuse_keys(object, kKeysOfAccuracies, "applies to right answers" + suffix);
  if (estimand == Estimand::mean_threshold) {
    return refuse_keys(
        object, kKeysOfTests,
        "belongs to a test, which the estimate \"mean-threshold\" does not have; remove it");
  }
  const auto refuse = [&](const char* key, const char* what) {
    if (const auto member = object.find(key)) member->refuse(what);
  };
  if (estimand == Estimand::threshold_difference) {
    return refuse("margin_db",
                  "belongs to \"threshold-equality\"; remove it, or register that estimand");
  }
  refuse("sides",
         "does not apply to an equality, which is tested by two one-sided tests; remove it");
  refuse("smallest_effect_db",
         "does not apply to an equality, which needs \"margin_db\"; remove it");
  static_cast<void>(object.at("margin_db"));
}

/// The default analysis of an estimand. Sign flips test against 0, so a margin needs a t test.
RegisteredAnalysis default_analysis(Estimand estimand, bool has_margin,
                                    RegisteredTest default_test) {
  RegisteredAnalysis analysis;
  analysis.estimand = estimand;
  if (estimand == Estimand::mean_accuracy) return analysis;
  if (is_threshold_estimand(estimand)) {
    analysis.one_sided = estimand == Estimand::threshold_equality;
    return analysis;
  }
  analysis.test =
      has_margin && default_test == RegisteredTest::sign_flip ? RegisteredTest::t : default_test;
  analysis.one_sided = has_margin;
  return analysis;
}

/// Describes a number that has one key for accuracies and another for thresholds.
void describe_size(ObjectIo& io, std::string_view key, std::optional<double>& size,
                   const NumberRange& range, bool applies, const KeyInfo& info) {
  std::optional<double> value = applies ? size : std::nullopt;
  io.number(key, value, range, info);
  if (value) size = value;
}

void describe_sizes(ObjectIo& io, RegisteredAnalysis& analysis) {
  const bool is_threshold = is_threshold_estimand(analysis.estimand);
  describe_size(io, "smallest_effect", analysis.smallest_effect, kShare, !is_threshold,
                {"smallest effect of interest: an accuracy above chance (0.4: 40 % right), or a "
                 "difference (0.07: 7 points)"});
  describe_size(
      io, "margin", analysis.margin, kShare, !is_threshold,
      {"margin of a difference, instead of `smallest_effect`: the first method is as good as the "
       "second if it is worse by less than this "
       "([non-inferiority](statistics.md#as-good-by-a-margin)); one-sided, by `t` or `crossover`"});
  describe_size(io, "smallest_effect_db", analysis.smallest_effect, kDecibels, is_threshold,
                {"for `threshold-difference`: smallest difference of interest"});
  describe_size(io, "margin_db", analysis.margin, kDecibels, is_threshold,
                {.meaning = "required for `threshold-equality`: thresholds are equal if every "
                            "pairwise difference is smaller than this, in either direction",
                 .default_text = "none"});
}

/// Describes the test and its interim looks.
void describe_test(ObjectIo& io, RegisteredAnalysis& analysis) {
  const bool has_test = analysis.estimand != Estimand::mean_threshold;
  io.choice("test", analysis.test, kRegisteredTestNames,
            {.meaning = "Student's t test over participants, exact sign flips of a difference, or "
                        "the [period-adjusted t "
                        "test](statistics.md#two-methods-in-blocks) of two methods in "
                        "blocks",
             .written = has_test,
             .default_text = "`t`; for a difference `crossover` if two methods are in blocks, else "
                             "`sign-flip`, or `t` with a margin"});
  io.choice("sides", analysis.one_sided, kSidesNames,
            {.meaning = "one-sided, for larger values, or two-sided",
             .written = has_test && analysis.estimand != Estimand::threshold_equality,
             .default_text = "`one`; `two` for a difference without margin"});
  io.list("looks", analysis.looks, {.max = 20},
          {.meaning = "numbers of participants at which an interim analysis of the registered "
                      "question is allowed (`unblind --interim`), ascending, below `participants`",
           .written = has_test},
          [](ValueIo& value, int& look) { value.integer(look, 2, kMaxParticipants); });
  io.rule([&analysis](const JsonValue& place, const JsonObject& /*object*/) {
    const auto falling = std::ranges::adjacent_find(analysis.looks, std::greater_equal<>());
    if (falling == analysis.looks.end()) return;
    place.refuse_below("/looks/" + std::to_string(falling + 1 - analysis.looks.begin()),
                       "is not greater than the previous look; list looks in ascending order");
  });
  io.choice("spending", analysis.spending, kSpendingNames,
            {.meaning = "how alpha is spent over the looks (Lan and DeMets)", .written = has_test});
}

void describe_analysis(ObjectIo& io, RegisteredAnalysis& analysis) {
  const bool is_threshold = is_threshold_estimand(analysis.estimand);
  io.list("methods", analysis.methods, {.max = 2},
          {.meaning = "for a difference: the first minus the second",
           .written = !is_threshold,
           .default_text = "the study's two",
           .range = "none or two labels"},
          [](ValueIo& value, std::string& label) { value.text(label, kPlainName); });
  io.list("standards", analysis.standards, {.max = 64},
          {.meaning =
               "for thresholds: a difference is the first minus the second. `class` (label) or "
               "`value` (one of the study's `standards`) can be omitted if the study has only one",
           .written = is_threshold,
           .default_text = "all of the study",
           .range = "`class` and `value`"},
          [](ValueIo& value, RegisteredStandard& standard) {
            value.part(standard, describe_standard);
          });
  io.number("alpha", analysis.alpha, {.low = kMinAlpha, .high = 0.5},
            {"error rate of the test over all looks"});
  describe_sizes(io, analysis);
  describe_test(io, analysis);
  io.optional(
      "exclusion_rules", analysis.exclusion_rules,
      {"rules that exclude a session, in addition to sessions that were stopped and participants "
       "who withdrew"},
      [](ValueIo& value, ExclusionRules& rules) { value.part(rules, describe_exclusion_rules); });
  io.choice("visits", analysis.visits, kRegisteredVisitsNames,
            {.meaning = "in a study with several visits: the visits that enter the analysis. "
                        "`all`: accuracy is computed over all visits; `first`: every participant "
                        "with a complete first visit counts",
             .if_changed = true});
}

}  // namespace

RegisteredTest default_test_of(const Study& study) {
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

void describe(ObjectIo& io, Registration& registration, RegisteredTest default_test) {
  io.text("hypothesis", registration.hypothesis, kStatement,
          {"the expected result, stated so that data can contradict it"});
  io.integer("participants", registration.participants, 0, kMaxParticipants,
             {"planned number; 0: not stated"});
  io.text("stopping_rule", registration.stopping_rule, kStatement, {"when data collection ends"});
  io.text("exclusions", registration.exclusions, kStatement,
          {"who is excluded, in addition to the validity rule of trials"});
  io.text("primary_test", registration.primary_test, kStatement, {"the test of the hypothesis"});
  std::optional<Estimand> estimand;
  if (registration.analysis) estimand = registration.analysis->estimand;
  io.optional("estimand", estimand,
              {.meaning = "the estimated quantity: the mean accuracy over participants, against "
                          "chance; the mean difference between two methods; or, for "
                          "[thresholds](thresholds.md#the-registered-question), the mean at one "
                          "standard, the difference of two standards, or the equality of two or "
                          "more. Each protocol supports some of these; ratings support none",
               .default_text = "none"},
              [](ValueIo& value, Estimand& choice) { value.choice(choice, kEstimandNames); });
  io.rule([&](const JsonValue& /*place*/, const JsonObject& object) {
    if (!estimand) {
      return refuse_keys(object, kAnalysisKeys,
                         "needs \"estimand\"; state what is estimated, or remove this key");
    }
    check_keys(object, *estimand);
    registration.analysis =
        default_analysis(*estimand, object.find("margin").has_value(), default_test);
  });
  RegisteredAnalysis defaults;
  describe_analysis(io, registration.analysis ? *registration.analysis : defaults);
  io.integer("safety_record_years", registration.safety_record_years, 0, 100,
             {"years for which the safety record of a session is kept if the participant's data "
              "are erased (`withdraw --erase`); unencrypted in every database"});
}

nlohmann::json to_json(const Registration& registration) {
  Registration copy = registration;
  Registration defaults;
  defaults.analysis.emplace();
  nlohmann::json text =
      written_section([&](ObjectIo& io) { describe(io, copy, RegisteredTest::t); },
                      [&](ObjectIo& io) { describe(io, defaults, RegisteredTest::t); });
  if (!registration.analysis) {
    for (const std::string_view key : kAnalysisKeys) text.erase(std::string(key));
  }
  return text;
}

}  // namespace touchtrial::study
