#include "analysis/cues/ideal_observer.hpp"

#include "analysis/cues/jobs.hpp"
#include "engine/perception/felt_classifier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace touchtrial {
namespace {

/// Log likelihoods nearer than this are equal: no compiler's rounding decides an answer.
constexpr double kTie = 1e-9;

/// Logarithm of the intensity of five bands together.
double whole(const FeltFeatures& felt, int first_band) {
  double power = 0.0;
  for (int band = 0; band < kFeltBands; ++band) power += std::exp(2.0 * felt[first_band + band]);
  return 0.5 * std::log(power);
}

void append_shape(std::vector<double>& features, const FeltFeatures& felt, int first_band) {
  const double level = whole(felt, first_band);
  for (int band = 0; band < kFeltBands; ++band) {
    features.push_back(felt[first_band + band] - level);
  }
}

/// Trials as a classifier learns them: stimuli are its labels.
struct Lessons {
  std::vector<int> label;                     ///< by trial
  std::vector<std::vector<double>> features;  ///< by trial
  std::vector<int> class_of_label;
  std::vector<int> trials_of_class;
};

Lessons lessons_of(Cue cue, std::span<const ObservedTrial> trials, int classes) {
  Lessons lessons;
  lessons.trials_of_class.resize(static_cast<std::size_t>(classes), 0);
  std::map<std::pair<int, int>, int> label_of;
  for (const ObservedTrial& trial : trials) {
    if (trial.class_index < 0 || trial.class_index >= classes || trial.exemplar < 0) {
      throw std::invalid_argument("ideal_answers: a trial's class or exemplar is out of range");
    }
    const auto [known, is_new] = label_of.try_emplace(
        {trial.class_index, trial.exemplar}, static_cast<int>(lessons.class_of_label.size()));
    if (is_new) lessons.class_of_label.push_back(trial.class_index);
    lessons.label.push_back(known->second);
    lessons.features.push_back(cue_features(cue, trial.felt));
    ++lessons.trials_of_class[trial.class_index];
  }
  return lessons;
}

FeltStatistics learnt(const Lessons& lessons) {
  FeltStatistics statistics(static_cast<int>(lessons.class_of_label.size()),
                            lessons.features.front().size());
  for (std::size_t i = 0; i < lessons.label.size(); ++i) {
    statistics.learn(lessons.label[i], lessons.features[i]);
  }
  return statistics;
}

/// The best of each class's stimuli.
std::vector<double> support_of_classes(const std::vector<double>& logs, const Lessons& lessons) {
  std::vector<double> support(lessons.trials_of_class.size(),
                              -std::numeric_limits<double>::infinity());
  for (std::size_t label = 0; label < logs.size(); ++label) {
    double& best = support[lessons.class_of_label[label]];
    best = std::max(best, logs[label]);
  }
  return support;
}

AnswerShares shares_of(const std::vector<double>& support) {
  const double most = *std::ranges::max_element(support);
  AnswerShares shares(support.size(), 0.0);
  const auto ties = std::ranges::count_if(support, [&](double s) { return s >= most - kTie; });
  for (std::size_t i = 0; i < support.size(); ++i) {
    if (support[i] >= most - kTie) shares[i] = 1.0 / static_cast<double>(ties);
  }
  return shares;
}

AnswerShares judged(std::size_t trial, const Lessons& lessons, FeltStatistics statistics) {
  const int label = lessons.label[trial];
  if (lessons.trials_of_class[lessons.class_of_label[label]] < 2) return {};
  statistics.forget(label, lessons.features[trial]);
  // Without noise of the sense: the observer is ideal.
  const FeltClassifier classifier(statistics, 0.0);
  return shares_of(
      support_of_classes(classifier.log_likelihoods(lessons.features[trial]), lessons));
}

}  // namespace

std::vector<double> cue_features(Cue cue, const FeltFeatures& felt) {
  if (cue == Cue::everything) return {felt.begin(), felt.end()};
  if (cue == Cue::rms) return {whole(felt, kLateralBandsAt)};
  std::vector<double> shape;
  append_shape(shape, felt, kLateralBandsAt);
  append_shape(shape, felt, kNormalBandsAt);
  return shape;
}

std::vector<AnswerShares> ideal_answers(Cue cue, std::span<const ObservedTrial> trials, int classes,
                                        int jobs) {
  if (classes < 1) throw std::invalid_argument("ideal_answers: there must be a class");
  std::vector<AnswerShares> answers(trials.size());
  if (trials.empty()) return answers;
  const Lessons lessons = lessons_of(cue, trials, classes);
  const FeltStatistics statistics = learnt(lessons);
  in_parallel(jobs, trials.size(),
              [&](std::size_t i) { answers[i] = judged(i, lessons, statistics); });
  return answers;
}

}  // namespace touchtrial
