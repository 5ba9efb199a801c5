
#include "engine/perception/felt_classifier.hpp"
#include "protocols/identification/analysis/felt_fixtures.hpp"
#include "support/catch.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace touchtrial {
namespace {

using namespace analysis::identification;

constexpr int kClasses = 5;
constexpr int kRepeats = 40;

double share_of_right(Cue cue, const std::vector<ObservedTrial>& trials, double noise = 0.0) {
  const Observer observer(cue, trials, kClasses);
  double right = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const AnswerShares shares =
        noise > 0.0 ? observer.noisy_answer(i, noise) : observer.ideal_answer(i);
    right += shares[trials[i].class_index];
  }
  return right / static_cast<double>(trials.size());
}

/// Classes of the likeliest stimulus by a classifier that is trained anew without one trial;
/// stimuli are classes here.
int answer_by_retraining(Cue cue, const std::vector<ObservedTrial>& trials, std::size_t out,
                         std::vector<double>& logs) {
  std::vector<engine::FeltExample> others;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (i != out) others.push_back({trials[i].class_index, cue_features(cue, trials[i].felt)});
  }
  logs = engine::FeltClassifier(others, 0.0).log_likelihoods(cue_features(cue, trials[out].felt));
  return static_cast<int>(std::ranges::max_element(logs) - logs.begin());
}

TEST_CASE(
    "where only strength differs, the observer of strength is right and that of shape guesses") {
  const auto trials = felt_trials(Difference::strength, kClasses, kRepeats);
  CHECK(share_of_right(Cue::rms, trials) == 1.0);
  CHECK(share_of_right(Cue::everything, trials) == 1.0);
  // 200 trials: 99.9 % of binomial draws with p = 0.2 lie between 22 and 59.
  const double by_shape = share_of_right(Cue::spectrum, trials);
  CHECK(by_shape > 0.10);
  CHECK(by_shape < 0.30);
}

TEST_CASE("where only shape differs, the observer of shape is right and that of strength guesses") {
  const auto trials = felt_trials(Difference::shape, kClasses, kRepeats);
  CHECK(share_of_right(Cue::spectrum, trials) == 1.0);
  CHECK(share_of_right(Cue::everything, trials) == 1.0);
  const double by_strength = share_of_right(Cue::rms, trials);
  CHECK(by_strength > 0.10);
  CHECK(by_strength < 0.30);
}

TEST_CASE("only the observer of everything feels directions") {
  const auto trials = felt_trials(Difference::direction, 4, kRepeats);
  CHECK(share_of_right(Cue::everything, trials) == 1.0);
  CHECK(share_of_right(Cue::rms, trials) < 0.40);
  CHECK(share_of_right(Cue::spectrum, trials) < 0.40);
}

TEST_CASE("a stronger force changes no shape, and adds its logarithm to the strength") {
  engine::FeltFeatures felt = felt_trials(Difference::shape, kClasses, 1).back().felt;
  const auto shape = cue_features(Cue::spectrum, felt);
  const auto strength = cue_features(Cue::rms, felt);
  for (double& feature : felt) feature += 0.7;
  const auto shape_of_stronger = cue_features(Cue::spectrum, felt);
  REQUIRE(shape.size() == 10);
  for (std::size_t i = 0; i < shape.size(); ++i) {
    CHECK(shape_of_stronger[i] == Approx(shape[i]).margin(1e-12));
  }
  REQUIRE(strength.size() == 1);
  CHECK(cue_features(Cue::rms, felt)[0] == Approx(strength[0] + 0.7).margin(1e-12));
  CHECK(cue_features(Cue::everything, felt).size() == engine::kFeltFeatures);
}

TEST_CASE("leaving a trial out by one subtraction gives the answers of training anew") {
  const Cue cue = GENERATE(Cue::rms, Cue::spectrum, Cue::everything);
  // So noisy that many answers are wrong.
  const auto trials = felt_trials(Difference::strength, kClasses, 6, 0.6);
  const Observer observer(cue, trials, kClasses);
  int wrong = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    std::vector<double> logs;
    const int slow = answer_by_retraining(cue, trials, i, logs);
    CHECK(observer.ideal_answer(i)[slow] == 1.0);
    wrong += slow == trials[i].class_index ? 0 : 1;
  }
  CHECK(wrong > 0);
}

TEST_CASE("trials that all feel the same have evenly split answers") {
  const auto trials = felt_trials(Difference::none, kClasses, 4, 0.0);
  for (const Cue cue : kCues) {
    const Observer observer(cue, trials, kClasses);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      for (const double share : observer.ideal_answer(i)) CHECK(share == Approx(0.2));
    }
  }
}

TEST_CASE("an observer that learnt swapped labels answers by them") {
  auto trials = felt_trials(Difference::strength, kClasses, kRepeats);
  // All trials of classes 0 and 1 but one are answered with the other class.
  for (std::size_t i = 2; i < trials.size(); ++i) {
    if (trials[i].class_index < 2) trials[i].class_index = 1 - trials[i].class_index;
  }
  const Observer observer(Cue::rms, trials, kClasses);
  CHECK(observer.ideal_answer(0)[1] == 1.0);
  CHECK(observer.ideal_answer(1)[0] == 1.0);
}

