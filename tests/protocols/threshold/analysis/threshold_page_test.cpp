#include "analysis/checkers/whole_page.hpp"
#include "analysis/exports/column_meanings.hpp"
#include "analysis/report/figures/figure.hpp"
#include "protocols/threshold/analysis/exports.hpp"
#include "protocols/threshold/analysis/figures.hpp"
#include "protocols/threshold/analysis/hand_made_tracks.hpp"
#include "protocols/threshold/analysis/measures.hpp"
#include "protocols/threshold/analysis/page/sections.hpp"
#include "protocols/threshold/analysis/threshold_analysis.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace touchtrial {
namespace {

namespace own = analysis::threshold;

/// Three participants, one of whom feels nothing, with a control block and catch trials.
HandMadeTracks small_study(const study::threshold::ThresholdOptions& options) {
  HandMadeTracks made(options, {"bark", "cloth"});
  const double thresholds[] = {-18.0, -14.0, 60.0};
  for (int person = 1; person <= 3; ++person) {
    made.session();
    const bool is_blend = options.along == study::threshold::LevelQuantity::blend;
    const int tracks = (is_blend ? 1 : 2) * static_cast<int>(options.standards.size());
    for (int track = 1; track <= tracks; ++track) {
      RandomStream random(5, "page", static_cast<std::uint64_t>(10 * person + track));
      made.track(person, track,
                 {procedures::Shape::weibull, thresholds[person - 1], 3.0, 0.5, 0.02}, random);
    }
    made.caught(person, 1, 3, 1);
    made.outside(person, study::Role::control, 6, 4);
  }
  return made;
}

std::vector<study::threshold::ThresholdOptions> kinds_of_studies() {
  return {detection_options(), constant_options({-12.0, -6.0}), same_different_options()};
}

std::size_t column_of(const analysis::DataTable& table, const std::string& name) {
  const auto found = std::ranges::find(table.columns, name);
  REQUIRE(found != table.columns.end());
  return static_cast<std::size_t>(found - table.columns.begin());
}

}  // namespace

TEST_CASE("every page of thresholds is whole, with figures described in words") {
  for (const auto& options : kinds_of_studies()) {
    HandMadeTracks made = small_study(options);
    made.outcomes.simulated = true;
    check_whole_page(*own::threshold_analysis().results(made.outcomes, {}));
  }
}

TEST_CASE("gnuplot draws every figure of thresholds") {
  for (const auto& options : kinds_of_studies()) {
    const own::ThresholdReport report = own::make_report(small_study(options).outcomes);
    const std::vector<analysis::Figure> figures = own::report_figures(report, "");
    for (const std::string& svg : analysis::draw_figures(figures, analysis::FigureFormat::svg)) {
      CHECK(svg.size() > 1000);
    }
  }
}

TEST_CASE("studies without trials have no figures of thresholds") {
  for (const auto& options : kinds_of_studies()) {
    const own::ThresholdReport report =
        own::make_report(HandMadeTracks(options, {"bark", "cloth"}).outcomes);
    CHECK_FALSE(own::thresholds_figure(report));
    CHECK_FALSE(own::functions_figure(report));
    CHECK_FALSE(own::tracks_figure(report));
    CHECK_FALSE(own::d_prime_figure(report));
  }
}

