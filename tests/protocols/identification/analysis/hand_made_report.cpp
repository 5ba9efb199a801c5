#include "protocols/identification/analysis/hand_made_report.hpp"

#include "analysis/confusion_of_counts.hpp"

namespace touchtrial {
namespace {

using namespace analysis::identification;

/// With one missing response to each class.
analysis::ConfusionMatrix confusion_of(const std::vector<std::vector<int>>& counts) {
  analysis::ConfusionMatrix confusion = confusion_of_counts(counts);
  for (int i = 0; i < confusion.classes(); ++i) confusion.add({i, std::nullopt});
  return confusion;
}

ReactionTimes times_of(double median) {
  return {.from_plane_on = {12, median - 1.0, median, median + 2.0},
          .from_contact = {12, median - 1.5, median - 0.5, median + 1.5}};
}

void add_participants(MethodReport& method) {
  for (int i = 1; i <= 6; ++i) {
    ParticipantAccuracy one{"P0" + std::to_string(i), {12, 6 + i}};
    one.matching = {{12, 12}, {1, 0, 2}};
    one.consistency = 0.5;
    method.per_participant.push_back(one);
  }
  method.mean = {6, 0.79, {0.63, 0.95}, 0.155};
  method.bootstrap = analysis::Interval{0.68, 0.9};
  method.spread = analysis::Spread{0.121, {0.05, 0.3}};
  method.prevalence = analysis::Prevalence{6, 5, 0.04, 0.826, {0.5, 0.97}};
}

analysis::ChoiceModel choice_of() {
  analysis::ChoiceModel model;
  model.similarity = Plane<double>(3, 3, 0.25);
  for (int i = 0; i < 3; ++i) model.similarity.at(i, i) = 1.0;
  model.bias = {0.5, 0.3, 0.2};
  model.group = {0, 0, 0};
  model.g_squared = 1.75;
  model.degrees_of_freedom = 1;
  model.p = 0.1859;
  model.draws = 999;
  model.drawn_p = 0.21;
  model.converged = true;
  return model;
}

MethodReport method_of(const std::string& name, const std::vector<std::vector<int>>& counts) {
  MethodReport method;
  method.method = name;
  method.confusion = confusion_of(counts);
  method.overall = method.confusion.accuracy();
  for (int i = 0; i < 3; ++i) {
    const analysis::Proportion accuracy = method.confusion.accuracy(i);
    method.accuracy.push_back({accuracy,
                               analysis::wilson_interval(accuracy),
                               analysis::clopper_pearson_interval(accuracy),
                               analysis::Interval{0.6, 0.9},
                               {6, 0.76, {0.55, 0.97}, 0.2}});
  }
  method.information = {0.91, 0.83, 0.05};
  method.chance = analysis::ChanceTest{57, 75, 25.0, 0.00002, true, 0};
  method.d_prime = {1.7, 1.4, 2.1};
  method.d_prime_over_participants = analysis::DPrime{1.7, 1.2, 2.3};
  method.choice = choice_of();
  add_participants(method);
  for (const double median : {4.0, 5.5, 6.25, 5.0})
    method.reaction_times.push_back(times_of(median));
  method.breakdowns = {
      {BreakdownKind::trial, {{"1", {6, 4}, {0.3, 0.9}}, {"2", {6, 5}, {0.4, 1}}}}};
  method.unbiased_hits = std::vector<UnbiasedHits>(4, {{6, 0.62, {0.5, 0.74}, 0.114}, 0.131});
  method.order = analysis::OrderEffects{
      {6, 0.0123, {-0.002, 0.0266}, 0.0136}, 0.082, {18, 9, 6.25, 0.31}, {17, 4, 6.0, 0.5}, 1999};
  method.confidence = ConfidenceReport{
      {{1, {30, 18}, {6, 0.6, {0.4, 0.8}, 0.19}}, {2, {42, 39}, {5, 0.93, {0.8, 1.0}, 0.1}}},
      {5, 0.71, {0.6, 0.82}, 0.09},
      1};
  method.robustness = {{TrialSubset::counted, {75, 57}, method.mean},
                       {TrialSubset::answered, {72, 57}, method.mean}};
  return method;
}

MethodPair pair_of() {
  MethodPair pair;
  pair.overall = {6,
                  -0.083,
                  {-0.2, 0.034},
                  0.125,
                  -0.42,
                  analysis::Interval{-0.16, -0.01},
                  analysis::TStatistic{-1.82, 5, -0.74, analysis::Interval{-1.63, 0.2}}};
  pair.odds_ratio = analysis::OddsRatio{0.66, {0.31, 1.4}, analysis::Interval{0.25, 1.7}};
  for (int i = 0; i < 3; ++i) {
    pair.classes.push_back({{25, 18}, {25, 20}, {6, -0.08, {-0.3, 0.14}, 0.5, -0.46}, {}});
  }
  return pair;
}

CueReport cues_of(const std::vector<std::string>& classes) {
  CueReport cues;
  cues.chance = 1.0 / 3.0;
  cues.classes = classes;
  MethodCues method;
  method.method = "adaptive";
  method.trials = 70;
  method.without_trace = 5;
  method.participants = {"P01", "P02"};
  method.human_mean = {2, 0.7, {0.5, 0.9}};
  for (const Cue cue : kCues) {
    ObserverFigures observer;
    observer.cue = cue;
    observer.mean = {2, 0.9, {0.8, 1.0}};
    observer.efficiency = {0.78, analysis::Interval{0.6, 0.95}};
    observer.divergence = {0.123, analysis::Interval{0.1, 0.2}};
    observer.matched_noise = 0.25;
    observer.matched_divergence = {0.045, analysis::Interval{0.03, 0.06}};
    method.observers.push_back(observer);
  }
  method.match =
      CueMatch{Cue::spectrum, Cue::everything, {0.02, analysis::Interval{-0.01, 0.05}}, false};
  cues.methods.push_back(method);
  return cues;
}

choices::AnswersByPlace places_of() {
  choices::AnswersByPlace places;
  for (const int named : {60, 45, 39}) {
    places.places.push_back({named, {{6, (named - 48) / 144.0, {-0.1, 0.2}, 0.08}, 0.04}});
  }
  places.p = 0.012;
  places.deals = 9999;
  places.preferences.global_null = {0.0034, 9999, 6, 2, 0.3};
  for (int i = 1; i <= 6; ++i) {
    choices::Preference one;
    one.participant = "P0" + std::to_string(i);
    one.choice = i % 3;
    one.place = 0;
    one.answers = 24;
    one.named_count = 12;
    one.right_there = {8, 7};
    one.right_elsewhere = {16, 9};
    one.p = i <= 2 ? 0.004 : 0.4;
    one.p_holm = i <= 2 ? 0.024 : 1.0;
    places.preferences.people.push_back(one);
  }
  return places;
}

analysis::PrimaryResult primary_of() {
  return {
      .estimand = study::Estimand::difference,
      .words = "mean over participants of the accuracy with adaptive less that with tv-gabor",
      .test = "sign flips over participants, two-sided",
      .sides = analysis::Sides::two,
      .p = 0.125,
      .choices = {{"registered", "as registered", 6, 150, -0.083, analysis::Interval{-0.2, 0.034}},
                  {"all", "with all excluded sessions", 7, 175, -0.06,
                   analysis::Interval{-0.17, 0.05}}},
      .verdict = analysis::Verdict::undecided,
      .reason = "Collecting ended with 7 of 20 planned participants."};
}

analysis::Collection collection_of() {
  analysis::Collection collection;
  collection.prescription = {60.0, "fade", "shuffled", 5, 1, "curtain", true, -20.0};
  for (int i = 1; i <= 8; ++i) {
    analysis::SessionRecord record;
    record.row.session = record.row.enrolment = i;
    record.row.participant = "P0" + std::to_string(i);
    record.row.state = record::SessionState::completed;
    record.row.device = "falcon";
    record.deviations = {{"no-masking-noise", kHostile}};
    collection.sessions.push_back(record);
  }
  collection.sessions[6].row.excluded = true;
  collection.sessions[6].exclusion_reason = kHostile;
  collection.sessions[7].row = record::SessionRow{};
  collection.sessions[7].row.session = 8;
  collection.sessions[7].row.withdrawn = true;
  collection.sessions[7].row.erased = true;
  collection.sessions[7].deviations.clear();
  analysis::ServoTrial trial{1, 1, {}, 2};
  trial.health.rate_hz = 999.5;
  trial.health.lateness_p99_us = 40.0;
  trial.health.lateness_worst_us = 180.0;
  collection.servo_trials = {trial};
  collection.flow.enrolled = 8;
  collection.flow.erased = 1;
  collection.flow.withdrawn = 1;
  collection.flow.excluded = 1;
  collection.flow.exclusion_reasons = {kHostile};
  collection.flow.analysed = 6;
  return collection;
}

}  // namespace

StudyReport hand_made_report(const std::string& label) {
  StudyReport report;
  report.study = "hand-made";
  report.protocol = "comparison";
  report.simulated = true;
  report.participants = 6;
  report.trials = 150;
  report.classes = {label, "cloth", "straw"};
  report.methods = {method_of("adaptive", {{20, 3, 1}, {2, 19, 3}, {2, 4, 18}}),
                    method_of("tv-gabor", {{22, 1, 1}, {2, 21, 1}, {2, 4, 18}})};
  report.pairs = {pair_of()};
  report.comparison = report.pairs[0].overall;
  report.collection = collection_of();
  report.registration.primary_test = "sign-flip permutation of adaptive less tv-gabor";
  report.primary = primary_of();
  report.demographics = {{"age", {{"20-29", 6}}, 0}};
  analysis::Explorations felt;
  felt.method = "adaptive";
  felt.trials = 75;
  felt.without_response = 3;
  felt.answer_s = {72, 4.0, 5.5, 7.0};
  felt.speed_mm_s = {75, 60.0, 80.0, 95.0};
  report.explorations = {felt};
  report.course.planned = 20;
  report.course.completed = 7;
  report.departures = {"7 of 20 participants.", kHostile};
  report.looks = {{std::chrono::seconds(1'769'860'800), 6, kHostile}};
  report.places = places_of();
  report.cues = cues_of(report.classes);
  report.warnings = {"Intervals of a class pool all trials.", kHostile};
  return report;
}

analysis::Provenance hand_made_provenance() {
  analysis::Provenance provenance{"hand.db", "0.1.0", std::string(64, 'a'), {}, {}};
  provenance.head.length = 12;
  provenance.head.hash.fill(0xbc);
  provenance.state.closed = true;
  provenance.state.unblinded = true;
  return provenance;
}

analysis::Picture hand_made_picture(const std::string& id, const std::string& section) {
  return {id, "A picture.", "Three bars: 80, 76 and 72%.",
          "<?xml version=\"1.0\"?>\n<!DOCTYPE svg>\n<svg viewBox=\"0 0 9 9\" "
          "xmlns=\"http://www.w3.org/2000/svg\" aria-labelledby=\"t d\"><title id=\"t\">bars"
          "</title><desc id=\"d\">three</desc><path id='p' d=\"M0 0\"/><use href='#p'/>"
          "<g clip-path=\"url(#p)\"/></svg>\n",
          section};
}

}  // namespace touchtrial
