#include "protocols/identification/analysis/fake_report.hpp"

#include "core/random.hpp"

#include <algorithm>

namespace touchtrial {
namespace {

using namespace analysis::identification;

MethodReport fake_method(const FakeReportOptions& options, std::size_t number) {
  const auto classes = static_cast<int>(options.classes.size());
  RandomStream random(7, "fake report", number);
  MethodReport method;
  method.method = options.methods[number];
  method.confusion = analysis::ConfusionMatrix(classes);
  const int places = classes * options.repeats;
  std::vector<analysis::Proportion> by_place(static_cast<std::size_t>(places));
  std::vector<ReactionTimes> reaction(static_cast<std::size_t>(classes) + 1);
  std::vector<double> accuracies;
  std::vector<std::vector<bool>> right;
  for (int p = 0; p < options.participants; ++p) {
    const double skill = 0.55 + 0.4 * random.uniform() - 0.1 * static_cast<double>(number);
    analysis::ConfusionMatrix own(classes);
    right.emplace_back();
    for (int place = 0; place < places; ++place) {
      const int presented = (place * 7 + p) % classes;
      analysis::Choice choice{presented, presented};
      const double fate = random.uniform();
      if (fate > skill)
        choice.answered = static_cast<int>(random.below(static_cast<unsigned>(classes)));
      if (fate > 0.99) choice.answered.reset();
      own.add(choice);
      right.back().push_back(choice.answered == presented);
      method.confusion.add(choice);
      analysis::Proportion& at = by_place[static_cast<std::size_t>(place)];
      ++at.n;
      if (choice.answered == presented) ++at.correct;
      if (choice.answered) {
        reaction[static_cast<std::size_t>(presented)].seconds.push_back(
            3.0 + presented + 9.0 * random.uniform() * random.uniform());
      }
    }
    ParticipantAccuracy one{.participant = "P" + std::to_string(p + 1), .accuracy = own.accuracy()};
    accuracies.push_back(one.accuracy.share().value_or(0.0));
    method.per_participant.push_back(one);
  }
  for (int c = 0; c < classes; ++c) {
    const analysis::Proportion accuracy = method.confusion.accuracy(c);
    method.accuracy.push_back({accuracy, analysis::wilson_interval(accuracy),
                               analysis::clopper_pearson_interval(accuracy),
                               analysis::jeffreys_interval(accuracy)});
  }
  method.overall = method.confusion.accuracy();
  method.mean = analysis::participant_mean(accuracies);
  for (ReactionTimes& times : reaction) {
    std::sort(times.seconds.begin(), times.seconds.end());
    times.from_plane_on = analysis::quartiles(times.seconds);
  }
  method.reaction_times = std::move(reaction);
  Breakdown trials{BreakdownKind::trial, {}};
  for (int place = 0; place < places && options.participants > 0; ++place) {
    const analysis::Proportion at = by_place[static_cast<std::size_t>(place)];
    trials.groups.push_back({std::to_string(place + 1), at, analysis::wilson_interval(at)});
  }
  method.breakdowns.push_back(std::move(trials));
  method.accuracy_over_trials = accuracy_over_trials(right);
  return method;
}

MethodPair fake_pair(const StudyReport& report, int first, int second) {
  const auto& a = report.methods[static_cast<std::size_t>(first)].per_participant;
  const auto& b = report.methods[static_cast<std::size_t>(second)].per_participant;
  std::vector<analysis::PairedAccuracy> paired;
  for (std::size_t i = 0; i < a.size(); ++i) {
    paired.push_back({a[i].accuracy.share().value_or(0.0), b[i].accuracy.share().value_or(0.0)});
  }
  MethodPair pair;
  pair.first = first;
  pair.second = second;
  pair.overall = analysis::compare_methods(paired);
  return pair;
}

}  // namespace

StudyReport fake_report(const FakeReportOptions& options) {
  StudyReport report;
  report.study = "fake";
  report.simulated = true;
  report.participants = options.participants;
  report.classes = options.classes;
  for (std::size_t i = 0; i < options.methods.size(); ++i) {
    report.methods.push_back(fake_method(options, i));
    report.trials += report.methods.back().overall.n;
  }
  for (std::size_t i = 0; i < options.methods.size(); ++i) {
    for (std::size_t k = i + 1; k < options.methods.size(); ++k) {
      report.pairs.push_back(fake_pair(report, static_cast<int>(i), static_cast<int>(k)));
    }
  }
  report.collection.flow.enrolled = options.participants;
  report.collection.flow.analysed = options.participants;
  for (int i = 0; i < options.servo_trials; ++i) {
    analysis::ServoTrial trial{1 + i / 25, 1 + i % 25, {}, 0};
    trial.health.rate_hz = 1000.0;
    trial.health.lateness_p50_us = 4.0 + i % 3;
    trial.health.lateness_p99_us = 30.0 + i % 17;
    trial.health.lateness_worst_us = 80.0 + 37.0 * (i % 23);
    report.collection.servo_trials.push_back(trial);
  }
  return report;
}

CueReport fake_cues(const FakeReportOptions& options) {
  CueReport cues;
  cues.simulated = true;
  cues.classes = options.classes;
  cues.chance = 1.0 / static_cast<double>(options.classes.size());
  for (std::size_t m = 0; m < options.methods.size(); ++m) {
    RandomStream random(8, "fake cues", m);
    MethodCues method;
    method.method = options.methods[m];
    for (std::size_t c = 0; c < kCues.size(); ++c) {
      ObserverFigures observer;
      observer.cue = kCues[c];
      for (int p = 0; p < options.participants; ++p) {
        observer.accuracy.push_back(
            std::min(1.0, 0.5 + 0.2 * static_cast<double>(c) + 0.2 * random.uniform()));
      }
      observer.mean = analysis::participant_mean(observer.accuracy);
      method.observers.push_back(observer);
    }
    for (int p = 0; p < options.participants; ++p) {
      method.human_accuracy.push_back(0.5 + 0.4 * random.uniform());
    }
    method.human_mean = analysis::participant_mean(method.human_accuracy);
    cues.methods.push_back(std::move(method));
  }
  return cues;
}

}  // namespace touchtrial