TEST_CASE("thresholds and their intervals read as text, censored ones without a number") {
  const study::threshold::ThresholdOptions options = detection_options();
  const std::vector<double>& levels = options.track.levels;
  CHECK(own::threshold_text({-21.25, -23.0, -19.5}, levels) == "−21.2 [−23.0, −19.5]");
  CHECK(own::threshold_text({-21.0, {}, -19.5}, levels) == "−21.0 [open, −19.5]");
  CHECK(own::threshold_text({-21.0, {}, {}}, levels) == "−21.0");
  CHECK(own::threshold_text({{}, {}, {}, procedures::Censored::below}, levels) == "below −40.0");
  CHECK(own::threshold_text({{}, {}, {}, procedures::Censored::above}, levels) == "above 0.0");
  using enum procedures::Censored;
  CHECK(own::threshold_text({{}, {}, {}, undetermined}, levels) == "not determined");
  CHECK(own::threshold_text({{}, -20.0, {}, undetermined}, levels) ==
        "not determined, above −20.0");
  CHECK(own::threshold_text({{}, {}, -12.5, undetermined}, levels) ==
        "not determined, below −12.5");
  CHECK(own::threshold_text({{}, -20.0, -3.0, undetermined}, levels) ==
        "not determined, between −20.0 and −3.0");
  study::threshold::ThresholdOptions order = constant_options({0.5});
  CHECK(own::quantity_text({0.1, 0.05, {}}, order) == "10.0% [5.0, open]");
  order.along = study::threshold::LevelQuantity::order;
  CHECK(own::quantity_at(order, {0, 0.5}, -20.0).value() == Approx(0.05));
  CHECK(own::quantity_text({0.05, 0.04, 0.06}, order) == "0.050 [0.040, 0.060]");
  CHECK_FALSE(own::quantity_at(options, {0, 0.0}, -20.0));
}

TEST_CASE("thresholds.csv has a row for each track, and tracks.csv one for each answered trial") {
  const HandMadeTracks made = small_study(constant_options({-12.0, -6.0}));
  const std::vector<analysis::ResultTable> tables = own::threshold_analysis().tables(made.outcomes);
  REQUIRE(tables.size() == 2);
  CHECK(tables[0].file == "thresholds.csv");
  CHECK(tables[0].table.rows.size() == 12);
  const auto& first = tables[0].table.rows.front();
  CHECK(first[column_of(tables[0].table, "trials")] == analysis::DataCell(std::int64_t{140}));
  CHECK(first[column_of(tables[0].table, "catch_trials")] == analysis::DataCell(std::int64_t{4}));
  CHECK(first[column_of(tables[0].table, "catch_right")] == analysis::DataCell(std::int64_t{3}));
  CHECK(tables[1].file == "tracks.csv");
  CHECK(tables[1].table.rows.size() == made.outcomes.trials.size());
  for (const analysis::ResultTable& one : tables) CHECK_NOTHROW(analysis::csv_text(one.table));
  const analysis::DataTable& trials = tables[1].table;
  const auto& row = trials.rows.front();
  const double level = std::get<double>(row[column_of(trials, "level_db")]);
  CHECK(std::get<double>(row[column_of(trials, "comparison")]) ==
        Approx(-12.0 + 20.0 * std::log10(1.0 + std::pow(10.0, level / 20.0))));
  CHECK(std::get<std::string>(row[column_of(trials, "standard")]) == "bark, standard -12 dB");
  CHECK(std::get<std::string>(row[column_of(trials, "kind")]) == "track");
  const auto& last = trials.rows.back();
  CHECK(std::get<std::string>(last[column_of(trials, "kind")]) == "control");
  CHECK(std::holds_alternative<std::monostate>(last[column_of(trials, "track")]));
  CHECK(std::get<double>(last[column_of(trials, "level_db")]) == -2.0);
  const std::size_t kind = column_of(trials, "kind");
  for (const auto& of : trials.rows) {
    if (std::get<std::string>(of[kind]) != "catch") continue;
    CHECK(of[column_of(trials, "track")] == analysis::DataCell(std::int64_t{1}));
    CHECK(std::get<std::string>(of[column_of(trials, "standard")]) == "bark, standard -12 dB");
    CHECK(std::get<double>(of[column_of(trials, "level_db")]) == -2.0);
  }
}

