// Checks that the study file's "registration" is consistent with the study.
#include "core/text.hpp"
#include "study/protocol.hpp"
#include "study/study_sections.hpp"

#include <algorithm>
#include <span>

namespace touchtrial::study {
namespace {

/// The number of an item of the study's own day sheet: 3 of "no-day-sheet-3".
std::optional<int> day_sheet_item(std::string_view code) {
  const std::string beginning = "no-day-sheet-";
  if (!code.starts_with(beginning)) return std::nullopt;
  const std::optional<int> item = number_in<int>(code.substr(beginning.size()));
  const bool is_valid = item && *item > 0 && code == beginning + std::to_string(*item);
  return is_valid ? item : std::nullopt;
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
      file.refuse_below(place(i), in_quotes(methods[i]) +
                                      " is not the label of a method that the study presents");
    }
  }
  if (methods.size() == 2 && methods[0] == methods[1]) {
    file.refuse_below(place(1), "repeats the first method; name two different ones");
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
                      "tests a difference against 0, not against a margin; use \"crossover\" for "
                      "blocks by method, else \"t\"");
  }
}

/// Checks that the protocol can answer the registered question. The protocol itself checks the
/// standards.
void check_protocol(const JsonValue& file, const Study& study) {
  const Estimand estimand = study.registration.analysis->estimand;
  const std::span<const Estimand> supported = study.protocol->estimands;
  if (std::ranges::find(supported, estimand) != supported.end()) return;
  const std::string what =
      in_quotes(name_of(estimand)) + " is not supported by the protocol " + study.protocol_name();
  const char* const place = "/registration/estimand";
  if (supported.empty()) {
    file.refuse_below(place, what +
                                 "; remove the estimand with its keys, and describe the test in "
                                 "primary_test");
  }
  std::vector<std::string> names;
  for (const Estimand supported_estimand : supported)
    names.emplace_back(name_of(supported_estimand));
  file.refuse_below(place, what + "; use one of: " + listed(names));
}

void check_estimand(const JsonValue& file, const Study& study) {
  const RegisteredAnalysis& analysis = *study.registration.analysis;
  const char* const place = "/registration/estimand";
  if (is_threshold_estimand(analysis.estimand)) {
    if (analysis.test == RegisteredTest::t) return;
    file.refuse_below("/registration/test",
                      "does not apply to thresholds; use \"t\", or remove it");
  }
  const bool has_several_methods = study.presented_methods() > 1;
  if (analysis.estimand == Estimand::difference) {
    if (!has_several_methods) {
      file.refuse_below(place,
                        "is a difference of methods, but the study presents only one; use "
                        "\"mean-accuracy\"");
    }
    check_methods(file, study);
    if (analysis.test == RegisteredTest::crossover) check_crossover(file, study);
    return;
  }
  if (has_several_methods) {
    file.refuse_below(place,
                      "is the accuracy with one method, but the study compares several; use "
                      "\"difference\"");
  }
  if (!analysis.methods.empty()) {
    file.refuse_below("/registration/methods", "belongs to a difference; remove it");
  }
  if (analysis.test != RegisteredTest::t) {
    file.refuse_below("/registration/test",
                      "tests a difference, but the study does not compare methods; use \"t\"");
  }
  const double chance = 1.0 / static_cast<double>(choices_of(study).size());
  if (analysis.smallest_effect && *analysis.smallest_effect <= chance) {
    file.refuse_below("/registration/smallest_effect",
                      "is " + number_text(*analysis.smallest_effect) +
                          ", not above chance, which is " + number_text(chance) +
                          "; give the smallest accuracy of interest");
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
                      "refers to item " + std::to_string(*item) + " of \"day_sheet\", which has " +
                          std::to_string(items) + "; name an existing item, or add this one");
  }
}

/// Checks that a session has more catch trials than the limit.
void check_missed_catch(const JsonValue& file, const Study& study) {
  const auto& rules = study.registration.analysis->exclusion_rules;
  if (!rules || !rules->missed_catch) return;
  const char* const place = "/registration/exclusion_rules/missed_catch";
  const int trials = study.task->answered_catches(study);
  if (trials == 0) {
    file.refuse_below(place,
                      "needs catch trials with a right answer, but the study has none; remove it");
  }
  if (*rules->missed_catch >= trials) {
    file.refuse_below(place, "is " + std::to_string(*rules->missed_catch) + ", but a session has " +
                                 counted(trials, "catch trial") +
                                 ", so nobody can miss more; lower it, or remove it");
  }
}

void check_looks(const JsonValue& file, const Registration& registration) {
  const std::vector<int>& looks = registration.analysis->looks;
  if (looks.empty() || looks.back() < registration.participants) return;
  const char* const place = "/registration/looks";
  if (registration.participants == 0) {
    file.refuse_below(place, "needs \"participants\"; state the planned number");
  }
  file.refuse_below(place, "has a look at " + std::to_string(looks.back()) + " participants, but " +
                               std::to_string(registration.participants) +
                               " are planned; choose earlier looks, or raise \"participants\"");
}

}  // namespace

void check_registration(const JsonValue& file, const Study& study) {
  const Registration& registration = study.registration;
  if (!registration.analysis) return;
  check_protocol(file, study);
  check_estimand(file, study);
  check_margin(file, *registration.analysis);
  if (registration.analysis->visits != RegisteredVisits::all) {
    const char* const place = "/registration/visits";
    if (study.visits.count < 2) {
      file.refuse_below(place, "selects a visit, but the study has only one; remove it");
    }
    if (study.visits.methods == VisitMethods::divided) {
      file.refuse_below(place, "must be \"all\", because each visit presents different methods");
    }
  }
  check_looks(file, registration);
  check_day_sheet(file, study);
  check_missed_catch(file, study);
}

}  // namespace touchtrial::study
