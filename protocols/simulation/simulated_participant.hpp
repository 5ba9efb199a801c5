/// \file A participant with a simulated hand and a sense of touch.
#pragma once

#include "core/random.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"
#include "engine/perception/felt_features.hpp"
#include "protocols/session/participant.hpp"
#include "protocols/simulation/felt_exploration.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "protocols/simulation/trial_course.hpp"
#include "study/order.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace touchtrial::simulation {

/// A choice or ratings, and the thinking time after exploring.
struct ParticipantAnswer {
  int position = 0;  ///< index of the picture, from 0
  std::chrono::nanoseconds thought{};
  std::vector<double> ratings{};  ///< if not empty, they replace the choice
};

/// A participant who replies to every step immediately, skips all questions of questionnaires, and
/// reports the lowest confidence. Subclasses explore and choose.
class PromptParticipant : public session::Participant {
 public:
  [[nodiscard]] std::optional<session::StepReply> show_step(const session::Step& step) final {
    session::StepReply reply;
    if (const auto* const answer_step = std::get_if<session::AnswerStep>(&step)) {
      on_question(*answer_step);
      const ParticipantAnswer choice = answer();
      if (choice.ratings.empty()) {
        reply.answer = ChoiceAnswer{choice.position};
      } else {
        reply.answer = RatingAnswer{choice.ratings};
      }
      reply.took = choice.thought;
      if (answer_step->confidence_levels > 0) reply.confidence = 1;
    }
    if (const auto* const question_step = std::get_if<session::QuestionStep>(&step)) {
      reply.answers.resize(question_step->questionnaire->questions.size());
    }
    if (std::holds_alternative<session::BreakStep>(step)) rest();
    if (const auto* const interval_step = std::get_if<session::IntervalStep>(&step)) {
      reply.took = kIntervalGap;
      interval(*interval_step);
    }
    return reply;
  }

  /// Answers after exploring.
  [[nodiscard]] virtual ParticipantAnswer answer() = 0;
  /// Called before each answer, with its question.
  virtual void on_question(const session::AnswerStep& /*step*/) {}
  /// Called at each break.
  virtual void rest() {}
  /// Called before each plane of a trial with several.
  virtual void interval(const session::IntervalStep& /*next*/) {}

 private:
  static constexpr std::chrono::seconds kIntervalGap{1};
};

/// A participant who strokes the plane on a new path in each trial and answers from felt features.
/// Random numbers depend only on the seed, the participant's number, and the number of earlier
/// trials. Subclasses make the choice. The subject must outlive it.
class SimulatedParticipant : public PromptParticipant {
 public:
  /// \param number  from 1
  SimulatedParticipant(const SubjectModel& subject, std::uint64_t seed, int number)
      : subject_(subject), seed_(seed), number_(number), sense_(subject) {}

  /// Starts a visit, with paths and noise that differ from those of earlier visits.
  /// \param visit  from 1
  /// \param course  the visit's trials; may be empty
  void start_visit(int visit, TrialCourse course = {}) {
    visit_ = visit;
    trials_begun_ = trials_before(visit);
    begin_visit(visit, std::move(course));
  }
  /// Receives the order that chooses presentations, for observers that need the level.
  /// \param order  of this visit
  virtual void follow(std::unique_ptr<study::Order> /*order*/) {}
  /// The offset of trial numbers at a visit. Visits do not share numbers, because no session has
  /// kTrialsOfVisit trials.
  [[nodiscard]] static std::uint64_t trials_before(int visit) noexcept {
    constexpr std::uint64_t kTrialsOfVisit = 1'000'000;
    return static_cast<std::uint64_t>(visit - 1) * kTrialsOfVisit;
  }

  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override;
  void feel(const device::ServoSample& sample) noexcept override;
  [[nodiscard]] ParticipantAnswer answer() final;

 protected:
  /// The answer to one presentation.
  /// \param felt  features without noise, natural logarithms of newtons
  /// \param random  stream_of_trial for kAnswerPurpose
  [[nodiscard]] virtual ParticipantAnswer choose(const engine::FeltFeatures& felt,
                                                 RandomStream& random) = 0;
  /// Called at the start of a visit.
  virtual void begin_visit(int /*visit*/, TrialCourse /*course*/) {}
  /// The features of the last exploration, without noise.
  [[nodiscard]] engine::FeltFeatures last_features() const noexcept { return sense_.features(); }
  /// The number of presentations, or intervals, that have begun in this visit.
  [[nodiscard]] int presentations_begun() const noexcept {
    return static_cast<int>(trials_begun_ - trials_before(visit_));
  }

 private:
  const SubjectModel& subject_;
  std::uint64_t seed_;
  int number_;
  HandSense sense_;
  std::optional<device::SimulatedHand> hand_;
  int visit_ = 1;
  std::uint64_t trials_begun_ = 0;
};

}  // namespace touchtrial::simulation