TEST_CASE(
    "the only trial of an exemplar is judged by its class, the only one of a class not at all") {
  auto trials = felt_trials(Difference::strength, 3, 4);
  trials[0].exemplar = 1;
  const Observer by_class(Cue::rms, trials, 3);
  CHECK(by_class.ideal_answer(0)[0] == 1.0);
  std::erase_if(trials, [](const ObservedTrial& trial) {
    return trial.class_index == 0 && trial.exemplar == 0;
  });
  REQUIRE(trials[0].class_index == 0);
  const Observer alone(Cue::rms, trials, 3);
  CHECK(alone.ideal_answer(0).empty());
  CHECK(alone.noisy_answer(0, 0.1).empty());
  CHECK_FALSE(alone.ideal_answer(1).empty());
}

TEST_CASE("the noisier its sense, the less often an observer is right, down to chance") {
  const auto trials = felt_trials(Difference::strength, kClasses, kRepeats);
  const double little = share_of_right(Cue::rms, trials, 0.1);
  const double some = share_of_right(Cue::rms, trials, 0.5);
  const double much = share_of_right(Cue::rms, trials, 50.0);
  CHECK(little > some);
  CHECK(some > much);
  CHECK(much == Approx(0.2).margin(0.05));
  // Steps of 0.5 between five classes with noise 0.5 each: the outer two err on one side, so
  // (2 Phi(.5) + 3 (2 Phi(.5) - 1)) / 5.
  CHECK(some == Approx(0.5063).margin(0.03));
}

TEST_CASE("shares of a noisy answer sum to one, and are the same every time") {
  const auto trials = felt_trials(Difference::shape, kClasses, 4, 0.3);
  const Observer observer(Cue::everything, trials, kClasses);
  const AnswerShares shares = observer.noisy_answer(3, 0.3);
  CHECK(std::accumulate(shares.begin(), shares.end(), 0.0) == Approx(1.0));
  CHECK(observer.noisy_answer(3, 0.3) == shares);
}

TEST_CASE("an observer refuses impossible trials") {
  const auto trials = felt_trials(Difference::none, 3, 2);
  REQUIRE_THROWS_AS(Observer(Cue::rms, trials, 2), std::invalid_argument);
  REQUIRE_THROWS_AS(Observer(Cue::rms, trials, 0), std::invalid_argument);
  auto undefined = trials;
  undefined[1].felt[0] = std::numeric_limits<double>::quiet_NaN();
  REQUIRE_THROWS_AS(Observer(Cue::everything, undefined, 3), std::invalid_argument);
  CHECK_NOTHROW(Observer(Cue::rms, std::vector<ObservedTrial>{}, 3));
}

using Responses = std::vector<std::optional<int>>;

/// Right in three of four trials, otherwise the next class.
Responses three_quarters_right(const std::vector<ObservedTrial>& trials) {
  Responses responses;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const int own = trials[i].class_index;
    responses.emplace_back(i / kClasses % 4 == 0 ? (own + 1) % kClasses : own);
  }
  return responses;
}

double share_of_right(const std::vector<AnswerShares>& answers,
                      const std::vector<ObservedTrial>& trials) {
  double right = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) right += answers[i][trials[i].class_index];
  return right / static_cast<double>(trials.size());
}

TEST_CASE("a matched observer is right as often as the participants") {
  const auto trials = felt_trials(Difference::strength, kClasses, 40);
  const ObserverAnswers answers =
      observer_answers(Cue::rms, trials, three_quarters_right(trials), kClasses);
  CHECK(share_of_right(answers.ideal, trials) == 1.0);
  CHECK(answers.matched_noise > 0.0);
  CHECK(share_of_right(answers.matched, trials) == Approx(0.75).margin(0.01));
}

TEST_CASE("an observer that knows less than the participants gets no noise") {
  const auto trials = felt_trials(Difference::shape, kClasses, 40);
  const ObserverAnswers answers =
      observer_answers(Cue::rms, trials, three_quarters_right(trials), kClasses);
  CHECK(answers.matched_noise == 0.0);
  CHECK(answers.matched == answers.ideal);
}

TEST_CASE("trials without a response do not count in matching the noise") {
  const auto trials = felt_trials(Difference::strength, kClasses, 40);
  Responses responses;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (i % 2 == 0) {
      responses.emplace_back(trials[i].class_index);
    } else {
      responses.emplace_back(std::nullopt);
    }
  }
  CHECK(observer_answers(Cue::rms, trials, responses, kClasses).matched_noise == 0.0);
}

TEST_CASE("observers' answers do not depend on the number of threads") {
  const auto trials = felt_trials(Difference::shape, kClasses, 20, 0.2);
  const Responses responses = three_quarters_right(trials);
  const ObserverAnswers one = observer_answers(Cue::everything, trials, responses, kClasses, 1);
  const ObserverAnswers four = observer_answers(Cue::everything, trials, responses, kClasses, 4);
  CHECK(one.ideal == four.ideal);
  CHECK(one.matched_noise == four.matched_noise);
  CHECK(one.matched == four.matched);
}

TEST_CASE("every trial needs a response or none") {
  const auto trials = felt_trials(Difference::none, kClasses, 2);
  REQUIRE_THROWS_AS(observer_answers(Cue::rms, trials, Responses(3), kClasses),
                    std::invalid_argument);
  const std::vector<ObservedTrial> none;
  CHECK(observer_answers(Cue::rms, none, Responses{}, kClasses).ideal.empty());
}

}  // namespace

}  // namespace touchtrial
