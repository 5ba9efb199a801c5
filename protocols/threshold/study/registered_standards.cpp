#include "protocols/threshold/study/registered_standards.hpp"

#include "protocols/threshold/study/threshold.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace touchtrial::study::threshold {
namespace {

constexpr const char* kPlace = "/registration/standards";

std::string standards_in_words(const Study& study) {
  std::vector<std::string> words;
  for (const Standard& one : standards_of(study)) words.push_back(words_of(study, one));
  return fmt::format("{}", fmt::join(words, "; "));
}

bool matches_name(const Study& study, const Standard& standard, const RegisteredStandard& name) {
  constexpr double kRounding = 1e-9;
  const std::string& label = study.classes[static_cast<std::size_t>(standard.class_index)].label;
  return (name.label.empty() || name.label == label) &&
         (!name.value || std::abs(*name.value - standard.value) < kRounding);
}

/// Indices of the standards that match a registered one.
std::vector<std::size_t> matching_standards(const Study& study, const RegisteredStandard& name) {
  const std::vector<Standard> standards = standards_of(study);
  std::vector<std::size_t> matches;
  for (std::size_t i = 0; i < standards.size(); ++i) {
    if (matches_name(study, standards[i], name)) matches.push_back(i);
  }
  return matches;
}

void require_names(const JsonValue& file, const Study& study) {
  const std::vector<RegisteredStandard>& names = study.registration.analysis->standards;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string place = fmt::format("{}/{}", kPlace, i);
    const std::vector<std::size_t> matches = matching_standards(study, names[i]);
    if (matches.empty()) {
      file.refuse_below(place,
                        "is not a standard of the study; use one of: " + standards_in_words(study));
    }
    if (matches.size() > 1) {
      file.refuse_below(place,
                        fmt::format("matches {} standards; give class and value of one of: {}",
                                    matches.size(), standards_in_words(study)));
    }
    if (std::ranges::find(indices, matches.front()) != indices.end()) {
      file.refuse_below(place, "repeats a standard; name each once");
    }
    indices.push_back(matches.front());
  }
}

void require_number(const JsonValue& file, const Study& study) {
  const Estimand estimand = study.registration.analysis->estimand;
  const std::size_t number = registered_standards(study).size();
  const std::string remedy =
      fmt::format("; name the standards in \"standards\", of: {}", standards_in_words(study));
  const auto refuse = [&](const char* needs) {
    const bool has_names = !study.registration.analysis->standards.empty();
    file.refuse_below(has_names ? kPlace : "/registration/estimand",
                      fmt::format("needs {}, but {} {}{}", needs,
                                  has_names ? "it names" : "the study has", number, remedy));
  };
  if (estimand == Estimand::mean_threshold && number != 1) refuse("one standard");
  if (estimand == Estimand::threshold_difference && number != 2) refuse("two standards");
  if (estimand == Estimand::threshold_equality && number < 2) refuse("two standards or more");
}

}  // namespace

void check_registered(const JsonValue& file, const Study& study) {
  const auto& analysis = study.registration.analysis;
  if (!analysis || !is_threshold_estimand(analysis->estimand)) return;
  if (options_of(study).question == Question::same_different) {
    file.refuse_below(
        "/registration/estimand",
        "needs thresholds, which the question \"same-different\" does not give; remove "
        "the estimand with its keys, and describe the test in primary_test");
  }
  require_names(file, study);
  require_number(file, study);
}

std::vector<std::size_t> registered_standards(const Study& study) {
  const std::vector<RegisteredStandard>& names = study.registration.analysis->standards;
  std::vector<std::size_t> indices;
  for (const RegisteredStandard& name : names)
    indices.push_back(matching_standards(study, name).front());
  if (!indices.empty()) return indices;
  indices.resize(standards_of(study).size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  return indices;
}

}  // namespace touchtrial::study::threshold
