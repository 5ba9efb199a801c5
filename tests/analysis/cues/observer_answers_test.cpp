#include "analysis/cues/observer_answers.hpp"

#include "analysis/cues/felt_fixtures.hpp"
#include "support/catch.hpp"

namespace touchtrial {
namespace {

constexpr int kClasses = 5;

using Responses = std::vector<std::optional<int>>;

/// Right in three of four trials, else the class after.
Responses three_quarters_right(const std::vector<analysis::ObservedTrial>& trials) {
  Responses responses;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const int own = trials[i].class_index;
    responses.emplace_back(i / kClasses % 4 == 0 ? (own + 1) % kClasses : own);
  }
  return responses;
}

double share_of_right(const std::vector<analysis::AnswerShares>& answers,
                      const std::vector<analysis::ObservedTrial>& trials) {
  double right = 0.0;
  for (std::size_t i = 0; i < trials.size(); ++i) right += answers[i][trials[i].class_index];
  return right / static_cast<double>(trials.size());
}

TEST_CASE("a matched observer is right as often as the participants") {
  const auto trials = felt_trials(Difference::strength, kClasses, 40);
  const analysis::ObserverAnswers answers = analysis::observer_answers(
      analysis::Cue::rms, trials, three_quarters_right(trials), kClasses);
  CHECK(share_of_right(answers.ideal, trials) == 1.0);
  CHECK(answers.matched_noise > 0.0);
  CHECK(share_of_right(answers.matched, trials) == Approx(0.75).margin(0.01));
}

TEST_CASE("an observer that knows less than the participants is left as it is") {
  const auto trials = felt_trials(Difference::shape, kClasses, 40);
  const analysis::ObserverAnswers answers = analysis::observer_answers(
      analysis::Cue::rms, trials, three_quarters_right(trials), kClasses);
  CHECK(answers.matched_noise == 0.0);
  CHECK(answers.matched == answers.ideal);
}

TEST_CASE("trials without a response do not count when noise is matched") {
  const auto trials = felt_trials(Difference::strength, kClasses, 40);
  Responses responses;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (i % 2 == 0) {
      responses.emplace_back(trials[i].class_index);
    } else {
      responses.emplace_back(std::nullopt);
    }
  }
  CHECK(analysis::observer_answers(analysis::Cue::rms, trials, responses, kClasses).matched_noise ==
        0.0);
}

TEST_CASE("observers answer the same whatever the number of threads") {
  const auto trials = felt_trials(Difference::shape, kClasses, 20, 0.2);
  const Responses responses = three_quarters_right(trials);
  const analysis::ObserverAnswers one =
      analysis::observer_answers(analysis::Cue::everything, trials, responses, kClasses, 1);
  const analysis::ObserverAnswers four =
      analysis::observer_answers(analysis::Cue::everything, trials, responses, kClasses, 4);
  CHECK(one.ideal == four.ideal);
  CHECK(one.matched_noise == four.matched_noise);
  CHECK(one.matched == four.matched);
}

TEST_CASE("every trial needs a response or none") {
  const auto trials = felt_trials(Difference::none, kClasses, 2);
  REQUIRE_THROWS_AS(analysis::observer_answers(analysis::Cue::rms, trials, Responses(3), kClasses),
                    std::invalid_argument);
  const std::vector<analysis::ObservedTrial> none;
  CHECK(analysis::observer_answers(analysis::Cue::rms, none, Responses{}, kClasses).ideal.empty());
}

}  // namespace
}  // namespace touchtrial
