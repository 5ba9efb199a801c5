// The report's numbers against the same ones computed here from the ratings themselves.
#include "analysis/exports/column_meanings.hpp"
#include "analysis/exports/trial_tables.hpp"
#include "analysis/report/results.hpp"
#include "protocols/rating/analysis/hand_made_ratings.hpp"
#include "protocols/rating/analysis/rating_analysis.hpp"
#include "protocols/rating/analysis/rating_model.hpp"
#include "protocols/rating/analysis/report.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

namespace touchtrial {
namespace {

namespace own = analysis::rating;
using nlohmann::json;

constexpr int kPeople = 4;
constexpr int kRepeats = 2;
/// Student's t at .975 with three degrees of freedom.
constexpr double kT3 = 3.182446305284263;

/// What person p says of class c by method m, the r-th time: on the line, and of seven points.
double on_line(int p, int c, int m, int r) {
  return 0.3 + 0.05 * p + 0.2 * (1 - m) + 0.1 * c + 0.02 * ((3 * p + 5 * c + 7 * m + 11 * r) % 5);
}
double on_points(int p, int c, int m, int r) {
  return 1.0 + (p + 2 * c + 3 * (1 - m) + r) % 7;
}
double in_catch_trials(int p) {
  return 0.05 + 0.01 * p;
}

HandMadeRatings four_people(const std::string& section = kTwoScales) {
  HandMadeRatings made(section);
  const bool two = section == kTwoScales;
  for (int p = 0; p < kPeople; ++p) {
    made.session();
    for (int r = 0; r < kRepeats; ++r) {
      for (int c = 0; c < 2; ++c) {
        for (int m = 0; m < 2; ++m) {
          std::vector<double> values{on_line(p, c, m, r)};
          if (two) values.push_back(on_points(p, c, m, r));
          made.rated(p + 1, c, m, values);
        }
      }
    }
    made.caught(p + 1, two ? std::vector<double>{in_catch_trials(p), 1.0}
                           : std::vector<double>{in_catch_trials(p)});
  }
  return made;
}

/// A person's mean of an item on the line.
double item_mean(int p, int c, int m) {
  return 0.5 * (on_line(p, c, m, 0) + on_line(p, c, m, 1));
}

double plain_mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double plain_sd(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += std::pow(value - plain_mean(values), 2);
  return std::sqrt(squares / (static_cast<double>(values.size()) - 1.0));
}

/// One number of each person.
std::vector<double> of_people(const std::function<double(int)>& number) {
  std::vector<double> all;
  for (int p = 0; p < kPeople; ++p) all.push_back(number(p));
  return all;
}

/// Checks mean, interval and SD over four people who lie well within the scale.
void check_mean(const json& found, const std::vector<double>& values, const char* name = "mean") {
  const double reach = kT3 * plain_sd(values) / 2.0;
  CHECK(found.at("participants") == 4);
  CHECK(found.at(name) == Approx(plain_mean(values)));
  CHECK(found.at("interval").at(0) == Approx(plain_mean(values) - reach));
  CHECK(found.at("interval").at(1) == Approx(plain_mean(values) + reach));
  CHECK(found.at("sd") == Approx(plain_sd(values)));
}

json json_of(const HandMadeRatings& made) {
  return json::parse(own::rating_analysis().results(made.outcomes, {})->json());
}

json fit_of(const HandMadeRatings& made) {
  return json_of(made).at("scales").at(0);
}

std::string said_by(const HandMadeRatings& made) {
  return said_in(own::rating_analysis().results(made.outcomes, {})->document({}, {}));
}

std::string warnings_of(const HandMadeRatings& made) {
  return json_of(made).at("warnings").dump();
}

std::size_t place_of(const analysis::DataTable& table, const std::string& name) {
  const auto found = std::ranges::find(table.columns, name);
  REQUIRE(found != table.columns.end());
  return static_cast<std::size_t>(found - table.columns.begin());
}

}  // namespace

TEST_CASE("a scale's means by item, method and class are those of the ratings") {
  const json scales = json_of(four_people()).at("scales");
  REQUIRE(scales.size() == 2);
  const json& fit = scales.at(0);
  CHECK(fit.at("id") == "fit");
  CHECK(fit.at("text") == "Do they fit?");
  CHECK(fit.at("low") == "not at all");
  CHECK(fit.at("points") == 0);
  CHECK(scales.at(1).at("points") == 7);
  REQUIRE(fit.at("items").size() == 4);
  const json& item = fit.at("items").at(2);
  CHECK(item.at("class") == "cloth");
  CHECK(item.at("method") == "adaptive");
  check_mean(item, of_people([](int p) { return item_mean(p, 1, 0); }));
  const json& method = fit.at("methods").at(1);
  CHECK(method.at("method") == "fixed");
  CHECK(method.at("items") == 2);
  check_mean(method,
             of_people([](int p) { return 0.5 * (item_mean(p, 0, 1) + item_mean(p, 1, 1)); }));
  const json& texture = fit.at("classes").at(0);
  CHECK(texture.at("class") == "bark");
  check_mean(texture,
             of_people([](int p) { return 0.5 * (item_mean(p, 0, 0) + item_mean(p, 0, 1)); }));
}

TEST_CASE("methods differ by the mean of people's own differences, tested by sign flips and t") {
  const json differences = fit_of(four_people()).at("differences");
  REQUIRE(differences.size() == 1);
  const json& pair = differences.at(0);
  CHECK(pair.at("first") == "adaptive");
  CHECK(pair.at("second") == "fixed");
  CHECK(pair.at("classes") == 2);
  const std::vector<double> own_differences = of_people([](int p) {
    return 0.5 *
           (item_mean(p, 0, 0) + item_mean(p, 1, 0) - item_mean(p, 0, 1) - item_mean(p, 1, 1));
  });
  check_mean(pair, own_differences, "difference");
  const double t = plain_mean(own_differences) / (plain_sd(own_differences) / 2.0);
  CHECK(pair.at("t") == Approx(t));
  int as_far = 0;
  for (int signs = 0; signs < 16; ++signs) {
    double sum = 0.0;
    for (int p = 0; p < kPeople; ++p) {
      sum += (signs >> p & 1 ? -1.0 : 1.0) * own_differences[static_cast<std::size_t>(p)];
    }
    as_far += std::abs(sum) >= 4.0 * std::abs(plain_mean(own_differences)) - 1e-9 ? 1 : 0;
  }
  CHECK(pair.at("p") == Approx(as_far / 16.0));
  CHECK(pair.at("p_holm") == pair.at("p"));
  CHECK(pair.at("t_p").get<double>() < 0.05);
  CHECK(pair.at("d_z").at("estimate") == Approx(t / 2.0));
  CHECK(pair.at("d_z").at("interval").at(0).get<double>() < t / 2.0);
  const json& jackknife = pair.at("d_z").at("jackknife");
  double without = 0.0;
  for (int left = 0; left < kPeople; ++left) {
    std::vector<double> others = own_differences;
    others.erase(others.begin() + left);
    without += plain_mean(others) / plain_sd(others) / 4.0;
  }
  CHECK(jackknife.at("estimate") == Approx(4.0 * (t / 2.0) - 3.0 * without));
}

TEST_CASE("agreement is of the two-way analysis of variance of people's means of items") {
  const json agreement = fit_of(four_people()).at("agreement");
  CHECK(agreement.at("items") == 4);
  CHECK(agreement.at("participants") == 4);
  CHECK(agreement.at("left_out") == 0);
  // Sums of squares from totals, not from deviations.
  double total = 0.0;
  double squares = 0.0;
  double of_items = 0.0;
  double of_persons = 0.0;
  for (int item = 0; item < 4; ++item) {
    const std::vector<double> row =
        of_people([item](int p) { return item_mean(p, item / 2, item % 2); });
    for (const double value : row) squares += value * value;
    total += 4.0 * plain_mean(row);
    of_items += 4.0 * std::pow(plain_mean(row), 2);
  }
  for (int p = 0; p < kPeople; ++p) {
    double sum = 0.0;
    for (int item = 0; item < 4; ++item) sum += item_mean(p, item / 2, item % 2);
    of_persons += sum * sum / 4.0;
  }
  const double correction = total * total / 16.0;
  const double items = (of_items - correction) / 3.0;
  const double people = (of_persons - correction) / 3.0;
  const double rest = (squares - of_items - of_persons + correction) / 9.0;
  CHECK(agreement.at("mean_squares").at("items") == Approx(items));
  CHECK(agreement.at("mean_squares").at("participants") == Approx(people));
  CHECK(agreement.at("mean_squares").at("residual") == Approx(rest));
  const double single = (items - rest) / (items + 3.0 * rest + 4.0 * (people - rest) / 4.0);
  CHECK(agreement.at("single").at("estimate") == Approx(single));
  CHECK(agreement.at("average").at("estimate") == Approx(4.0 * single / (1.0 + 3.0 * single)));
  CHECK(agreement.at("single").at("interval").at(0).get<double>() < single);
  CHECK(agreement.at("single").at("interval").at(1).get<double>() > single);
}

TEST_CASE("repeats of people correlate within items, and their use of the scale is counted") {
  const json fit = fit_of(four_people());
  std::vector<double> correlations;
  for (int p = 0; p < kPeople; ++p) {
    std::vector<double> means;
    std::vector<double> all;
    double within = 0.0;
    for (int item = 0; item < 4; ++item) {
      const double first = on_line(p, item / 2, item % 2, 0);
      const double second = on_line(p, item / 2, item % 2, 1);
      means.push_back(0.5 * (first + second));
      all.insert(all.end(), {first, second});
      within += std::pow(first - second, 2) / 2.0 / 4.0;
    }
    const double between = 2.0 * std::pow(plain_sd(means), 2);
    correlations.push_back((between - within) / (between + within));
    const json& use = fit.at("use").at("participants").at(static_cast<std::size_t>(p));
    CHECK(use.at("participant") == "P" + std::to_string(p + 1));
    CHECK(use.at("n") == 8);
    CHECK(use.at("at_low") == 0);
    CHECK(use.at("mean") == Approx(plain_mean(all)));
    CHECK(use.at("sd") == Approx(plain_sd(all)));
    CHECK(use.at("narrow") == false);
    CHECK(use.at("retest") == Approx(correlations.back()));
  }
  double z = 0.0;
  for (const double one : correlations) z += std::atanh(std::min(one, 0.99)) / kPeople;
  CHECK(fit.at("retest").at("mean") == Approx(std::tanh(z)));
  CHECK(fit.at("retest").at("participants") == 4);
  CHECK(fit.at("use").at("n") == 32);
}

TEST_CASE("a person's scatter is what the means of person and items leave") {
  const own::ScaleReport fit = own::make_report(four_people().outcomes).scales.at(0);
  REQUIRE(fit.scatter.size() == 4);
  double squares = 0.0;
  for (const auto& one : fit.scatter) squares += 3.0 * one.value() * one.value();
  CHECK(squares / 9.0 == Approx(fit.agreement.mean_squares.value().residual));
}

TEST_CASE("catch trials stand beside the same people's scored trials") {
  const json found = fit_of(four_people()).at("catch");
  CHECK(found.at("participants") == 4);
  CHECK(found.at("mean") == Approx(plain_mean(of_people(in_catch_trials))));
  CHECK(found.at("not_lower") == 0);
  const std::vector<double> differences = of_people([](int p) {
    return (item_mean(p, 0, 0) + item_mean(p, 0, 1) + item_mean(p, 1, 0) + item_mean(p, 1, 1)) /
               4.0 -
           in_catch_trials(p);
  });
  CHECK(found.at("difference") == Approx(plain_mean(differences)));
  CHECK(found.at("per_participant").at(3).at("catch") == Approx(in_catch_trials(3)));
  CHECK_THAT(warnings_of(four_people()), !names("P2"));
}

TEST_CASE("catch trials that are rated as high as textures are warned of") {
  HandMadeRatings made;
  for (int p = 1; p <= 4; ++p) {
    made.session();
    for (int item = 0; item < 4; ++item) {
      made.rated(p, item / 2, item % 2, {0.4 + 0.05 * item + 0.02 * (p * item % 3)});
    }
    made.caught(p, {p == 1 ? 0.1 : 0.7});
  }
  const json json = json_of(made);
  CHECK(json.at("scales").at(0).at("catch").at("not_lower") == 3);
  const std::string warnings = json.at("warnings").dump();
  CHECK_THAT(warnings, names("P2 P3 P4"));
  CHECK_THAT(said_by(made), names("3"));
}

TEST_CASE("too few people for sign flips are warned of, by the number of pairs") {
  const auto people = [](int n, const std::vector<std::string>& methods) {
    HandMadeRatings made(kOneScale, methods);
    for (int p = 1; p <= n; ++p) {
      made.session();
      for (int c = 0; c < 2; ++c) {
        for (int m = 0; m < static_cast<int>(methods.size()); ++m) {
          made.rated(p, c, m, {0.5 + 0.1 * m + 0.05 * c - 0.03 * (p % 3)});
        }
      }
    }
    return warnings_of(made);
  };
  CHECK_THAT(people(5, {"adaptive", "fixed"}), names("5"));
  CHECK_THAT(people(6, {"adaptive", "fixed"}), !holds_text("sign flips"));
  CHECK_THAT(people(6, {"a", "b", "c"}), names("6 3"));
  CHECK_THAT(people(7, {"a", "b", "c"}), !holds_text("sign flips"));
  CHECK_THAT(people(2, {"adaptive"}), !holds_text("sign flips"));
}

TEST_CASE("narrow use of the scale, uneven scatter and missing ratings are warned of") {
  HandMadeRatings made;
  const double wild[] = {0.9, 0.1, 0.2, 1.0};
  for (int p = 1; p <= 6; ++p) {
    made.session();
    for (int item = 0; item < 4; ++item) {
      if (p == 6 && item == 3) continue;
      const double usual = 0.3 + 0.15 * item + 0.005 * (p * item % 3);
      made.rated(p, item / 2, item % 2, {p == 1 ? wild[item] : p == 2 ? 0.5 : usual});
    }
  }
  const std::string warnings = warnings_of(made);
  CHECK_THAT(warnings, names("P2"));
  CHECK(fit_of(made).at("agreement").at("left_out") == 1);
  CHECK_THAT(warnings_of(four_people(kOneScale)), !names("P2"));
}

TEST_CASE("a study without trials, and one without sessions, have a report without numbers") {
  for (const bool session : {false, true}) {
    HandMadeRatings made(kTwoScales);
    if (session) made.session();
    const json json = json_of(made);
    REQUIRE(json.at("scales").size() == 2);
    const auto& fit = json.at("scales").at(0);
    CHECK(fit.at("items").at(0).at("mean").is_null());
    CHECK(fit.at("differences").at(0).at("difference").is_null());
    CHECK(fit.at("differences").at(0).at("p").is_null());
    CHECK(fit.at("agreement").at("single").is_null());
    CHECK(fit.at("retest").at("mean").is_null());
    CHECK(fit.at("catch").is_null());
    CHECK(own::rating_analysis().tables(made.outcomes).at(0).table.rows.empty());
    for (const analysis::Figure& figure :
         own::rating_analysis().results(made.outcomes, {})->figures("")) {
      CHECK_FALSE(figure.id.starts_with("ratings"));
    }
  }
}

TEST_CASE("one participant has means, and neither intervals nor agreement") {
  HandMadeRatings made;
  made.session();
  for (int item = 0; item < 4; ++item) made.rated(1, item / 2, item % 2, {0.2 + 0.1 * item});
  const json fit = fit_of(made);
  CHECK(fit.at("items").at(3).at("mean") == Approx(0.5));
  CHECK(fit.at("items").at(3).at("interval").is_null());
  const json& pair = fit.at("differences").at(0);
  CHECK(pair.at("difference") == Approx(-0.1));
  CHECK(pair.at("interval").is_null());
  CHECK(pair.at("p") == 1.0);
  CHECK(pair.at("t").is_null());
  CHECK(pair.at("d_z").is_null());
  CHECK(fit.at("agreement").at("single").is_null());
  CHECK(fit.at("use").at("participants").at(0).at("scatter").is_null());
  CHECK_THAT(said_by(made), names("adaptive fixed −0.10"));
}

TEST_CASE("sessions that do not count and trials without an answer have no rating") {
  HandMadeRatings made = four_people(kOneScale);
  const json before = fit_of(made);
  made.session(false);
  made.rated(5, 0, 0, {1.0});
  made.caught(5, {1.0});
  made.missed(1, 0, 0);
  CHECK(fit_of(made) == before);
  const json json = json_of(made);
  CHECK(json.at("without_answer") == 1);
  CHECK(json.at("exploration").at(0).at("without_response") == 1);
}

TEST_CASE("ratings.csv has a row for each scale of each scored and catch trial") {
  HandMadeRatings made = four_people();
  made.session(false);
  made.rated(5, 0, 0, {1.0, 7.0});
  const std::vector<analysis::ResultTable> tables = own::rating_analysis().tables(made.outcomes);
  REQUIRE(tables.size() == 1);
  CHECK(tables[0].file == "ratings.csv");
  const analysis::DataTable& table = tables[0].table;
  REQUIRE(table.rows.size() == 2 * kPeople * 9);
  CHECK_NOTHROW(analysis::csv_text(table));
  for (const std::string& column : table.columns) {
    CHECK_FALSE(analysis::meaning_of(column).description.empty());
  }
  const auto cell = [&](std::size_t row, const char* column) {
    return table.rows[row][place_of(table, column)];
  };
  using analysis::DataCell;
  // The fourth trial: class 1 by method 1.
  CHECK(cell(7, "participant") == DataCell(std::string("P1")));
  CHECK(cell(7, "trial") == DataCell(std::int64_t{4}));
  CHECK(cell(7, "kind") == DataCell(std::string("scored")));
  CHECK(cell(7, "class") == DataCell(std::string("cloth")));
  CHECK(cell(7, "method") == DataCell(std::string("fixed")));
  CHECK(cell(7, "exemplar") == DataCell(std::string("cloth.png")));
  CHECK(cell(7, "scale") == DataCell(std::string("rough")));
  CHECK(cell(7, "rating") == DataCell(on_points(0, 1, 1, 0)));
  CHECK(cell(16, "kind") == DataCell(std::string("catch")));
  CHECK(cell(16, "class") == DataCell());
  CHECK(cell(16, "method") == DataCell());
  CHECK(cell(16, "exemplar") == DataCell());
  CHECK(cell(16, "rating") == DataCell(in_catch_trials(0)));
}

TEST_CASE("tables of trials have a column for each scale, whose meaning is known") {
  HandMadeRatings made = four_people();
  made.missed(1, 0, 0);
  const auto own_columns = own::rating_analysis().trial_columns(made.outcomes);
  REQUIRE(own_columns.size() == 2);
  CHECK(own_columns[0].name == "rating_fit");
  CHECK(own_columns[1].name == "rating_rough");
  const auto cell = [&](const analysis::TrialOutcome& trial, const analysis::TrialColumn& column) {
    return column.value({trial.participant, trial.row, false, &made.outcomes, &trial});
  };
  const analysis::TrialOutcome& first = made.outcomes.trials.front();
  CHECK(cell(first, own_columns[0]) == analysis::DataCell(on_line(0, 0, 0, 0)));
  CHECK(cell(first, own_columns[1]) == analysis::DataCell(on_points(0, 0, 0, 0)));
  CHECK(cell(made.outcomes.trials.back(), own_columns[0]) == analysis::DataCell());
  for (const analysis::TrialColumn& column : own_columns) CHECK(column.after_unblinding);
  CHECK_THAT(std::string(analysis::meaning_of("rating_rough").description), names("rough"));
  const auto common = analysis::trial_columns();
  const auto correct = std::ranges::find(common, "correct", &analysis::TrialColumn::name);
  REQUIRE(correct != common.end());
  CHECK(cell(first, *correct) == analysis::DataCell());
}

TEST_CASE("the script of the model of ratings has the study's methods and all functions") {
  const std::string script = own::rating_model(four_people().outcomes).script;
  CHECK_THAT(script, holds_text("methods <- c(\"adaptive\", \"fixed\")\n"));
  CHECK(script.ends_with(std::string(own::rating_model_functions())));
}

TEST_CASE("wishes that a report of ratings cannot fulfil are refused by their names") {
  const HandMadeRatings made;
  using analysis::ReportOptions;
  CHECK_THROWS_WITH(own::rating_analysis().results(made.outcomes, {.trial = "P1:3"}),
                    holds_text("--trial"));
  CHECK_THROWS_WITH(
      own::rating_analysis().results(made.outcomes, {.traces = ReportOptions::Traces::yes}),
      holds_text("--cues"));
}

}  // namespace touchtrial