TEST_CASE("thresholds.csv says where each threshold lies, as the group's mean takes it") {
  HandMadeTracks made(detection_options());
  const auto observer = [](double threshold) {
    return procedures::Observer{procedures::Shape::weibull, threshold, 3.5, 0.5, 0.0};
  };
  RandomStream random(5, "threshold page test");
  for (const double threshold : {-20.0, 40.0}) {
    made.session();
    made.track(static_cast<int>(made.outcomes.sessions.size()), 1, observer(threshold), random);
  }
  const own::ThresholdReport report = own::make_report(made.outcomes);
  const analysis::DataTable table =
      analysis::data_table_of(report.tracks, own::track_measures(report));
  REQUIRE(table.rows.size() == 2);
  const auto cell = [&](std::size_t row, const char* column) {
    return table.rows[row][column_of(table, column)];
  };
  CHECK(cell(0, "at_least_db") == cell(0, "threshold_db"));
  CHECK(cell(0, "at_most_db") == cell(0, "threshold_db"));
  CHECK(std::holds_alternative<double>(cell(0, "at_least_db")));
  CHECK(std::holds_alternative<std::monostate>(cell(1, "threshold_db")));
  CHECK(std::holds_alternative<std::monostate>(cell(1, "at_most_db")));
}

TEST_CASE("a standard near the pack's gain has fewer levels, and is censored at its own highest") {
  study::threshold::ThresholdOptions options = constant_options({-12.0, -3.0});
  HandMadeTracks made(options);
  made.session();
  const std::size_t levels = study::threshold::levels_of(options, {0, -3.0}).size();
  REQUIRE(levels < options.track.levels.size());
  for (int i = 0; i < 60; ++i) {
    made.answer({1, 2, i % static_cast<int>(levels), i % 2, i / 2 % 2});
  }
  made.caught(1, 2, 10, 10);
  const own::ThresholdReport report = own::make_report(made.outcomes);
  REQUIRE(report.tracks.size() == 1);
  CHECK(report.tracks[0].answers.n == 60);
  CHECK_FALSE(report.tracks[0].threshold());
  CHECK(report.standards.at(1).levels.size() == levels);
  const std::string text = analysis::document_text(
      own::threshold_analysis().results(made.outcomes, {})->document({}, {}));
  // A guesser may be above the levels, or lapse at all of them.
  CHECK_THAT(text, names("−12.0") || holds_text("not determined"));
}

TEST_CASE("wishes that a report of thresholds cannot fulfil are refused by their names") {
  const HandMadeTracks made(detection_options());
  const auto& room = own::threshold_analysis();
  using analysis::ReportOptions;
  CHECK_THROWS_WITH(room.results(made.outcomes, {.trial = "P1:3"}), holds_text("--trial"));
  CHECK_THROWS_WITH(room.results(made.outcomes, {.traces = ReportOptions::Traces::yes}),
                    holds_text("--cues"));
}

TEST_CASE("tables of trials have the track and the level where an order chose them") {
  const HandMadeTracks made = small_study(constant_options({-12.0, -6.0}));
  const std::vector<analysis::TrialColumn> own_columns =
      own::threshold_analysis().trial_columns(made.outcomes);
  REQUIRE(own_columns.size() == 3);
  const analysis::TrialOutcome& trial = made.outcomes.trials.front();
  const analysis::TrialView view{trial.participant, trial.row, false, &made.outcomes, &trial};
  CHECK(own_columns[0].name == "track");
  CHECK(own_columns[0].value(view) == analysis::DataCell(std::int64_t{1}));
  CHECK(own_columns[1].value(view) == analysis::DataCell(std::string("bark, standard -12 dB")));
  CHECK(own_columns[2].value(view) ==
        analysis::DataCell(
            levels_from(-32.0, -2.0, 5.0)[static_cast<std::size_t>(trial.chosen->level)]));
  for (const analysis::TrialColumn& column : own_columns) {
    CHECK(column.after_unblinding);
    CHECK_FALSE(analysis::meaning_of(column.name).description.empty());
  }
}

TEST_CASE("the model's script has the study's guess rate, its criterion and all functions") {
  const std::string script = own::threshold_model(small_study(detection_options()).outcomes).script;
  CHECK_THAT(script, holds_text("guess <- 0.5\n") && holds_text("scale_db <- 5\n") &&
                         holds_text("shape <- \"weibull\"\n"));
  CHECK_THAT(script, holds_text("(1 + x | participant) + (1 + x | participant:standard)"));
  CHECK(script.ends_with(std::string(own::threshold_model_functions())));
}

}  // namespace touchtrial
