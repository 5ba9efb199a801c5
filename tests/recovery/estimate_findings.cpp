#include "analysis/statistics/choice_model.hpp"
#include "analysis/statistics/confusion.hpp"
#include "analysis/statistics/d_prime.hpp"
#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/information_transfer.hpp"
#include "recovery/finding.hpp"
#include "recovery/population.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace touchtrial::recovery {
namespace {

/// Adds lines for the bias of information transfer of one participant, with `repeats` presentations
/// of each class.
void add_information(double d_prime, int repeats, int repetitions, std::vector<Finding>& findings) {
  const Population people{.d_prime = d_prime, .repeats = repeats};
  const double truth = true_information(people);
  const int n = people.classes * repeats;
  const std::string who = fmt::format("{} trials, d' {} ({:.1f} % right, {:.2f} bit)", n, d_prime,
                                      100.0 * true_accuracy(people), truth);
  const auto estimate = [&](auto statistic) {
    return average_of(repetitions, "information" + who, [&](RandomStream& random) {
      const auto study = study_of(people, 1, random);
      return statistic(analysis::information_transfer(people.classes, study, 0, 20)) - truth;
    });
  };
  const double miller = std::pow(people.classes - 1, 2) / (2.0 * n * std::numbers::ln2);
  const Average raw =
      estimate([](const analysis::InformationTransfer& it) { return it.raw.value_or(0.0); });
  findings.push_back({"bias", "information transfer, raw, bit", who, 0.0, raw.mean,
                      raw.standard_error, 0.3 * miller, 1.5 * miller,
                      "upward; smaller where many cells stay empty"});
  const Average corrected =
      estimate([](const analysis::InformationTransfer& it) { return it.corrected.value_or(0.0); });
  findings.push_back({"bias", "information transfer, Miller-Madow, bit", who, 0.0, corrected.mean,
                      corrected.standard_error, raw.mean - miller, raw.mean - miller,
                      "a first-order correction: too much where cells stay empty"});
}

void add_null(int repetitions, std::vector<Finding>& findings) {
  const Population guessing{.d_prime = 0.0};
  const Average difference = average_of(repetitions, "null", [&](RandomStream& random) {
    const auto study = study_of(guessing, 1, random);
    const analysis::InformationTransfer it =
        analysis::information_transfer(guessing.classes, study, 0, 100);
    return it.raw.value_or(0.0) - it.null_mean.value_or(0.0);
  });
  findings.push_back({"bias", "raw less its permutation null, bit", "25 trials at chance", 0.0,
                      difference.mean, difference.standard_error, 0.0, 0.0, ""});
}

void add_d_prime(int repetitions, std::vector<Finding>& findings) {
  const Population people{.d_prime = 1.75, .repeats = 100};
  const Average found = average_of(repetitions, "d' of many", [&](RandomStream& random) {
    return d_prime(accuracies(study_of(people, 1, random)).front(), people.classes)
        .estimate.value_or(0.0);
  });
  findings.push_back({"recovered", "nominal d'", "500 trials, d' 1.75", people.d_prime, found.mean,
                      found.standard_error, people.d_prime, people.d_prime + 0.005,
                      "curvature of the inverse"});
}

void add_biased_d_prime(int repetitions, std::vector<Finding>& findings) {
  const Population people{.d_prime = 1.75, .bias = {0.8, 0.3, 0.0, -0.3, -0.8}, .repeats = 100};
  const Average found = average_of(repetitions, "d' with bias", [&](RandomStream& random) {
    return d_prime(accuracies(study_of(people, 1, random)).front(), people.classes)
        .estimate.value_or(0.0);
  });
  findings.push_back({"recovered", "nominal d' of people with a bias",
                      "500 trials, d' 1.75, bias 0.8 to -0.8", people.d_prime, found.mean,
                      found.standard_error, 1.2, 1.7,
                      "nominal: a preference for answers looks like less sensitivity"});
}

void add_accuracy(const Population& people, const std::string& who, int repetitions,
                  std::vector<Finding>& findings) {
  const double truth = true_accuracy(people);
  const Average found = average_of(repetitions, "accuracy" + who, [&](RandomStream& random) {
    const auto right = accuracies(study_of(people, 12, random));
    return analysis::participant_mean(shares(right)).mean.value_or(0.0);
  });
  findings.push_back({"recovered", "mean accuracy", who, truth, found.mean, found.standard_error,
                      truth, truth, ""});
}

void add_swapped(int repetitions, std::vector<Finding>& findings) {
  const Population swapped{.d_prime = 3.0, .swaps_first_two = true};
  const double unswapped = true_accuracy({.d_prime = 3.0});
  const Average found = average_of(repetitions, "swapped", [&](RandomStream& random) {
    const analysis::ConfusionMatrix confusion =
        confusion_of(swapped.classes, study_of(swapped, 1, random));
    return analysis::best_label_matching(confusion).accuracy.share().value_or(0.0);
  });
  findings.push_back({"recovered", "best matching of swapped labels",
                      fmt::format("25 trials, d' 3, two labels swapped ({:.1f} % right)",
                                  100.0 * true_accuracy(swapped)),
                      unswapped, found.mean, found.standard_error, unswapped, unswapped, ""});
}

/// Tests of the model's fit where it holds for everybody.
/// \param of_each  presentations of each class, of all participants
/// \param taste  SD of participants' log biases
void add_fit(int of_each, int participants, double taste, int repetitions,
             std::vector<Finding>& findings) {
  constexpr int kDraws = 199;
  const std::string who = fmt::format(
      "{} trials of a similarity choice model, {}{}", 5 * of_each,
      participants == 1 ? "one participant" : fmt::format("{} participants", participants),
      taste > 0.0 ? fmt::format(" with likings of SD {}", taste) : "");
  const auto rate = [&](bool drawn) {
    return average_of(repetitions, "choice fit" + who, [&](RandomStream& random) {
      analysis::ConfusionMatrix all(5);
      for (int person = 0; person < participants; ++person) {
        std::vector<double> bias = luce_bias();
        for (double& one : bias) one *= std::exp(taste * random.normal());
        add_answers(luce_probabilities(bias), of_each / participants, random, all);
      }
      const auto model = analysis::choice_model(all);
      if (!model) return 0.0;
      const auto p = drawn ? analysis::choice_model_p(*model, kDraws) : model->p;
      return p.value_or(1.0) <= 0.05 ? 1.0 : 0.0;
    });
  };
  const Average chi_square = rate(false);
  findings.push_back({"type-I error", "choice model, goodness of fit, chi-square", who, 0.05,
                      chi_square.mean, chi_square.standard_error, 0.02, 0.12,
                      "chi-square is an approximation"});
  const Average by_draws = rate(true);
  findings.push_back({"type-I error", "choice model, goodness of fit, drawn tables", who, 0.05,
                      by_draws.mean, by_draws.standard_error, taste > 0.0 ? 0.01 : 0.035, 0.065,
                      taste > 0.0 ? "people who differ vary less together than one would"
                                  : "drawn from the estimates"});
}

void add_choice_model(int repetitions, std::vector<Finding>& findings) {
  const Plane<double> p = luce_probabilities(luce_bias());
  const auto add = [&](const std::string& what, double truth, auto statistic) {
    const Average found = average_of(repetitions, "choice" + what, [&](RandomStream& random) {
      const auto model = analysis::choice_model(answers_with(p, 400, random));
      return model ? statistic(*model) : 0.0;
    });
    findings.push_back({"recovered", what, "2,000 trials of a similarity choice model", truth,
                        found.mean, found.standard_error, 0.99 * truth, 1.02 * truth,
                        "ratios of counts are biased a little"});
  };
  add("similarity of two classes", 0.3,
      [](const analysis::ChoiceModel& m) { return m.similarity.at(0, 1); });
  add("similarity of two others", 0.1,
      [](const analysis::ChoiceModel& m) { return m.similarity.at(2, 4); });
  add("bias for the first answer", 0.3, [](const analysis::ChoiceModel& m) { return m.bias[0]; });
  add_fit(400, 1, 0.0, repetitions / 4, findings);
  add_fit(100, 20, 0.0, repetitions / 4, findings);
  add_fit(100, 20, 0.5, repetitions / 4, findings);
}

}  // namespace

std::vector<Finding> estimate_findings(int repetitions) {
  std::vector<Finding> findings;
  for (const int repeats : {5, 25, 100}) {
    for (const double d_prime : {0.0, 1.75, 2.6}) {
      add_information(d_prime, repeats, repetitions / (repeats > 25 ? 4 : 1), findings);
    }
  }
  add_null(repetitions, findings);
  add_d_prime(repetitions, findings);
  add_biased_d_prime(repetitions, findings);
  add_accuracy({.d_prime = 2.0, .spread = 0.5}, "12 participants, d' 2 (SD 0.5)", repetitions,
               findings);
  add_accuracy({.d_prime = 2.0, .lapse = 0.1}, "12 participants, d' 2, lapse 0.1", repetitions,
               findings);
  add_accuracy({.d_prime = 1.5, .bias = {0.8, 0.3, 0.0, -0.3, -0.8}},
               "12 participants, d' 1.5, bias 0.8 to -0.8", repetitions, findings);
  add_swapped(repetitions, findings);
  add_choice_model(repetitions, findings);
  return findings;
}

}  // namespace touchtrial::recovery
