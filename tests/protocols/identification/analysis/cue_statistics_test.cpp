#include "protocols/identification/analysis/cues/cue_statistics.hpp"

#include "core/random.hpp"
#include "support/catch.hpp"

#include <cmath>
#include <vector>

namespace touchtrial {
namespace {

using namespace analysis::identification;

using Counts = std::vector<double>;

constexpr int kClasses = 4;

AnswerShares surely(int class_index) {
  AnswerShares shares(kClasses, 0.0);
  shares[class_index] = 1.0;
  return shares;
}

/// A participant who answers like the observer of strength, which takes the last class for the one
/// before it. The observer of everything is always right, and that of shape guesses evenly.
ParticipantAnswers like_strength(int number, int repeats, int slips = 0) {
  ParticipantAnswers one("P" + std::to_string(number), kClasses);
  for (int i = 0; i < repeats * kClasses; ++i) {
    const int presented = i % kClasses;
    const int by_strength = presented == kClasses - 1 ? presented - 1 : presented;
    const int answer = i < slips ? (presented + 2) % kClasses : by_strength;
    const AnswerShares evenly(kClasses, 0.25);
    one.add({presented,
             answer,
             {surely(by_strength), evenly, surely(presented)},
             {surely(by_strength), evenly, surely(presented)}});
  }
  return one;
}

TEST_CASE("efficiency is what was achieved over what was available") {
  const std::vector<ParticipantAnswers> all{like_strength(1, 5), like_strength(2, 5)};
  const CueStatistics statistics = cue_statistics(all, 0);
  CHECK(statistics.efficiency[0].value.value() == Approx(1.0));
  CHECK(statistics.efficiency[1].value.value() == Approx(3.0));
  CHECK(statistics.efficiency[2].value.value() == Approx(0.75));
  CHECK(statistics.corrected_efficiency[0].value.value() == Approx(1.0));
  CHECK_FALSE(statistics.corrected_efficiency[1].value);
  CHECK_FALSE(statistics.corrected_efficiency[1].interval);
  CHECK(statistics.corrected_efficiency[2].value.value() == Approx(0.5 / 0.75));
  // All participants are alike, so every draw is the same.
  CHECK(statistics.efficiency[2].interval.value().low == Approx(0.75));
  CHECK(statistics.efficiency[2].interval.value().high == Approx(0.75));
}

TEST_CASE("the observer with the participants' confusions is found, and told from the others") {
  std::vector<ParticipantAnswers> all;
  for (int i = 0; i < 6; ++i) all.push_back(like_strength(i, 5, i % 3));
  const CueMatch match = cue_statistics(all, 0).match.value();
  CHECK(match.best == Cue::rms);
  CHECK(match.second == Cue::everything);
  CHECK(match.is_distinct);
  CHECK(match.difference.interval.value().low > 0.0);
  CHECK(match.difference.interval.value().low <= match.difference.value.value());
  CHECK(match.difference.interval.value().high >= match.difference.value.value());
}

TEST_CASE("five participants decide nothing, although the interval excludes 0") {
  std::vector<ParticipantAnswers> all;
  for (int i = 0; i < kMinForVerdict - 1; ++i) all.push_back(like_strength(i, 5, i % 3));
  const CueMatch match = cue_statistics(all, 0).match.value();
  CHECK(match.difference.interval.value().low > 0.0);
  CHECK_FALSE(match.is_distinct);
}

TEST_CASE("with one participant there are numbers but no intervals and no verdict") {
  const std::vector<ParticipantAnswers> alone{like_strength(1, 5)};
  const CueStatistics statistics = cue_statistics(alone, 0);
  CHECK(statistics.efficiency[2].value.value() == Approx(0.75));
  CHECK_FALSE(statistics.efficiency[2].interval);
  CHECK(statistics.match.value().best == Cue::rms);
  CHECK_FALSE(statistics.match.value().is_distinct);
}

TEST_CASE("observers who answer alike are not told apart") {
  std::vector<ParticipantAnswers> all;
  for (int i = 0; i < 8; ++i) {
    ParticipantAnswers& one = all.emplace_back("P" + std::to_string(i), kClasses);
    for (int k = 0; k < 20; ++k) {
      const AnswerShares sure = surely(k % kClasses);
      const AnswerShares evenly(kClasses, 0.25);
      // Strength and everything answer the same.
      one.add({k % kClasses, k < i ? 0 : k % kClasses, {sure, evenly, sure}, {sure, evenly, sure}});
    }
  }
  const CueMatch match = cue_statistics(all, 0).match.value();
  CHECK(match.difference.value.value() == 0.0);
  CHECK_FALSE(match.is_distinct);
}

TEST_CASE("without a response there is nothing to match, and accuracy is zero") {
  std::vector<ParticipantAnswers> all;
  for (int i = 0; i < 2; ++i) {
    ParticipantAnswers& one = all.emplace_back("P" + std::to_string(i), kClasses);
    for (int k = 0; k < kClasses; ++k) {
      one.add(
          {k, std::nullopt, {surely(k), surely(k), surely(k)}, {surely(k), surely(k), surely(k)}});
    }
    CHECK(one.no_response[0] == 1);
  }
  const CueStatistics statistics = cue_statistics(all, 0);
  CHECK(statistics.efficiency[0].value.value() == 0.0);
  CHECK_FALSE(statistics.match);
  CHECK_FALSE(statistics.divergence[0].value);
}

TEST_CASE("intervals do not depend on the number of threads, and differ between methods") {
  std::vector<ParticipantAnswers> all;
  for (int i = 0; i < 9; ++i) all.push_back(like_strength(i, 5, i));
  const analysis::Interval one = cue_statistics(all, 0, 1).efficiency[2].interval.value();
  CHECK(cue_statistics(all, 0, 4).efficiency[2].interval.value() == one);
  CHECK(one.low < one.high);
  const analysis::Interval other = cue_statistics(all, 1).efficiency[2].interval.value();
  CHECK_FALSE(one == other);
}

TEST_CASE("the bootstrap's width is that of the mean's distribution") {
  // Accuracies 0.25 to 0.75 of 16 participants against an observer who is always right.
  std::vector<ParticipantAnswers> all;
  double mean = 0.0;
  double squares = 0.0;
  for (int i = 0; i < 16; ++i) {
    ParticipantAnswers one("P" + std::to_string(i), kClasses);
    const double right = 10.0 + i % 4 * 5.0;
    for (int k = 0; k < 40; ++k) {
      const int presented = k % kClasses;
      const AnswerShares sure = surely(presented);
      const int answer = k < right ? presented : (presented + 1) % kClasses;
      one.add({presented, answer, {sure, sure, sure}, {sure, sure, sure}});
    }
    mean += right / 40.0 / 16.0;
    squares += (right / 40.0) * (right / 40.0) / 16.0;
    all.push_back(one);
  }
  const double error = std::sqrt((squares - mean * mean) / 16.0);
  const analysis::Interval interval = cue_statistics(all, 0).efficiency[2].interval.value();
  // Expanded percentiles of 16 participants: t of 15 degrees, 2.1314, times sqrt(16 / 15).
  CHECK(interval.high - interval.low == Approx(2.0 * 2.2013 * error).epsilon(0.05));
  CHECK(0.5 * (interval.high + interval.low) == Approx(mean).margin(0.01));
}

/// Somebody who often takes a class for the next; the observer of everything is right in 70 % of
/// trials, and errs evenly.
ParticipantAnswers confused(int number, std::uint64_t study) {
  ParticipantAnswers one("P" + std::to_string(number), kClasses);
  RandomStream random(study, "confused", static_cast<std::uint64_t>(number));
  for (int i = 0; i < 5 * kClasses; ++i) {
    const int presented = i % kClasses;
    const int answer = random.uniform() < 0.7 ? presented : (presented + 1) % kClasses;
    AnswerShares shares(kClasses, 0.1);
    shares[presented] = 0.7;
    one.add({presented, answer, {shares, shares, shares}, {shares, shares, shares}});
  }
  return one;
}

TEST_CASE("a divergence lies in its interval, and is on average that of the probabilities") {
  const Counts human{0.7, 0.3, 0.0, 0.0};
  const Counts observer{0.7, 0.1, 0.1, 0.1};
  const double truth = jensen_shannon_bits(human, observer);
  for (const int participants : {6, 40}) {
    double sum = 0.0;
    constexpr int kStudies = 40;
    for (int study = 0; study < kStudies; ++study) {
      std::vector<ParticipantAnswers> all;
      for (int i = 0; i < participants; ++i) {
        all.push_back(confused(i, static_cast<std::uint64_t>(study)));
      }
      const CueFigure found = cue_statistics(all, 0, 1).divergence[2];
      CHECK(found.interval.value().low <= found.value.value());
      CHECK(found.interval.value().high >= found.value.value());
      sum += found.value.value() / kStudies;
    }
    CHECK(sum == Approx(truth).margin(0.01));
  }
}

TEST_CASE("the divergence of equal shares is 0 and of disjoint ones 1 bit") {
  CHECK(jensen_shannon_bits(Counts{3.0, 1.0}, Counts{6.0, 2.0}) == 0.0);
  CHECK(jensen_shannon_bits(Counts{4.0, 0.0}, Counts{0.0, 1.0}) == 1.0);
}

TEST_CASE("the divergence of a certainty and an even draw follows the formula") {
  // H(3/4, 1/4) - H(1, 0) / 2 - H(1/2, 1/2) / 2
  CHECK(jensen_shannon_bits(Counts{1.0, 0.0}, Counts{1.0, 1.0}) ==
        Approx(0.311278124459).margin(1e-11));
  CHECK(jensen_shannon_bits(Counts{1.0, 1.0}, Counts{1.0, 0.0}) ==
        Approx(0.311278124459).margin(1e-11));
}

TEST_CASE("classes that were never presented to somebody do not count") {
  const Counts one{1.0, 0.0, 1.0, 1.0};
  const Counts other{1.0, 1.0, 0.0, 0.0};
  CHECK(answer_divergence(one, other, 2).value() == Approx(0.311278124459).margin(1e-11));
  CHECK_FALSE(answer_divergence(Counts(4, 0.0), other, 2));
  const Counts both{1.0, 0.0, 0.0, 1.0};
  CHECK(answer_divergence(both, one, 2).value() == Approx(0.5 * 0.311278124459).margin(1e-11));
}

}  // namespace

}  // namespace touchtrial
