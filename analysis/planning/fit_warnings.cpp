#include "analysis/planning/subject_fit.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <boost/math/distributions/chi_squared.hpp>
#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

constexpr double kHighCorrelation = 0.9;
constexpr double kMisfitLevel = 0.05;
constexpr double kGuessingLevel = 0.05;
constexpr double kLargeMonteCarloShare = 0.3;

/// Sums of confusions by presented and by answered class.
struct Margins {
  explicit Margins(std::size_t classes) : presented(classes, 0.0), answered(classes, 0.0) {}

  void add(const std::vector<std::vector<double>>& table) {
    for (std::size_t c = 0; c < table.size(); ++c) {
      for (std::size_t a = 0; a < table.size(); ++a) {
        presented[c] += table[c][a];
        answered[a] += table[c][a];
        total += table[c][a];
      }
      correct += table[c][c];
    }
  }

  std::vector<double> presented;
  std::vector<double> answered;
  double total = 0.0;
  double correct = 0.0;
};

/// Over all methods.
Margins margins_of(const SubjectFit& fit) {
  Margins margins(fit.classes.size());
  for (const auto& method : fit.observed) margins.add(method);
  return margins;
}

const ParameterEstimate* estimate_of(const SubjectFit& fit, std::string_view name) {
  const auto found = std::ranges::find(fit.estimates, name, &ParameterEstimate::name);
  return found == fit.estimates.end() ? nullptr : &*found;
}

void warn_of_extremes(const SubjectFit& fit, std::vector<std::string>& warnings) {
  const Margins margins = margins_of(fit);
  if (margins.correct == margins.total) {
    warnings.push_back(
        "every answer is right: noise and lapses have no lower limit, and the biases are "
        "arbitrary");
  }
  if (margins.correct == 0.0) {
    warnings.push_back(
        "no answer is right, which is worse than chance: noise and lapses cannot explain this; "
        "check the label swaps");
  }
}

/// Tests whether answers depend on what is presented, by method (Pearson's chi-square).
void warn_of_guessing(const SubjectFit& fit, std::vector<std::string>& warnings) {
  double chi_square = 0.0;
  int freedom = 0;
  for (const auto& method : fit.observed) {
    Margins margins(method.size());
    margins.add(method);
    for (std::size_t c = 0; c < method.size(); ++c) {
      for (std::size_t a = 0; a < method.size(); ++a) {
        const double expected =
            margins.total > 0.0 ? margins.presented[c] * margins.answered[a] / margins.total : 0.0;
        if (expected > 0.0) chi_square += std::pow(method[c][a] - expected, 2) / expected;
      }
    }
    const auto is_positive = [](double count) { return count > 0.0; };
    const auto rows = static_cast<int>(std::ranges::count_if(margins.presented, is_positive));
    const auto columns = static_cast<int>(std::ranges::count_if(margins.answered, is_positive));
    freedom += std::max(0, rows - 1) * std::max(0, columns - 1);
  }
  if (freedom > 0) {
    const boost::math::chi_squared_distribution<> distribution(freedom);
    const double p = boost::math::cdf(boost::math::complement(distribution, chi_square));
    if (p <= kGuessingLevel) return;
  }
  warnings.push_back(
      "the answers cannot be distinguished from guessing: they do not depend on the stimulus "
      "beyond chance; noise and lapses have no upper limit");
}

/// Warns if people differ more, or less, than in the subject model.
void warn_of_spread(const SubjectFit& fit, std::vector<std::string>& warnings) {
  if (!fit.people || fit.people->assumed_p > kMisfitLevel) return;
  const std::string difference = fmt::format(
      "participants differ {} than in the subject model (spread of noise {:.2f}, p = {:.3g})",
      fit.people->spread > fit.assumed_spread ? "more" : "less", fit.assumed_spread,
      fit.people->assumed_p);
  warnings.push_back(
      fit.spread_replaced
          ? difference + fmt::format(": everything was fitted with the estimated spread, {:.2f}",
                                     fit.people->spread)
          : difference + ": the fit does not describe these people; leave out --fix spread");
}

void warn_of_classes(const SubjectFit& fit, std::vector<std::string>& warnings) {
  const Margins margins = margins_of(fit);
  for (std::size_t c = 0; c < fit.classes.size(); ++c) {
    if (margins.presented[c] == 0.0) {
      warnings.push_back(fmt::format(
          "\"{}\" was never presented: its confusions come only from the model", fit.classes[c]));
    }
    if (margins.answered[c] == 0.0) {
      warnings.push_back(fmt::format("\"{}\" was never answered: the bias against it has no limit",
                                     fit.classes[c]));
    }
  }
}

