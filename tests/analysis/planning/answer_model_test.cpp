#include "analysis/planning/answer_model.hpp"

#include "analysis/planning/planned_study.hpp"
#include "support/catch.hpp"

#include <cmath>

namespace touchtrial {
namespace {

const std::vector<planning::PictureLayout> kLayouts = {{2, 0, 1, 4, 3}, {4, 3, 2, 1, 0}};

/// A subject with every kind of error, equal for everybody.
simulation::SubjectModel erring_subject() {
  simulation::SubjectModel subject = planned_subject();
  subject.feature_noise = 1.0;
  subject.lapse = 0.15;
  subject.position_bias = 0.8;
  subject.class_bias = {{"brick", 0.5}, {"cloth", -0.3}};
  subject.label_swap = {{"bark", "cloth"}};
  return subject;
}

/// Compares counted answers with the model's probabilities, summed over layouts.
/// \param errors  largest difference, in standard errors of the counts
void require_alike(const PlannedStudy& planned, const simulation::SubjectModel& subject,
                   double errors) {
  constexpr int kParticipants = 600;
  constexpr int kRepeats = 20;
  const planning::FitCounts counts = simulated_counts(planned, subject, kParticipants, kRepeats, 5);
  const planning::AnswerTable table = planned.model(32).answers(subject, counts.layouts);
  const planning::Confusions observed = planning::observed_confusions(counts, counts.people);
  const planning::Confusions expected = planning::expected_confusions(counts, table);
  for (std::size_t m = 0; m < observed.size(); ++m) {
    for (std::size_t c = 0; c < 5; ++c) {
      double presented = 0.0;
      for (const double count : observed[m][c]) presented += count;
      for (std::size_t a = 0; a < 5; ++a) {
        const double p = expected[m][c][a] / presented;
        const double error = std::sqrt(presented * p * (1.0 - p));
        INFO(m << ": " << c << " answered " << a << ", " << observed[m][c][a] << " of "
               << expected[m][c][a]);
        CHECK(std::abs(observed[m][c][a] - expected[m][c][a]) <= errors * error + 1e-9);
      }
    }
  }
}

TEST_CASE("probabilities of answers are the shares of answers given one by one") {
  const PlannedStudy planned(120);
  // The largest of 25 standard normal numbers exceeds 4 once in 600 times. The error of the
  // quasi-random points is well below one.
  require_alike(planned, erring_subject(), 4.5);
}

TEST_CASE("probabilities of answers average over differences between people") {
  const PlannedStudy planned(60);
  simulation::SubjectModel subject = erring_subject();
  subject.feature_noise_spread = 0.5;
  subject.lapse_spread = 1.0;
  subject.position_bias_spread = 0.7;
  subject.class_bias_spread = 0.6;
  // Answers of one person are correlated: 600 people count less than their trials.
  require_alike(planned, subject, 8.0);
}

TEST_CASE("several images and methods have probabilities of their own") {
  const PlannedStudy planned(40, {.images = 2, .comparison = true});
  require_alike(planned, erring_subject(), 4.5);
}

TEST_CASE("probabilities add up to one, and do not depend on jobs or on codes") {
  const PlannedStudy planned(24);
  simulation::SubjectModel subject = erring_subject();
  subject.feature_noise_spread = 0.3;
  const planning::AnswerTable alone = planned.model(2, 1).answers(subject, kLayouts, true);
  const planning::AnswerTable crowd = planned.model(2, 4).answers(subject, kLayouts, true);
  for (int layout = 0; layout < 2; ++layout) {
    for (int place = 0; place < 5; ++place) {
      double sum = 0.0;
      for (int c = 0; c < 5; ++c) {
        sum += alone.answers(layout, place)[c];
        REQUIRE(alone.answers(layout, place)[c] == crowd.answers(layout, place)[c]);
        REQUIRE(alone.slopes(layout, place)[c] == crowd.slopes(layout, place)[c]);
      }
      CHECK(sum == Approx(1.0).margin(1e-12));
    }
  }
}

TEST_CASE("slopes by a picture's bias agree with finite differences") {
  const PlannedStudy planned(80);
  const planning::AnswerModel model = planned.model(4);
  const simulation::SubjectModel subject = erring_subject();
  const planning::AnswerTable here = model.answers(subject, kLayouts, true);
  constexpr double kStep = 1e-3;
  for (int picture = 0; picture < 5; ++picture) {
    simulation::SubjectModel more = subject;
    more.class_bias.push_back({planned.labels[picture], kStep});
    simulation::SubjectModel less = subject;
    less.class_bias.push_back({planned.labels[picture], -kStep});
    const planning::AnswerTable above = model.answers(more, kLayouts);
    const planning::AnswerTable below = model.answers(less, kLayouts);
    for (int place = 0; place < 5; ++place) {
      for (int c = 0; c < 5; ++c) {
        const double slope =
            (above.answers(1, place)[c] - below.answers(1, place)[c]) / (2.0 * kStep);
        // The difference is inexact where the winner changes within a step, which is rare.
        CHECK(here.slopes(1, place)[c * 5 + picture] == Approx(slope).margin(2e-3));
      }
    }
  }
}

TEST_CASE("stimuli that feel the same share their answers evenly, whatever the noise") {
  const PlannedStudy planned(8, {.smooth = true});
  simulation::SubjectModel subject = planned_subject();
  subject.feature_noise = GENERATE(1e-3, 0.5);
  const planning::AnswerTable table = planned.model().answers(subject, kLayouts);
  for (int place = 0; place < 5; ++place) {
    for (int c = 0; c < 5; ++c) CHECK(table.answers(0, place)[c] == Approx(0.2).margin(1e-9));
  }
}

TEST_CASE("answers that are all lapses are at chance") {
  const PlannedStudy planned(8);
  simulation::SubjectModel subject = planned_subject();
  subject.feature_noise = 0.3;
  subject.lapse = 1.0;
  const planning::AnswerTable lapsing = planned.model().answers(subject, kLayouts);
  for (int c = 0; c < 5; ++c) CHECK(lapsing.answers(0, 3)[c] == Approx(0.2).margin(1e-12));
}

TEST_CASE("the mean lapse of a population lies beyond its median lapse") {
  simulation::SubjectModel subject{.lapse = 0.05};
  CHECK(planning::mean_lapse(subject) == 0.05);
  subject.lapse_spread = 1.0;
  CHECK(planning::mean_lapse(subject) > 0.06);
  CHECK(planning::mean_lapse(subject) < 0.09);
  subject.lapse = 0.0;
  CHECK(planning::mean_lapse(subject) == 0.0);
}

}  // namespace
}  // namespace touchtrial
