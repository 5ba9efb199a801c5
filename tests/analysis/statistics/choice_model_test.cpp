#include "analysis/statistics/choice_model.hpp"

#include "analysis/confusion_of_counts.hpp"
#include "core/random.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <vector>

namespace touchtrial {
namespace {

using namespace analysis;
using Counts = std::vector<std::vector<int>>;

const Counts kFive{
    {18, 3, 1, 2, 1}, {5, 14, 2, 3, 1}, {1, 4, 16, 1, 3}, {2, 1, 2, 19, 1}, {1, 2, 5, 2, 15}};

/// The probability of answer j to class i, from the model's similarities and biases.
double probability(const ChoiceModel& model, int i, int j) {
  double all = 0.0;
  for (int k = 0; k < model.similarity.height(); ++k) {
    all += model.bias[k] * model.similarity.at(i, k);
  }
  return model.bias[j] * model.similarity.at(i, j) / all;
}

double row_sum(const Plane<double>& plane, int i) {
  double sum = 0.0;
  for (int j = 0; j < plane.width(); ++j) sum += plane.at(i, j);
  return sum;
}

double column_sum(const Plane<double>& plane, int j) {
  double sum = 0.0;
  for (int i = 0; i < plane.height(); ++i) sum += plane.at(i, j);
  return sum;
}

/// Checks a law of maximum likelihood in log-linear models: the margins stay the same.
void check_margins(const Counts& counts, const ChoiceModel& model) {
  const auto classes = static_cast<int>(counts.size());
  for (int i = 0; i < classes; ++i) {
    double row = 0.0;
    double column = 0.0;
    for (int j = 0; j < classes; ++j) {
      row += counts[i][j];
      column += counts[j][i];
      CHECK(model.expected.at(i, j) + model.expected.at(j, i) ==
            Approx(counts[i][j] + counts[j][i]).margin(1e-10));
    }
    CHECK(row_sum(model.expected, i) == Approx(row).epsilon(1e-10));
    CHECK(column_sum(model.expected, i) == Approx(column).epsilon(1e-10));
  }
}

}  // namespace

// Expected values: statsmodels 0.13, Poisson GLM of rows, columns and pairs off the diagonal.
TEST_CASE("choice_model gives the values of an independent implementation") {
  const ChoiceModel model = *analysis::choice_model(confusion_of_counts(kFive));
  CHECK(model.converged);
  CHECK(model.groups == 1);
  CHECK(model.expected.at(0, 0) == 18.0);
  CHECK(model.expected.at(0, 1) == Approx(3.461849499680184).margin(1e-9));
  CHECK(model.expected.at(1, 2) == Approx(3.00041279995542).margin(1e-9));
  CHECK(model.expected.at(4, 2) == Approx(4.841345155343281).margin(1e-9));
  CHECK(model.g_squared == Approx(2.3698257342773323).margin(1e-9));
  CHECK(model.degrees_of_freedom == 6);
  // SciPy 1.10, chi2.sf(2.3698257342773323, 6)
  CHECK(model.p.value() == Approx(0.8827).margin(5e-5));
}

TEST_CASE("choice_model keeps the margins, and its parameters make its expected counts") {
  const ChoiceModel model = *analysis::choice_model(confusion_of_counts(kFive));
  check_margins(kFive, model);
  double bias = 0.0;
  for (int i = 0; i < 5; ++i) {
    bias += model.bias[i];
    CHECK(model.similarity.at(i, i) == 1.0);
    for (int j = 0; j < 5; ++j) {
      CHECK(model.similarity.at(i, j) == Approx(model.similarity.at(j, i)));
      CHECK(25.0 * probability(model, i, j) == Approx(model.expected.at(i, j)).epsilon(1e-9));
    }
  }
  CHECK(bias == Approx(1.0));
}

TEST_CASE("choice_model recovers the similarities and biases behind the counts") {
  // Bias 1 : 2 : 4, similarity 1/2, 1/4, 1/4; rows scaled so that all counts are whole.
  const ChoiceModel model =
      *analysis::choice_model(confusion_of_counts({{4, 4, 4}, {2, 8, 4}, {1, 2, 16}}));
  CHECK(model.g_squared == Approx(0.0).margin(1e-9));
  CHECK(model.bias[0] == Approx(1.0 / 7.0).epsilon(1e-9));
  CHECK(model.bias[1] == Approx(2.0 / 7.0).epsilon(1e-9));
  CHECK(model.bias[2] == Approx(4.0 / 7.0).epsilon(1e-9));
  CHECK(model.similarity.at(0, 1) == Approx(0.5).epsilon(1e-9));
  CHECK(model.similarity.at(0, 2) == Approx(0.25).epsilon(1e-9));
  CHECK(model.similarity.at(1, 2) == Approx(0.25).epsilon(1e-9));
  CHECK(model.degrees_of_freedom == 1);
  CHECK(model.p.value() == Approx(1.0).margin(1e-4));
}

TEST_CASE("With two classes choice_model fits everything and tests nothing") {
  const ChoiceModel model = *analysis::choice_model(confusion_of_counts({{8, 2}, {4, 6}}));
  CHECK(model.converged);
  CHECK(model.degrees_of_freedom == 0);
  CHECK_FALSE(model.p.has_value());
  CHECK(model.g_squared == Approx(0.0).margin(1e-12));
  CHECK(model.similarity.at(0, 1) == Approx(std::sqrt(2.0 * 4.0 / (8.0 * 6.0))));
  CHECK(model.bias[0] / model.bias[1] == Approx(std::sqrt(8.0 * 4.0 / (2.0 * 6.0))));
}

TEST_CASE("Without wrong answers choice_model knows no similarity and compares no biases") {
  const ChoiceModel model =
      *analysis::choice_model(confusion_of_counts({{5, 0, 0}, {0, 5, 0}, {0, 0, 5}}));
  CHECK(model.converged);
  CHECK(model.groups == 3);
  CHECK(model.similarity.at(0, 1) == 0.0);
  CHECK(model.bias == std::vector<double>{1.0, 1.0, 1.0});
  CHECK(model.expected.at(1, 1) == 5.0);
  CHECK(model.degrees_of_freedom == 0);
  CHECK_FALSE(model.p.has_value());
}

TEST_CASE("Groups never taken for each other are fitted each on its own") {
  const Counts counts{{8, 2, 0, 0}, {4, 6, 0, 0}, {0, 0, 7, 3}, {0, 0, 1, 9}};
  const ChoiceModel model = *analysis::choice_model(confusion_of_counts(counts));
  CHECK(model.group == std::vector<int>{0, 0, 1, 1});
  CHECK(model.bias[0] + model.bias[1] == Approx(1.0));
  CHECK(model.bias[2] + model.bias[3] == Approx(1.0));
  CHECK(model.similarity.at(0, 2) == 0.0);
  CHECK(model.degrees_of_freedom == 0);
  check_margins(counts, model);
}

TEST_CASE("Where answers go one way only the maximum lies at infinity, and the counts are fitted") {
  // Class 2 is taken for others, nothing is ever taken for it.
  const Counts counts{{8, 2, 0}, {3, 7, 0}, {2, 1, 7}};
  const ChoiceModel model = *analysis::choice_model(confusion_of_counts(counts));
  CHECK(model.converged);
  CHECK(model.group == std::vector<int>{0, 0, 1});
  CHECK(model.expected.at(2, 0) == 2.0);
  CHECK(model.expected.at(0, 2) == 0.0);
  CHECK(std::isnan(model.similarity.at(2, 0)));
  CHECK(model.similarity.at(0, 1) == Approx(std::sqrt(2.0 * 3.0 / 56.0)));
  CHECK(model.bias[2] == 1.0);
  check_margins(counts, model);
}

TEST_CASE("A circle of wrong answers is one group although no pair goes both ways") {
  const Counts counts{{4, 3, 0}, {0, 4, 3}, {3, 0, 4}};
  const ChoiceModel model = *analysis::choice_model(confusion_of_counts(counts));
  CHECK(model.groups == 1);
  CHECK(model.expected.at(0, 1) == Approx(1.5));
  CHECK(model.expected.at(1, 0) == Approx(1.5));
  CHECK(model.bias[0] == Approx(1.0 / 3.0));
  CHECK(model.g_squared == Approx(2.0 * 9.0 * std::log(2.0)));
  check_margins(counts, model);
}

TEST_CASE("A class that was never answered right has neither similarities nor a bias") {
  const Counts counts{{8, 1, 1}, {3, 0, 7}, {2, 2, 6}};
  const ChoiceModel model = *analysis::choice_model(confusion_of_counts(counts));
  CHECK(std::isnan(model.similarity.at(0, 1)));
  CHECK(std::isnan(model.bias[1]));
  CHECK(model.bias[0] + model.bias[2] == Approx(1.0));
  CHECK(model.similarity.at(1, 1) == 1.0);
  check_margins(counts, model);
}

TEST_CASE("choice_model settles where one answer in thousands holds two groups together") {
  const Counts counts{{2000, 900, 1, 0}, {800, 2000, 0, 0}, {1, 0, 2000, 700}, {0, 0, 950, 2000}};
  const ChoiceModel model = *analysis::choice_model(confusion_of_counts(counts));
  CHECK(model.converged);
  check_margins(counts, model);
}

TEST_CASE("choice_model settles for any small table, its margins kept") {
  RandomStream random(10, "choice model test");
  int fitted = 0;
  for (int round = 0; round < 200; ++round) {
    const int classes = 2 + round % 5;
    Counts counts(classes, std::vector<int>(classes));
    for (int k = 0; k < 5 * classes; ++k) {
      const auto shown = static_cast<int>(random.below(classes));
      const bool feels = random.uniform() < 0.6;
      ++counts[shown][feels ? shown : static_cast<int>(random.below(classes))];
    }
    const std::optional<ChoiceModel> model = analysis::choice_model(confusion_of_counts(counts));
    if (!model) continue;
    ++fitted;
    CHECK(model->converged);
    check_margins(counts, *model);
    CHECK(model->degrees_of_freedom >= 0);
    CHECK(model->degrees_of_freedom <= (classes - 1) * (classes - 2) / 2);
    CHECK(model->g_squared >= 0.0);
  }
  CHECK(fitted > 100);
}

TEST_CASE("choice_model is nothing where a class was never presented or never answered") {
  CHECK_FALSE(analysis::choice_model(ConfusionMatrix(3)).has_value());
  CHECK_FALSE(analysis::choice_model(confusion_of_counts({{3, 2}, {0, 0}})).has_value());
  CHECK_FALSE(analysis::choice_model(confusion_of_counts({{3, 0}, {2, 0}})).has_value());
  ConfusionMatrix silent = confusion_of_counts({{3, 2}, {0, 0}});
  silent.add({1, {}});
  CHECK_FALSE(analysis::choice_model(silent).has_value());
}

TEST_CASE("a table that follows the choice model fits as well as any drawn one") {
  // Symmetric counts are quasi-symmetric: G squared is 0.
  const ChoiceModel model =
      *analysis::choice_model(confusion_of_counts({{9, 2, 3}, {2, 9, 1}, {3, 1, 9}}));
  CHECK(choice_model_p(model, 99) == 1.0);
}

TEST_CASE(
    "a table that no choice model gives fits worse than the drawn ones, always by the same p") {
  const ChoiceModel model =
      *analysis::choice_model(confusion_of_counts({{80, 40, 1}, {1, 80, 40}, {40, 1, 80}}));
  CHECK(choice_model_p(model, 99) == 0.01);
  const ChoiceModel five = *analysis::choice_model(confusion_of_counts(kFive));
  const double p = choice_model_p(five, 399).value();
  CHECK(p == choice_model_p(five, 399).value());
  // With 125 trials the two differ, but by little.
  CHECK(p == Approx(five.p.value()).margin(0.1));
  CHECK_FALSE(p == choice_model_p(five, 399, 1).value());
}

TEST_CASE("the p by drawn tables is that of tables drawn answer by answer") {
  constexpr int kDraws = 399;
  const ChoiceModel five = *analysis::choice_model(confusion_of_counts(kFive));
  RandomStream random(0, "choice model", 3);
  int as_bad = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    ConfusionMatrix drawn(5);
    for (int i = 0; i < 5; ++i) {
      const double all = row_sum(five.expected, i);
      for (int left_out = 0; left_out < 25; ++left_out) {
        double left = random.uniform() * all;
        int answer = 0;
        while (answer < 4 && left >= five.expected.at(i, answer)) {
          left -= five.expected.at(i, answer++);
        }
        drawn.add({i, answer});
      }
    }
    if (analysis::choice_model(drawn).value().g_squared >= five.g_squared - 1e-9) ++as_bad;
  }
  CHECK(choice_model_p(five, kDraws, 3) == (as_bad + 1.0) / (kDraws + 1.0));
}

TEST_CASE("without degrees of freedom nothing is drawn") {
  const ChoiceModel model = *analysis::choice_model(confusion_of_counts({{8, 2}, {4, 6}}));
  CHECK_FALSE(choice_model_p(model, 99).has_value());
  const ChoiceModel five = *analysis::choice_model(confusion_of_counts(kFive));
  CHECK_THROWS_AS(choice_model_p(five, 0), std::invalid_argument);
}

}  // namespace touchtrial