std::string name_of(const ParameterEstimate& one) {
  return one.label.empty() ? one.name : "the bias of \"" + one.label + "\"";
}

/// Adds one line for all open ends.
void warn_of_open_ends(const SubjectFit& fit, std::vector<std::string>& warnings) {
  std::string names;
  for (const ParameterEstimate& one : fit.estimates) {
    if (one.profile.lower && one.profile.upper) continue;
    names += (names.empty() ? "" : ", ") + name_of(one);
  }
  if (names.empty()) return;
  warnings.push_back("an end of the profile's interval was not found within the searched range: " +
                     names + "; the interval is open there");
}

void warn_of_weak_estimates(const SubjectFit& fit, std::vector<std::string>& warnings) {
  const auto r = fit.noise_lapse_correlation;
  if (r && std::abs(*r) > kHighCorrelation) {
    warnings.push_back(
        fmt::format("noise and lapse can hardly be distinguished (their estimates correlate "
                    "{:.2f}): fix one of them with --fix",
                    *r));
  }
  for (const ParameterEstimate& one : fit.estimates) {
    const std::string name = name_of(one);
    if (!one.standard_error) {
      warnings.push_back(
          name + " cannot be separated from the others with these answers: fix it with --fix");
      continue;
    }
    const bool no_lapses = one.name == "lapse" && one.value == 0.0;
    if (one.at_bound && !no_lapses) {
      warnings.push_back(name + " is at an end of the searched range: the answers do not limit it");
    }
    if (one.monte_carlo_error > kLargeMonteCarloShare * *one.standard_error) {
      warnings.push_back(name + " depends on the sample of explorations: give more --explorations");
    }
  }
}

}  // namespace

std::string keys_ignored_by_fits(const simulation::SubjectModel& subject) {
  using simulation::Training;
  std::vector<std::string> keys;
  if (subject.training == Training::own) keys.emplace_back("training");
  if (subject.memory_noise > 0.0) keys.emplace_back("memory_noise");
  if (subject.learning.factor > 1.0) keys.emplace_back("learning");
  if (subject.period_noise_spread > 0.0) keys.emplace_back("period_noise_spread");
  if (subject.serial.is_on()) keys.emplace_back("serial");
  if (subject.fatigue.noise_per_min > 0.0 || subject.fatigue.lapse_per_min > 0.0) {
    keys.emplace_back("fatigue");
  }
  return fmt::format("{}", fmt::join(keys, ", "));
}

std::vector<std::string> fit_warnings(const FitCounts& counts, const SubjectFit& fit,
                                      const FreeParameters& free, const FreeParameters& used) {
  std::vector<std::string> warnings;
  if (counts.people.size() == 1) {
    warnings.push_back(
        "one participant: the fit describes this person, not differences between people");
  }
  if (free.position && !used.position) {
    warnings.push_back(
        "all participants had the pictures in the same order: a preference for positions cannot be "
        "separated from one for classes, and keeps the subject model's value");
  }
  warn_of_spread(fit, warnings);
  warn_of_extremes(fit, warnings);
  warn_of_guessing(fit, warnings);
  warn_of_classes(fit, warnings);
  warn_of_weak_estimates(fit, warnings);
  warn_of_open_ends(fit, warnings);
  if (const ParameterEstimate* lapse = estimate_of(fit, "lapse"); lapse && lapse->value == 0.0) {
    warnings.push_back(
        "the estimated lapse rate is 0, which is also the lower end of its interval");
  }
  if (counts.methods.size() > 1) {
    warnings.push_back(
        "noise, lapse and bias are assumed equal for all methods, which differ only in their "
        "textures");
  }
  if (const std::string ignored = keys_ignored_by_fits(fit.subject); !ignored.empty()) {
    warnings.push_back(
        "the fit assumes that all trials of a person are equivalent, and one training for "
        "everybody; it ignores the subject model's values of " +
        ignored + ", so the estimated noise is that of an average trial");
  }
  if (fit.p && *fit.p < kMisfitLevel) {
    warnings.push_back(
        fmt::format("the model does not fit the confusions (p = {:.3f}): its parameters do not "
                    "describe these answers",
                    *fit.p));
  }
  return warnings;
}

}  // namespace touchtrial::planning
